"""A command on a grid that keeps every limit exactly, where no exact arcs were found."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from preshape.command.rest_to_rest.shortest.grid import Grid
from preshape.command.rest_to_rest.shortest.motion import Motion
from preshape.command.rest_to_rest.shortest.problem import Problem
from preshape.command.rest_to_rest.shortest.programme import SAMPLES, Farthest, left_by_levels
from preshape.engine.edges import vibration_peaks

__all__ = ["AT_REST", "kept_on_grid"]

SPARE = 3e-7
"""The command is made for a target farther by this part and then scaled: room for the corrections that make its end
exact, which are as small as the solver's own error."""

TIGHTENINGS, TIGHTER, TRIALS = 5, 1.5, 16
"""So many times limits are tightened near where they are exceeded, by so many times what is too much; then all is
scaled down, from a farther target, until so many programmes have been solved."""

LONGER = 2.0
"""A command that is short of the target by a part (of the root of the distance) takes so many times that part longer:
a little more than needed, since what goes farther is scaled down."""

LOOKS = 17
"""Samples of an interval at which its largest deflection is looked for; whether all is kept is asked exactly."""

AT_REST = 1e-12
"""Vibration left that counts as none [-]."""


def kept_on_grid(grid: Grid, duration: float) -> Motion | None:
    """Levels that bring everything to rest on the target to rounding, within all limits also between the nodes.

    Limits are tightened near where they are exceeded. Where that does not end, a command that goes farther is scaled
    down until all is kept. None if neither ends.

    Parameters
    ----------
    grid : Grid
        With its problem.
    duration : float
        About as long as it takes [s].
    """
    problem = grid.problem
    limits, part, room = np.ones((problem.rows.shape[0], grid.intervals * SAMPLES)), 1.0, 1.0 + SPARE
    tightened = 0
    for _ in range(TRIALS):
        found = grid.farthest(duration, limits, part)
        wanted = problem.target * room
        if found.distance < wanted:
            duration *= 1.0 + LONGER * (1.0 - math.sqrt(max(found.distance, 0.0) / wanted))
            continue
        motion = _exactly_at_rest(problem, found)
        force, largest = float(np.abs(motion.levels).max()), motion.largest()
        vibration = _vibration(problem, motion)
        most = max(force, *largest.tolist(), vibration)
        if float(motion.residuals.max()) < AT_REST and most <= 1.0:
            return motion
        room *= max(most if tightened >= TIGHTENINGS else force, 1.0) * (1.0 + SPARE)
        if tightened < TIGHTENINGS and most > force:
            tightened += 1
            over = motion.largest_in_arcs(LOOKS)
            over[:, 1:] = np.maximum(over[:, 1:], over[:, :-1])
            over = 1.0 + TIGHTER * np.maximum(over * (1.0 + SPARE) - 1.0, 0.0)
            limits /= np.repeat(over, SAMPLES, axis=1)
            part /= 1.0 + TIGHTER * max(vibration * (1.0 + SPARE) - 1.0, 0.0)
    return None


def _vibration(problem: Problem, motion: Motion) -> float:
    """The largest vibration on the edges, in units of its tolerance [-]."""
    peaks = vibration_peaks(problem.edges, motion.leads, motion.steps)
    return max((1.0 + peak.excess for peak in peaks), default=0.0)


def _exactly_at_rest(problem: Problem, found: Farthest) -> Motion:
    """The least change of all levels that makes the end exact, after scaling the distance to the target."""
    times, unit = found.times, problem.unit
    widths, middle = np.diff(times), times[-1] - 0.5 * (times[:-1] + times[1:])
    waves = left_by_levels(problem.rates, times)
    rows = np.concatenate([[widths * middle / unit**2, widths / unit], waves.real, waves.imag])
    wanted = np.zeros(rows.shape[0])
    wanted[0] = 1.0
    levels: NDArray[np.float64] = found.levels * (problem.target / max(found.distance, problem.target))
    for _ in range(2):
        levels = levels + np.linalg.lstsq(rows, wanted - rows @ levels, rcond=None)[0]
    return Motion(problem, times, levels)
