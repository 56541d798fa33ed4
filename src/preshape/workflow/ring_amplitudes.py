"""How strongly known modes ring in a recording after the stop, and how well that is known.

The poles are given; amplitudes follow by linear least squares, each channel by itself, with a constant for gravity.
What the fit leaves is the noise: its spectrum, by an autoregressive model, gives the covariance of the amplitudes, so
that a fan or a motor near a mode counts for what it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Mode

__all__ = ["RingFit", "Tail", "amplitude_interval", "band_power", "fit_ringing"]

NOISE_ORDER = 8
SAMPLES_PER_COEFFICIENT = 16
"""Coefficients of the autoregressive model of the noise, at most, and samples that each needs."""

NORMAL_95 = 1.96
SURELY_LARGE = 400.0
"""Squared amplitude, in variances of the noise, from which on the amplitude is normally distributed."""

_Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Tail:
    """A recording from the stop on.

    Parameters
    ----------
    values : ndarray, shape (channel, sample)
        As measured.
    rate : float
        Samples per second [Hz].
    offset : float
        Time from the stop to the first sample [s], below one sample.
    floor : ndarray or None, shape (channel,)
        Standard deviation of each channel before the move; None where the recording does not show it.
    """

    values: _Array
    rate: float
    offset: float
    floor: _Array | None = None

    @property
    def times(self) -> _Array:
        """Times since the stop [s], shape (sample,)."""
        return self.offset + np.arange(self.values.shape[-1]) / self.rate


@dataclass(frozen=True, eq=False)
class RingFit:
    """Amplitudes of modes in one tail.

    Parameters
    ----------
    parts : ndarray, shape (mode, channel, 2)
        Cosine and sine part of each mode at the stop, in the unit of the values.
    covariances : ndarray, shape (mode, channel, 2, 2)
        Of `parts`.
    curve : ndarray, shape (channel, sample)
        The fitted motion, the constant taken off.
    centred : ndarray, shape (channel, sample)
        The measured motion, the fitted constant taken off.
    density : ndarray, shape (channel, frequency)
        Power of the noise on the grid of a transform of `length` samples; its mean is the variance.
    length : int
        Samples of that transform.
    """

    parts: _Array
    covariances: _Array
    curve: _Array
    centred: _Array
    density: _Array
    length: int


def fit_ringing(tail: Tail, modes: Sequence[Mode]) -> RingFit:
    """Amplitudes of `modes` in a tail, with their covariance under the noise that the fit leaves."""
    count, samples = len(modes), tail.values.shape[-1]
    basis = _basis(modes, tail.times)
    inverse = np.linalg.pinv(basis)
    found = inverse @ tail.values.T  # (2 * mode + 1, channel)
    curve = (basis[:, :-1] @ found[:-1]).T
    centred = tail.values - found[-1][:, None]
    left = centred - curve
    length = 4 * samples
    freedom = samples / max(samples - basis.shape[1], 1)
    density = np.array([_noise_density(row, length) for row in left]) * freedom
    if tail.floor is not None:  # never less than the sensor's own noise
        density *= np.maximum(tail.floor**2 / np.maximum(density.mean(axis=-1), np.finfo(float).tiny), 1.0)[:, None]
    spectra = np.fft.fft(inverse[: 2 * count], length, axis=-1).reshape(count, 2, length)
    covariances = np.einsum("kif,cf,kjf->kcij", spectra.conj(), density, spectra, optimize=True).real / length
    parts = found[:-1].reshape(count, 2, tail.values.shape[0]).transpose(0, 2, 1)
    return RingFit(parts, covariances, curve, centred, density, length)


def amplitude_interval(fits: Sequence[RingFit], mode: int) -> tuple[float, float, float]:
    """Amplitude of a mode at the stop over repeats (root mean square), and the ends of its 95 % interval.

    Over all channels, as the length of the vector. The squared length of a noisy vector is distributed as a noncentral
    chi square; noise alone gives length, too, which is taken off, and a lower end of 0 means that the mode cannot be
    told from noise. With three repeats and more the interval is also as wide as their spread says (Student's t).
    """
    from scipy.stats import t as student

    squares = np.array([float(np.sum(fit.parts[mode] ** 2)) for fit in fits])
    traces = np.array([float(np.trace(fit.covariances[mode], axis1=1, axis2=2).sum()) for fit in fits])
    along = sum(
        float(np.einsum("ci,cij,cj->", fit.parts[mode], fit.covariances[mode], fit.parts[mode])) for fit in fits
    )
    total, trace, number = float(squares.sum()), float(traces.sum()), len(fits)
    variance = max(along / max(total, np.finfo(float).tiny), np.finfo(float).tiny)
    low, high = _noncentrality(total / variance, trace / variance)
    low, high = np.sqrt(variance * low / number), np.sqrt(variance * high / number)
    middle = float(np.sqrt(max(total - trace, 0.0) / number))
    if number > 2:
        each = np.sqrt(np.maximum(squares - traces, 0.0))
        half = float(student.ppf(0.975, number - 1) * np.std(each, ddof=1) / np.sqrt(number))
        low, high = min(low, max(middle - half, 0.0)), max(high, middle + half)
    return middle, float(min(low, middle)), float(max(high, middle))


def band_power(fit: RingFit, tail: Tail, samples: int, below: float) -> tuple[_Array, _Array]:
    """Mean square of each channel below a frequency in the first samples, and its variance, each of shape (channel,).

    The samples are projected on the low bins of their own transform: no filter smears what was before the stop into it.
    The floor, where known, is taken off. The variance is that of a square of signal and Gaussian noise.
    """
    samples = min(samples, tail.values.shape[-1])
    frequencies = np.fft.fftfreq(samples, 1.0 / tail.rate)
    kept = np.abs(frequencies) <= below
    grid = np.abs(np.fft.fftfreq(fit.length, 1.0 / tail.rate)) <= below
    low = np.fft.ifft(np.where(kept, np.fft.fft(fit.centred[:, :samples], axis=-1), 0.0), axis=-1).real
    signal = np.fft.fft(np.fft.ifft(np.where(kept, np.fft.fft(fit.curve[:, :samples], axis=-1), 0.0), axis=-1).real,
                        fit.length, axis=-1)  # fmt: skip
    noise = fit.density * grid
    cross = np.sum(np.abs(signal) ** 2 * noise, axis=-1) / fit.length
    variance = (4.0 * cross + 2.0 * samples * np.mean(noise**2, axis=-1)) / samples**2
    floor = 0.0 if tail.floor is None else tail.floor**2 * float(np.mean(kept))
    return np.maximum(np.mean(low**2, axis=-1) - floor, 0.0), np.asarray(variance)


def _basis(modes: Sequence[Mode], times: _Array) -> _Array:
    """Columns exp(-z w t) cos, sin(w_d t) for each mode, then a constant, shape (sample, 2 * mode + 1)."""
    columns = []
    for mode in modes:
        wave = np.exp(mode.pole * times)
        columns += [wave.real, wave.imag]
    return np.stack([*columns, np.ones_like(times)], axis=1)


def _noise_density(left: _Array, length: int) -> _Array:
    """Power of noise over the frequencies of a transform, by the Yule-Walker equations; its mean is the variance."""
    from scipy.linalg import solve_toeplitz

    samples = left.size
    lags = min(NOISE_ORDER, samples // SAMPLES_PER_COEFFICIENT)
    covariance = np.array([float(left[: samples - k] @ left[k:]) / samples for k in range(lags + 1)])
    if covariance[0] <= 0.0 or lags < 1:
        return np.full(length, max(covariance[0], 0.0))
    covariance[0] *= 1.0 + 1e-9  # a pure sinusoid would make the equations singular
    factors = solve_toeplitz(covariance[:-1], covariance[1:])
    response = np.abs(np.fft.fft(np.concatenate([[1.0], -factors]), length)) ** 2
    density = 1.0 / np.maximum(response, 1e-12)
    return np.asarray(covariance[0] * density / density.mean())


def _noncentrality(value: float, freedoms: float) -> tuple[float, float]:
    """95 % interval of the noncentrality of a chi square that came out as `value`."""
    from scipy.optimize import brentq
    from scipy.stats import ncx2

    if value - freedoms > SURELY_LARGE:
        root = np.sqrt(value - freedoms)
        return float((root - NORMAL_95) ** 2), float((root + NORMAL_95) ** 2)
    end = value + 10.0 * np.sqrt(value + 1.0) + 40.0

    def solved(level: float) -> float:
        if ncx2.cdf(value, freedoms, 1e-12) < level:
            return 0.0
        return float(brentq(lambda x: ncx2.cdf(value, freedoms, x) - level, 1e-12, end))

    return solved(0.975), solved(0.025)
