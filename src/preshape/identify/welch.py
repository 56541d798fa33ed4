"""The power spectral density of a time series, as Klipper takes it."""

from __future__ import annotations

import numpy as np

from preshape.errors import InputError
from preshape.identify import klipper_raw
from preshape.identify.measurement import Spectrum, TimeSeries

__all__ = ["KAISER_BETA", "is_sweep", "spectrum"]

KAISER_BETA = 6.0
"""Shape of the analysis window, Klipper's."""

WINDOW = 0.5
"""Klipper's shortest window [s]; the number of samples is the next power of two."""

SHORTEST_SWEEP = 20.0
"""Klipper's raw data of this length [s] and more are resonance tests (at most 2 Hz/s over some 130 Hz)."""

SHORTEST_WINDOW = 16
"""Samples; a shorter record has no spectrum worth the name."""


def is_sweep(time_series: TimeSeries) -> bool:
    """Whether a time series is Klipper's resonance test, and not a short recording by its ACCELEROMETER_MEASURE."""
    return time_series.format.startswith(klipper_raw.FORMAT) and time_series.duration >= SHORTEST_SWEEP


def spectrum(time_series: TimeSeries, *, window_duration: float = WINDOW) -> Spectrum:
    """Average the periodograms of half overlapping, mean-free Kaiser windows (Welch).

    With the default window the sum over the channels is Klipper's psd_xyz before its normalisation
    (klippy/extras/shaper_calibrate.py).

    Parameters
    ----------
    time_series : TimeSeries
        Vibration over time.
    window_duration : float
        Shortest window [s]; rounded up to a power of two samples, and down to what the record holds.

    Returns
    -------
    Spectrum
        One-sided density in the squared unit per hertz, shape (channel, frequency), from 0 to half the sample rate.

    Raises
    ------
    InputError
        If the window is not a duration or the record is shorter than 16 samples.

    References
    ----------
    P. D. Welch, The use of fast Fourier transform for the estimation of power spectra, IEEE Trans. Audio
    Electroacoust. 15 (1967) 70-73.

    Examples
    --------
    >>> import numpy as np
    >>> hum = np.sin(2 * np.pi * 50.0 * np.arange(4096) / 1024.0)
    >>> result = spectrum(TimeSeries(1024.0, 0.0, hum[None, :], ("x",)))
    >>> float(result.frequencies[result.total.argmax()])
    50.0
    """
    from scipy.signal import welch

    if not (np.isfinite(window_duration) and window_duration > 0.0):
        raise InputError(f"window_duration {window_duration!r} s is not usable: give a finite number above 0 s.")
    samples = time_series.values.shape[-1]
    if samples < SHORTEST_WINDOW:
        raise InputError(
            f"{samples} samples are too few for a spectrum: record at least {SHORTEST_WINDOW}, better a second or more."
        )
    wanted = max(time_series.sample_rate * window_duration, SHORTEST_WINDOW)
    length = 1 << int(np.ceil(np.log2(wanted)))
    if length > samples:
        length = 1 << int(np.log2(samples))
    # One channel at a time: all windows of all channels together take several times the memory of a long record.
    estimates = [
        welch(
            channel,
            fs=time_series.sample_rate,
            window=("kaiser", KAISER_BETA),
            nperseg=length,
            noverlap=length // 2,
            detrend="constant",
            scaling="density",
        )
        for channel in time_series.values
    ]
    return Spectrum(
        estimates[0][0],
        np.maximum([density for _, density in estimates], 0.0),
        time_series.channels,
        unit=f"({time_series.unit})^2/Hz" if time_series.unit else "",
        window_duration=length / time_series.sample_rate,
        excitation_exponent=2.0 if is_sweep(time_series) else 0.0,
        source=time_series.source,
        format=time_series.format,
        remarks=time_series.remarks,
    )
