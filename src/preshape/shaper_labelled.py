"""Commands with labels, of pandas and xarray: their time index is the sample time, and goes on behind the command.

Neither package is imported: what comes is asked for what it has, and the answer is made of its own class.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError

__all__ = ["Labelled", "is_labelled", "labelled_shaped"]

EVEN = 1e-3
"""A time may be beside its place on an even grid by this part of the interval, or by the index's resolution."""

SECONDS = ("", "s", "sec", "second", "seconds")

Shaping = Callable[[Any, float, int], NDArray[np.float64]]
"""Values, sample time [s] and time axis to shaped values."""


class _Labelled(Protocol):
    @property
    def loc(self) -> Any:
        """Values by label: of a Series, a DataFrame, a DataArray."""


Labelled = TypeVar("Labelled", bound=_Labelled)


def is_labelled(command: object) -> bool:
    """Whether it is a Series or DataFrame of pandas, or a DataArray or Dataset of xarray."""
    return hasattr(command, "loc") and (hasattr(command, "iloc") or hasattr(command, "dims"))


def labelled_shaped(command: Any, shape: Shaping, dt: float | None, axis: int) -> Any:
    """A labelled command shaped: of its own class, its labels continued.

    Parameters
    ----------
    command : pandas.Series, pandas.DataFrame or xarray.DataArray
        A Series or DataFrame has the time along its rows; a DataArray along its dimension "time", or the one at `axis`
        if it has none of that name. Numbers with a point are seconds; a DatetimeIndex and a TimedeltaIndex say it
        themselves; an index that counts needs dt.
    shape : callable
        What shapes values.
    dt : float or None
        Sample time [s], where the index does not say it.
    axis : int
        Of a DataArray.

    Raises
    ------
    InputError
        If the index is not evenly spaced, says another dt, or cannot be continued.
    """
    if hasattr(command, "iloc"):
        return _table_shaped(command, shape, dt)
    if hasattr(command, "data_vars"):
        raise InputError("a Dataset is shaped array by array: dataset.map(lambda one: shaper.shape(one)).")
    return _array_shaped(command, shape, dt, axis)


def _table_shaped(command: Any, shape: Shaping, dt: float | None) -> Any:
    index = command.index
    values = (index if getattr(index, "tz", None) is None else index.tz_convert(None)).to_numpy()
    if getattr(index, "nlevels", 1) > 1:
        raise InputError("the index has several levels: unstack them, so that the rows are times.")
    step = _sample_time(values, dt, "index")
    shaped = shape(_numbers(command), step, 0)
    more = shaped.shape[0] - values.size
    index = index.append(index[-1:].repeat(more) + _steps(values, more, step)).rename(index.name)
    labels = {"columns": command.columns} if hasattr(command, "columns") else {"name": command.name}
    result = type(command)(shaped, index=index, **labels)
    result.attrs = dict(command.attrs)
    return result


def _array_shaped(command: Any, shape: Shaping, dt: float | None, axis: int) -> Any:
    if not command.dims:
        raise InputError("the array has no dimension: give one with the time along one of them.")
    along = command.dims.index("time") if axis == -1 and "time" in command.dims else axis
    try:
        dimension = command.dims[along]
    except IndexError:
        raise InputError(f"axis {axis} is none of the dimensions {', '.join(map(str, command.dims))}.") from None
    beside = [name for name, one in command.coords.items() if dimension in one.dims and name != dimension]
    if beside:
        raise InputError(f"the coordinate {beside[0]!r} along {dimension!r} cannot be continued: drop_vars it first.")
    kept = {name: one.variable for name, one in command.coords.items() if dimension not in one.dims}
    if dimension not in command.coords:
        step = _sample_time(np.arange(command.sizes[dimension]), dt, dimension)
        shaped = shape(_numbers(command), step, along)
    else:
        coordinate = command.coords[dimension]
        values = np.asarray(coordinate.values)
        unit = str(coordinate.attrs.get("units", "")).strip().lower()
        if unit not in SECONDS and values.dtype.kind == "f":
            raise InputError(f"the coordinate {dimension!r} is in {unit!r}: convert it to seconds.")
        step = _sample_time(values, dt, dimension)
        shaped = shape(_numbers(command), step, along)
        more = shaped.shape[along] - values.size
        longer = np.concatenate([values, values[-1:].repeat(more) + _steps(values, more, step)])
        kept[dimension] = (dimension, longer, dict(coordinate.attrs))
    return type(command)(shaped, dims=command.dims, coords=kept, name=command.name, attrs=dict(command.attrs))


def _numbers(command: Any) -> NDArray[np.float64]:
    try:
        return np.asarray(command.values, dtype=float)
    except (TypeError, ValueError):
        raise InputError("the command holds something that is no number: give the columns of the axes only.") from None


def _sample_time(values: NDArray[Any], dt: float | None, name: str) -> float:
    """The sample time [s] that an index says, or dt where it only counts."""
    kind = values.dtype.kind
    if kind not in "fiuMm":
        raise InputError(f"the {name} is no time: give seconds, dates or durations, or reset it and give dt.")
    if values.size == 0:
        raise InputError("the command has no samples: give some.")
    if kind in "iu" or values.size == 1:
        if dt is None:
            raise InputError(f"the {name} only counts: give dt, or times in seconds, dates or durations as {name}.")
        if values.size > 1 and (np.diff(values.astype(np.int64)) != values[1] - values[0]).any():
            raise InputError(f"the {name} does not count evenly: sort it, or reset it.")
        return dt
    resolution = 0.0
    if kind in "Mm":
        if np.isnat(values).any():
            raise InputError(f"the {name} holds a time that is none (NaT): drop those rows.")
        resolution = float(np.timedelta64(1, _unit(values)) / np.timedelta64(1, "ns")) * 1e-9
        times = np.asarray((values - values[0]) / np.timedelta64(1, "ns") * 1e-9, dtype=float)
    else:
        times = values.astype(float) - float(values[0])
    said = float(times[-1]) / (times.size - 1)
    away = np.abs(times - said * np.arange(times.size))
    if not (np.isfinite(times).all() and said > 0.0 and away.max() <= max(EVEN * said, resolution)):
        raise InputError(f"the {name} is not evenly spaced and increasing: resample it before shaping.")
    if dt is not None and abs(dt - said) > EVEN * said:
        raise InputError(f"the {name} says {said:g} s from sample to sample and dt {dt:g} s: leave dt out.")
    return said


def _steps(values: NDArray[Any], more: int, dt: float) -> NDArray[Any]:
    """What is added to the last label for those that come."""
    count = np.arange(1, more + 1)
    if values.dtype.kind in "Mm":
        unit = _unit(values)
        ticks = dt * 1e9 / float(np.timedelta64(1, unit) / np.timedelta64(1, "ns"))
        return np.asarray(np.rint(count * ticks).astype(np.int64).astype(f"timedelta64[{unit}]"))
    if values.dtype.kind == "f":
        return np.asarray(count * dt)
    return np.asarray(count * (int(values[1]) - int(values[0]) if values.size > 1 else 1))


def _unit(values: NDArray[Any]) -> Any:
    return np.datetime_data(values.dtype)[0]
