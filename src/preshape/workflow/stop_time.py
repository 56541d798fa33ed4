"""When a move stops in a recording, when it begins, and how loud the sensor is before."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.identify import TimeSeries
from preshape.identify.decaying_sinusoids import DecayFit
from preshape.identify.free_decay import find_free_decay
from preshape.workflow.change_point import change_point
from preshape.workflow.free_continuation import continued, decay_components, left_at_start

__all__ = ["Motion", "find_motion"]

MOST_MODES = 4
"""Modes that are looked for to find the free part."""

SURELY_FREE = 0.05
FEWEST_FREE = 8
"""Part of the free decay that is skipped, and samples at least, as its beginning may be early."""

LOUD = 5.0
"""A sample is no noise when it is off by so many standard deviations."""

QUIETEST = 24
SURELY_QUIET = 0.7
"""Samples that must be quiet before the move for the floor to be known, and the part of the time before it that is."""

EARLIER = (0.02, 0.005)
"""Components that have died away where the vibration is surely free are looked for so much earlier [s]."""

EXTENSIONS = 6
"""So often."""

STILL_FREE = 1.6
"""What is left there, in mean squares of the rest, at most."""

_Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Motion:
    """What a recording shows of a move.

    Parameters
    ----------
    begin : float or None
        When it begins [s]; None where the recording starts later.
    stop : float
        When the command stops [s]; the first sample's time where the recording starts later.
    spread : float
        Standard deviation of `stop` [s]; 0 when it was given or the recording starts there.
    floor : ndarray or None, shape (channel,)
        Standard deviation of each channel before the move.
    top : float or None
        Largest speed, in the unit of the values times seconds; None where the beginning is not recorded.
    """

    begin: float | None
    stop: float
    spread: float
    floor: _Array | None
    top: float | None


def find_motion(series: TimeSeries, stop: float | None) -> Motion:
    """Beginning, stop and floor of a recording; `stop` [s] when it is known.

    The stop is the earliest time from which on the record is free vibration: a free part is found near the end, and
    continued backwards as long as what was measured before agrees with it.
    """
    begin, floor = _beginning(series)
    spread = 0.0
    if stop is None:
        stop, spread = _stop(series, begin)
    top = None
    if begin is not None and floor is not None:
        first = round((begin - series.start) * series.sample_rate)
        last = round((stop - series.start) * series.sample_rate)
        moving = series.values - series.values[:, :first].mean(axis=-1, keepdims=True)
        speeds = np.cumsum(moving[:, :last], axis=-1) / series.sample_rate
        top = float(np.sqrt(np.max(np.sum(speeds**2, axis=0)))) if last > first else None
    return Motion(begin, stop, spread, floor, top)


def _beginning(series: TimeSeries) -> tuple[float | None, _Array | None]:
    """When the record stops being quiet, and the noise until then; (None, None) when it begins in motion."""
    first = series.values[:, :QUIETEST]
    if first.shape[-1] < QUIETEST:
        return None, None
    middle, noise = first.mean(axis=-1, keepdims=True), first.std(axis=-1, keepdims=True)
    whole = float(np.sqrt(np.sum(np.var(series.values, axis=-1))))
    if float(np.sqrt(np.sum(noise**2))) > whole / LOUD:
        return None, None
    tiny = np.finfo(float).tiny
    loud = np.flatnonzero((np.abs(series.values - middle) > LOUD * (noise + tiny)).sum(axis=0))
    loud = loud[loud >= QUIETEST]
    if not loud.size:
        return None, None
    # A single outlier is none: two of the next three are loud, too.
    onset = next((int(k) for k in loud if np.count_nonzero((loud > k) & (loud <= k + 3)) >= 2), int(loud[0]))
    quiet = series.values[:, : max(int(SURELY_QUIET * onset), QUIETEST)]
    return series.start + onset / series.sample_rate, np.asarray(quiet.std(axis=-1, ddof=1))


def _stop(series: TimeSeries, begin: float | None) -> tuple[float, float]:
    """The stop [s] and its standard deviation."""
    rate, values, samples = series.sample_rate, series.values, series.values.shape[-1]
    decay = find_free_decay(series, MOST_MODES)
    if decay is None:
        return series.start, 0.0
    found = round((decay.start - series.start) * rate)
    if begin is None and found <= max(2.0 * rate / decay.rate, 3.0):
        return series.start, 0.0
    earliest = 0 if begin is None else round((begin - series.start) * rate)
    free = max(found, earliest + 1)
    free += max(int(SURELY_FREE * (samples - free)), FEWEST_FREE)
    fit = _components(values, rate, free)
    if fit is None:
        return decay.start, 1.0 / decay.rate
    middle, spread = _break(values, rate, fit, free, earliest)
    for _ in range(EXTENSIONS):
        for earlier in EARLIER:
            head = max(round(earlier * rate), FEWEST_FREE)
            start = int(middle) - head
            more = _components(values, rate, start) if start > earliest else None
            if more is not None and left_at_start(values, rate, more, start, head) < STILL_FREE:
                middle, spread = _break(values, rate, more, start, earliest)
                break
        else:
            break
    return series.start + middle / rate, spread / rate


def _break(values: _Array, rate: float, fit: DecayFit, free: int, earliest: int) -> tuple[float, float]:
    broken = continued(values, rate, fit, free, earliest)
    if broken is None:
        return float(earliest), FEWEST_FREE
    moving = values[:, earliest:free]
    middle, spread = change_point(broken.off, broken.covariances, moving.std(axis=-1) + np.finfo(float).tiny)
    return broken.first + middle, spread


def _components(values: _Array, rate: float, first: int) -> DecayFit | None:
    """Of the samples from `first` on."""
    tail = values[:, first:]
    return decay_components(tail, rate) if tail.shape[-1] >= FEWEST_FREE else None
