"""Klipper's spectrum: from raw acceleration samples to power over frequency."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError, MeasurementError

__all__ = ["AccelerationSpectrum", "normalise_to_frequencies", "power_spectral_density"]

WINDOW_SECONDS = 0.5
"""A window holds at least this time [s], rounded up to a power of two of samples."""

KAISER_BETA = 6.0
"""Shape of the Kaiser window [-]."""

LOW_FREQUENCY = 10.0
"""Below this frequency [Hz] the normalised power is faded out: twice the 5 Hz at which Klipper's sweep begins."""

OFFSET = 0.1
"""Added to the frequency [Hz] so that the division at 0 Hz is finite."""


@dataclass(frozen=True, eq=False)
class AccelerationSpectrum:
    """Power spectral density of acceleration, as Klipper computes and writes it.

    Parameters
    ----------
    frequencies : ndarray, shape (frequency,)
        [Hz]
    psd : ndarray, shape (axis, frequency)
        One-sided density of each axis, acceleration^2 / Hz.
    """

    frequencies: NDArray[np.float64]
    psd: NDArray[np.float64]

    @property
    def total(self) -> NDArray[np.float64]:
        """Sum over the axes, shape (frequency,): the column `psd_xyz`."""
        total: NDArray[np.float64] = self.psd.sum(axis=0)
        return total


def power_spectral_density(times: ArrayLike, acceleration: ArrayLike) -> AccelerationSpectrum:
    """Klipper's power spectral density of a recorded acceleration.

    Welch's method: Kaiser windows overlapping by half, the mean of each removed. Klipper takes the sample rate as
    N / (last time - first time) where N - 1 would be exact, so for the evenly sampled record its frequencies are
    N / (N - 1) times Welch's and its densities (N - 1) / N times.

    Parameters
    ----------
    times : array_like, shape (time,)
        [s], increasing.
    acceleration : array_like, shape (axis, time) or (time,)
        Any unit; Klipper's is mm/s^2.

    Returns
    -------
    AccelerationSpectrum

    Raises
    ------
    MeasurementError
        If the record is not longer than one window (half a second, rounded up to a power of two of samples).
    InputError
        If the shapes do not fit, values are not finite, or the times do not increase.

    References
    ----------
    ECOSYSTEM 1.6, points 1 to 3.

    Examples
    --------
    >>> t = np.arange(800) / 400.0
    >>> spectrum = power_spectral_density(t, np.sin(2 * np.pi * 50.0 * t))
    >>> float(spectrum.frequencies[spectrum.total.argmax()].round())
    50.0
    """
    t, a = _record(times, acceleration)
    rate = t.size / float(t[-1] - t[0])
    samples = max(int(rate * WINDOW_SECONDS), 1)
    window_size = 2 ** math.ceil(math.log2(samples))
    if t.size <= window_size:
        raise MeasurementError(
            f"the record has {t.size} samples, and one window alone takes {window_size} at {rate:.0f} samples/s: "
            "measure for longer."
        )
    from scipy.signal import welch

    # welch takes an array of weights, which its type stubs do not say; by name it would make another Kaiser window.
    window: Any = np.kaiser(window_size, KAISER_BETA)
    frequencies, psd = welch(
        a,
        fs=rate,
        window=window,
        noverlap=window_size // 2,
        detrend="constant",
        scaling="density",
    )
    return AccelerationSpectrum(np.asarray(frequencies, dtype=float), np.asarray(psd, dtype=float))


def normalise_to_frequencies(frequencies: ArrayLike, psd: ArrayLike) -> NDArray[np.float64]:
    """Klipper's normalisation, which its scores expect: power over frequency, faded out below 10 Hz.

    The excitation's acceleration grows with frequency; dividing by it makes the spectrum comparable over frequency.

    Parameters
    ----------
    frequencies : array_like, shape (frequency,)
        [Hz], 0 or more.
    psd : array_like, shape (..., frequency)
        Not yet normalised: a `resonances` file's columns are not, a `calibration_data` file's are.

    Returns
    -------
    ndarray, shape (..., frequency)

    Raises
    ------
    InputError
        If the shapes do not fit, or a frequency is negative or not finite.

    References
    ----------
    ECOSYSTEM 1.6, point 4.

    Examples
    --------
    >>> normalise_to_frequencies([19.9, 39.9], [200.0, 200.0]).tolist()
    [10.0, 5.0]
    """
    f, p = np.asarray(frequencies, dtype=float), np.asarray(psd, dtype=float)
    if f.ndim != 1 or p.ndim == 0 or p.shape[-1] != f.size:
        raise InputError(
            f"frequencies of shape {f.shape} and psd of shape {p.shape}: the psd's last axis must be the frequencies'."
        )
    if not (np.isfinite(f).all() and (f >= 0.0).all()):
        raise InputError("a frequency is negative, NaN or infinite: give frequencies in hertz, 0 or more.")
    fade = np.where(f < LOW_FREQUENCY, np.exp(1.0 - (LOW_FREQUENCY / (f + OFFSET)) ** 2), 1.0)
    normalised: NDArray[np.float64] = p / (f + OFFSET) * fade
    return normalised


def _record(times: ArrayLike, acceleration: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times (time,) and acceleration (axis, time), checked."""
    t, a = np.asarray(times, dtype=float), np.atleast_2d(np.asarray(acceleration, dtype=float))
    if t.ndim != 1 or t.size < 2 or a.ndim != 2 or a.shape[-1] != t.size:
        raise InputError(
            f"times of shape {t.shape} and acceleration of shape {a.shape}: give at least two times, and as many "
            "samples of each axis along the last axis of the acceleration."
        )
    if not (np.isfinite(t).all() and np.isfinite(a).all()):
        raise InputError("the record holds NaN or infinity: drop those samples.")
    if (np.diff(t) <= 0.0).any():
        raise InputError("the record's times do not increase: sort the samples, and drop repeated ones.")
    return t, a
