"""Newton's method on the optimality system: amplitudes, times, duration and multipliers at their exact values.

Unknown are a_1..a_N, the leads u_2..u_N (u_1 = 0) and c in R^m; the equations are
  sum a_i g(u_i) = 0, sum a_i = 1;  p(u) = c.g(u): p(u_i) = 0 for all i, p'(u_i) = 0 for the interior ones;  |c| = 1.
One of them is redundant (sum a_i p(u_i) = 0), so p(u_k) = 0 is left out for the largest impulse k, where the others
determine it best, and the system is square. Harmonics drop the rank further: then, and only then, a step is the
least-squares one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import Basis, plain_rows

__all__ = ["Polished", "polish", "settled"]

ACCEPTED = 10.0
"""An equation error of up to this many roundings of the basis, times the root of its size, counts as zero."""

NOTHING = 1e-12
"""An amplitude of this size is zero: harmonics leave impulses in the start that the solution does not need."""

MAXIMUM_STEPS = 40

LARGEST_MOVE = 0.3
"""No impulse moves by more than this fraction of the smallest gap in one step, so that the order is kept."""

SINGULAR = 1e-14
"""A reciprocal condition number below this calls for the least-squares step."""

STILL = 1e-8
"""After a step of this relative size the next one is rounding; a small error alone does not say so when near-equal
modes make the duration ill-determined."""

RANK_TOLERANCE = 1e-12

MET = 4e-15
"""Equations of the papers that are missed by no more than this [-] are met to the last digits."""

PARALLEL = 1e-7
"""Rows of the papers that differ by less than this fraction are left to the orthonormal ones."""


@dataclass(frozen=True)
class Polished:
    """A stationary point of the optimality system.

    Parameters
    ----------
    leads, amplitudes : ndarray, shape (impulse,)
        Times before the last impulse, increasing from 0 [s], and [-].
    multipliers : ndarray, shape (row,)
        Unit vector c.
    error : float
        Largest equation error [-], in units of what rounding allows at best.
    minima : (ndarray, ndarray, float) or None
        Where p is lowest, as Polynomial.minima gives it, if that has been looked at.
    """

    leads: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    multipliers: NDArray[np.float64]
    error: float
    minima: tuple[NDArray[np.float64], NDArray[np.float64], float] | None = None

    @property
    def converged(self) -> bool:
        """Whether this is a shaper at all: the equations hold and no amplitude is negative."""
        return self.error <= ACCEPTED * math.sqrt(self.multipliers.size) and bool((self.amplitudes > -NOTHING).all())

    def without_empty_impulses(self) -> Polished:
        """The same without the impulses whose amplitude is nothing but rounding."""
        keep = self.amplitudes > NOTHING
        return self if keep.all() else replace(self, leads=self.leads[keep], amplitudes=self.amplitudes[keep])


def polish(
    basis: Basis,
    leads: NDArray[np.float64],
    amplitudes: NDArray[np.float64],
    multipliers: NDArray[np.float64],
    steps: int = MAXIMUM_STEPS,
) -> Polished:
    """Solve the optimality system from a start near its solution, in at most `steps` steps."""
    scale = basis.duration
    u, a, c = leads.copy(), amplitudes.copy(), multipliers.copy()
    u[0] = 0.0
    count, size = u.size, basis.size
    best = Polished(u, a, c, np.inf)
    total, unknown = size + 2 * count - 1, np.arange(count)
    others = np.delete(unknown, int(np.argmax(a)))
    moving = np.flatnonzero(others)
    touching, flat = slice(size + 1, size + count), slice(size + count, total - 1)
    jacobian = np.zeros((total, total))
    jacobian[size, :count] = 1.0
    equations = np.empty(total)
    stalled, moved = 0, math.inf
    for _ in range(steps):
        raw = basis.raw(u)
        g, slope, curve = basis.values(raw), basis.slopes(raw, 1) * scale, basis.slopes(raw, 2) * scale**2
        p_slope = c @ slope
        equations[:size], equations[size], equations[-1] = g @ a, a.sum() - 1.0, c @ c - 1.0
        equations[touching], equations[flat] = (c @ g)[others], p_slope[1:-1]
        error = float(np.abs(equations).max()) / basis.rounding
        stalled = 0 if error < 0.5 * best.error else stalled + 1
        if error < best.error:
            best = Polished(u.copy(), a.copy(), c.copy(), error)
        if not np.isfinite(error) or (stalled > 2 and best.error <= ACCEPTED):
            break
        if best.error <= 1.0 and (moved <= STILL or stalled > 0):
            break
        jacobian[:size, :count] = g
        jacobian[:size, count : 2 * count - 1] = (slope * a)[:, 1:]
        jacobian[touching, 2 * count - 1 :] = g.T[others]
        jacobian[moving + size + 1, others[moving] + count - 1] = p_slope[others[moving]]
        jacobian[flat, 2 * count - 1 :] = slope.T[1:-1]
        jacobian[unknown[1:-1] + size + count - 1, unknown[1:-1] + count - 1] = (c @ curve)[1:-1]
        jacobian[-1, 2 * count - 1 :] = 2.0 * c
        step = _step(jacobian, equations)
        moved = float(np.abs(step[count : 2 * count - 1]).max())
        move = moved * scale
        shorten = min(1.0, LARGEST_MOVE * float(np.diff(u).min()) / move) if move > 0.0 else 1.0
        a = a + shorten * step[:count]
        u = u.copy()
        u[1:] += shorten * step[count : 2 * count - 1] * scale
        c = c + shorten * step[2 * count - 1 :]
    return best


def settled(basis: Basis, polished: Polished) -> Polished:
    """Meet the constraints to the last digit: orthonormal rows carry more rounding than those of the papers.

    The smallest change of amplitudes and times that does it is far below what the optimality equations can see. What
    near-equal modes ask beyond that, the orthonormal rows have already met better than the papers' rows could.
    """
    u, a = polished.leads.copy(), polished.amplitudes.copy()
    count = u.size
    rows, slopes = plain_rows(basis.modes, basis.orders, u, basis.duration)
    missed = np.append(rows @ a, a.sum() - 1.0)
    if float(np.abs(missed).max()) <= MET:
        return polished
    jacobian = np.block([[rows, (slopes * a)[:, 1:] * basis.duration], [np.ones((1, count)), np.zeros((1, count - 1))]])
    step = np.linalg.lstsq(jacobian, -missed, rcond=PARALLEL)[0]
    u[1:] += step[count:] * basis.duration
    return replace(polished, leads=u, amplitudes=a + step[:count])


def _step(jacobian: NDArray[np.float64], equations: NDArray[np.float64]) -> NDArray[np.float64]:
    """-J^-1 e by elimination, or the least-squares step when J is singular to working precision.

    Columns are scaled to length one first: leads of tiny impulses have short ones, which are small, but not dependent.
    """
    from scipy.linalg.lapack import dgecon, dgetrf, dgetrs

    lengths = np.linalg.norm(jacobian, axis=0)
    lengths = np.where(lengths > 0.0, lengths, 1.0)
    scaled = jacobian / lengths
    factors, pivots, trouble = dgetrf(scaled)
    if trouble == 0:
        reciprocal, _ = dgecon(factors, np.abs(scaled).sum(axis=0).max())
        if reciprocal > SINGULAR:
            solution, _ = dgetrs(factors, pivots, equations)
            return np.asarray(-solution / lengths)
    return np.asarray(-np.linalg.lstsq(scaled, equations, rcond=RANK_TOLERANCE)[0] / lengths)
