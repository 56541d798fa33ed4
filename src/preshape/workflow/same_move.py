"""Two recordings of the same move laid over each other: what one holds, shaped, is what the other holds.

A linear machine answers the shaped command with its shaped answer: y(t) = sum_i a_i x(t - t_i - d). The delay d between
the recordings is not known, and all of the move tells it, by least squares. So the stops follow from each other however
noisy they are. A machine that was told a shaper for another frequency executes one whose times are stretched: that is
fitted, too. What still does not fit shows another shaper, or another move.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.identify import TimeSeries
from preshape.shaper import Shaper

__all__ = ["Overlay", "overlaid"]

STRETCHES = np.exp(np.linspace(-0.7, 0.7, 57))
"""Of the shaper's times, that are tried: from half to twice."""

STEPS = 20
SETTLED = 1e-3
"""Steps of the refinement, at most; it ends when it moves by less than so many samples."""

LEAST_SPREAD = 0.1
"""Standard deviation of a delay, in samples, at least: a jump is seen at the next sample."""

SURE = 4.0
SEEN = 0.3
"""A stretch is believed from so many standard deviations on, when it moves the last impulse by so many samples."""

BLOCK = 0.02
"""Errors are alike for less than this [s]."""

SMOOTHED = 15
"""Frequencies over which a power is averaged before it is compared with the noise."""

EDGE = 3
"""Samples at the ends of a recording where it is not known between the samples."""

_Array = NDArray[np.float64]


@dataclass(frozen=True)
class Overlay:
    """How a recording lies over another.

    Parameters
    ----------
    later : float
        What ends at t in the first ends at t + later in the second [s], shaping counted.
    spread : float
        Standard deviation of that [s].
    stretch : float
        Of the shaper's times; 1 when the shaper fits as it is.
    unexplained : float
        Root mean square of what does not fit, noise taken off, as a part of that of the motion.
    """

    later: float
    spread: float
    stretch: float
    unexplained: float


class _Compared:
    """A recording, shaped and delayed, minus another one, on the other one's samples."""

    def __init__(self, first: TimeSeries, second: TimeSeries, shaper: Shaper | None, weight: _Array) -> None:
        self.rate = second.sample_rate
        given, self.wanted = weight * _resampled(first, self.rate), weight * second.values
        given, self.wanted = _rested(given), _rested(self.wanted)
        self.samples = given.shape[-1]
        self.start = first.start - second.start
        self.times = np.zeros(1) if shaper is None else np.asarray(shaper.times)
        self.amplitudes = np.ones(1) if shaper is None else np.asarray(shaper.amplitudes)
        self._size = 1 << int(np.ceil(np.log2(given.shape[-1] + self.wanted.shape[-1])))
        self._omega = 2.0 * np.pi * np.fft.rfftfreq(self._size, 1.0 / self.rate)
        spectra = [np.fft.rfft(one, self._size, axis=-1) for one in (given, self.wanted)]
        self.gain = _above_noise(spectra, (given.shape[-1], self.wanted.shape[-1]))
        self._spectrum, self._other = (self.gain * one for one in spectra)
        self.wanted = np.fft.irfft(self._other, self._size, axis=-1)[:, : self.wanted.shape[-1]]

    def best(self, stretch: float) -> tuple[float, float]:
        """Least sum of squares over all delays by whole samples, and the delay [s]."""
        shaped = self._spectrum * (self.amplitudes @ np.exp(-1j * np.outer(stretch * self.times, self._omega)))
        alike = np.fft.irfft(np.sum(np.conj(shaped) * self._other, axis=0), self._size)
        lag = int(np.argmax(alike))
        energy = 2.0 * float(np.sum(np.abs(shaped) ** 2)) / self._size
        signed = lag if lag < self.wanted.shape[-1] else lag - self._size
        return energy - 2.0 * float(alike[lag]), signed / self.rate - self.start

    def rows(self, delay: float, stretch: float) -> tuple[_Array, _Array, _Array]:
        """What is left, shape (channel, sample), and its slopes by the delay and by the stretch."""
        shift = self.start + delay
        waves = self.amplitudes[:, None] * np.exp(-1j * np.outer(stretch * self.times + shift, self._omega))
        low = max(int(np.ceil(shift * self.rate)) + EDGE, 0)
        high = max(min(self.wanted.shape[-1], int(shift * self.rate) + self.samples - EDGE), low)
        turned = -1j * self._omega
        parts = (waves.sum(axis=0), turned * waves.sum(axis=0), turned * (self.times @ waves))
        found = [np.fft.irfft(self._spectrum * part, self._size, axis=-1)[:, low:high] for part in parts]
        found[0] = found[0] - self.wanted[:, low:high]
        left, by_delay, by_stretch = (one - one.mean(axis=-1, keepdims=True) if one.size else one for one in found)
        return left, by_delay, by_stretch


def overlaid(first: TimeSeries, second: TimeSeries, shaper: Shaper | None, noise: tuple[_Array, _Array]) -> Overlay:
    """Lay `first`, shaped, over `second`; both hold the whole move, and rest before it.

    Parameters
    ----------
    first, second : TimeSeries
        In the same axes; the first is resampled to the second's rate where they differ.
    shaper : Shaper or None
        Between them; None for two repeats.
    noise : pair of ndarray, each of shape (channel,)
        Standard deviation of the noise in each.
    """
    weight = 1.0 / np.maximum(np.hypot(*noise), np.finfo(float).tiny)[:, None]
    compared = _Compared(first, second, shaper, weight)
    stretches = STRETCHES if compared.times[-1] > 0.0 else np.ones(1)
    tried = [compared.best(float(one)) for one in stretches]
    index = int(np.argmin([cost for cost, _ in tried]))
    delay, stretch, covariance, left = _refined(compared, tried[index][1], float(stretches[index]), True)
    last = float(compared.times[-1])
    off, sure = (stretch - 1.0) * last, SURE * np.sqrt(covariance[1, 1]) * last
    if abs(off) <= max(sure, SEEN / compared.rate):
        delay, stretch, covariance, left = _refined(compared, compared.best(1.0)[1], 1.0, False)
    spread = float(np.sqrt(max(np.array([1.0, last]) @ covariance @ np.array([1.0, last]), 0.0)))
    power = float(np.sum(compared.amplitudes**2))
    expected = float(np.sum(weight[:, 0] ** 2 * (power * noise[0] ** 2 + noise[1] ** 2)) * np.mean(compared.gain**2))
    excess = max(float(np.sum(left**2)) / max(left.shape[-1], 1) - expected, 0.0)
    moving = max(float(np.sum(compared.wanted**2)) / compared.wanted.shape[-1], np.finfo(float).tiny)
    return Overlay(
        delay + stretch * last, max(spread, LEAST_SPREAD / compared.rate), stretch, float(np.sqrt(excess / moving))
    )


def _refined(compared: _Compared, delay: float, stretch: float, both: bool) -> tuple[float, float, _Array, _Array]:
    """Delay, stretch, their covariance and what is left, by damped Gauss-Newton steps from a start."""
    left, *slopes = compared.rows(delay, stretch)
    for _ in range(STEPS):
        jacobian = np.stack([one.ravel() for one in (slopes if both else slopes[:1])], axis=1)
        step = -np.linalg.pinv(jacobian) @ left.ravel()
        reach = max(abs(float(step[0])), abs(float(step[-1])) * float(compared.times[-1]) if both else 0.0)
        step = step * min(1.0, 1.0 / max(reach * compared.rate, 1e-12))
        size = min(reach * compared.rate, 1.0)
        while size > SETTLED:
            moved = delay + float(step[0]), stretch + (float(step[1]) if both else 0.0)
            trial = compared.rows(*moved)
            if trial[0].size and np.mean(trial[0] ** 2) < np.mean(left**2):
                delay, stretch, (left, *slopes) = *moved, trial
                break
            step, size = 0.5 * step, 0.5 * size
        if size <= SETTLED:
            break
    jacobian = np.stack([one.ravel() for one in (slopes if both else slopes[:1])], axis=1)
    # What is left sits where the motion changes fast, and neighbours are alike: blocks of samples count with their own.
    inverse = np.linalg.pinv(jacobian) * left.ravel()
    block = max(round(BLOCK * compared.rate), 1)
    parts = inverse.reshape(inverse.shape[0], *left.shape).sum(axis=1)
    parts = np.add.reduceat(parts, np.arange(0, parts.shape[-1], block), axis=-1)
    covariance = np.zeros((2, 2))
    covariance[: parts.shape[0], : parts.shape[0]] = parts @ parts.T
    return delay, stretch, covariance, left


def _above_noise(spectra: list[NDArray[np.complex128]], samples: tuple[int, int]) -> _Array:
    """For each frequency the part of the power that is no noise: derivatives by time would be of little else.

    Both have a noise of variance below 1 in each channel.
    """
    gains = []
    for spectrum, count in zip(spectra, samples, strict=True):
        power = np.sum(np.abs(spectrum) ** 2, axis=0) / (count * spectrum.shape[0])
        smooth = np.convolve(np.pad(power, SMOOTHED // 2, mode="edge"), np.full(SMOOTHED, 1.0 / SMOOTHED), "valid")
        gains.append(np.maximum(1.0 - 1.0 / np.maximum(smooth, 1e-12), 0.0))
    return np.asarray(np.minimum(*gains))


def _rested(values: _Array) -> _Array:
    """The level at the end taken off, and the level at the beginning made the same."""
    return np.asarray(values - values[:, -values.shape[-1] // 4 :].mean(axis=-1, keepdims=True))


def _resampled(series: TimeSeries, rate: float) -> _Array:
    if series.sample_rate == rate:
        return series.values
    times = np.arange(int((series.values.shape[-1] - 1) * rate / series.sample_rate) + 1) / rate
    own = np.arange(series.values.shape[-1]) / series.sample_rate
    return np.array([np.interp(times, own, row) for row in series.values])
