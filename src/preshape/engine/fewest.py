"""Fewest impulses among given leads: integers decide where they are, and every answer is checked exactly.

The integers are HiGHS' (engine/integers.py), whose tolerances could hide that a set of impulses is not enough. So each
set that it finds is solved again by itself; one that fails is cut off, with everything inside it, and the search goes
on. A bound that needs no integers, windows that cannot be left empty, comes first and often says at once that a wanted
number is too small.
"""

from __future__ import annotations

import math
import time
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from preshape.engine.integers import find_places
from preshape.engine.programme import Programme, solve
from preshape.engine.projection import nearest_on
from preshape.engine.windows import needed_windows
from preshape.errors import InputError

__all__ = ["Fewest", "amplitudes_at", "fewest"]

TIME_LIMIT = 20.0
"""Seconds for one search; the proof for more than about fifty places can take hours, and then the bound is reported."""

WINDOW_PART = 0.5
"""Part of the time that may go into windows, which take milliseconds for hundreds of places."""

EXCESS = 1e-8
"""Cones and inequalities count as met up to this [-], ten times what the conic solver is asked for."""

SMALLEST = 1e-9
"""An impulse below this is none [-]."""


@dataclass(frozen=True)
class Fewest:
    """The outcome of :func:`fewest`.

    Parameters
    ----------
    leads, amplitudes : ndarray, shape (impulse,)
        The impulses found [s] and [-]: they meet the programme.
    at_least : int
        No shaper at the programme's leads with fewer impulses than this meets it. It may exceed the number found by
        one that was wanted and is proved to be too small.
    """

    leads: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    at_least: int

    @property
    def proved(self) -> bool:
        """Whether fewer are impossible."""
        return self.at_least >= self.leads.size


def fewest(
    programme: Programme, start: NDArray[np.float64], at_most: int | None = None, time_limit: float = TIME_LIMIT
) -> Fewest:
    """The fewest impulses that meet a programme, as far as the time goes.

    Parameters
    ----------
    programme : Programme
        Its lower limit of the amplitudes is finite and not above 0; the upper one is finite too, unless the lower is 0.
    start : ndarray, shape (impulse,)
        Amplitudes that meet it, zeros where there is no impulse.
    at_most : int, optional
        Look only for this many or fewer; ``at_least`` is above it when that is proved to be impossible.
    time_limit : float
        [s].

    Raises
    ------
    InputError
        If an amplitude has no limit, or must not be 0.
    """
    end = time.monotonic() + time_limit
    if not (-math.inf < programme.low <= 0.0) or (programme.low < 0.0 and not math.isfinite(programme.high)):
        raise InputError(
            "the fewest impulses are found between limits only: give a lower limit of 0, or of both signs two limits."
        )
    if programme.low == 0.0:
        programme = replace(programme, high=min(programme.high, 1.0))
    best = start
    windows = needed_windows(
        programme.leads.size, lambda kept: amplitudes_at(programme, kept) is not None, WINDOW_PART * time_limit
    )
    at_least = max(1, len(windows))
    cuts: list[NDArray[np.bool_]] = []
    while at_least < _count(best) and (at_most is None or at_least <= at_most < _count(best)):
        left = end - time.monotonic()
        if left <= 0.0:
            break
        wanted = _count(best) - 1 if at_most is None else at_most
        answer = find_places(programme, windows, cuts, wanted, minimise=at_most is None, time_limit=left)
        at_least = max(at_least, answer.at_least)
        if answer.places is None:
            break
        found = amplitudes_at(programme, answer.places)
        if found is None:
            cuts.append(answer.places)
        else:
            best = found
    used = np.flatnonzero(best)
    return Fewest(programme.leads[used], best[used], at_least)


def amplitudes_at(programme: Programme, places: NDArray[np.bool_]) -> NDArray[np.float64] | None:
    """Amplitudes that meet `programme` with impulses only where `places` is true (zeros elsewhere), or None."""
    used = np.flatnonzero(places)
    full = np.zeros(places.size)
    if used.size == 0:
        return None
    basis, rows = programme.basis, programme.equalities[:, used]
    elastic = programme.limits.size > 0 or programme.radii.size > 0
    if basis is not None and programme.low == 0.0 and programme.high >= 1.0 and not elastic:
        nearest = nearest_on(basis, programme.leads[used], rows)
        if nearest.distance > basis.rounding:
            return None
        full[used[np.isin(programme.leads[used], nearest.leads)]] = nearest.amplitudes
        return full
    part = replace(
        programme,
        leads=programme.leads[used],
        equalities=rows,
        cones=programme.cones[:, used],
        inequalities=programme.inequalities[:, used],
    )
    found = solve(part) if elastic else solve(part, cost=np.zeros(used.size))
    if not found.solved or found.excess > EXCESS:
        return None
    full[used] = np.where(np.abs(found.amplitudes) > SMALLEST, found.amplitudes, 0.0)
    return full


def _count(amplitudes: NDArray[np.float64]) -> int:
    return int(np.count_nonzero(amplitudes))
