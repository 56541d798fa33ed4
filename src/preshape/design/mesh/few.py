"""Fewest impulses on the grid, or at most a given number; and how much longer the shaper must be for that."""

from __future__ import annotations

import time
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from preshape.design.mesh.problem import GridProblem
from preshape.design.mesh.slots import SlotImpulses, convolved_on_slots, impulses_in
from preshape.engine.basis import Basis
from preshape.engine.constraints import ImpulsesBetween, ZeroVibration
from preshape.engine.fewest import fewest
from preshape.engine.programme import gather
from preshape.engine.projection import nearest_on
from preshape.errors import InputError

__all__ = ["Few", "few_impulses"]

SEARCH_SECONDS = 8.0
"""For one search among the slots of one duration. What is not proved by then needs hours, not seconds."""

COARSE_SECONDS = 2.0
"""For the search on a coarser grid within the grid."""

ALL_SECONDS = 20.0
"""For all durations that are tried together."""

LONGEST = 5
"""More impulses are spared by a longer shaper only where the grid fits the modes again: up to this many times the
duration that one shaper after the other takes."""

COARSE_SLOTS = 60
"""Coarser grids have at most this many slots: as many as a search gets through."""


@dataclass(frozen=True)
class Few:
    """Few impulses, and what is known about fewer.

    Parameters
    ----------
    impulses : SlotImpulses
        Its `slots` are those that were needed for so few.
    at_least : int
        Within these slots, no shaper has fewer impulses than this.
    shorter_excluded : bool
        Whether as few are proved to be impossible with one slot fewer.
    """

    impulses: SlotImpulses
    at_least: int
    shorter_excluded: bool


def few_impulses(problem: GridProblem, start: SlotImpulses, limit: int | None, *, minimise: bool, longer: bool) -> Few:
    """At most `limit` impulses within the slots of `start`, or in more slots if `longer` allows them.

    With `minimise` the fewest, as far as the time goes.

    Raises
    ------
    InputError
        If `limit` impulses are too few, with the number that would do.
    """
    needed = max(problem.orders) + 2
    if limit is not None and limit < needed:
        raise InputError(
            f"at most {limit} impulses cannot do it: a mode whose vibration and {needed - 2} derivatives of it vanish "
            f"needs at least {needed}; give at_most={needed} or more."
        )
    end = time.monotonic() + ALL_SECONDS
    few = _searched(problem, start, None if minimise else limit, end)
    if limit is None or few.impulses.places.size <= limit:
        return replace(few, shorter_excluded=start.shortest)
    if longer:
        enough = _lengthened(problem, few, limit, end)
        fewer = _searched(problem, enough.impulses, None, end) if minimise else enough
        return replace(fewer, shorter_excluded=enough.shorter_excluded)
    count = few.impulses.places.size
    known = f"at least {few.at_least} are needed" if few.at_least > limit else "as few were not found"
    raise InputError(
        f"at most {limit} impulses are too few on this grid within {start.slots * problem.dt:.9g} s: {known} there; "
        f"give at_most={count}, which is enough, or a longer duration."
    )


def _lengthened(problem: GridProblem, short: Few, limit: int, end: float) -> Few:
    """More and more slots until `limit` impulses are enough, then bisection between the last two numbers."""
    failed, last, step = short, LONGEST * problem.enough, 1
    found: Few | None = None
    while found is None and failed.impulses.slots < last and time.monotonic() < end:
        trial = _in_slots(problem, short.impulses, min(short.impulses.slots + step, last), limit, end)
        step *= 2
        if trial.impulses.places.size <= limit:
            found = trial
        else:
            failed = trial
    if found is None:
        count, slots = failed.impulses.places.size, failed.impulses.slots
        raise InputError(
            f"no shaper of at most {limit} impulses was found on this grid in up to {slots * problem.dt:.9g} s: "
            f"give at_most={count}, which is enough there, another servo period, or design.direct and design.rounded."
        )
    while found.impulses.slots - failed.impulses.slots > 1:
        middle = (found.impulses.slots + failed.impulses.slots) // 2
        trial = _in_slots(problem, short.impulses, middle, limit, end)
        if trial.impulses.places.size <= limit:
            found = trial
        else:
            failed = trial
    return replace(found, shorter_excluded=failed.at_least > limit)


def _in_slots(problem: GridProblem, known: SlotImpulses, slots: int, limit: int, end: float) -> Few:
    """In more slots than those of `known`, whose impulses are a start there too."""
    starts = [known, impulses_in(problem, slots)]
    if slots >= problem.enough:
        starts.append(convolved_on_slots(problem))
    start = min((one for one in starts if one is not None), key=lambda one: one.places.size)
    return _searched(problem, replace(start, slots=slots, resolved=True), limit, end)


def _searched(problem: GridProblem, start: SlotImpulses, limit: int | None, end: float) -> Few:
    """Within the slots of `start` only: on coarser grids first, where symmetries of the modes show at once."""
    basis = problem.basis(start.slots)
    for step in _coarser_steps(problem, start.slots):
        places = np.arange(0, start.slots + 1, step)
        leads = problem.leads(start.slots)[places]
        nearest = nearest_on(basis, leads)
        if nearest.distance <= basis.rounding:
            at = places[np.isin(leads, nearest.leads)]
            coarse = replace(start, places=at, amplitudes=nearest.amplitudes)
            found = _fewest(problem, basis, coarse, places, limit, min(COARSE_SECONDS, end - time.monotonic()))
            if found.impulses.places.size < start.places.size:
                start = found.impulses
    every = np.arange(start.slots + 1)
    return _fewest(problem, basis, start, every, limit, min(SEARCH_SECONDS, end - time.monotonic()))


def _fewest(
    problem: GridProblem, basis: Basis, start: SlotImpulses, places: NDArray[np.intp], limit: int | None, seconds: float
) -> Few:
    """The engine's search among some places, from impulses at some of them."""
    zero = [ZeroVibration(mode, order) for mode, order in zip(problem.modes, problem.orders, strict=True)]
    programme = gather([*zero, ImpulsesBetween(0.0)], problem.leads(start.slots)[places], basis)
    amplitudes = np.zeros(places.size)
    amplitudes[np.isin(places, start.places)] = start.amplitudes
    found = fewest(programme, amplitudes, limit, max(0.0, seconds))
    at = places[np.isin(programme.leads, found.leads)]
    at_least = max(found.at_least, max(problem.orders) + 2)
    return Few(replace(start, places=at, amplitudes=found.amplitudes), at_least, False)


def _coarser_steps(problem: GridProblem, slots: int) -> list[int]:
    """Every so many slots: half a period of the fastest mode, half and a third of that."""
    half = min(mode.damped_period for mode in problem.modes) / 2.0 / problem.dt
    steps = {round(half / part) for part in (1, 2, 3)}
    return sorted((step for step in steps if step > 1 and slots // step <= COARSE_SLOTS), reverse=True)
