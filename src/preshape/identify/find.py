"""Modes from any measurement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from preshape.errors import InputError, MeasurementError
from preshape.identify.decay_modes import FEWEST_SAMPLES, check_wishes, ring_down
from preshape.identify.identification import Identification
from preshape.identify.joint import jointly
from preshape.identify.klipper_sweep import Sweep
from preshape.identify.known_input import modes_of_known_input
from preshape.identify.measurement import Measurement, TimeSeries
from preshape.identify.operational_modes import is_stationary, operational_modes
from preshape.identify.response_modes import modes_of_sweep
from preshape.identify.spectrum_modes import modes_of_spectrum
from preshape.identify.welch import is_sweep, spectrum

__all__ = ["find_modes"]


def find_modes(
    measurement: Measurement | Sequence[Measurement],
    *,
    damping: float | None = None,
    maximum: int = 4,
    excitation: Sweep | str | None = None,
) -> Identification:
    """Find the modes in a measurement, or in several of one machine.

    What runs depends on what the measurement is: the response to the commanded acceleration for raw data of Klipper's
    sweeps, a fit of the spectrum that knows excitation and window where only a spectrum is there, decaying sinusoids
    for what rings down, and covariances of all channels for a machine that is shaken all the time by what nobody
    measured. Where the first choice finds nothing, the spectrum of the whole record is fitted, and `trouble` says so.

    Parameters
    ----------
    measurement : TimeSeries or Spectrum, or a sequence of them
        From :func:`preshape.identify.read`, or made by hand. Several (positions, payloads, repeats) are one machine:
        modes within 5 % of each other are one, and its interval covers those of all.
    damping : float, optional
        Fixes all damping ratios instead of fitting them.
    maximum : int
        Largest number of modes.
    excitation : Sweep or str, optional
        The sweep that was commanded; found in Klipper's raw data unless given. Or the name of the channel that holds
        the input (a force, a command), whatever it was: noise, a sweep, a move.

    Returns
    -------
    Identification
        Modes with intervals, the strongest first, and what is wrong with the measurement.

    Raises
    ------
    MeasurementError
        If the measurement is too short, or constant.
    InputError
        If `damping` or `maximum` make no sense, there is no measurement, the input is not one of its channels, or
        an excitation is named for a spectrum.

    Notes
    -----
    On simulated Klipper sweeps, frequencies from 40 to 120 Hz come out within 0.1 % and damping ratios from 0.005 to
    0.15 within 1 %, two modes 1.5 Hz apart too. From a spectrum alone, one mode comes out as well, but two modes closer
    than the window's width (about 3 Hz) do not. Modes below 10 Hz or above the end of the sweep are not found.

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
    if isinstance(measurement, Sequence):
        if not measurement:
            raise InputError("no measurement was given: give at least one.")
        return jointly([_found(each, damping, maximum, excitation) for each in measurement], maximum)
    return _found(measurement, damping, maximum, excitation)


def _found(
    measurement: Measurement, damping: float | None, maximum: int, excitation: Sweep | str | None
) -> Identification:
    if not isinstance(measurement, TimeSeries):
        if excitation is not None:
            raise InputError(
                "an excitation was named for a spectrum, which has no time: give the raw data, or no excitation."
            )
        return modes_of_spectrum(measurement, damping, maximum)
    if measurement.values.shape[-1] < FEWEST_SAMPLES:
        name = measurement.source or "the time series"
        raise MeasurementError(
            f"{name}: {measurement.values.shape[-1]} samples are too few to find modes; "
            f"record at least {FEWEST_SAMPLES}."
        )
    if isinstance(excitation, str):
        return modes_of_known_input(measurement, excitation, damping, maximum)
    if excitation is not None or is_sweep(measurement):
        return modes_of_sweep(measurement, excitation, damping, maximum)
    first = operational_modes(measurement, damping=damping, maximum=maximum) if is_stationary(measurement) else None
    if first is None or first.stabilisation is None:  # it dies away, or is too short for anything else
        first = ring_down(measurement, damping=damping, maximum=maximum)
    if first.modes:
        return first
    fallback = modes_of_spectrum(spectrum(measurement), damping, maximum)
    reasons = tuple(sentence for sentence in first.trouble if sentence not in measurement.remarks)
    note = "the modes come from the spectrum of the whole record, whose damping ratios are rough."
    return replace(fallback, trouble=(*fallback.trouble, *reasons, note), clear=False)
