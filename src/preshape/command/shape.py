"""MoveShape: a move of unit distance in unit time, and the command of any distance and limits that has its form."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.checks import nonzero, not_negative, positive
from preshape.command.checks import sample_count
from preshape.command.command import Command
from preshape.errors import InputError

__all__ = ["Limits", "MoveShape", "shaped_move", "shortest_of"]

GROWTH, SAME = 1.1, 1e-6
"""Step of the search for a duration, and its relative precision."""

Curve = Callable[[NDArray[np.float64]], NDArray[np.float64]]


@dataclass(frozen=True)
class Limits:
    """What a move must keep to; None is no limit.

    Parameters
    ----------
    speed, acceleration, jerk : float, optional
        [unit/s], [unit/s^2], [unit/s^3], above zero.
    """

    speed: float | None = None
    acceleration: float | None = None
    jerk: float | None = None

    def __post_init__(self) -> None:
        for name, unit in (("speed", "m/s"), ("acceleration", "m/s^2"), ("jerk", "m/s^3")):
            if getattr(self, name) is not None:
                object.__setattr__(self, name, positive(f"maximum_{name}", getattr(self, name), unit))


@dataclass(frozen=True)
class MoveShape:
    """A rest-to-rest move from 0 to 1 in the time from 0 to 1, with the largest magnitudes of its derivatives.

    Parameters
    ----------
    position, velocity, acceleration : callable
        Of an array of times in [0, 1].
    peak_velocity, peak_acceleration, peak_jerk : float
        Largest magnitudes; an infinite jerk means that the acceleration jumps.
    """

    position: Curve
    velocity: Curve
    acceleration: Curve
    peak_velocity: float
    peak_acceleration: float
    peak_jerk: float

    def shortest(self, distance: float, limits: Limits) -> float:
        """The least duration [s] that keeps to the limits; InputError when one cannot be kept or none is given."""
        if limits.jerk is not None and math.isinf(self.peak_jerk):
            raise InputError("this move jumps in acceleration, so no jerk limit can be kept: leave it out.")
        size = abs(distance)
        times = []
        if limits.speed is not None:
            times.append(size * self.peak_velocity / limits.speed)
        if limits.acceleration is not None:
            times.append(math.sqrt(size * self.peak_acceleration / limits.acceleration))
        if limits.jerk is not None:
            times.append(math.cbrt(size * self.peak_jerk / limits.jerk))
        if not times:
            raise InputError(
                "a move needs a duration or a limit: give duration, maximum_speed or maximum_acceleration."
            )
        return max(times)

    def duration(self, distance: float, duration: float | None, limits: Limits) -> float:
        """The duration asked for [s], if it keeps to the limits, or the shortest that does."""
        if duration is None:
            return self.shortest(distance, limits)
        asked = positive("duration", duration, "s")
        if limits != Limits() and asked < (least := self.shortest(distance, limits)) * (1.0 - 1e-12):
            raise InputError(f"a duration of {asked:g} s breaks a limit: this move takes at least {least:.6g} s.")
        return asked


def shaped_move(
    shape: MoveShape, distance: float, duration: float | None, limits: Limits, *, dt: float, rest: float, quantity: str
) -> Command:
    """The command of a shape: exact at the samples, the end position exact too.

    Parameters
    ----------
    shape : MoveShape
        The form of the move.
    distance : float
        Where it ends; its sign is the direction.
    duration : float or None
        [s]; the shortest within the limits unless given.
    limits : Limits
        What it keeps to.
    dt, rest : float
        Sample interval and least time at rest in the samples after the move [s].
    quantity : str
        What is commanded, with its unit.
    """
    distance, dt = nonzero("distance", distance, "m"), positive("dt", dt, "s")
    time = shape.duration(distance, duration, limits)
    held = sample_count(not_negative("rest", rest, "s"), dt)
    samples = np.arange(max(1, sample_count(time, dt)) + 1 + held) * dt
    u = np.minimum(samples / time, 1.0)
    ended = samples >= time * (1.0 - 1e-12)
    position = np.where(ended, 1.0, shape.position(u))
    position[0] = 0.0
    return Command(
        dt=dt,
        values=distance * position,
        quantity=quantity,
        duration=time,
        velocity=distance / time * np.where(ended, 0.0, shape.velocity(u)),
        acceleration=distance / time**2 * np.where(ended, 0.0, shape.acceleration(u)),
    )


def shortest_of(shape_for: Callable[[float], MoveShape], distance: float, limits: Limits) -> float:
    """The least duration [s] at which a form that depends on the duration keeps to the limits, to a part in 1e6.

    The form changes little with the duration, so the first that is long enough is found by growing, then by bisection.
    """
    high = shape_for(1.0).shortest(distance, limits)
    while shape_for(high).shortest(distance, limits) > high:
        high *= GROWTH
    low = high / GROWTH
    while shape_for(low).shortest(distance, limits) <= low:
        low /= GROWTH
    while high - low > SAME * high:
        middle = 0.5 * (low + high)
        if shape_for(middle).shortest(distance, limits) <= middle:
            high = middle
        else:
            low = middle
    return high
