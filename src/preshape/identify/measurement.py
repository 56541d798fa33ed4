"""What a measurement file holds: a time series or a spectrum."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError

__all__ = ["Measurement", "PrintedSpectrum", "Spectrum", "TimeSeries"]


LARGEST_VALUE = 1e100
"""Larger magnitudes are no measurement, and their squares would overflow."""


@dataclass(frozen=True, eq=False, slots=True)
class TimeSeries:
    """Vibration over time, uniformly sampled.

    Parameters
    ----------
    sample_rate : float
        Samples per second [Hz].
    start : float
        Time of the first sample [s].
    values : ndarray, shape (channel, sample)
        Measured values, in `unit`.
    channels : tuple of str
        A name for each channel.
    unit : str
        Unit of the values; empty when the file does not say.
    source : str
        The file they come from; empty for a simulation.
    format : str
        The format of that file.
    remarks : tuple of str
        What the reader noticed and the user should know (lost samples, say), as sentences.

    Raises
    ------
    InputError
        If the array is not two-dimensional, holds NaN or infinity, or does not match the channels.

    Examples
    --------
    >>> import numpy as np
    >>> series = TimeSeries(1000.0, 0.0, np.zeros((1, 3)), ("x",))
    >>> series.times
    array([0.   , 0.001, 0.002])
    """

    sample_rate: float
    start: float
    values: NDArray[np.float64]
    channels: tuple[str, ...]
    unit: str = ""
    source: str = ""
    format: str = "array"
    remarks: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if not (np.isfinite(self.sample_rate) and self.sample_rate > 0.0):
            raise InputError(f"sample rate {self.sample_rate!r} Hz is not usable: give a finite rate above 0 Hz.")
        if not np.isfinite(self.start):
            raise InputError(f"start {self.start!r} s is not a time: give a finite number of seconds.")
        object.__setattr__(self, "values", _checked(self.values, self.channels, "values", "sample"))

    @property
    def times(self) -> NDArray[np.float64]:
        """Time of each sample [s], shape (sample,)."""
        return self.start + np.arange(self.values.shape[-1]) / self.sample_rate

    @property
    def duration(self) -> float:
        """Time that the samples cover, one period each [s]."""
        return float(self.values.shape[-1] / self.sample_rate)


@dataclass(frozen=True, eq=False, slots=True)
class PrintedSpectrum:
    """The very numbers of a spectrum file, on which Klipper's scores are computed.

    Parameters
    ----------
    frequencies : ndarray, shape (frequency,)
        As printed, so rounded [Hz].
    power : ndarray, shape (dataset, frequency)
        As printed: the sum over the axes (`psd_xyz`), or one row a dataset.
    """

    frequencies: NDArray[np.float64]
    power: NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class Spectrum:
    """Power spectral density of vibration, one-sided.

    Parameters
    ----------
    frequencies : ndarray, shape (frequency,)
        Increasing frequencies [Hz].
    density : ndarray, shape (channel, frequency)
        Power spectral density, in `unit`.
    channels : tuple of str
        A name for each channel.
    unit : str
        Unit of the density.
    normalised : bool
        True when Klipper's division by the frequency has been applied already.
    window_duration : float
        Length of the Kaiser (beta = 6) analysis window behind the estimate [s]: its width limits what can be resolved.
    excitation_exponent : float
        Power p of the frequency in the density of the excitation, f**p: 2 for a sweep at one rate whose acceleration
        grows with the frequency (Klipper's), 1 after Klipper's normalisation, 0 where nothing is known.
    source, format : str
        The file they come from and its format.
    remarks : tuple of str
        What the reader noticed and the user should know, as sentences.
    printed : PrintedSpectrum or None
        What the file says, where that was rounded or is summed otherwise.

    Raises
    ------
    InputError
        If frequencies do not increase, or the density holds NaN, infinity, or values below zero.
    """

    frequencies: NDArray[np.float64]
    density: NDArray[np.float64]
    channels: tuple[str, ...]
    unit: str = ""
    normalised: bool = False
    window_duration: float = 0.64
    excitation_exponent: float = 0.0
    source: str = ""
    format: str = "array"
    remarks: tuple[str, ...] = ()
    printed: PrintedSpectrum | None = None

    def __post_init__(self) -> None:
        density = _checked(self.density, self.channels, "density", "frequency")
        frequencies = np.array(self.frequencies, dtype=np.float64)
        if frequencies.shape != density.shape[-1:] or not np.all(np.diff(frequencies) > 0.0):
            raise InputError(
                f"frequencies of shape {frequencies.shape} do not fit a density of shape {density.shape}: "
                "give one increasing frequency [Hz] for each column."
            )
        if np.any(density < 0.0):
            raise InputError("a power spectral density below zero was given: it must be zero or more everywhere.")
        frequencies.flags.writeable = False
        object.__setattr__(self, "frequencies", frequencies)
        object.__setattr__(self, "density", density)

    @property
    def total(self) -> NDArray[np.float64]:
        """Density summed over the channels (Klipper's psd_xyz), shape (frequency,)."""
        return np.asarray(self.density.sum(axis=0))


Measurement: TypeAlias = TimeSeries | Spectrum
"""What :func:`preshape.identify.read` returns and :func:`preshape.identify.find_modes` takes."""


def _checked(array: NDArray[np.float64], channels: tuple[str, ...], name: str, axis: str) -> NDArray[np.float64]:
    """A read-only copy of `array`, shape (channel, axis), or a sentence why not; what cannot change is not copied."""
    checked = array if _is_constant(array) else np.array(array, dtype=np.float64)
    if checked.ndim != 2 or checked.shape[0] != len(channels) or checked.size == 0:
        raise InputError(
            f"{name} of shape {checked.shape} do not fit {len(channels)} channel names: "
            f"give an array (channel, {axis})."
        )
    lowest, highest = float(checked.min()), float(checked.max())  # NaN when any number is
    if not (np.isfinite(lowest) and np.isfinite(highest)):
        raise InputError(f"{name} hold NaN or infinity: give finite numbers only.")
    if max(-lowest, highest) > LARGEST_VALUE:
        raise InputError(f"{name} hold numbers above {LARGEST_VALUE:g}, which no sensor gives: check the unit.")
    checked.flags.writeable = False
    return checked


def _is_constant(array: object) -> bool:
    """Whether it is an array of float64 that nobody can write to, not through what it is a view of either."""
    if not isinstance(array, np.ndarray) or array.dtype != np.float64:
        return False
    part: object = array
    while isinstance(part, np.ndarray):
        if part.flags.writeable:
            return False
        part = part.base
    return part is None
