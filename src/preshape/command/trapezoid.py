"""Trapezoid: the move of trapezoidal velocity, at an acceleration limit and a speed limit."""

from __future__ import annotations

import math

from preshape.checks import nonzero, positive
from preshape.command.command import Command
from preshape.command.symmetric import Segment, slowed, symmetric_move

__all__ = ["trapezoid"]


def trapezoid(
    distance: float,
    *,
    maximum_speed: float,
    maximum_acceleration: float,
    duration: float | None = None,
    dt: float,
    rest: float = 0.0,
    quantity: str = "position [m]",
) -> Command:
    """The fastest rest-to-rest move within a speed and an acceleration limit.

    Full acceleration, cruise, full deceleration; when the way is too short to reach `maximum_speed`
    (\\|distance\\| < speed^2 / acceleration) the cruise vanishes and the velocity is a triangle.
    Its duration is d/v + v/a, or 2 sqrt(d/a) for the triangle.

    Parameters
    ----------
    distance : float
        Where the move ends [m]; negative moves backwards, 0 is refused.
    maximum_speed : float
        Speed limit [m/s], above zero.
    maximum_acceleration : float
        Acceleration limit [m/s^2], above zero.
    duration : float, optional
        [s]; the shortest within the limits unless given. A longer one slows the same move in time: less speed,
        acceleration and jerk, in the same proportions.
    dt : float
        Sample interval [s].
    rest : float
        How long at least the end position is kept in the samples [s].
    quantity : str
        What is commanded, with its unit. With another unit of length, give all limits in it.

    Returns
    -------
    Command
        Position, velocity and acceleration of shape (sample,), exact at the samples: the polynomials of the move, not
        a numerical integral. The last sample is at rest on `distance` exactly.

    Raises
    ------
    InputError
        If a value is out of range or not finite, the duration breaks a limit, or `dt` asks for more
        samples than a command may have.

    Examples
    --------
    >>> move = trapezoid(0.3, maximum_speed=0.5, maximum_acceleration=5.0, dt=0.001)
    >>> round(move.duration, 12), round(float(move.velocity.max()), 12)
    (0.7, 0.5)
    """
    distance = nonzero("distance", distance, "m")
    speed = positive("maximum_speed", maximum_speed, "m/s")
    acceleration = positive("maximum_acceleration", maximum_acceleration, "m/s^2")
    size = abs(distance)
    ramp = min(speed / acceleration, math.sqrt(size / acceleration))
    # The cruise is what is left: 0 for the triangle, where rounding could make the difference negative.
    cruise = max(0.0, size / speed - speed / acceleration)
    half = [Segment(ramp, acceleration), Segment(0.5 * cruise, 0.0)]
    return symmetric_move(distance, slowed(half, duration), dt=dt, rest=rest, quantity=quantity)
