"""The separating polynomial p(u) over the lead u: a combination of the constraints' functions, and where it is lowest.

  p(u) = c . g(u) + sum_k Re(conj(lambda_k) exp(-s_k u)) - sum_k v_k |lambda_k|

The first part belongs to zero vibration, the others to vibration of at most v_k at the points s_k. No positive shaper
that meets the constraints can make the integral of p positive, so p > 0 on an interval excludes all shapers there.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import BRACKET, EXACT, MAXIMUM_REFINEMENTS, SAMPLES_PER_PERIOD, Basis

__all__ = ["Polynomial"]

NO_RATES: NDArray[np.complex128] = np.zeros(0, dtype=complex)


class Polynomial:
    """p(u) with its derivatives.

    Parameters
    ----------
    basis : Basis or None
        Functions of zero vibration.
    multipliers : ndarray, shape (row,)
        c; without a basis, empty.
    rates, waves : ndarray of complex, shape (point,)
        s_k [1/s] and lambda_k [-].
    offset : float
        sum_k v_k |lambda_k| [-].
    """

    def __init__(
        self,
        basis: Basis | None,
        multipliers: NDArray[np.float64],
        rates: NDArray[np.complex128] = NO_RATES,
        waves: NDArray[np.complex128] = NO_RATES,
        offset: float = 0.0,
    ) -> None:
        self._basis, self._rates, self._offset = basis, -rates, offset
        own = [] if basis is None else basis.weights(multipliers, 4)
        self._weights: list[NDArray[np.float64]] = []
        for n in range(5 if rates.size else 0):
            wave = waves * (-rates.conj()) ** n
            self._weights.append(np.concatenate(([own[n]] if own else []) + [wave.real, wave.imag]))
        self._weights = self._weights or own
        fastest = float(np.abs(rates.imag).max()) / (2.0 * math.pi) if rates.size else 0.0
        self._fastest = fastest if basis is None else max(fastest, max(mode.frequency for mode in basis.modes))
        self._functions = rates.size + (0 if basis is None else basis.size // 2)

    def samples(self, stop: float) -> NDArray[np.float64]:
        """Even leads in [0, stop] [s] that show the extrema of p."""
        return np.linspace(0.0, stop, math.ceil(SAMPLES_PER_PERIOD * self._fastest * stop) + 8 * self._functions)

    def __call__(self, leads: NDArray[np.float64]) -> NDArray[np.float64]:
        """p at `leads` [s]."""
        values: NDArray[np.float64] = self._weights[0] @ self._rows(leads) - self._offset
        return values

    def _rows(self, leads: NDArray[np.float64]) -> NDArray[np.float64]:
        parts = [] if self._basis is None else [self._basis.raw(leads)]
        if self._rates.size:
            wave = np.exp(np.multiply.outer(self._rates, leads))
            parts += [wave.real, wave.imag]
        return parts[0] if len(parts) == 1 else np.concatenate(parts)

    def minima(
        self, stop: float, precision: float = EXACT, expected: NDArray[np.float64] | None = None
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
        """Leads [s] of all local minima on [0, stop], both ends included, the values there, and the largest |p|.

        Between neighbouring roots of p'' the slope is monotone, so none of its roots is missed there; samples alone
        would miss a minimum beside a maximum, which is what flat certificates have. Roots of p'' may hide beside each
        other in the same way, and are told apart by those of p'''. `precision` is that of the leads, relative to
        `stop`; minima that are near the `expected` leads are found sooner.
        """
        samples = self.samples(stop)
        rows = self._rows(samples)
        values, slopes, bends, thirds = (self._weights[n] @ rows for n in range(4))
        step = float(samples[1] - samples[0])
        # an extremum hides between two samples only where the slope is nearly zero, and its own slope too; a function
        # of one sign at both whose derivative changes its sign once comes nearer to zero only if it sets out that way
        bend, third = _larger(bends), _larger(thirds)
        near = _smaller(slopes) <= step * (bend + step * third)
        hidden = near & (_smaller(bends) <= 2.0 * step * third) & _dips(bends, thirds)
        nodes, bends, slopes, near = self._with_nodes(
            samples, self._refined(3, samples, thirds, np.flatnonzero(hidden), BRACKET * stop), bends, slopes, near
        )
        turning = self._refined(2, nodes, bends, np.flatnonzero(near & _dips(slopes, bends)), BRACKET * stop)
        nodes, _, slopes, _ = self._with_nodes(nodes, turning, bends, slopes, near)
        turns = np.flatnonzero((slopes[:-1] < 0.0) & (slopes[1:] >= 0.0))
        inner = self._refined(1, nodes, slopes, turns, precision * stop, expected)
        found = np.unique(np.concatenate([[0.0], inner, [stop]]))
        return found, self(found), float(np.abs(values - self._offset).max())

    def _with_nodes(
        self,
        nodes: NDArray[np.float64],
        more: NDArray[np.float64],
        bends: NDArray[np.float64],
        slopes: NDArray[np.float64],
        near: NDArray[np.bool_],
    ) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64], NDArray[np.bool_]]:
        """Nodes in order with `more` among them, p'' and p' there, and whether roots may hide after each."""
        if more.size == 0:
            return nodes, bends, slopes, near
        rows, every = self._rows(more), np.concatenate([nodes, more])
        order = np.argsort(every, kind="stable")
        bends = np.concatenate([bends, self._weights[2] @ rows])[order]
        slopes = np.concatenate([slopes, self._weights[1] @ rows])[order]
        near = np.concatenate([near, [False], np.ones(more.size, dtype=bool)])[order][:-1]
        return every[order], bends, slopes, near

    def _refined(
        self,
        derivative: int,
        nodes: NDArray[np.float64],
        values: NDArray[np.float64],
        change: NDArray[np.intp],
        precision: float,
        expected: NDArray[np.float64] | None = None,
    ) -> NDArray[np.float64]:
        """The root of the n-th derivative after each node `change`: Newton steps that bisection keeps inside.

        `values` are the derivative's at the nodes, and change their sign there.
        """
        low, high = nodes[change], nodes[change + 1]
        if low.size == 0:
            return low
        value_of, slope_of = self._weights[derivative], self._weights[derivative + 1]
        sign = np.where(values[change + 1] >= 0.0, 1.0, -1.0)
        guess = low + (high - low) * (values[change] / (values[change] - values[change + 1]))
        if expected is not None and expected.size:
            nearest = expected[np.minimum(np.searchsorted(expected, low), expected.size - 1)]
            guess = np.where((nearest >= low) & (nearest <= high), nearest, guess)
        for _ in range(MAXIMUM_REFINEMENTS):
            rows = self._rows(guess)
            value, slope = sign * (value_of @ rows), sign * (slope_of @ rows)
            low, high = np.where(value < 0.0, guess, low), np.where(value < 0.0, high, guess)
            step = guess - value / np.where(slope > 0.0, slope, np.inf)
            inside = (step >= low) & (step <= high) & (slope > 0.0)
            following = np.where(inside, step, 0.5 * (low + high))
            moved = float(np.abs(following - guess).max())
            guess = following
            if moved <= precision:
                break
        return guess


def _dips(values: NDArray[np.float64], slopes: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether |values| falls after each node and rises again before the next, without a change of their sign."""
    positive, rising = values >= 0.0, slopes >= 0.0
    dips: NDArray[np.bool_] = (
        (positive[:-1] == positive[1:]) & (rising[:-1] != rising[1:]) & (positive[:-1] != rising[:-1])
    )
    return dips


def _smaller(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The smaller magnitude of each value and the next."""
    return np.minimum(np.abs(values[:-1]), np.abs(values[1:]))


def _larger(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The larger magnitude of each value and the next."""
    return np.maximum(np.abs(values[:-1]), np.abs(values[1:]))
