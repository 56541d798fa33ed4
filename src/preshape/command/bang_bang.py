"""Bang-bang: full acceleration to the middle of the way, full deceleration to its end."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from preshape.command.command import Command
from preshape.command.shape import Limits, MoveShape, shaped_move
from preshape.profile import Profile

__all__ = ["BANG_BANG_SHAPE", "bang_bang"]

BANG_BANG_SHAPE = MoveShape(
    position=lambda u: np.where(u < 0.5, 2.0 * u**2, 1.0 - 2.0 * (1.0 - u) ** 2),
    velocity=lambda u: np.where(u < 0.5, 4.0 * u, 4.0 * (1.0 - u)),
    acceleration=lambda u: np.where(u < 0.5, 4.0, -4.0),
    peak_velocity=2.0,
    peak_acceleration=4.0,
    peak_jerk=np.inf,
)


def bang_bang(
    distance: float,
    *,
    duration: float | None = None,
    maximum_speed: float | None = None,
    maximum_acceleration: float | None = None,
    maximum_jerk: float | None = None,
    dt: float,
    rest: float = 0.0,
    quantity: str = "position [m]",
) -> Command:
    """The fastest move under an acceleration limit; an undamped mode keeps 16 sin^2(w T / 4) / (w T)^2 of the distance.

    Parameters
    ----------
    distance : float
        Where the move ends [m]; negative moves backwards, 0 is refused.
    duration : float, optional
        [s]; the shortest within the limits unless given.
    maximum_speed, maximum_acceleration, maximum_jerk : float, optional
        Limits [m/s, m/s^2, m/s^3]; a jerk limit cannot be kept, for the acceleration jumps.
    dt : float
        Sample interval [s].
    rest : float
        How long at least the end position is kept in the samples [s].
    quantity : str
        What is commanded, with its unit. With another unit of length, give all limits in it.

    Raises
    ------
    InputError
        If a value is out of range, neither duration nor limit is given, or the duration breaks a limit.

    References
    ----------
    Robertson, section II; Singer & Seering, introduction.

    Examples
    --------
    >>> move = bang_bang(0.1, duration=0.5, dt=0.001)
    >>> round(float(move.velocity.max()), 4)
    0.4
    """
    limits = Limits(maximum_speed, maximum_acceleration, maximum_jerk)
    move = shaped_move(BANG_BANG_SHAPE, distance, duration, limits, dt=dt, rest=rest, quantity=quantity)
    switches, level = np.array([0.0, 0.5, 1.0]) * move.duration, 4.0 * distance / move.duration**2
    return replace(move, profile=Profile.steps(switches, level * np.array([1.0, -2.0, 1.0]), order=2))
