"""S-curve: the seven-segment move, at a jerk limit, an acceleration limit and a speed limit."""

from __future__ import annotations

import math

from preshape.checks import nonzero, positive
from preshape.command.command import Command
from preshape.command.symmetric import Segment, slowed, symmetric_move

__all__ = ["s_curve"]


def s_curve(
    distance: float,
    *,
    maximum_speed: float,
    maximum_acceleration: float,
    maximum_jerk: float,
    duration: float | None = None,
    dt: float,
    rest: float = 0.0,
    quantity: str = "position [m]",
) -> Command:
    """The fastest rest-to-rest move within a speed, an acceleration and a jerk limit.

    Jerk up, full acceleration, jerk down, cruise, and the same mirrored. A limit that the way is too short to reach
    takes its segment away: no cruise below the speed limit, no constant acceleration below the acceleration limit,
    down to the four segments of jerk alone, of duration 4 (d / 2j)^(1/3).

    Parameters
    ----------
    distance : float
        Where the move ends [m]; negative moves backwards, 0 is refused.
    maximum_speed : float
        Speed limit [m/s], above zero.
    maximum_acceleration : float
        Acceleration limit [m/s^2], above zero.
    maximum_jerk : float
        Jerk limit [m/s^3], above zero. For none, take :func:`preshape.command.trapezoid`.
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
    >>> move = s_curve(0.3, maximum_speed=0.5, maximum_acceleration=5.0, maximum_jerk=100.0, dt=0.001)
    >>> round(move.duration, 12)
    0.75
    """
    distance = nonzero("distance", distance, "m")
    speed = positive("maximum_speed", maximum_speed, "m/s")
    acceleration = positive("maximum_acceleration", maximum_acceleration, "m/s^2")
    jerk = positive("maximum_jerk", maximum_jerk, "m/s^3")
    size = abs(distance)

    rise, plateau = _ramp(speed, acceleration, jerk)
    cruise = size / speed - (2.0 * rise + plateau)
    if cruise <= 0.0:  # the speed limit is not reached: the speed that is, from v * (time to reach v) = |distance|
        cruise = 0.0
        lag = acceleration / jerk
        if size > 2.0 * acceleration * lag**2:
            reached = 2.0 * size / (lag + math.sqrt(lag**2 + 4.0 * size / acceleration))
            rise, plateau = _ramp(reached, acceleration, jerk)
        else:
            rise, plateau = math.cbrt(0.5 * size / jerk), 0.0
    top = jerk * rise
    half = [
        Segment(rise, 0.0, jerk),
        Segment(plateau, top),
        Segment(rise, top, -jerk),
        Segment(0.5 * cruise, 0.0),
    ]
    return symmetric_move(distance, slowed(half, duration), dt=dt, rest=rest, quantity=quantity)


def _ramp(speed: float, acceleration: float, jerk: float) -> tuple[float, float]:
    """Duration of each jerk segment and of the constant acceleration between them [s], on the way to `speed`."""
    lag = acceleration / jerk
    plateau = speed / acceleration - lag
    return (lag, plateau) if plateau > 0.0 else (math.sqrt(speed / jerk), 0.0)
