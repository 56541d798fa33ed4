"""Reading the arcs of a structure off a solution on a grid: where Newton's method begins."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from preshape.command.rest_to_rest.shortest.contacts import Hold, contacts_of
from preshape.command.rest_to_rest.shortest.problem import Problem
from preshape.command.rest_to_rest.shortest.programme import Farthest
from preshape.command.rest_to_rest.shortest.structure import Arc, Structure

__all__ = ["read_arcs", "transitions"]

FULL = 1e-3
"""A level this near 1 is full [-]; the solver stays that far away from it only where it does not matter."""

SMEARED = 3
"""A change of sign over this many intervals may be more than one switch."""

EMPTY = 1e-4
"""An arc shorter than this fraction of an interval is none."""


def read_arcs(problem: Problem, found: Farthest, split: bool = False) -> Structure:
    """The arcs that a solution on a grid approximates.

    Parameters
    ----------
    problem : Problem
        What was solved.
    found : Farthest
        The solution.
    split : bool
        Whether to read a change of sign that is smeared over several intervals as three switches close to each other
        instead of one. Near moves that a single switch would do, the solver does not tell them apart.
    """
    holds, touches = contacts_of(problem, found)
    end = float(found.times[-1])
    arcs: list[Arc] = []
    before: Hold | None = None
    for hold in [*holds, None]:
        bangs = _bangs(found, before.loose[1] if before else 0.0, hold.loose[0] if hold else end, split)
        if before is not None and bangs:
            bangs[0] = replace(bangs[0], start=before.left(found, bangs[0].level))
        arcs += bangs
        if hold is not None:
            arcs += _entry(problem, found, before, hold, bangs)
        before = hold
    arcs = arcs or [Arc(0.0, 1.0)]
    for k in range(len(arcs) - 1, 0, -1):
        if arcs[k].level == arcs[k - 1].level and arcs[k - 1].row is None:
            arcs[k - 1 : k + 1] = [replace(arcs[k], start=arcs[k - 1].start)]
    arcs[0] = replace(arcs[0], start=0.0)
    return Structure(tuple(arcs), tuple(touches), end)


def transitions(problem: Problem, found: Farthest) -> NDArray[np.bool_]:
    """Intervals of the grid in or next to which something changes, shape (interval,): where a finer grid would help."""
    holds, touches = contacts_of(problem, found)
    marked = np.abs(found.levels) < 1.0 - FULL
    for hold in holds:
        marked &= ~((found.times[:-1] >= hold.tight[0]) & (found.times[1:] <= hold.tight[1]))
    marked[1:] |= found.levels[1:] * found.levels[:-1] < 0.0
    moments = np.array([time for hold in holds for time in hold.loose] + [touch.time for touch in touches])
    marked[np.clip(np.searchsorted(found.times, moments) - 1, 0, marked.size - 1)] = True
    wide = marked.copy()
    wide[1:] |= marked[:-1]
    wide[:-1] |= marked[1:]
    return wide


def _entry(problem: Problem, found: Farthest, before: Hold | None, hold: Hold, bangs: list[Arc]) -> list[Arc]:
    """The arc of a hold, after `bangs` or directly after another hold."""
    same = before is not None and before.row == hold.row
    if same and before is not None and not bangs:
        return [] if before.sign == hold.sign else _reversal(problem, before, hold)
    start = hold.entered(found, bangs[-1].level) if bangs else hold.loose[0]
    return [Arc(start, hold.level, hold.row, hold.sign)]


def _reversal(problem: Problem, before: Hold, after: Hold) -> list[Arc]:
    """From one limit of a mode to the other at full force, where the grid is too coarse to show it.

    In the middle between the two holds, and as long as an undamped mode takes.
    """
    rate = float(np.abs(problem.rates[problem.rows[before.row] != 0.0]).max())
    middle = 0.5 * (before.loose[1] + after.loose[0])
    length = math.acos(1.0 / (1.0 + abs(before.level))) / rate
    held = Arc(middle + length, after.level, after.row, after.sign)
    back = -math.copysign(1.0, before.level)
    return [Arc(middle - length, back), Arc(middle, -back), held]


def _bangs(found: Farthest, start: float, stop: float, split: bool) -> list[Arc]:
    """Arcs of full force between two times [s]."""
    left, right = np.maximum(found.times[:-1], start), np.minimum(found.times[1:], stop)
    inside = np.flatnonzero(right - left > EMPTY * np.diff(found.times))
    levels, width, begins = found.levels[inside], (right - left)[inside], left[inside]
    kinds = np.where(np.abs(levels) > 1.0 - FULL, np.sign(levels), 0.0)
    bounds = [0, *(np.flatnonzero(np.diff(kinds)) + 1).tolist(), kinds.size]
    arcs: list[Arc] = []
    for a, b in zip(bounds[:-1], bounds[1:], strict=True):
        if b == a:
            continue
        if kinds[a] != 0.0:
            if not arcs or arcs[-1].level != kinds[a]:
                arcs.append(Arc(float(begins[a]), float(kinds[a])))
            continue
        if a == 0 or b == kinds.size:
            continue
        first, last = float(kinds[a - 1]), float(kinds[b])
        if first == last:
            arcs += _pulse(begins[a:b], width[a:b], levels[a:b], first)
        elif split and b - a >= SMEARED:
            arcs += _three_switches(begins[a:b], width[a:b], levels[a:b], first)
        else:
            arcs.append(Arc(float(_switch(begins[a:b], width[a:b], levels[a:b], first)), last))
    return arcs


def _switch(
    begins: NDArray[np.float64], width: NDArray[np.float64], levels: NDArray[np.float64], first: float
) -> float:
    """When a single change from `first` to its opposite gives the area of some levels."""
    return float(begins[0] + 0.5 * (width.sum() + first * (width @ levels)))


def _three_switches(
    begins: NDArray[np.float64], width: NDArray[np.float64], levels: NDArray[np.float64], first: float
) -> list[Arc]:
    """Three with the area and the first moment of some levels, the outer ones as far from the middle one."""
    middle = _switch(begins, width, levels, first)
    centres = begins + 0.5 * width - middle
    ends = np.array([begins[0], begins[-1] + width[-1]]) - middle
    # a single switch has the moment -first (ends . ends) / 2, and two more at a distance d add 2 d^2
    moment = first * float((width * levels) @ centres) + 0.5 * float(ends @ ends)
    apart = min(math.sqrt(max(0.5 * moment, 0.0)), 0.5 * float(width.sum()))
    return [Arc(middle - apart, -first), Arc(middle, first), Arc(middle + apart, -first)]


def _pulse(
    begins: NDArray[np.float64], width: NDArray[np.float64], levels: NDArray[np.float64], full: float
) -> list[Arc]:
    """The opposite of full force for as long as gives the area of some levels, in the middle of them."""
    span = float(width.sum())
    length = 0.5 * (span - full * float(width @ levels))
    middle = float(begins[0]) + 0.5 * span
    return [Arc(middle - 0.5 * length, -full), Arc(middle + 0.5 * length, full)]
