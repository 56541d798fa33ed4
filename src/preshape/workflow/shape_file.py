"""Shaping a command that lies in a file."""

from __future__ import annotations

import csv
import io
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from preshape import identify
from preshape.errors import InputError
from preshape.files import write_atomically
from preshape.shaper import Shaper

__all__ = ["ShapedFile", "shape_file"]


@dataclass(frozen=True)
class ShapedFile:
    """What was written.

    Parameters
    ----------
    path : Path
        The file.
    channels : tuple of str
        Its columns after the time.
    dt : float
        Sample time [s].
    samples_before, samples_after : int
        Length of the command and of the shaped command.
    """

    path: Path
    channels: tuple[str, ...]
    dt: float
    samples_before: int
    samples_after: int


def shape_file(
    shaper: Shaper,
    command: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    sample_rate: float | None = None,
) -> ShapedFile:
    """Shape every column of a command file and write the result, longer by the shaper's duration.

    The machine is taken to rest at the first row's values before the command begins, and at the last row's afterwards.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    command : path
        CSV with a time column [s] and one column an axis, or columns only and a `sample_rate` [Hz].
    out : path
        CSV to write: time [s] and the same columns.

    Raises
    ------
    InputError
        If the command cannot be read as a time series, or `out` cannot be written.
    """
    if Path(out).exists() and Path(command).exists() and Path(out).samefile(command):
        raise InputError(f"{out} is the command itself: choose another name with --out, so that nothing is lost.")
    series = identify.read(command, sample_rate=sample_rate)
    if not isinstance(series, identify.TimeSeries):
        raise InputError(f"{command} holds a spectrum, not a command over time: give a CSV with a time column.")
    dt = 1.0 / series.sample_rate
    shaped = shaper.shape(series.values, dt, initial=series.values[:, :1])
    times = series.start + np.arange(shaped.shape[-1]) * dt
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    unit = f" [{series.unit}]" if series.unit else ""
    writer.writerow(["time [s]", *(f"{channel}{unit}" for channel in series.channels)])
    for t, row in zip(times, shaped.T, strict=True):
        writer.writerow([f"{t:.9g}", *(repr(float(value)) for value in row)])
    path = write_atomically(out, text.getvalue())
    return ShapedFile(path, series.channels, dt, series.values.shape[-1], shaped.shape[-1])
