"""What every kind of command asks of its times, and the sentences it answers with."""

from __future__ import annotations

import math

from preshape.checks import positive
from preshape.errors import InputError

__all__ = ["GRID_SLACK", "sample_count", "whole_samples"]

GRID_SLACK = 1e-9
"""A time this near a sample, in sample intervals, is on it: what rounding in a quotient of two decimals amounts to."""

MOST_SAMPLES = 20_000_000
"""A longer command is a mistaken sample interval: 20 million samples are 160 MB an array."""


def sample_count(time: float, dt: float) -> int:
    """The number of sample intervals that cover `time`; a time on the grid to :data:`GRID_SLACK` counts as on it."""
    count = time / dt
    if count > MOST_SAMPLES:
        raise InputError(
            f"{time:g} s at dt = {dt:g} s asks for {count:.3g} samples, more than the {MOST_SAMPLES:,} that a command "
            "may have: give a larger dt or a shorter command."
        )
    return math.ceil(count - GRID_SLACK)


def whole_samples(name: str, time: float, dt: float) -> int:
    """`time` in samples, if it is a whole number of them and at least one."""
    time = positive(name, time, "s")
    count = sample_count(time, dt)
    if count < 1 or abs(time / dt - count) > GRID_SLACK * max(1.0, count):
        below, above = math.floor(time / dt) * dt, (math.floor(time / dt) + 1) * dt
        remedy = f"{above:.9g} s" if below == 0.0 else f"{below:.9g} s or {above:.9g} s"
        raise InputError(
            f"{name} is {time:.9g} s, not a whole number of samples of {dt:g} s: give {remedy}, or another dt."
        )
    return count
