"""Text files with a table of numbers: loaded with a limit, parsed in bulk, never evaluated.

The fast path is one bulk parse. Only when that fails is the file gone through line by line, to say which line and
which cell is wrong.
"""

from __future__ import annotations

import csv
import math
import os
import stat
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from preshape.errors import MeasurementError

__all__ = ["MAXIMUM_FILE_SIZE", "Table", "cells", "check_increasing", "check_rate", "load_text", "parse_table"]

MAXIMUM_FILE_SIZE = 200_000_000
"""Files of this size [bytes] and above are refused before anything is read (about 80 minutes of Klipper raw data)."""

SHOWN_CELL = 24
"""Characters of a wrong cell that an error message shows."""

RATE_TOLERANCE = 0.01
"""Relative difference at which a given sample rate contradicts the one in the file."""

Table = NDArray[np.float64]
"""Parsed numbers, shape (row, column)."""


def load_text(path: str | os.PathLike[str]) -> str:
    """The text of a measurement file; raises MeasurementError where that is not possible."""
    source = os.fspath(path)
    try:
        status = os.stat(source)
    except FileNotFoundError:
        raise MeasurementError(f"{source}: there is no such file; check the path.") from None
    except (OSError, ValueError) as error:
        raise MeasurementError(f"{source}: the file cannot be opened ({_reason(error)}); check the path.") from None
    if stat.S_ISDIR(status.st_mode):
        raise MeasurementError(f"{source}: this is a directory; give the measurement file in it.")
    if not stat.S_ISREG(status.st_mode):
        raise MeasurementError(f"{source}: this is not a regular file; give a measurement file.")
    if status.st_size >= MAXIMUM_FILE_SIZE:
        raise MeasurementError(
            f"{source}: the file has {status.st_size / 1e6:.0f} MB and the limit is below "
            f"{MAXIMUM_FILE_SIZE / 1e6:.0f} MB; cut the part that holds the vibration."
        )
    try:
        data = Path(source).read_bytes()
    except OSError as error:
        raise MeasurementError(
            f"{source}: the file cannot be read ({_reason(error)}); check its permissions."
        ) from None
    if not data.strip():
        raise MeasurementError(f"{source}: the file is empty; record the measurement again.")
    if b"\0" in data:
        raise MeasurementError(f"{source}: the file is binary, not text; give the measurement as CSV.")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise MeasurementError(
            f"{source}: the file is not text (byte {error.start} is not UTF-8); give the measurement as CSV."
        ) from None


def _reason(error: Exception) -> str:
    """The operating system's words for what went wrong, without the path."""
    return str(getattr(error, "strerror", None) or error).lower()


def cells(line: str, delimiter: str | None = ",") -> list[str]:
    """The stripped cells of one line; a delimiter of None means white space. Quoted cells may hold the delimiter."""
    if delimiter is None:
        return line.split()
    return [cell.strip() for cell in next(csv.reader([line.strip()], delimiter=delimiter), [])]


def parse_table(
    lines: list[str], first_line: int, columns: int, source: str, used: int | None = None, delimiter: str | None = ","
) -> Table:
    """Parse lines of numbers, shape (row, `used`).

    Parameters
    ----------
    lines : list of str
        Lines of the file; blank ones are passed over.
    first_line : int
        Number of the first of them in the file, counted from 1, for messages.
    columns : int
        Number of cells that each line must have.
    source : str
        File name, for messages.
    used : int, optional
        Only so many columns, from the left, are parsed.
    delimiter : str or None
        None means white space.

    Raises
    ------
    MeasurementError
        Naming the line and the cell.
    """
    used = columns if used is None else used
    try:
        if used == columns:  # np.loadtxt checks the number of columns only when it reads all of them
            table = np.loadtxt(lines, delimiter=delimiter, comments=None, ndmin=2)
        else:
            table = _checked_slowly(lines, first_line, columns, source, used, delimiter)
    except ValueError as error:
        _checked_slowly(lines, first_line, columns, source, used, delimiter)
        raise MeasurementError(f"{source}: the table of numbers cannot be read ({error}); export it again.") from None
    if table.shape[1:] != (used,) or not np.all(np.isfinite(table)):
        table = _checked_slowly(lines, first_line, columns, source, used, delimiter)
    return table


def _checked_slowly(
    lines: list[str], first_line: int, columns: int, source: str, used: int, delimiter: str | None
) -> Table:
    """Parse line by line; raise on the first cell or line that is wrong."""
    rows: list[list[float]] = []
    for number, line in enumerate(lines, start=first_line):
        if not line.strip():
            continue
        found = cells(line, delimiter)
        if len(found) != columns:
            remedy = (
                "the file is truncated; copy it again" if _is_last(lines, number - first_line) else "repair that line"
            )
            raise MeasurementError(
                f"{source}: line {number} has {_columns(len(found))} where the lines before have {columns}; {remedy}."
            )
        rows.append([_number(cell, number, source) for cell in found[:used]])
    return np.array(rows, dtype=np.float64).reshape(-1, used)


def _columns(count: int) -> str:
    return f"{count} column" if count == 1 else f"{count} columns"


def _is_last(lines: list[str], index: int) -> bool:
    return not any(line.strip() for line in lines[index + 1 :])


def _number(cell: str, line: int, source: str) -> float:
    """The finite number in a cell, or a sentence naming line and cell."""
    shown = cell if len(cell) <= SHOWN_CELL else cell[:SHOWN_CELL] + "..."
    try:
        value = float(cell)
        if "_" in cell:  # Python's digit grouping is no number in a measurement file
            raise ValueError
    except ValueError:
        raise MeasurementError(
            f"{source}: line {line} holds '{shown}' where a number is expected; correct or remove that line."
        ) from None
    if not math.isfinite(value):
        raise MeasurementError(
            f"{source}: line {line} holds '{shown}', which is not a finite number; correct or remove that line."
        )
    return value


def check_increasing(column: NDArray[np.float64], name: str, first_line: int, source: str) -> None:
    """Raise unless the column increases from row to row; rows are taken to stand on consecutive lines."""
    steps = np.diff(column)
    wrong = np.flatnonzero(steps <= 0.0)
    if wrong.size:
        row = int(wrong[0]) + 1
        what = "repeats" if steps[row - 1] == 0.0 else "goes back"
        raise MeasurementError(
            f"{source}: the {name} {what} at data row {row + 1} (about line {first_line + row}), "
            f"to {column[row]:.9g} after {column[row - 1]:.9g}; sort the rows and remove duplicates."
        )


def check_rate(given: float | None, found: float, source: str) -> None:
    """Raise when a sample rate is given that contradicts the one in the file."""
    if given is not None and abs(given - found) > RATE_TOLERANCE * found:
        raise MeasurementError(
            f"{source}: sample_rate={given:g} Hz was given, but the file itself says {found:.6g} Hz; "
            "leave sample_rate out."
        )


def check_fixed_decimals(lines: list[str], first_line: int, source: str) -> None:
    """Raise when the last number of a fixed-format file is shorter than the one above it: the file was cut there."""
    filled = [index for index, line in enumerate(lines) if line.strip()]
    if len(filled) < 2:
        return
    last, before = (lines[filled[index]].rpartition(",")[2].strip() for index in (-1, -2))
    if len(last.partition(".")[2]) < len(before.partition(".")[2]):
        raise MeasurementError(
            f"{source}: the last line ({first_line + filled[-1]}) is cut in the middle of a number; "
            "the file is truncated, copy it again."
        )
