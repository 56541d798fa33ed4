"""The motions that a workbench draws: exact at every point, each remembered until what it depends on changes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from preshape.command import trapezoid
from preshape.mode import Mode
from preshape.plant import Motion, Output, exact_motion
from preshape.profile import Profile
from preshape.shaper import Shaper
from preshape.workflow.workbench.state import Move, Plant

__all__ = ["STEP", "Response", "motion_of", "profile_of", "read_only", "response", "times_until"]

REMEMBERED = 64

STEP = Move(distance=1.0, kind="step")
"""The unit step that every plant is shown."""

TAIL_PERIODS = 4.0
"""What is drawn after the last command, in periods of the slowest mode."""

POINTS_PER_PERIOD, FEWEST_POINTS, MOST_POINTS = 12, 300, 1500
"""Points of the fastest mode's period, unless they come to more than can be seen."""


@dataclass(frozen=True, eq=False)
class Response:
    """A plant's motion under a command, at the times of the view.

    Parameters
    ----------
    command : ndarray, shape (sample,)
        What is commanded [m; a unit step has none].
    position : ndarray, shape (sample,)
        Where the output is, in the unit of the command.
    deflection : ndarray, shape (sample,)
        How far it is from the command, in the same unit.
    peak_deflection : float
        Largest size of the deflection over all time, between the samples too.
    residual : float
        Largest amplitude that the vibration can have after the command has ended: the modes' amplitudes added up.
    end_time : float
        When the command ends [s].
    """

    command: NDArray[np.float64]
    position: NDArray[np.float64]
    deflection: NDArray[np.float64]
    peak_deflection: float
    residual: float
    end_time: float


@lru_cache(maxsize=REMEMBERED)
def profile_of(move: Move) -> Profile:
    """The move without a shaper, from 0 at time 0."""
    if move.kind == "step":
        return Profile.steps([0.0], [move.distance])
    made = trapezoid(
        move.distance,
        maximum_speed=move.speed,
        maximum_acceleration=move.acceleration,
        dt=0.25 * move.duration,
    )
    assert made.profile is not None  # a trapezoid is a polynomial
    return made.profile


def times_until(end_time: float, modes: tuple[Mode, ...]) -> NDArray[np.float64]:
    """Evenly spaced times [s] from 0 to some periods after the last command, fine enough for the fastest mode."""
    slowest, fastest = (choose(mode.frequency for mode in modes) for choose in (min, max))
    end = end_time + TAIL_PERIODS / slowest
    wanted = math.ceil(min(POINTS_PER_PERIOD * fastest * end, MOST_POINTS))
    return read_only(np.linspace(0.0, end, max(wanted, FEWEST_POINTS) + 1))


def read_only(values: NDArray[np.float64]) -> NDArray[np.float64]:
    """The array, which is remembered and shown to several, closed to writing."""
    values.flags.writeable = False
    return values


@lru_cache(maxsize=REMEMBERED)
def motion_of(modes: tuple[Mode, ...], plant: Plant, move: Move, shaper: Shaper | None) -> Motion:
    """The plant's exact motion, with the outputs "position" and "deflection"."""
    command = profile_of(move) if shaper is None else profile_of(move).shaped(shaper)
    gains = plant.gains or (1.0 / len(modes),) * len(modes)
    if plant.kind == "carried":
        return exact_motion(
            modes,
            command,
            driven_by=2,
            forces=[-1.0] * len(modes),
            outputs={"position": Output(gains, command=1.0), "deflection": Output(gains)},
        )
    return exact_motion(
        modes,
        command,
        forces=[mode.omega**2 for mode in modes],
        outputs={"position": Output(gains), "deflection": Output(gains, command=-sum(gains))},
    )


@lru_cache(maxsize=REMEMBERED)
def response(modes: tuple[Mode, ...], plant: Plant, move: Move, shaper: Shaper | None, end_time: float) -> Response:
    """The motion at the times until `end_time` [s] (:func:`times_until`)."""
    motion = motion_of(modes, plant, move, shaper)
    command = profile_of(move) if shaper is None else profile_of(move).shaped(shaper)
    peak, residual = _extremes(modes, plant, move, shaper)
    times = times_until(end_time, modes)
    return Response(
        command=read_only(command(times)),
        position=read_only(motion("position", times)),
        deflection=read_only(motion("deflection", times)),
        peak_deflection=peak,
        residual=residual,
        end_time=motion.end_time,
    )


@lru_cache(maxsize=REMEMBERED)
def _extremes(modes: tuple[Mode, ...], plant: Plant, move: Move, shaper: Shaper | None) -> tuple[float, float]:
    motion = motion_of(modes, plant, move, shaper)
    return motion.peak("deflection").value, motion.residual("deflection")
