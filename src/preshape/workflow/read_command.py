"""A command for a plant from a file: one column an input, on the simulation's step."""

from __future__ import annotations

import os
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from preshape import identify
from preshape.checks import positive
from preshape.errors import InputError

__all__ = ["read_command"]

WHOLE = 1e-6
"""How far, relative, the file's interval may be from a whole number of steps."""


def read_command(
    path: str | os.PathLike[str],
    inputs: Mapping[str, str],
    *,
    dt: float | None = None,
    sample_rate: float | None = None,
) -> tuple[NDArray[np.float64], float]:
    """The command in a file, held from row to row.

    Parameters
    ----------
    path : path
        CSV with a time column [s] and one column for each input, or without time and with a `sample_rate` [Hz]. Columns
        that are named as the inputs may stand in any order; otherwise they are taken in order.
    inputs : mapping of str to str
        Units of the plant's inputs, by name.
    dt : float, optional
        Step of the simulation [s]: the file's interval or a whole part of it; the file's unless given.
    sample_rate : float, optional
        Rows per second [Hz], for a table without a time column.

    Returns
    -------
    command : ndarray, shape (input, sample)
    dt : float
        From sample to sample [s].

    Raises
    ------
    InputError
        If the file cannot be read, has another number of columns, or another interval than fits `dt`.
    """
    series = identify.read(path, sample_rate=sample_rate)
    if not isinstance(series, identify.TimeSeries):
        raise InputError(f"{path} holds a spectrum, not a command over time: give a CSV with a time column.")
    if series.values.shape[0] != len(inputs):
        raise InputError(
            f"{path} has {series.values.shape[0]} column(s) besides the time, and the plant {len(inputs)} input(s): "
            f"give one for each of {', '.join(inputs)}."
        )
    names = list(series.channels)
    order = [names.index(name) for name in inputs] if set(names) == set(inputs) else list(range(len(names)))
    values, step = series.values[order], 1.0 / series.sample_rate
    if dt is None:
        return values, step
    times = step / positive("dt", dt, "s")
    repeat = round(times)
    if repeat < 1 or abs(times - repeat) > WHOLE * times:
        raise InputError(
            f"the command in {path} has a sample every {step:g} s, which the simulation's step of {dt:g} s does not "
            f"fit: give {step:g} s, or a whole part of it, as dt."
        )
    return np.repeat(values, repeat, axis=1), dt
