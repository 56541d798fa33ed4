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

__all__ = ["Motion", "find_motion", "find_stop"]

MOST_MODES = 4
"""Modes that are looked for to find the free part."""

SURELY_FREE = 0.05
FEWEST_FREE = 8
"""Part of the free decay that is skipped, and samples at least, as its beginning may be early."""

LOUD = 5.0
"""A sample is no noise when it is off by so many standard deviations."""

QUIETEST = 24
SURELY_QUIET = 0.7
MOVING = 0.95
"""Samples that must be quiet before the move for the floor to be known, the part of the time before it that is,
and the part of all samples that may be quiet."""

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
    begin_spread : float
        Standard deviation of `begin` [s].
    stop : float
        When the command stops [s]; the first sample's time where the recording starts later.
    spread : float
        Standard deviation of `stop` [s]; 0 when it was given or the recording starts there.
    floor : ndarray or None, shape (channel,)
        Standard deviation of each channel before the move.
    """

    begin: float | None
    begin_spread: float
    stop: float
    spread: float
    floor: _Array | None

    def top(self, series: TimeSeries) -> float | None:
        """Largest speed until the stop, in the unit of the values times seconds; None without the beginning."""
        if self.begin is None:
            return None
        first = int((self.begin - series.start) * series.sample_rate)
        last = round((self.stop - series.start) * series.sample_rate)
        if not 0 < first < last:
            return None
        moving = series.values - series.values[:, :first].mean(axis=-1, keepdims=True)
        speeds = np.cumsum(moving[:, :last], axis=-1) / series.sample_rate
        return float(np.sqrt(np.max(np.sum(speeds**2, axis=0))))


def find_motion(series: TimeSeries) -> Motion:
    """Beginning and floor of a recording; the stop is still to be found."""
    begin, spread, floor = _beginning(series)
    return Motion(begin, spread, series.start, 0.0, floor)


def _beginning(series: TimeSeries) -> tuple[float | None, float, _Array | None]:
    """When the record stops being quiet, the standard deviation of that, and the noise until then.

    None, 0 and None when it begins in motion.
    """
    nothing = None, 0.0, None
    if series.values.shape[-1] < 2 * QUIETEST:
        return nothing
    first = series.values[:, :QUIETEST]
    middle, noise = first.mean(axis=-1, keepdims=True), first.std(axis=-1, keepdims=True) + np.finfo(float).tiny
    off = np.abs(series.values - middle)
    # A record that begins in motion has its largest deviations there.
    if not np.any(np.quantile(off, MOVING, axis=-1) > LOUD * noise[:, 0]):
        return nothing
    loud = np.flatnonzero((off > LOUD * noise).sum(axis=0))
    loud = loud[loud >= QUIETEST]
    # A single outlier is none: two of the next three are loud, too.
    onset = next((int(k) for k in loud if np.count_nonzero((loud > k) & (loud <= k + 3)) >= 2), None)
    if onset is None:
        return nothing
    quiet = series.values[:, : max(int(SURELY_QUIET * onset), QUIETEST)]
    floor = quiet.std(axis=-1, ddof=1) + np.finfo(float).tiny
    # The same question as at the stop, with time reversed and nothing that rings.
    last = min(onset + FEWEST_FREE, series.values.shape[-1])
    window = series.values[:, max(onset - 2 * QUIETEST, 0) : last][:, ::-1] - quiet.mean(axis=-1, keepdims=True)
    noises = np.repeat(floor[:, None], window.shape[-1], axis=-1)
    at, spread = change_point(window, noises, series.values.std(axis=-1) + np.finfo(float).tiny)
    return series.start + (last - 1 - at) / series.sample_rate, spread / series.sample_rate, np.asarray(floor)


def find_stop(series: TimeSeries, begin: float | None) -> tuple[float, float]:
    """The stop [s] and its standard deviation, for a move that began at `begin`, or before the recording (None).

    The stop is the earliest time from which on the record is free vibration: a free part is found near the end, and
    continued backwards as long as what was measured before agrees with it.
    """
    rate, values, samples = series.sample_rate, series.values, series.values.shape[-1]
    decay = find_free_decay(series, MOST_MODES)
    if decay is None:
        return series.start, 0.0
    found = round((decay.start - series.start) * rate)
    if begin is None and found <= max(2.0 * rate / decay.rate, 3.0):
        return series.start, 0.0
    step = max(round(rate / decay.rate), 1)
    earliest = 0 if begin is None else round((begin - series.start) * rate)
    free = max(found, earliest + 1)
    free += max(int(SURELY_FREE * (samples - free)), FEWEST_FREE)
    fit = _components(values, rate, free, step)
    if fit is None:
        return decay.start, 1.0 / decay.rate
    middle, spread = _break(values, rate, fit, free, earliest)
    for _ in range(EXTENSIONS):
        for earlier in EARLIER:
            head = max(round(earlier * rate), FEWEST_FREE)
            start = int(middle) - head
            more = _components(values, rate, start, step) if start > earliest else None
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
    middle, spread = change_point(broken.off, broken.noise, moving.std(axis=-1) + np.finfo(float).tiny)
    return broken.first + middle, spread


def _components(values: _Array, rate: float, first: int, step: int) -> DecayFit | None:
    """Of the samples from `first` on, thinned by means of so many: decaying sinusoids stay what they are."""
    tail = values[:, first:]
    tail = tail[:, : tail.shape[-1] // step * step].reshape(tail.shape[0], -1, step).mean(axis=-1)
    return decay_components(tail, rate / step) if tail.shape[-1] >= FEWEST_FREE else None
