"""When a move stops in a recording, when it begins, and how loud the sensor is before."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from preshape.identify import TimeSeries, ring_down
from preshape.identify.free_decay import find_free_decay
from preshape.mode import Mode

__all__ = ["Motion", "find_motion", "find_stop"]

MOST_MODES = 4
"""Modes of the vibration that is continued backwards."""

SURELY_FREE = 0.2
"""Part of the free decay that is skipped, as its beginning may be early."""

LOUD = 5.0
"""A sample is no noise when it is off by so many standard deviations."""

QUIETEST = 24
SURELY_QUIET = 0.7
MOVING = 0.95
"""Samples that must be quiet before the move for the floor to be known, the part of the time before it that is, and the
part of all samples that may be quiet."""

BEGUN = 0.002
"""Standard deviation of a beginning [s]: with limited jerk the first samples are below the noise."""

WIDTHS = (4, 8, 16, 32)
"""Samples over which it is asked whether they continue the free vibration backwards."""

NEAR = 0.1
"""A mode of this recording that is as near to a known one is that one, less well known."""

STRONG = 0.1
"""Share of the vibration from which on a mode that is not known is believed."""

MODEL_ERROR = 0.02
"""Part of the vibration by which its continuation may be off."""

LEAST_SPREAD = 1.0
"""Standard deviation of the stop, in samples, at least."""

UNLIKELY = 5.5
"""Their mean is off by so many standard deviations of the noise where the vibration is not free."""

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
    return series.start + onset / series.sample_rate, max(BEGUN, 1.0 / series.sample_rate), np.asarray(floor)


def find_stop(series: TimeSeries, begin: float | None, known: Sequence[Mode] = ()) -> tuple[float, float]:
    """The stop [s] and its standard deviation, for a move that began at `begin`, or before the recording (None).

    The stop is the earliest time from which on the record is free vibration: a free part is found near the end, and
    continued backwards as long as what was measured before agrees with it. One time in three that is wrong by more than
    a millisecond, so it takes two recordings to be believed.
    """
    rate, values, samples = series.sample_rate, series.values, series.values.shape[-1]
    decay = find_free_decay(series, MOST_MODES)
    if decay is None:
        return series.start, 0.0
    found = round((decay.start - series.start) * rate)
    if begin is None and found <= max(2.0 * rate / decay.rate, 3.0):
        return series.start, 0.0
    earliest = 0 if begin is None else round((begin - series.start) * rate)
    at = max(found, earliest + 1)
    later = at + int(SURELY_FREE * (samples - at))
    # With known modes only what is not known is wanted here, and must not come from the end of the move.
    found_here = ring_down(_from(series, later if known else at)).modes or ring_down(series).modes
    own = [one.mode for one in found_here if not known or one.share > STRONG]
    modes = [*known, *(one for one in own if all(abs(one.frequency / other.frequency - 1.0) > NEAR for other in known))]
    if not modes:
        return series.start + found / rate, 1.0 / decay.rate
    at = later
    past = _Continuation(values, rate, np.array([one.pole for one in modes]))
    while at > earliest + WIDTHS[0]:
        widths = [width for width in WIDTHS if at - width >= earliest]
        off, odds = past.at(at, widths[-1])
        broken = [width for width, odd in zip(WIDTHS, odds, strict=False) if odd > UNLIKELY]
        if broken:
            free, spread = _free_samples(off[:, -broken[0] :])
            return series.start + (at - free) / rate, max(spread, LEAST_SPREAD) / rate
        at -= 2
    return (series.start, 0.0) if begin is None else (series.start + at / rate, WIDTHS[0] / rate)


def _from(series: TimeSeries, first: int) -> TimeSeries:
    return replace(series, start=series.start + first / series.sample_rate, values=series.values[:, first:], remarks=())


class _Continuation:
    """Free vibration fitted to the end of a record, and continued backwards; cheap at every sample.

    The sums of the normal equations run from the end of the record, so that every start is one small system.
    """

    def __init__(self, values: _Array, rate: float, poles: NDArray[np.complex128]) -> None:
        samples = values.shape[-1]
        waves = np.exp(np.multiply.outer(np.arange(samples) / rate, poles))
        self._basis = np.concatenate([waves.real, waves.imag, np.ones((samples, 1))], axis=1)
        self._values = values - values[:, -samples // 4 :].mean(axis=-1, keepdims=True)
        self._normal = _from_end(self._basis[:, :, None] * self._basis[:, None, :])
        self._right = _from_end(self._basis[:, :, None] * self._values.T[:, None, :])
        self._squares = _from_end(self._values.T**2)

    def at(self, first: int, width: int) -> tuple[_Array, list[float]]:
        """How far the `width` samples before `first` are off, over the noise, and how unlikely that is.

        The odds are those of the mean of the last w of them, in standard deviations, for each of `WIDTHS`: a command
        that has not stopped is first of all an offset.
        """
        scale = 1.0 / np.maximum(np.sqrt(np.diagonal(self._normal[first])), 1e-150)
        inverse = scale[:, None] * np.linalg.pinv(scale[:, None] * self._normal[first] * scale) * scale
        found = inverse @ self._right[first]
        rest = self._squares[first] - np.sum(found * self._right[first], axis=0)
        freedoms = max(self._values.shape[-1] - first - found.shape[0], 1)
        noise = np.sqrt(np.maximum(rest, 0.0) / freedoms) + np.finfo(float).tiny
        rows = self._basis[first - width : first]
        ahead = (rows @ found).T
        # The poles are not exact: continued backwards, the vibration may be off by a small part of itself.
        noise = np.hypot(noise, MODEL_ERROR * np.abs(ahead).max(axis=-1))
        off = (self._values[:, first - width : first] - ahead) / noise[:, None]
        odds = []
        for last in (one for one in WIDTHS if one <= width):
            summed = rows[-last:].sum(axis=0)
            deviation = np.sqrt(last + float(summed @ inverse @ summed))
            odds.append(float(np.abs(off[:, -last:].sum(axis=-1)).max() / deviation))
        return off, odds


def _from_end(rows: _Array) -> _Array:
    """Sums from each row to the last."""
    return np.asarray(np.cumsum(rows[::-1], axis=0)[::-1])


def _free_samples(off: _Array) -> tuple[float, float]:
    """How many of the last samples are still free, and the standard deviation of that.

    Before the stop they are off by an offset and a slope, after it by noise alone; all places weighted by likelihood.
    """
    width = off.shape[-1]
    costs = []
    for count in range(2, width + 1):
        line = np.stack([np.ones(count), np.arange(count)], axis=1)
        before = off[:, :count]
        rest = before - (line @ (np.linalg.pinv(line) @ before.T)).T
        costs.append(float(np.sum(rest**2) + np.sum(off[:, count:] ** 2)))
    weights = np.exp(-0.5 * (np.array(costs) - min(costs)))
    free = width - np.arange(2, width + 1)
    mean = float(weights @ free / weights.sum())
    return mean, float(np.sqrt(weights @ (free - mean) ** 2 / weights.sum()))
