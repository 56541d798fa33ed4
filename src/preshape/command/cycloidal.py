"""Cycloidal: the cam profile x = u - sin(2 pi u) / 2 pi, smooth to the acceleration."""

from __future__ import annotations

import numpy as np

from preshape.command.command import Command
from preshape.command.shape import Limits, MoveShape, shaped_move

__all__ = ["CYCLOIDAL_SHAPE", "cycloidal"]

CYCLOIDAL_SHAPE = MoveShape(
    position=lambda u: u - np.sin(2.0 * np.pi * u) / (2.0 * np.pi),
    velocity=lambda u: 1.0 - np.cos(2.0 * np.pi * u),
    acceleration=lambda u: 2.0 * np.pi * np.sin(2.0 * np.pi * u),
    peak_velocity=2.0,
    peak_acceleration=2.0 * np.pi,
    peak_jerk=4.0 * np.pi**2,
)


def cycloidal(
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
    """A cycloidal cam: an undamped mode keeps abs(sin(pi r) / (pi r (1 - r^2))) of the distance, r = w T / 2 pi.

    Parameters
    ----------
    distance : float
        Where the move ends [m]; negative moves backwards, 0 is refused.
    duration : float, optional
        [s]; the shortest within the limits unless given.
    maximum_speed, maximum_acceleration, maximum_jerk : float, optional
        Limits [m/s, m/s^2, m/s^3]; all can be kept.
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
    Singer & Seering, introduction; Sehitoglu & Aristizabal.

    Examples
    --------
    >>> move = cycloidal(0.1, duration=0.5, dt=0.001)
    >>> round(float(move.velocity.max()), 4)
    0.4
    """
    limits = Limits(maximum_speed, maximum_acceleration, maximum_jerk)
    return shaped_move(CYCLOIDAL_SHAPE, distance, duration, limits, dt=dt, rest=rest, quantity=quantity)
