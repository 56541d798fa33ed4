"""Modes from a record with its input beside the outputs: the impulse response, and the modes that ring in it.

The impulse response is the least-squares filter from the input to each output. In frequency it is the H1 estimate,
cross over auto spectrum, but without a window: nothing leaks, so damping is not spread. A little of the input's power
is added at all frequencies, so that nothing is made of those where the input had none.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError, MeasurementError
from preshape.identify.decay_modes import ring_down
from preshape.identify.identification import KNOWN_INPUT, Identification
from preshape.identify.measurement import TimeSeries
from preshape.identify.text import printable

__all__ = ["modes_of_known_input"]

MOST_LAGS = 4000
"""Samples of the impulse response."""

RECORD_OVER_RESPONSE = 8
"""The record is at least so many times longer."""

RIDGE = 3e-3
"""Power that is added to the input's at all frequencies, over its mean."""

LEAST_EXPLAINED = 0.5
"""Part of the outputs' power that the input must explain for the modes to be trusted."""

_Array = NDArray[np.float64]


def modes_of_known_input(series: TimeSeries, name: str, damping: float | None, maximum: int) -> Identification:
    """Fit modes to the response to a channel of the record.

    Parameters
    ----------
    series : TimeSeries
        Input and outputs.
    name : str
        Of the channel that holds the input: a force, a command, the acceleration of the base.
    damping : float, optional
        Fixes all damping ratios.
    maximum : int
        Largest number of modes.

    Raises
    ------
    InputError
        If there is no such channel, or no other.
    MeasurementError
        If the input is constant.

    References
    ----------
    L. Ljung, System Identification, 2nd ed. (1999), sections 4.2 (finite impulse responses) and 7.3 (least squares).
    """
    if series.channels.count(name) != 1 or len(series.channels) < 2:
        listed = ", ".join(printable(channel[:40]) for channel in series.channels[:12])
        raise InputError(f"the input {name!r} is not one of several channels: there are {listed}; name one of those.")
    at = series.channels.index(name)
    outputs = np.delete(series.values, at, axis=0)
    given = series.values[at]
    if not np.ptp(given) > 0.0:
        raise MeasurementError(
            f"{series.source or 'the record'}: the input {name!r} is constant; name another channel."
        )
    response, explained = _impulse_response(given, outputs)
    others = tuple(channel for channel in series.channels if channel != name)
    # The first sample is what goes through directly, as in an acceleration: no mode is in it alone.
    found = ring_down(
        TimeSeries(series.sample_rate, 0.0, response[:, 1:], others, source=series.source, remarks=series.remarks),
        damping=damping,
        maximum=maximum,
    )
    if explained >= LEAST_EXPLAINED:
        return replace(found, method=KNOWN_INPUT)
    note = (
        f"the input {name!r} explains only {100.0 * explained:.0f} % of the outputs: noise, a machine that is not "
        "linear, or not what drives it."
    )
    return replace(found, method=KNOWN_INPUT, trouble=(*found.trouble, note), clear=False)


def _impulse_response(given: _Array, outputs: _Array) -> tuple[_Array, float]:
    """The filters that make the outputs from the input, shape (output, lag), and the part of power they explain."""
    from scipy.linalg import solve_toeplitz

    samples = given.size
    lags = min(MOST_LAGS, samples // RECORD_OVER_RESPONSE)
    length = 1 << (2 * samples - 1).bit_length()
    driven = np.fft.rfft(given - given.mean(), length)
    results = np.fft.rfft(outputs - outputs.mean(axis=-1, keepdims=True), length, axis=-1)
    own = np.fft.irfft(np.abs(driven) ** 2)[:lags]
    crossed = np.fft.irfft(results * np.conj(driven), axis=-1)[:, :lags]
    own[0] *= 1.0 + RIDGE
    response = np.asarray(solve_toeplitz(own, crossed.T).T, dtype=np.float64)
    power = np.sum((outputs - outputs.mean(axis=-1, keepdims=True)) ** 2)
    return response, float(np.sum(response * crossed) / max(power, np.finfo(float).tiny))
