"""The shortest move of a problem: on a grid first, then exact, then proved.

The levels on a grid look like a structure of arcs; its times are made exact by Newton's method, and a lower bound says
how much shorter a command could be at most. If that is not nothing, the grid is refined where the force changes, and
all is done again.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from preshape.command.rest_to_rest.shortest.adjoint import from_structure
from preshape.command.rest_to_rest.shortest.arcs import read_arcs, transitions
from preshape.command.rest_to_rest.shortest.grid import Grid
from preshape.command.rest_to_rest.shortest.motion import Motion
from preshape.command.rest_to_rest.shortest.on_grid import AT_REST, kept_on_grid
from preshape.command.rest_to_rest.shortest.polish import ActiveTolerance, polish
from preshape.command.rest_to_rest.shortest.problem import Problem
from preshape.command.rest_to_rest.shortest.programme import Farthest
from preshape.command.rest_to_rest.shortest.structure import Arc, Structure
from preshape.command.rest_to_rest.shortest.witness import from_grid
from preshape.engine.edges import vibration_peaks
from preshape.errors import InputError

__all__ = ["PROVED", "Found", "shortest_move"]

PROVED = 1e-9
"""Part of the duration by which a command that is called optimal could be shorter at most."""

GROWN = 1.2
"""The first grid is made anew when the duration has grown by more than this since it was made."""

REFINEMENTS = 3

LARGEST, MANY_POINTS, SUMMED = 3_000, 20.0, 0.2
"""No grid is refined to more intervals: the solver takes seconds then. Half as many with so many points, with four
modes followed instead of one, or with five more modes in sums."""

LONGEST = 250.0
"""Periods of the fastest mode that a move may take; the first grid has 24 intervals in each."""

PREFERRED = 1e-5
"""A command on a grid must be shorter by this part to be preferred to one of exact arcs."""

KEPT, ROUNDINGS, MOST_KEPT = 1e-10, 3.0, 1e-9
"""Limits may be exceeded by rounding only: this part of them, or so many times what rounding of the times leaves, but
never by more than the last."""

MOST = 120
"""More arcs and touches than this are no structure but what a grid makes of a level that varies; Newton's method would
take seconds to find that out."""

VERTICES = 1_000
"""Vertices are not asked for on grids of more intervals: ending in one takes seconds there."""

INACTIVE = 1e-6
"""Part of the largest multiplier below which a point does not matter."""

SAME_PEAK = 0.5
"""A peak is the one of the step before if it has moved by less than this angle over the duration [rad]."""

EXCHANGES = 12


@dataclass(frozen=True, eq=False)
class Found:
    """A command that does the move.

    Parameters
    ----------
    motion : Motion
        What it does; its times [s] and levels.
    structure : Structure or None
        Its arcs, if their times are exact; None for levels on a grid.
    least : float
        No command is shorter than this [s].
    """

    motion: Motion
    structure: Structure | None
    least: float

    @property
    def duration(self) -> float:
        """[s]"""
        return float(self.motion.times[-1])

    @property
    def gap(self) -> float:
        """Part of the duration that a command could save at most [-]."""
        return max(0.0, 1.0 - self.least / self.duration)


def shortest_move(problem: Problem, first: Structure | None = None) -> Found | None:
    """The shortest command found for a problem, and how short any could be; None if the solvers found none.

    Parameters
    ----------
    problem : Problem
        What is asked.
    first : Structure, optional
        Arcs that may be the shortest: if they prove to be, nothing is searched.

    Raises
    ------
    InputError
        If the move takes too many periods of the fastest mode.
    """
    least = 2.0 * problem.unit
    best = None if first is None else _proved(problem, first)
    if best is not None and best.gap <= PROVED:
        return best
    least = max(least, 0.0 if best is None else best.least)
    grid = _first_grid(problem, least)
    found = grid.reaching(problem.target, least)
    if found.times[-1] > GROWN * least:
        grid = _first_grid(problem, float(found.times[-1]))
        found = grid.reaching(problem.target, float(found.times[-1]))
    for _ in range(REFINEMENTS + 1):
        for vertex in (False,) if problem.edges or grid.intervals > VERTICES else (False, True):
            if vertex:
                found = grid.farthest(float(found.times[-1]), vertex=True)
            least = max(least, from_grid(problem, found).least_duration(problem.target))
            for structure, motion, active in _exact(problem, found):
                witness = from_structure(problem, structure, motion, found, active)
                least = max(least, witness.least_duration(problem.target))
                if best is None or structure.end < best.duration:
                    best = Found(motion, structure, least)
                if 1.0 - least / best.duration <= PROVED:
                    return Found(best.motion, best.structure, min(least, best.duration))
        finer = grid.refined(transitions(problem, found))
        summed = np.count_nonzero(problem.rows) - problem.rows.shape[0]
        cost = (2.0 + len(problem.tracked)) / 3.0 + SUMMED * summed + found.points.size / MANY_POINTS
        if finer.intervals > LARGEST / cost:
            break
        grid = finer
        found = grid.reaching(problem.target, float(found.times[-1]))
    on_grid = kept_on_grid(grid, float(found.times[-1]))
    if on_grid is not None and (best is None or on_grid.times[-1] < (1.0 - PREFERRED) * best.duration):
        return Found(on_grid, None, least)
    return best if best is None else Found(best.motion, best.structure, least)


def _proved(problem: Problem, first: Structure) -> Found | None:
    """A structure made exact, with its bound."""
    exact = _exchanged(problem, first, [])
    if exact is None:
        return None
    structure, motion, active = exact
    least = from_structure(problem, structure, motion, None, active).least_duration(problem.target)
    return Found(motion, structure, min(least, structure.end))


def _first_grid(problem: Problem, duration: float) -> Grid:
    periods = duration * problem.fastest / (2.0 * np.pi)
    if periods > LONGEST:
        raise InputError(
            f"the move takes {duration:.4g} s or more, {periods:.3g} periods of the fastest mode, and no more than "
            f"{LONGEST:g} are solved: leave out modes that are that fast, or move less far, with more force or more "
            "deflection."
        )
    return Grid.even(problem, duration)


def _exact(problem: Problem, found: Farthest) -> Iterator[tuple[Structure, Motion, Sequence[ActiveTolerance]]]:
    """Exact commands that a solution on a grid may stand for, limits checked."""
    plain = read_arcs(problem, found)
    several = read_arcs(problem, found, split=True)
    candidates: list[Structure] = [plain] if several == plain else [plain, several]
    if problem.rows.size == 0:
        candidates.insert(0, _where_p_changes(problem, found))
    for structure in candidates:
        if len(structure.arcs) + len(structure.touches) > MOST:
            continue
        exact = _exchanged(problem, structure, _active(problem, found))
        if exact is not None:
            yield exact


def _where_p_changes(problem: Problem, found: Farthest) -> Structure:
    """Full force with the sign of the grid's p: where switches are too close for the levels to tell them apart."""
    starts, signs = from_grid(problem, found).signs()
    starts[0] = 0.0
    arcs = [Arc(float(start), float(sign)) for start, sign in zip(starts, signs, strict=True)]
    return Structure(tuple(arcs), (), float(found.times[-1]))


def _exchanged(
    problem: Problem, structure: Structure, active: list[ActiveTolerance]
) -> tuple[Structure, Motion, Sequence[ActiveTolerance]] | None:
    """A structure made exact, the tolerances being active where the vibration peaks, and only where they matter."""
    for _ in range(EXCHANGES):
        polished = polish(problem, structure, active)
        if polished is None:
            return None
        structure = polished.structure
        motion = Motion(problem, structure.times, structure.levels)
        peaks = vibration_peaks(problem.edges, motion.leads, motion.steps)
        if polished.needed.all() and all(peak.excess <= KEPT for peak in peaks):
            kept = min(max(KEPT, ROUNDINGS * problem.rounding(structure.end)), MOST_KEPT)
            right = (motion.largest() <= 1.0 + kept).all() and (motion.residuals <= AT_REST).all()
            return (structure, motion, active) if right else None
        active = [one for one, needed in zip(active, polished.needed, strict=True) if needed]
        near = SAME_PEAK / structure.end
        active = [
            ActiveTolerance(peak.rate, peak.edge.tolerance)
            for peak in peaks
            if peak.excess > KEPT or any(abs(peak.rate - one.rate) < near for one in active)
        ]
    return None


def _active(problem: Problem, found: Farthest) -> list[ActiveTolerance]:
    """The peaks of vibration whose tolerance is active: those next to a point with a multiplier."""
    peaks = vibration_peaks(problem.edges, found.times[-1] - found.times, found.steps)
    rates = np.array([peak.rate for peak in peaks])
    waves = np.abs(found.waves)
    matter = found.points[waves[problem.rates.size :] > INACTIVE * waves.max()]
    nearest = {int(np.argmin(np.abs(rates - point))) for point in matter}
    return [ActiveTolerance(peaks[k].rate, peaks[k].edge.tolerance) for k in sorted(nearest)]
