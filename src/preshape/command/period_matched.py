"""Period-matched trapezoid: ramps of velocity as long as whole periods of a mode, which then is left at rest.

A ramp of velocity is a box of acceleration; over whole periods a box excites an undamped mode not at all. No shaper and
no latency, but the acceleration is what the period dictates.
"""

from __future__ import annotations

import math

from preshape.checks import nonzero, positive
from preshape.command.command import Command
from preshape.command.symmetric import Segment, asked_duration, symmetric_move
from preshape.mode import ModesLike, one_mode

__all__ = ["period_matched"]

ROUNDING = 1e-12
"""A ramp this close to whole periods, relatively, is whole."""


def period_matched(
    distance: float,
    mode: ModesLike,
    *,
    maximum_speed: float,
    maximum_acceleration: float,
    duration: float | None = None,
    dt: float,
    rest: float = 0.0,
    quantity: str = "position [m]",
) -> Command:
    """The fastest trapezoidal velocity within the limits whose ramps are whole periods of `mode` long.

    Parameters
    ----------
    distance : float
        Where the move ends [m]; negative moves backwards, 0 is refused.
    mode : Mode or (frequency [Hz], damping)
        What it leaves at rest; with damping z about pi z of the vibration of bang-bang remains.
    maximum_speed, maximum_acceleration : float
        Limits [m/s, m/s^2].
    duration : float, optional
        [s]; the shortest within the limits unless given. A longer one lengthens the cruise: the ramps stay
        whole periods.
    dt, rest, quantity
        As for :func:`preshape.command.trapezoid`.

    Raises
    ------
    InputError
        If a value is out of range or not finite, or the duration breaks a limit.

    Examples
    --------
    >>> move = period_matched(1.0, (2.0, 0.0), maximum_speed=0.5, maximum_acceleration=1.2, dt=0.001)
    >>> round(move.duration, 9)
    2.5
    """
    size = abs(nonzero("distance", distance, "m"))
    speed = positive("maximum_speed", maximum_speed, "m/s")
    acceleration = positive("maximum_acceleration", maximum_acceleration, "m/s^2")
    period = one_mode(mode).damped_period
    best = math.inf
    ramp = cruise = 0.0
    # with n periods a ramp reaches at most min(speed, a n T); longer ramps than the limits need only take longer
    for count in range(1, _periods(max(speed / acceleration, math.sqrt(size / acceleration)), period) + 1):
        reached = min(speed, acceleration * count * period, size / (count * period))
        held = size / reached - count * period
        if count * period + size / reached < best * (1.0 - ROUNDING):
            best, ramp, cruise = count * period + size / reached, count * period, max(0.0, held)
    if duration is not None:
        cruise = asked_duration(duration, 2.0 * ramp + cruise) - 2.0 * ramp
    top = size / (ramp + cruise)
    half = [Segment(ramp, top / ramp), Segment(0.5 * cruise, 0.0)]
    return symmetric_move(distance, half, dt=dt, rest=rest, quantity=quantity)


def _periods(time: float, period: float) -> int:
    return max(1, math.ceil(time / period * (1.0 - ROUNDING)))
