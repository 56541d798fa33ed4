"""Lower bounds on the time of a move, from a function p that no command can beat.

Take any constant c, any phasors, any signed masses and densities m on the outputs, and any waves q on the tolerances:
  p(t) = (T - t) - c + sum_j e_j(t),   e_j'' - 2 z w e_j' + w^2 e_j = -w^2 (masses and densities of mode j).
Every force |v| <= 1 that has the modes at rest at T, keeps the outputs within 1 and the vibration within V moves by
  X(T) = integral (T - t) v dt  <=  integral |p| dt + sum |m| + sum V |q|,
since what p adds to T - t integrates to quantities that are zero or limited. A command that ends earlier is one that is
zero afterwards, so what |p| and m amount to there comes off the right side: if X must be the target, that part cannot
be more than the right side exceeds the target by. This holds for every p; a good one makes the bound sharp.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.command.rest_to_rest.shortest.problem import Problem, kappa
from preshape.command.rest_to_rest.shortest.programme import Farthest

__all__ = ["Witness", "from_grid"]

SAMPLES_PER_PERIOD = 32
"""Samples between which p changes its sign at most once, its turning points being looked at besides."""

FEWEST_SAMPLES = 6

ROUNDING = 1e-14
"""Sums are known to this part of them; the bound allows for it."""

BISECTIONS = 60


@dataclass(frozen=True, eq=False)
class Witness:
    """The function p in pieces, and the price of its masses, densities and waves.

    Parameters
    ----------
    times : ndarray, shape (piece + 1,)
        Ends of the pieces, increasing from 0 [s].
    phasors : ndarray of complex, shape (piece, wave)
        On each piece, sum_j e_j(t) = Re sum phasor exp(-s (its end - t)) [s].
    rates : ndarray of complex, shape (wave,)
        s of modes and tolerated points [1/s].
    constant : float
        c [s].
    zero : ndarray of bool, shape (piece,)
        Pieces on which a density makes p zero.
    masses : ndarray, shape (piece,)
        What |m| amounts to on each piece and at its beginning [s^2].
    price : float
        sum V |q| [s^2].
    """

    times: NDArray[np.float64]
    phasors: NDArray[np.complex128]
    rates: NDArray[np.complex128]
    constant: float
    zero: NDArray[np.bool_]
    masses: NDArray[np.float64]
    price: float

    def values(self, times: NDArray[np.float64], pieces: NDArray[np.intp], derivative: int = 0) -> NDArray[np.float64]:
        """p, its first derivative (1) or its integral (-1) at `times` [s] within `pieces`, shape (sample,)."""
        lead = self.times[pieces + 1] - times
        waves = self.phasors[pieces] * np.exp(-np.multiply.outer(lead, self.rates))
        total = np.real(waves * self.rates ** float(derivative)).sum(axis=1)
        line = self.times[-1] - times - self.constant
        rest = {0: line, 1: np.full_like(line, -1.0), -1: -0.5 * line**2}[derivative]
        return np.where(self.zero[pieces], 0.0, total + rest)

    def least_duration(self, target: float) -> float:
        """No command moves by `target` [s^2] in less than this time [s]."""
        left, right, pieces = self._of_one_sign()
        areas = np.abs(self.values(right, pieces, -1) - self.values(left, pieces, -1))
        reach = float(areas.sum() + self.masses.sum()) + self.price
        excess = max(reach - target, 0.0) + ROUNDING * (reach + target) + self._cancelled()
        # A mass comes off only with all of its piece, so it is counted where the piece ends, seen from the end removed.
        first, last = np.flatnonzero(np.diff(pieces, prepend=-1)), np.flatnonzero(np.diff(pieces, append=-1))
        from_left, from_right = areas.copy(), areas.copy()
        from_left[last] += self.masses[pieces[last]]
        from_right[first] += self.masses[pieces[first]]
        if excess >= from_left.sum():
            return 0.0
        gone = np.cumsum(from_left)
        k = int(np.searchsorted(gone, excess))
        begin = self._at_area(left[k], right[k], pieces[k], excess - gone[k] + from_left[k])
        gone = np.cumsum(from_right[::-1])[::-1]
        k = areas.size - 1 - int(np.searchsorted(gone[::-1], excess))
        end = self._at_area(right[k], left[k], pieces[k], excess - gone[k] + from_right[k])
        return float(max(end - left[0], right[-1] - begin))

    def signs(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Where intervals begin in which p keeps its sign [s], and the signs; no two neighbours have the same."""
        left, right, pieces = self._of_one_sign()
        sign = np.sign(self.values(0.5 * (left + right), pieces))
        left, sign = left[sign != 0.0], sign[sign != 0.0]
        changes = np.append(True, np.diff(sign) != 0.0)
        return left[changes], sign[changes]

    def _cancelled(self) -> float:
        """What rounding leaves of the integral of \\|p\\| where large parts of p cancel [s^2].

        Between two changes of its sign it is the difference of two antiderivatives, each with the error of its parts.
        """
        lead = float(self.times[-1] - self.times[0])
        parts = (np.abs(self.phasors) / np.abs(self.rates)).sum(axis=1)
        line = (lead + abs(self.constant)) ** 2
        return float(np.finfo(float).eps * (parts.sum() + line))

    def _at_area(self, start: float, stop: float, piece: int, area: float) -> float:
        """The time, from `start` towards `stop`, where the integral of p from there on amounts to `area`."""
        where = np.array([piece])
        origin = float(self.values(np.array([start]), where, -1)[0])
        for _ in range(BISECTIONS):
            middle = 0.5 * (start + stop)
            if abs(float(self.values(np.array([middle]), where, -1)[0]) - origin) < area:
                start = middle
            else:
                stop = middle
        return stop

    def _of_one_sign(self) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.intp]]:
        """Starts and ends [s] of intervals in which p keeps its sign, and the pieces they are in."""
        span = np.diff(self.times)
        fastest = float(np.abs(self.rates).max()) / (2.0 * np.pi)
        counts = FEWEST_SAMPLES + np.ceil(span * fastest * SAMPLES_PER_PERIOD).astype(int)
        pieces = np.repeat(np.arange(span.size), counts)
        within = np.concatenate([np.linspace(0.0, 1.0, count) for count in counts])
        times = self.times[pieces] + within * span[pieces]
        times[within == 1.0] = self.times[1:]
        for derivative in (1, 0):
            value = self.values(times, pieces, derivative)
            found = np.flatnonzero((value[:-1] * value[1:] < 0.0) & (pieces[:-1] == pieces[1:]))
            roots = self._roots(times[found], times[found + 1], pieces[found], derivative)
            times, pieces = np.concatenate([times, roots]), np.concatenate([pieces, pieces[found]])
            # by pieces first: a root may be at the joint, and then belongs to the piece before it or after it
            order = np.lexsort((times, pieces))
            times, pieces = times[order], pieces[order]
        inside = pieces[:-1] == pieces[1:]
        return times[:-1][inside], times[1:][inside], pieces[:-1][inside]

    def _roots(
        self, low: NDArray[np.float64], high: NDArray[np.float64], pieces: NDArray[np.intp], derivative: int
    ) -> NDArray[np.float64]:
        if low.size == 0:
            return low
        rising = self.values(high, pieces, derivative) > 0.0
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            above = (self.values(middle, pieces, derivative) > 0.0) == rising
            low, high = np.where(above, low, middle), np.where(above, middle, high)
        return np.asarray(0.5 * (low + high))


def from_grid(problem: Problem, found: Farthest) -> Witness:
    """The p of a solution on a grid: a mass at every sample."""
    rates = np.concatenate([problem.rates, found.points])
    modes = problem.rates.size
    times = np.append(found.sample_times, found.times[-1])
    kicks, masses = np.zeros((times.size - 1, rates.size), dtype=complex), np.zeros(times.size - 1)
    if problem.rows.size:
        kicks[:, :modes] = found.masses.T @ (problem.rows * (kappa(problem.rates) * problem.rates))
        masses = np.abs(found.masses).sum(axis=0)
    turned = np.exp(-np.multiply.outer(np.diff(times), rates))
    phasors = np.zeros_like(kicks)
    phasor = np.conj(found.waves) * rates
    for k in range(times.size - 2, -1, -1):
        phasors[k] = phasor
        phasor = phasor * turned[k] - kicks[k]
    price = float(np.abs(found.waves[modes:]) @ found.tolerances)
    return Witness(times, phasors, rates, found.velocity, np.zeros(times.size - 1, dtype=bool), masses, price)
