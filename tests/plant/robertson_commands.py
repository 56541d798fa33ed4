"""Closed-form rest-to-rest forces for Robertson's benchmark m1 = m2 = k = 1, |u| <= 1, written out for the tests."""

from __future__ import annotations

import math

import numpy as np

from preshape.profile import Profile

W = math.sqrt(2.0)
PERIOD = 2 * math.pi / W


def on_off(distance: float) -> Profile:
    """The closed form for m1 = m2 = k = 1, |u| <= 1."""
    t2 = math.sqrt(2 * distance)
    times = np.add.outer([0.0, t2, 2 * t2], [0.0, PERIOD / 6, PERIOD / 3]).ravel()
    return Profile.steps(times, [1.0, -1, 1, -2, 2, -2, 1, -1, 1])


def limited(distance: float, level: float) -> Profile:
    """The closed form that holds the deflection at level times the static one, "1, -1, a"."""
    a = level
    t1, t2 = math.acos((4 - 2 * a - a * a) / 4) / W, math.acos((2 - 2 * a - a * a) / (2 + 2 * a)) / W
    mu = math.acos(1 / (1 + a)) / W
    p, q = 2 * t1 - t2, t1**2 / 2 + t1 * (t2 - t1) - (t2 - t1) ** 2 / 2
    b, c = p + a * mu, q + p * mu - mu * mu / 2 - distance
    hold = (-b + math.sqrt(b * b - 2 * a * c)) / a
    middle = t2 + hold + mu
    half = [0.0, t1, t2, middle - mu]
    times = [*half, middle, *(2 * middle - t for t in reversed(half))]
    return Profile.steps(times, [1.0, -2, 1 + a, -1 - a, 2, -1 - a, 1 + a, -2, 1])
