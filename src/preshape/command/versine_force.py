"""Versine force: an acceleration of 1 - cos, once forwards and once backwards, smooth to the jerk."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.command.command import Command
from preshape.command.shape import Limits, MoveShape, shaped_move

__all__ = ["VERSINE_FORCE_SHAPE", "versine_force"]


def _half(u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Position on the way to the middle."""
    half: NDArray[np.float64] = 2.0 * u**2 + (np.cos(4.0 * np.pi * u) - 1.0) / (4.0 * np.pi**2)
    return half


def _rate(u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Velocity on the way to the middle."""
    rate: NDArray[np.float64] = 4.0 * u - np.sin(4.0 * np.pi * u) / np.pi
    return rate


VERSINE_FORCE_SHAPE = MoveShape(
    position=lambda u: np.where(u < 0.5, _half(u), 1.0 - _half(1.0 - u)),
    velocity=lambda u: np.where(u < 0.5, _rate(u), _rate(1.0 - u)),
    acceleration=lambda u: np.where(u < 0.5, 4.0, -4.0) * (1.0 - np.cos(4.0 * np.pi * u)),
    peak_velocity=2.0,
    peak_acceleration=8.0,
    peak_jerk=16.0 * np.pi,
)


def versine_force(
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
    """Accelerates as 1 - cos: an undamped mode keeps what bang-bang leaves, divided by abs(1 - (w T / 4 pi)^2).

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
    Meckl & Seering, as quoted by Singer & Seering.

    Examples
    --------
    >>> move = versine_force(0.1, duration=0.5, dt=0.001)
    >>> round(float(move.velocity.max()), 4)
    0.4
    """
    limits = Limits(maximum_speed, maximum_acceleration, maximum_jerk)
    return shaped_move(VERSINE_FORCE_SHAPE, distance, duration, limits, dt=dt, rest=rest, quantity=quantity)
