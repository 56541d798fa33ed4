"""A problem on a grid of levels: the time in which the farthest move is just as far as the target."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from preshape.command.rest_to_rest.shortest.polish import ActiveTolerance
from preshape.command.rest_to_rest.shortest.problem import Problem
from preshape.command.rest_to_rest.shortest.programme import Farthest, farthest
from preshape.engine.edges import Edge, vibration_peaks

__all__ = ["Grid"]

PER_PERIOD, FEWEST_PER_PERIOD = 24, 8
"""Intervals in a period of the highest frequency to begin with, and in moves over many periods."""

FEWEST, MANY = 400, 2_400
"""Intervals to begin with, however slow everything is; and so many that periods must do with fewer: a programme that
follows one mode takes a second then, and one that follows four takes two."""

MANY_POINTS = 100.0
"""Points of edges that make a programme as large again."""

SPLIT = 4
"""Parts that an interval is divided into where the force changes."""

REACHED = 1e-7
"""The search over the duration stops where the distance is right to this part of it; Newton's method does the rest."""

TRIALS = 16

SETTLED = 1e-9
"""The search also stops where the duration does not change by more than this part: the solver is no better."""

FLATTEST = 0.02
"""The distance's square root never grows more slowly with the time than by this part of a rigid body's."""

POINTS_PER_RIPPLE = 6
"""Points of an edge in 1/duration of frequency to begin with."""

MISSED = 1e-3
"""Vibration over the tolerance by this part calls for a point where it peaks."""

EXCHANGES = 8

Limits = NDArray[np.float64] | float


@dataclass(frozen=True, eq=False)
class Grid:
    """A problem and a grid.

    Parameters
    ----------
    problem : Problem
        What is asked.
    nodes : ndarray, shape (interval + 1,)
        Fractions of the duration, increasing from 0 to 1.
    peaks : list of ActiveTolerance
        Points at which vibration is limited beside an even sample of the edges; the search adds to them.
    """

    problem: Problem
    nodes: NDArray[np.float64]
    peaks: list[ActiveTolerance] = field(default_factory=list)

    @classmethod
    def even(cls, problem: Problem, duration: float) -> Grid:
        """Fine enough for all modes in a duration [s]; of an even number of intervals: one node is in the middle."""
        periods = duration * problem.fastest / (2.0 * math.pi)
        points = sum(_points_on(edge, duration) for edge in problem.edges)
        many = MANY / ((2.0 + len(problem.tracked)) / 3.0 + points / MANY_POINTS)
        count = max(FEWEST, min(PER_PERIOD * periods, max(many, FEWEST_PER_PERIOD * periods)))
        return cls(problem, np.linspace(0.0, 1.0, 2 * math.ceil(0.5 * count) + 1))

    @property
    def intervals(self) -> int:
        """How many levels there are."""
        return self.nodes.size - 1

    def refined(self, marked: NDArray[np.bool_]) -> Grid:
        """The grid with some intervals split, `marked` of shape (interval,)."""
        starts, steps = self.nodes[:-1][marked], np.diff(self.nodes)[marked]
        inner = [starts + steps * part / SPLIT for part in range(1, SPLIT)]
        return Grid(self.problem, np.sort(np.concatenate([self.nodes, *inner])), self.peaks)

    def reaching(self, target: float, duration: float, limits: Limits = 1.0, part: float = 1.0) -> Farthest:
        """The farthest move in the time in which it is just as far as a target [s^2].

        Parameters
        ----------
        target : float
            [s^2].
        duration : float
            Where to begin the search [s].
        limits : ndarray, shape (output, sample), or float
            What outputs are kept to, in units of their limits [-].
        part : float
            What vibration is kept to, in units of its tolerances [-].
        """
        for _ in range(EXCHANGES):
            found = self._as_far(target, duration, limits, part)
            duration = float(found.times[-1])
            peaks = vibration_peaks(self.problem.edges, duration - found.times, found.steps)
            missed = [peak for peak in peaks if peak.vibration > part * peak.edge.tolerance * (1.0 + MISSED)]
            self.peaks.extend(ActiveTolerance(peak.rate, peak.edge.tolerance) for peak in missed)
            if not missed:
                break
        return found

    def farthest(self, duration: float, limits: Limits = 1.0, part: float = 1.0, vertex: bool = False) -> Farthest:
        """The farthest move in a duration [s]."""
        rates, tolerances = [one.rate for one in self.peaks], [one.tolerance for one in self.peaks]
        for edge in self.problem.edges:
            count = _points_on(edge, duration)
            rates += edge.rate(np.linspace(0.0, 1.0, count)).tolist()
            tolerances += [edge.tolerance] * count
        points = np.array(rates, dtype=complex)
        return farthest(self.problem, duration, self.nodes, points, part * np.array(tolerances), limits, vertex)

    def _as_far(self, target: float, duration: float, limits: Limits, part: float) -> Farthest:
        """By secants on the square root of the distance, which grows nearly linearly with the time."""
        unit = math.sqrt(target)
        past: tuple[float, float] | None = None
        for _ in range(TRIALS):
            found = self.farthest(duration, limits, part)
            reach = math.sqrt(max(found.distance, 0.0)) / unit
            if abs(reach - 1.0) < REACHED:
                break
            slope = 0.5 / unit
            if past is not None and duration != past[0]:
                slope = max((reach - past[1]) / (duration - past[0]), FLATTEST * slope)
            past = duration, reach
            duration += (1.0 - reach) / slope
            if abs(duration - past[0]) < SETTLED * duration:
                break
        return found


def _points_on(edge: Edge, duration: float) -> int:
    """At how many points of an edge vibration is limited to begin with."""
    span = abs(complex(edge.rate(np.array(1.0)) - edge.rate(np.array(0.0)))) / (2.0 * math.pi)
    return 1 if edge.is_point else math.ceil(POINTS_PER_RIPPLE * span * duration) + 3
