"""Versine: the position x = (1 - cos(pi u)) / 2, half a cosine."""

from __future__ import annotations

import numpy as np

from preshape.command.command import Command
from preshape.command.shape import Limits, MoveShape, shaped_move

__all__ = ["VERSINE_SHAPE", "versine"]

VERSINE_SHAPE = MoveShape(
    position=lambda u: 0.5 * (1.0 - np.cos(np.pi * u)),
    velocity=lambda u: 0.5 * np.pi * np.sin(np.pi * u),
    acceleration=lambda u: 0.5 * np.pi**2 * np.cos(np.pi * u),
    peak_velocity=np.pi / 2.0,
    peak_acceleration=np.pi**2 / 2.0,
    peak_jerk=np.inf,
)


def versine(
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
    """Half a cosine in position: an undamped mode keeps abs(cos(pi r) / (1 - 4 r^2)) of the distance, r = w T / 2 pi.

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
    Singer & Seering, introduction (Meckl & Seering).

    Examples
    --------
    >>> move = versine(0.1, duration=0.5, dt=0.001)
    >>> round(float(move.velocity.max()), 4)
    0.3142
    """
    limits = Limits(maximum_speed, maximum_acceleration, maximum_jerk)
    return shaped_move(VERSINE_SHAPE, distance, duration, limits, dt=dt, rest=rest, quantity=quantity)
