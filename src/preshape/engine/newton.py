"""Newton's method on the optimality system: amplitudes, times, duration and multipliers at their exact values.

Unknown are a_1..a_N, t_2..t_N (t_1 = 0) and c in R^m; the equations are
  sum a_i g(t_i) = 0, sum a_i = 1;  p(t) = c.g(t): p(t_i) = 0 for all i, p'(t_i) = 0 for the interior ones;  |c| = 1.
One row is redundant and harmonics drop the rank further, so each step is a least-squares step.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import Basis

__all__ = ["Polished", "polish"]

ACCEPTED = 10.0
"""An equation error of up to this many times the basis' rounding level counts as zero."""

NOTHING = 1e-12
"""An amplitude of this size is zero: harmonics leave impulses in the start that the solution does not need."""

MAXIMUM_STEPS = 40

LARGEST_MOVE = 0.3
"""No impulse moves by more than this fraction of the smallest gap in one step, so that the order is kept."""

RANK_TOLERANCE = 1e-12


@dataclass(frozen=True)
class Polished:
    """A stationary point of the optimality system.

    Parameters
    ----------
    times, amplitudes : ndarray, shape (impulse,)
        [s] and [-].
    multipliers : ndarray, shape (row,)
        Unit vector c.
    error : float
        Largest equation error [-], in units of what rounding allows at best.
    """

    times: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    multipliers: NDArray[np.float64]
    error: float

    @property
    def converged(self) -> bool:
        """Whether this is a shaper at all: the equations hold and no amplitude is negative."""
        return self.error <= ACCEPTED and bool((self.amplitudes > -NOTHING).all())

    def without_empty_impulses(self) -> Polished:
        """The same without the impulses whose amplitude is nothing but rounding."""
        keep = self.amplitudes > NOTHING
        return replace(self, times=self.times[keep], amplitudes=self.amplitudes[keep])


def polish(
    basis: Basis, times: NDArray[np.float64], amplitudes: NDArray[np.float64], multipliers: NDArray[np.float64]
) -> Polished:
    """Solve the optimality system from a start near its solution."""
    scale = basis.duration
    t, a, c = times.copy(), amplitudes.copy(), multipliers.copy()
    t[0] = 0.0
    count, size = t.size, basis.size
    best = Polished(t, a, c, np.inf)
    for _ in range(MAXIMUM_STEPS):
        g, slope, curve = basis(t), basis(t, 1) * scale, basis(t, 2) * scale**2
        p, p_slope, p_curve = c @ g, c @ slope, c @ curve
        equations = np.concatenate([g @ a, [a.sum() - 1.0], p, p_slope[1:-1], [c @ c - 1.0]])
        error = float(np.abs(equations).max()) / basis.rounding
        if error < best.error:
            best = Polished(t.copy(), a.copy(), c.copy(), error)
        if error <= 1.0 or not np.isfinite(error):
            break
        jacobian = np.zeros((equations.size, 2 * count - 1 + size))
        jacobian[:size, :count] = g
        jacobian[:size, count : 2 * count - 1] = (slope * a)[:, 1:]
        jacobian[size, :count] = 1.0
        touching = slice(size + 1, size + 1 + count)
        jacobian[touching, 2 * count - 1 :] = g.T
        jacobian[touching, count : 2 * count - 1] = np.diag(p_slope)[:, 1:]
        flat = slice(size + 1 + count, size + 2 * count - 1)
        jacobian[flat, 2 * count - 1 :] = slope.T[1:-1]
        jacobian[flat, count : 2 * count - 1] = np.diag(p_curve)[1:-1, 1:]
        jacobian[-1, 2 * count - 1 :] = 2.0 * c
        step = -np.linalg.lstsq(jacobian, equations, rcond=RANK_TOLERANCE)[0]
        move = float(np.abs(step[count : 2 * count - 1]).max()) * scale
        shorten = min(1.0, LARGEST_MOVE * float(np.diff(t).min()) / move) if move > 0.0 else 1.0
        a = a + shorten * step[:count]
        t = t.copy()
        t[1:] += shorten * step[count : 2 * count - 1] * scale
        c = c + shorten * step[2 * count - 1 :]
    return _settled(basis, best)


def _settled(basis: Basis, polished: Polished) -> Polished:
    """Meet the constraints to the last digit: orthonormal rows of near-equal modes carry more rounding than raw ones.

    The smallest change of amplitudes and times that does it is far below what the optimality equations can see.
    """
    t, a = polished.times.copy(), polished.amplitudes.copy()
    count = t.size
    for _ in range(2):
        rows, slopes = basis.raw(t), basis.raw(t, 1) * basis.duration
        jacobian = np.block([[rows, (slopes * a)[:, 1:]], [np.ones((1, count)), np.zeros((1, count - 1))]])
        step = np.linalg.lstsq(jacobian, -np.append(rows @ a, a.sum() - 1.0), rcond=RANK_TOLERANCE)[0]
        a = a + step[:count]
        t[1:] += step[count:] * basis.duration
    return replace(polished, times=t, amplitudes=a)
