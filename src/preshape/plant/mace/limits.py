"""A commanded angle as a gimbal with limits can follow it: bounded speed, bounded acceleration, no overshoot."""

from __future__ import annotations

import math

from preshape.plant.mace.structure import GimbalLimits

__all__ = ["LimitedFollower"]


class LimitedFollower:
    """Follows an angle step by step, as fast as the limits let it, and brakes in time.

    Parameters
    ----------
    limits : GimbalLimits
    angle : float
        Where it rests at first [rad].
    step : float
        Between calls [s].

    Examples
    --------
    Half a radian at 0.5 rad/s and 1 rad/s^2 takes 0.5 / 0.5 + 0.5 / 1 = 1.5 s:

    >>> follower = LimitedFollower(GimbalLimits(0.5, 1.0, 1.0), 0.0, 0.001)
    >>> angles = [follower.towards(0.5) for _ in range(1600)]
    >>> round(angles[1400], 3), round(angles[-1], 6), max(angles) <= 0.5
    (0.495, 0.5, True)
    """

    def __init__(self, limits: GimbalLimits, angle: float, step: float) -> None:
        self._limits, self._angle, self._step = limits, angle, step
        self._speed = 0.0

    def towards(self, target: float) -> float:
        """The angle [rad] one step later."""
        h, a = self._step, self._limits.acceleration
        left = target - self._angle
        if left == 0.0 and self._speed == 0.0:
            return self._angle
        # The speed from which one step at that speed, and braking after it, ends at the target.
        braking = math.sqrt((0.5 * a * h) ** 2 + 2.0 * a * abs(left)) - 0.5 * a * h
        wanted = math.copysign(min(braking, self._limits.speed, abs(left) / h), left)
        self._speed += min(max(wanted - self._speed, -a * h), a * h)
        self._angle += self._speed * h
        if abs(target - self._angle) < 1e-12 and abs(self._speed) <= a * h:
            self._angle, self._speed = target, 0.0
        return self._angle
