"""A column of time stamps: to a sample rate, and to values on a uniform grid of times."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.errors import MeasurementError
from preshape.identify.text import Table

__all__ = ["uniform"]

LONGEST_STEP = 1.75
"""A step of time longer than this many mean steps is a gap, not jitter: the file is refused."""

JITTER = 0.01
"""Time stamps within this part of a step of a uniform grid are uniform; beyond it samples are interpolated."""


def uniform(times: NDArray[np.float64], values: Table, first_line: int | None, source: str) -> tuple[float, Table]:
    """Sample rate [Hz] and the values on a uniform grid of the same times.

    Parameters
    ----------
    times : ndarray, shape (sample,)
        Increasing [s].
    values : ndarray, shape (channel, sample)
        Interpolated linearly where the time stamps jitter.
    first_line : int or None
        Line of the first sample, for messages; None where the numbers do not stand in lines.
    source : str
        File name, for messages.

    Raises
    ------
    MeasurementError
        If samples are missing between two time stamps.
    """
    step = float(times[-1] - times[0]) / (len(times) - 1)
    steps = np.diff(times)
    worst = int(np.argmax(steps))
    if not steps[worst] <= LONGEST_STEP * step:
        line = "" if first_line is None else f", about line {first_line + worst + 1}"
        raise MeasurementError(
            f"{source}: samples are missing or the time steps are too uneven, from {steps.min():.3g} s to "
            f"{steps[worst]:.3g} s (data row {worst + 2}{line}) around a mean of {step:.3g} s; "
            "resample the data or cut the gap."
        )
    grid = times[0] + step * np.arange(len(times))
    deviation = float(np.max(np.abs(times - grid)))
    if deviation > JITTER * step and deviation > _resolution(times):
        values = np.array([np.interp(grid, times, channel) for channel in values])
    return 1.0 / step, values


def _resolution(times: NDArray[np.float64]) -> float:
    """The decimal step to which the time stamps were rounded [s]: a deviation within it is rounding, not jitter."""
    for decimals in range(10):
        scaled = times * 10.0**decimals
        if np.all(np.abs(scaled - np.round(scaled)) < 1e-3):
            return 10.0**-decimals
    return 0.0
