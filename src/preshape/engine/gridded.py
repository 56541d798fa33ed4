"""The shortest shaper on a servo grid under any linear and conic constraints: the mesh is the grid, and stays.

For a number of slots the constraints are one convex programme; points of bands where more vibration remains than it
allows are added until the continuum of frequencies has none. The number of slots is found by bisection: more slots can
always do what fewer can.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.engine.constraints import AtMostImpulses, Constraint, ImpulsesBetween, ServoGrid, VibrationAtMost
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
    proved : bool
        Whether one slot fewer is impossible; with a limit on the number of impulses the time may not suffice for that.
    """

    leads: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    slots: int
    proved: bool


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
    low, high = 0, 1
    found = _at(constraints, grid, high)
    while found is None:
        if high >= most:
            return None
        low, high = high, min(2 * high, most)
        found = _at(constraints, grid, high)
    while high - low > 1:
        middle = (low + high) // 2
        trial = _at(constraints, grid, middle)
        if trial is None:
            low = middle
        else:
            high, found = middle, trial
    return found


def _at(constraints: Sequence[Constraint], grid: ServoGrid, slots: int) -> Gridded | None:
    """Amplitudes on a grid of so many slots, or None."""
    leads = grid.leads(slots)
    asks = [one for one in constraints if isinstance(one, VibrationAtMost)]
    edges = tuple(edge for ask in asks for edge in edges_of([ask.band], ask.tolerance))
    others = [one for one in constraints if not isinstance(one, VibrationAtMost | ServoGrid)]
    if not any(isinstance(one, ImpulsesBetween) for one in others):
        others.append(ImpulsesBetween(-1.0, 1.0))
    points = sampled_points(edges, float(leads[-1]))
    programme = gather([*others, *tolerated(points)], leads)
    for _ in range(MAXIMUM_EXCHANGES):
        amplitudes = _amplitudes(programme)
        if amplitudes is None:
            return None
        missed = _missed(edges, leads, amplitudes, points)
        if not missed:
            break
        points = sorted([*points, *missed], key=lambda point: edges.index(point[0]))
        programme = gather([*others, *tolerated(points)], leads, programme.basis)
    else:
        return None
    return _counted(programme, amplitudes, others, edges)


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


def _counted(
    programme: Programme, amplitudes: NDArray[np.float64], others: Sequence[Constraint], edges: Sequence[Edge]
) -> Gridded | None:
    """The solution, with no more impulses than allowed."""
    limit = min((one.count for one in others if isinstance(one, AtMostImpulses)), default=None)
    used = np.flatnonzero(amplitudes)
    slots = programme.leads.size - 1
    if limit is None or used.size <= limit:
        return Gridded(programme.leads[used] - programme.leads[used[0]], amplitudes[used], slots, True)
    few = fewest(programme, amplitudes, at_most=limit)
    if few.leads.size > limit or _missed(edges, few.leads, few.amplitudes, []):
        return None
    order = np.argsort(few.leads)
    return Gridded(few.leads[order] - few.leads[order[0]], few.amplitudes[order], slots, few.proved)
