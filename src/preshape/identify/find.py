"""Modes from any measurement."""

from __future__ import annotations

from dataclasses import replace

from preshape.errors import MeasurementError
from preshape.identify.decay_modes import FEWEST_SAMPLES, check_wishes, ring_down
from preshape.identify.identification import Identification
from preshape.identify.measurement import Measurement, TimeSeries
from preshape.identify.spectrum_modes import modes_of_spectrum
from preshape.identify.welch import is_sweep, spectrum

__all__ = ["find_modes"]


def find_modes(measurement: Measurement, *, damping: float | None = None, maximum: int = 4) -> Identification:
    """Find the modes in a measurement.

    Klipper's sweeps, raw or as spectra, get a fit of the spectrum that knows the excitation and the analysis window.
    Other time series are taken as ring-downs; where none is found, their spectrum is fitted, and `trouble` says so.

    Parameters
    ----------
    measurement : TimeSeries or Spectrum
        From :func:`preshape.identify.read`, or made by hand.
    damping : float, optional
        Fixes all damping ratios instead of fitting them.
    maximum : int
        Largest number of modes.

    Returns
    -------
    Identification
        Modes with intervals, the strongest first, and what is wrong with the measurement.

    Raises
    ------
    MeasurementError
        If the measurement is too short, or constant.
    InputError
        If `damping` or `maximum` make no sense.

    Notes
    -----
    On simulated Klipper sweeps one mode comes out within 0.1 % in frequency and 3 % in damping for damping ratios
    from 0.005 to 0.15. In spectra, two modes closer than the window's width (about 3 Hz), and modes below 10 Hz or
    above the end of the sweep, are not resolved.

    Examples
    --------
    >>> import numpy as np
    >>> times = np.arange(1000) / 1000.0
    >>> decay = np.exp(-8.0 * times) * np.sin(2 * np.pi * 30.0 * times)
    >>> found = find_modes(TimeSeries(1000.0, 0.0, decay[None, :], ("x",)))
    >>> found.method, round(found.modes[0].mode.pole.real, 3)
    ('ring-down', -8.0)
    """
    check_wishes(damping, maximum)
    if not isinstance(measurement, TimeSeries):
        return modes_of_spectrum(measurement, damping, maximum)
    if measurement.values.shape[-1] < FEWEST_SAMPLES:
        name = measurement.source or "the time series"
        raise MeasurementError(
            f"{name}: {measurement.values.shape[-1]} samples are too few to find modes; "
            f"record at least {FEWEST_SAMPLES}."
        )
    if is_sweep(measurement):
        return modes_of_spectrum(spectrum(measurement), damping, maximum)
    decay = ring_down(measurement, damping=damping, maximum=maximum)
    if decay.modes:
        return decay
    fallback = modes_of_spectrum(spectrum(measurement), damping, maximum)
    reasons = tuple(sentence for sentence in decay.trouble if sentence not in measurement.remarks)
    note = "the modes come from the spectrum of the whole record, whose damping ratios are rough."
    return replace(fallback, trouble=(*fallback.trouble, *reasons, note))
