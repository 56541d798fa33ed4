"""Shaping a command that lies in a file."""

from __future__ import annotations

import csv
import io
import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from preshape import identify
from preshape.command.path import ContourError, ShapedPath, shaped_path
from preshape.errors import InputError
from preshape.files import write_atomically
from preshape.report import contour_figure, figure_bytes, figure_format
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
    unit : str
        Of all columns; empty when the file does not say.
    shaped : ShapedPath
        The columns, before and after, with the delay of each.
    contour : ContourError or None
        How far the shaped path leaves the commanded one's curve [unit], where that was asked for.
    figure : Path or None
        The drawing of it.
    """

    path: Path
    channels: tuple[str, ...]
    dt: float
    samples_before: int
    samples_after: int
    unit: str
    shaped: ShapedPath
    contour: ContourError | None = None
    figure: Path | None = None


def shape_file(
    shaper: Shaper,
    command: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    columns: Mapping[str, Shaper] | None = None,
    delays: str = "equal",
    advance: bool = False,
    contour: bool = False,
    figure: str | os.PathLike[str] | None = None,
    sample_rate: float | None = None,
) -> ShapedFile:
    """Shape every column of a command file and write the result, longer by the shaper's duration.

    The machine is taken to rest at the first row's values before the command begins, and at the last row's afterwards.

    Parameters
    ----------
    shaper : Shaper
        For every column that has none of its own.
    command : path
        CSV with a time column [s] and one column an axis, or columns only and a `sample_rate` [Hz].
    out : path
        CSV to write: time [s] and the same columns.
    columns : mapping of str to Shaper, optional
        Shapers of single columns, by their names in the file.
    delays : {"equal", "own"}
        Whether all columns are delayed alike, so that straight lines of a path stay straight at constant speed.
    advance : bool
        Whether to begin ahead by the delay, so that nothing is late at constant speed: times then begin before the
        command's.
    contour : bool
        Whether to take the columns as the axes of one path and measure how far the shaped one leaves its curve.
    figure : path, optional
        Where to draw that, as .svg, .png or .pdf.
    sample_rate : float, optional
        Rows per second [Hz], for a table without a time column.

    Raises
    ------
    InputError
        If the command cannot be read as a time series, has no column of a name, or a file cannot be written.
    """
    if Path(out).exists() and Path(command).exists() and Path(out).samefile(command):
        raise InputError(f"{out} is the command itself: choose another name with --out, so that nothing is lost.")
    series = identify.read(command, sample_rate=sample_rate)
    if not isinstance(series, identify.TimeSeries):
        raise InputError(f"{command} holds a spectrum, not a command over time: give a CSV with a time column.")
    dt = 1.0 / series.sample_rate
    shapers = _of_columns(shaper, columns or {}, series.channels)
    shaped = shaped_path(series.values, shapers, dt, delays=delays, advance=advance)
    error = shaped.contour_error() if contour or figure is not None else None
    drawing = None
    if figure is not None:
        kind = figure_format(figure)
        drawn = {f"{delays} delays" if columns else "shaped": shaped}
        if columns and delays == "equal":
            drawn["own delays"] = shaped_path(series.values, shapers, dt, delays="own")
        drawing = figure_bytes(contour_figure(drawn, names=series.channels, unit=series.unit), kind)
    path = write_atomically(out, _text(series, shaped))
    return ShapedFile(
        path,
        series.channels,
        dt,
        series.values.shape[-1],
        shaped.shaped.shape[-1],
        series.unit,
        shaped,
        error,
        write_atomically(figure, drawing) if figure is not None and drawing is not None else None,
    )


def _of_columns(shaper: Shaper, columns: Mapping[str, Shaper], channels: Sequence[str]) -> list[Shaper]:
    """One shaper a column."""
    for name in columns:
        if list(channels).count(name) != 1:
            raise InputError(f"the command has no single column {name!r}: its columns are {', '.join(channels)}.")
    return [columns.get(channel, shaper) for channel in channels]


def _text(series: identify.TimeSeries, shaped: ShapedPath) -> str:
    """The table that is written."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    unit = f" [{series.unit}]" if series.unit else ""
    writer.writerow(["time [s]", *(f"{channel}{unit}" for channel in series.channels)])
    for t, row in zip(series.start + shaped.times, shaped.shaped.T, strict=True):
        writer.writerow([f"{t:.9g}", *(repr(float(value)) for value in row)])
    return text.getvalue()
