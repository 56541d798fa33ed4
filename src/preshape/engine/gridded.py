"""The shortest shaper on a servo grid under any linear and conic constraints: the mesh is the grid, and stays.

For a number of slots the constraints are one convex programme; points of bands where more vibration remains than it
allows are added until the continuum of frequencies has none. The number of slots is found by bisection: more slots can
always do what fewer can.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.engine.constraints import (
    AtMostImpulses,
    Constraint,
    ImpulsesBetween,
    PartialSumsBetween,
    ServoGrid,
    VibrationAtMost,
)
from preshape.engine.edges import Edge, edges_of, vibration_peaks
from preshape.engine.fewest import amplitudes_at, fewest
from preshape.engine.programme import Programme, gather, solve
from preshape.engine.tolerant_search import Point, sampled_points, tolerated

__all__ = ["Gridded", "shortest_on_grid"]

EXCESS = 1e-8
"""Cones and inequalities count as met up to this [-], ten times what the conic solver is asked for."""

MISSED = 1e-7
"""Vibration between the points may exceed the tolerance by this fraction before a point is added."""

SMALL = (1e-4, 1e-6, 1e-8)
"""Parts of the largest amplitude below which an impulse is tried to be done without."""

MAXIMUM_EXCHANGES = 30

WAITING = 1e-9
"""V is measured at the last impulse. Where it only falls below the tolerance some time after the others (heavy
damping), a last impulse of this size [-] marks when."""

TIME_LIMIT, GROWTH = 20.0, 1.15
"""Seconds for a search with a limit on the number of impulses, and from one number of slots to the next in it."""

MOST_SLOTS = 4000
"""More slots than this make the programme too large to answer soon."""


@dataclass(frozen=True)
class Gridded:
    """The outcome of :func:`shortest_on_grid`.

    Parameters
    ----------
    leads, amplitudes : ndarray, shape (impulse,)
        [s] and [-].
    slots : int
        Grid steps from the first to the last impulse.
    too_short : int
        The largest number of slots known to be impossible; one fewer than `slots` when that is proved the least. With a
        limit on the number of impulses the time may not suffice for that.
    """

    leads: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    slots: int
    too_short: int

    @property
    def proved(self) -> bool:
        """Whether one slot fewer is impossible."""
        return self.too_short == self.slots - 1


@dataclass(frozen=True)
class _Trial:
    """Amplitudes at all leads of a number of slots, or None; whether None is certain."""

    amplitudes: NDArray[np.float64] | None
    certain: bool = True


def shortest_on_grid(constraints: Sequence[Constraint], grid: ServoGrid, longest: float) -> Gridded | None:
    """The fewest slots that meet all `constraints`, or None when up to `longest` [s] none do.

    Parameters
    ----------
    constraints : sequence of Constraint
        Zero or tolerated vibration, limits of impulses, partial sums and responses, a number of impulses.
    grid : ServoGrid
        Its dt is the step.
    longest : float
        Where to stop [s].
    """
    most = min(math.ceil(longest / grid.dt), MOST_SLOTS)
    limit = min((one.count for one in constraints if isinstance(one, AtMostImpulses)), default=math.inf)
    found = _bisected(lambda slots: _at(constraints, grid, slots), grid, 0, most, 2.0)
    if found is None or found.leads.size <= limit:
        return found
    end = time.monotonic() + TIME_LIMIT

    def counted(slots: int) -> _Trial:
        left = end - time.monotonic()
        return _at(constraints, grid, slots, int(limit), left) if left > 0.0 else _Trial(None, False)

    return _bisected(counted, grid, found.too_short, most, GROWTH)


def _bisected(
    trial_at: Callable[[int], _Trial], grid: ServoGrid, too_short: int, most: int, growth: float
) -> Gridded | None:
    """The fewest slots that a trial calls enough, above `too_short`; None when up to `most` are not."""
    low, high, certain = too_short, too_short + 1, too_short
    trial = trial_at(high)
    while trial.amplitudes is None:
        if high >= most:
            return None
        certain = high if trial.certain else certain
        low, high = high, min(max(high + 1, math.ceil(growth * high)), most)
        trial = trial_at(high)
    used = np.flatnonzero(trial.amplitudes)
    amplitudes, high = trial.amplitudes[used], max(int(used[-1]), low + 1)
    while high - low > 1:
        middle = (low + high) // 2
        trial = trial_at(middle)
        if trial.amplitudes is None:
            low, certain = middle, max(certain, middle) if trial.certain else certain
        else:
            used = np.flatnonzero(trial.amplitudes)
            amplitudes, high = trial.amplitudes[used], max(int(used[-1]), low + 1)
    return Gridded(used * np.float64(grid.dt), amplitudes, high, certain)


def _at(
    constraints: Sequence[Constraint], grid: ServoGrid, slots: int, limit: int | None = None, seconds: float = 0.0
) -> _Trial:
    """Amplitudes on a grid of so many slots; no more than `limit` of them, looked for for some `seconds`."""
    leads = grid.leads(slots)
    asks = [one for one in constraints if isinstance(one, VibrationAtMost)]
    edges = tuple(edge for ask in asks for edge in edges_of([ask.band], ask.tolerance))
    others = [one for one in constraints if not isinstance(one, VibrationAtMost | ServoGrid)]
    if not any(isinstance(one, ImpulsesBetween) for one in others):
        span = _span(others)
        others.append(ImpulsesBetween(-span, span))
    points = sampled_points(edges, float(leads[-1]))
    programme = gather([*others, *tolerated(points)], leads)
    end = time.monotonic() + seconds
    for _ in range(MAXIMUM_EXCHANGES):
        amplitudes = _amplitudes(programme)
        if amplitudes is None:
            return _Trial(None)
        if limit is not None and np.count_nonzero(amplitudes) > limit:
            few = fewest(programme, amplitudes, at_most=limit, time_limit=end - time.monotonic())
            if few.leads.size > limit:
                return _Trial(None, few.at_least > limit)
            amplitudes = np.zeros(leads.size)
            amplitudes[np.searchsorted(leads, few.leads)] = few.amplitudes
        amplitudes = _ended(edges, leads, amplitudes)
        missed = _missed(edges, leads, amplitudes, points)
        if not missed:
            return _Trial(amplitudes)
        points = sorted([*points, *missed], key=lambda point: edges.index(point[0]))
        programme = gather([*others, *tolerated(points)], leads, programme.basis)
    return _Trial(None, False)


def _ended(edges: Sequence[Edge], leads: NDArray[np.float64], amplitudes: NDArray[np.float64]) -> NDArray[np.float64]:
    """The same with an impulse at lead 0: all moved there, or where that exceeds a tolerance a tiny one added."""
    first = int(np.flatnonzero(amplitudes)[0])
    if first == 0:
        return amplitudes
    moved = np.roll(amplitudes, -first)
    if not _missed(edges, leads, moved, []):
        return moved
    ended = amplitudes.copy()
    ended[0] = WAITING
    return ended


def _span(constraints: Sequence[Constraint]) -> float:
    """What an impulse may be when nothing says: partial sums within limits differ by no more than these do."""
    spans = [one.high - one.low for one in constraints if isinstance(one, PartialSumsBetween)]
    return min((span for span in spans if math.isfinite(span)), default=1.0)


def _amplitudes(programme: Programme) -> NDArray[np.float64] | None:
    """Amplitudes that meet the programme, of all these the ones with the least mean delay; None when there are none."""
    elastic = programme.radii.size > 0 or programme.limits.size > 0
    earliest = -programme.leads / programme.leads[-1]
    solution = solve(programme) if elastic else solve(programme, cost=earliest)
    if not solution.solved or solution.excess > EXCESS:
        return None
    if elastic and solution.excess < -EXCESS:
        quickest = solve(programme, cost=earliest)
        solution = quickest if quickest.solved else solution
    # interior-point methods leave a little everywhere: try without it, else with all but rounding
    sizes = np.abs(solution.amplitudes)
    for smallest in SMALL:
        amplitudes = amplitudes_at(programme, sizes > smallest * sizes.max())
        if amplitudes is not None:
            return amplitudes
    result: NDArray[np.float64] = solution.amplitudes / solution.amplitudes.sum()
    return result


def _missed(
    edges: Sequence[Edge], leads: NDArray[np.float64], amplitudes: NDArray[np.float64], points: Sequence[Point]
) -> list[Point]:
    """Peaks above the tolerance that are not among the points."""
    return [
        (peak.edge, peak.w)
        for peak in vibration_peaks(edges, leads, amplitudes)
        if peak.excess > MISSED and (peak.edge, peak.w) not in points
    ]
