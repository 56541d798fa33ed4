"""Contacts: where a solution on a grid holds an output on its limit, and where one only touches it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.command.rest_to_rest.shortest.problem import Problem
from preshape.command.rest_to_rest.shortest.programme import Farthest
from preshape.command.rest_to_rest.shortest.structure import Touch

__all__ = ["Hold", "contacts_of"]

ON_LIMIT = 0.5
"""A sample is on the limit where what is left is below this part of (w h)^2, h being the interval and the output's gain
a factor: levels that alternate within a hold come that near, and what leaves at full force is farther away soon."""

WIDEST = 0.02
"""On the limit is never farther from it than this [-]."""

ROUNDING = 1e-7
"""What the solver leaves of the limit where there is nothing left [-]."""

NEAR = 0.05
"""Contacts with the same limit closer than this angle of their fastest mode [rad] are one."""

HELD = 7
"""An output is held on its limit if this many samples in a row matter there; where it touches, two or three do."""

MATTERS = 0.01
"""A sample matters if its multiplier is more than this part of the mean of its neighbours on the limit."""

NOTHING = 1e-7
"""A contact whose multipliers are less than this part of all of them constrains nothing."""

WINDOW = 2.0
"""How much farther than where an output first is on its limit the force is looked at, to tell when the hold began."""


@dataclass(frozen=True)
class Hold:
    """An output on its limit.

    Parameters
    ----------
    level : float
        The force that keeps it there [-].
    row : int
        The output.
    sign : float
        Which limit, 1 or -1.
    loose : tuple of float
        From when to when the output is near the limit [s].
    tight : tuple of float
        From when to when it is on it, as far as the solver can tell [s].
    """

    level: float
    row: int
    sign: float
    loose: tuple[float, float]
    tight: tuple[float, float]

    def entered(self, found: Farthest, before: float) -> float:
        """When the force changes from a level to that of the hold, by the area under what the grid shows [s]."""
        start = self.loose[0]
        stop = min(self.tight[0] + WINDOW * (self.tight[0] - start), self.loose[1])
        return start + self._time_at(found, before, start, stop)

    def left(self, found: Farthest, after: float) -> float:
        """When it changes to the level after the hold [s]."""
        stop = self.loose[1]
        start = max(self.tight[1] - WINDOW * (stop - self.tight[1]), self.loose[0])
        return stop - self._time_at(found, after, start, stop)

    def _time_at(self, found: Farthest, other: float, start: float, stop: float) -> float:
        """How long between two times the force must have been at another level to give the area that it has."""
        if other == self.level:
            return 0.0
        width = np.minimum(found.times[1:], stop) - np.maximum(found.times[:-1], start)
        area = float(np.maximum(width, 0.0) @ found.levels)
        return min(max((area - self.level * (stop - start)) / (other - self.level), 0.0), stop - start)


def contacts_of(problem: Problem, found: Farthest) -> tuple[list[Hold], list[Touch]]:
    """Holds in order of time, and touches."""
    holds: list[Hold] = []
    touches: list[Touch] = []
    total = float(np.abs(found.masses).sum())
    steps = np.repeat(np.diff(found.times), found.sample_times.size // found.levels.size)
    for row, values in enumerate(found.outputs):
        bend = float(np.abs(problem.rows[row]) @ np.abs(problem.rates) ** 2)
        # a vertex is on a limit or it is not; the solution inside keeps away where that costs it nothing
        width = 0.0 if found.vertex else np.minimum(ON_LIMIT * bend * steps**2, WIDEST)
        near = np.abs(values) >= 1.0 - ROUNDING - width
        fastest = float(np.abs(problem.rates[problem.rows[row] != 0.0]).max())
        mode = problem.held_mode(row)
        for run in _runs(np.where(near, np.sign(values), 0.0), found.sample_times, NEAR / fastest):
            sign, times = float(np.sign(values[run.start])), found.sample_times[run]
            masses = np.abs(found.masses[row, run])
            if masses.sum() <= NOTHING * total:
                continue
            if mode is None or np.count_nonzero(masses > MATTERS * masses.mean()) < HELD:
                touches.append(Touch(float(times @ masses / masses.sum()), row, sign))
                continue
            on = times[np.abs(values[run]) >= 1.0 - ROUNDING]
            on = on if on.size else times
            level = problem.held_level(row, mode, sign)
            loose, tight = (float(times[0]), float(times[-1])), (float(on[0]), float(on[-1]))
            holds.append(Hold(level, row, sign, loose, tight))
    return sorted(holds, key=lambda hold: hold.loose[0]), touches


def _runs(limit: NDArray[np.float64], times: NDArray[np.float64], apart: float) -> list[slice]:
    """Stretches of samples on the same limit; what is less than `apart` [s] from the last one belongs to it."""
    edges = np.flatnonzero(np.diff(limit)) + 1
    bounds = [0, *edges.tolist(), limit.size]
    found: list[slice] = []
    for a, b in zip(bounds[:-1], bounds[1:], strict=True):
        if b == a or limit[a] == 0.0:
            continue
        if found and limit[found[-1].start] == limit[a] and times[a] - times[found[-1].stop - 1] < apart:
            found[-1] = slice(found[-1].start, b)
        else:
            found.append(slice(a, b))
    return found
