"""What is wrong with a record whatever its format: a clipped sensor, a wrong unit, aliasing, a channel that is off.

Each check says what was seen and what to do, in a sentence; none changes the record.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.identify.measurement import TimeSeries

__all__ = ["sensor_trouble"]

FLAT = 3
"""Samples of the same extreme value in a row that are a flat top."""

STEEP = 4.0
"""A flat top is cut off when a step beside it is more than so many of the smallest steps: a rounded top is not."""

CLIPPED = 6
"""Samples on flat tops from which on a channel counts as clipped."""

FEWEST = 64
"""Samples below which nothing is said."""

BLOCK = 256
MOST_BLOCKS = 2000
"""Samples of the blocks, and number of blocks spread over the record, in which power near half the rate is measured."""

TOP = 0.8
"""The uppermost fifth of the band, where folded frequencies appear first."""

FOLDED = 0.4
"""White noise has a fifth of its power there; with this part and more, what is above half the rate is not small."""

GRAVITY = {"g": 1.0, "m/s^2": 9.80665, "mm/s^2": 9806.65}
NEAR = 0.1
"""Relative difference within which a constant acceleration is gravity."""

STEADY = 0.02
"""Relative difference of the two halves' means within which an acceleration is constant."""

_Array = NDArray[np.float64]


def sensor_trouble(series: TimeSeries) -> tuple[str, ...]:
    """Sentences on what is wrong with a record; empty when nothing is.

    Parameters
    ----------
    series : TimeSeries
        The record, as it was read.
    """
    if series.values.shape[-1] < FEWEST:
        return ()
    moving = np.ptp(series.values, axis=-1) > 0.0
    if not moving.any():
        return ()  # said by those who look for modes
    return (
        *_constant(series, moving),
        *_clipped(series, moving),
        *_wrong_unit(series),
        *_aliased(series, moving),
    )


def _constant(series: TimeSeries, moving: NDArray[np.bool_]) -> tuple[str, ...]:
    still = [name for name, moves in zip(series.channels, moving, strict=True) if not moves]
    if not still:
        return ()
    return (f"channel {', '.join(still)} never changes: that sensor is off or not connected.",)


def _clipped(series: TimeSeries, moving: NDArray[np.bool_]) -> tuple[str, ...]:
    """Flat tops at the extreme value with a steep side: the signal went on where the sensor could not follow."""
    found = []
    for name, channel, moves in zip(series.channels, series.values, moving, strict=True):
        if not moves:
            continue
        smallest = None
        for extreme in (float(channel.max()), float(channel.min())):
            at = np.flatnonzero(channel == extreme)
            if at.size < CLIPPED:
                continue
            runs = np.split(at, np.flatnonzero(np.diff(at) > 1) + 1)
            smallest = _resolution(channel) if smallest is None else smallest
            flat = [run for run in runs if run.size >= FLAT and _side(channel, run) > STEEP * smallest]
            count = sum(run.size for run in flat)
            if count >= CLIPPED:
                found.append(
                    f"channel {name}, {count} samples at {extreme:.4g}{' ' + series.unit if series.unit else ''}"
                )
    if not found:
        return ()
    return (
        f"the sensor is clipped ({'; '.join(found)}): the vibration was larger than its range, so set a wider range or "
        "excite less.",
    )


def _resolution(channel: _Array) -> float:
    """The smallest step between neighbouring samples that are not the same."""
    steps = np.abs(np.diff(channel))
    steps = steps[steps > 0.0]
    return float(steps.min())


def _side(channel: _Array, run: NDArray[np.intp]) -> float:
    """The larger step beside a run of samples."""
    before = abs(channel[run[0]] - channel[run[0] - 1]) if run[0] > 0 else 0.0
    after = abs(channel[run[-1]] - channel[run[-1] + 1]) if run[-1] + 1 < channel.size else 0.0
    return float(max(before, after))


def _wrong_unit(series: TimeSeries) -> tuple[str, ...]:
    """Gravity in another unit than the file says."""
    if series.unit not in GRAVITY:
        return ()
    half = series.values.shape[-1] // 2
    first, second = series.values[:, :half].mean(axis=-1), series.values[:, half:].mean(axis=-1)
    level = float(np.linalg.norm(0.5 * (first + second)))
    if level == 0.0 or float(np.linalg.norm(first - second)) > STEADY * level:
        return ()
    for unit, gravity in GRAVITY.items():
        if unit != series.unit and abs(level - gravity) < NEAR * gravity:
            return (
                f"the unit is probably wrong: the constant part is {level:.4g}, which is gravity in {unit} and not in "
                f"{series.unit}, the unit of this file.",
            )
    return ()


def _aliased(series: TimeSeries, moving: NDArray[np.bool_]) -> tuple[str, ...]:
    """Much power just below half the rate: then there is much above it, too, and it appears folded."""
    length = BLOCK if series.values.shape[-1] >= BLOCK else FEWEST
    count = series.values.shape[-1] // length
    stride = max(count // MOST_BLOCKS, 1)
    power = np.zeros(length // 2 + 1)
    for channel in (one for one, moves in zip(series.values, moving, strict=True) if moves):
        blocks = channel[: count * length].reshape(count, length)[::stride]
        centred = blocks - blocks.mean(axis=-1, keepdims=True)
        power += np.sum(np.abs(np.fft.rfft(centred * np.hanning(length), axis=-1)) ** 2, axis=0)
    part = float(power[int(TOP * (length // 2)) :].sum() / max(float(power.sum()), np.finfo(float).tiny))
    if part < FOLDED:
        return ()
    half = 0.5 * series.sample_rate
    return (
        f"aliasing is likely: {100.0 * part:.0f} % of the vibration lies just below half the sample rate "
        f"({half:.4g} Hz), and what is above appears folded to lower frequencies, where it cannot be told from modes; "
        "sample faster, or with the sensor's low-pass filter on.",
    )
