"""Arrays with names, as NumPy's and MATLAB's files hold them: which is the time, which the rate, which the record."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.errors import MeasurementError
from preshape.identify.measurement import TimeSeries
from preshape.identify.source_file import MOST_NUMBERS
from preshape.identify.text import check_increasing, check_rate
from preshape.identify.time_column import uniform
from preshape.identify.wanted import Wanted, pick_part

__all__ = ["series_of"]

MINIMUM_ROWS = 2
MOST_CHANNELS = 64
_TIME = re.compile(r"(?:time|t|times|timestamps?|seconds)$", re.IGNORECASE)
_RATE = re.compile(r"(?:sample_?rate|sampling_?rate|sampling_?frequency|fs|rate)$", re.IGNORECASE)
_INTERVAL = re.compile(r"(?:dt|ts|sample_?time|interval)$", re.IGNORECASE)
_Array = NDArray[np.float64]


def series_of(arrays: Mapping[str, NDArray[Any]], source: str, wanted: Wanted, name: str) -> TimeSeries:
    """The time series in a set of arrays.

    Parameters
    ----------
    arrays : mapping of str to ndarray
        One number named `fs`, `sample_rate` ... is the rate [Hz], one named `dt` the interval [s]; a vector named `t`,
        `time` ... is the time [s]; everything else is the record. Of a matrix the axis that is as long as the time, or
        the longer one, is time. Without time or rate the first row of a matrix is the time.
    source : str
        File name, for messages.
    wanted : Wanted
        A rate, and the name of the record where there are several.
    name : str
        The format.

    Raises
    ------
    MeasurementError
        If there is no record or no rate, or more than one record.
    """
    part = wanted.part
    if part is not None:  # what else is in the file may be of any kind
        names = [key for key in arrays if not _is_clock(key)]
        part = names[pick_part(names, part, source)]
        arrays = {key: value for key, value in arrays.items() if key == part or _is_clock(key)}
    numbers = {key: _real(value, key, source) for key, value in arrays.items() if value.size > 0}
    single = {key: float(value.flat[0]) for key, value in numbers.items() if value.size == 1}
    rate = wanted.sample_rate
    for key, value in single.items():
        found = value if _RATE.match(key) else 1.0 / value if _INTERVAL.match(key) and value > 0.0 else None
        if found is not None:
            if not (np.isfinite(found) and found > 0.0):
                raise MeasurementError(f"{source}: {key!r} is {value!r}, which is no sample rate; correct it.")
            check_rate(rate, found, source)  # also one name against another: fs against dt
            rate = found
    vectors = {key: value for key, value in numbers.items() if value.size > 1}
    clock = next((key for key, value in vectors.items() if _TIME.match(key) and value.ndim == 1), None)
    times = vectors.pop(clock) if clock is not None else None
    values, channels = _record(vectors, times, part, source)
    if times is None and rate is None:
        if len(values) < 2:
            raise MeasurementError(
                f"{source}: there is no time vector ('t') and no sample rate ('fs'); give sample_rate [Hz]."
            )
        times, values, channels = values[0], values[1:], channels[1:]
    if values.shape[-1] < MINIMUM_ROWS:
        raise MeasurementError(f"{source}: the record has {values.shape[-1]} samples; a measurement needs many.")
    start = 0.0
    if times is not None:
        check_increasing(times, "time", None, source)
        found, values = uniform(times, values, None, source)
        check_rate(rate, found, source)
        rate, start = found, float(times[0])
    assert rate is not None
    return TimeSeries(rate, start, values, channels, "", source, name)


def _is_clock(key: str) -> bool:
    """Whether an array may be the time or the rate."""
    return any(pattern.match(key) for pattern in (_TIME, _RATE, _INTERVAL))


def _real(array: NDArray[Any], name: str, source: str) -> _Array:
    """A numeric array as float64 without axes of length one, checked."""
    squeezed = np.squeeze(array)
    if squeezed.ndim > 2:
        raise MeasurementError(f"{source}: {_short(name)} has {squeezed.ndim} axes; a record has one or two.")
    if squeezed.size > MOST_NUMBERS:
        raise MeasurementError(
            f"{source}: {_short(name)} holds {squeezed.size / 1e6:.0f} million numbers and at most "
            f"{MOST_NUMBERS / 1e6:.0f} are taken; cut the part that holds the vibration."
        )
    number = squeezed.astype(np.float64)
    if not (np.isfinite(number.min()) and np.isfinite(number.max())):
        raise MeasurementError(f"{source}: {_short(name)} holds NaN or infinity; a record has finite numbers only.")
    return number


def _record(
    vectors: Mapping[str, _Array], times: _Array | None, part: str | None, source: str
) -> tuple[_Array, tuple[str, ...]]:
    """Values (channel, sample) and channel names of the record that is wanted."""
    lengths = {value.shape for value in vectors.values()}
    if part is None and len(vectors) > 1 and len(lengths) == 1 and len(next(iter(lengths))) == 1:
        return np.array(list(vectors.values())), tuple(vectors)
    names = list(vectors)
    name = names[pick_part(names, part, source)]
    array = vectors[name]
    if array.ndim == 1:
        values = array[None, :]
    else:
        length = max(array.shape) if times is None else len(times)
        if array.shape[0] == array.shape[1] or length not in array.shape:
            raise MeasurementError(
                f"{source}: which axis of {_short(name)}, shape {array.shape}, is time cannot be told; "
                "add a time vector as long as that axis."
            )
        values = array.T if array.shape[0] == length else array
    if times is not None and values.shape[-1] != len(times):
        raise MeasurementError(
            f"{source}: {_short(name)} has {values.shape[-1]} samples and the time has {len(times)}; "
            "give as many of one as of the other."
        )
    if len(values) > MOST_CHANNELS:
        raise MeasurementError(
            f"{source}: {_short(name)} has {len(values)} channels and at most {MOST_CHANNELS} are taken; pick some."
        )
    return values, tuple([name] if len(values) == 1 else [f"{name} {i + 1}" for i in range(len(values))])


def _short(name: str) -> str:
    return repr(name if len(name) <= MOST_CHANNELS else name[:MOST_CHANNELS] + "...")
