"""A command on a grid that keeps every limit exactly, where no exact arcs were found."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.command.rest_to_rest.shortest.grid import Grid
from preshape.command.rest_to_rest.shortest.motion import Motion
from preshape.command.rest_to_rest.shortest.problem import Problem
from preshape.command.rest_to_rest.shortest.programme import SAMPLES, Farthest, left_by_levels
from preshape.engine.edges import vibration_peaks

__all__ = ["kept_on_grid"]

SPARE = 3e-7
"""The command is made for a target farther by this part and then scaled: room for the corrections that make its end
exact, which are as small as the solver's own error."""

TIGHTENINGS, LOCAL = 14, 6
"""So many times limits are tightened, and so many of them only near where they are exceeded: then everywhere."""

LOOKS = 17
"""Samples of an interval at which its largest deflection is looked for; whether all is kept is asked exactly."""

AT_REST = 1e-12
"""Vibration left that counts as none [-]."""


def kept_on_grid(grid: Grid, duration: float) -> Motion | None:
    """Levels that bring everything to rest on the target to rounding, within all limits also between the nodes.

    Limits are tightened near where they are exceeded, then everywhere, until none is; None if that does not end.

    Parameters
    ----------
    grid : Grid
        With its problem.
    duration : float
        About as long as it takes [s].
    """
    problem = grid.problem
    limits, part = np.ones((problem.rows.shape[0], grid.intervals * SAMPLES)), 1.0
    for attempt in range(TIGHTENINGS):
        found = grid.reaching(problem.target * (1.0 + SPARE), duration, limits, part)
        duration = float(found.times[-1])
        motion = _exactly_at_rest(problem, found)
        peaks = vibration_peaks(problem.edges, motion.leads, motion.steps)
        most = max((1.0 + peak.excess for peak in peaks), default=0.0)
        at_rest = float(motion.residuals.max()) < AT_REST and np.abs(motion.levels).max() <= 1.0
        largest = motion.largest()
        if at_rest and most <= 1.0 and (largest <= 1.0).all():
            return motion
        over = motion.largest_in_arcs(LOOKS)
        over[:, 1:] = np.maximum(over[:, 1:], over[:, :-1])
        if attempt >= LOCAL:
            over[:] = largest[:, None]
        over = np.maximum(over * (1.0 + SPARE), 1.0)
        limits /= np.repeat(over, SAMPLES, axis=1)
        part /= max(1.0, most * (1.0 + SPARE))
    return None


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
