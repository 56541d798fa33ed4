"""Tables of numbers in text: parsed in bulk as the file streams by, never evaluated.

The fast path is one bulk parse. Only when that fails is the file gone through line by line, to say which line and
which cell is wrong.
"""

from __future__ import annotations

import array
import csv
import math
from collections.abc import Generator, Iterable
from contextlib import closing
from itertools import chain

import numpy as np
from numpy.typing import NDArray

from preshape.errors import MeasurementError
from preshape.identify.source_file import SourceFile

__all__ = [
    "LONGEST_NAME",
    "Table",
    "cells",
    "check_fixed_decimals",
    "check_increasing",
    "check_rate",
    "parse_table",
    "printable",
]

SHOWN_CELL = 24
"""Characters of a wrong cell that an error message shows."""

LONGEST_NAME = 200
"""Characters; what is longer is no name of a column and no comment with a rate, and is not searched for one."""

RATE_TOLERANCE = 0.01
"""Relative difference at which a given sample rate contradicts the one in the file."""

Table = NDArray[np.float64]
"""Parsed numbers, shape (row, column)."""


def cells(line: str, delimiter: str | None = ",") -> list[str]:
    """The stripped cells of one line; a delimiter of None means white space. Quoted cells may hold the delimiter."""
    if delimiter is None:
        return line.split()
    try:
        return [cell.strip() for cell in next(csv.reader([line.strip()], delimiter=delimiter), [])]
    except csv.Error:  # a cell longer than its limit, or a line end in quotes
        return [cell.strip() for cell in line.split(delimiter)]


def parse_table(
    file: SourceFile,
    first: int,
    columns: int,
    *,
    used: int | None = None,
    delimiter: str | None = ",",
    trailer: bool = False,
) -> Table:
    """Parse the lines of numbers in a file, shape (row, `used`).

    Parameters
    ----------
    file : SourceFile
        The file.
    first : int
        Index of its first line of numbers, counted from 0; blank lines below are passed over.
    columns : int
        Number of cells that each line must have.
    used : int, optional
        Only so many columns, from the left, are parsed.
    delimiter : str or None
        None means white space.
    trailer : bool
        True when the last line is not one of numbers.

    Raises
    ------
    MeasurementError
        Naming the line and the cell.
    """
    used = columns if used is None else used
    # np.loadtxt checks the number of columns only when it reads all of them
    table = _in_bulk(file, first, delimiter, trailer) if used == columns else None
    if table is None or table.shape[1] != used:
        return _checked_slowly(file, first, columns, used, delimiter, trailer)
    return table


def _in_bulk(file: SourceFile, first: int, delimiter: str | None, trailer: bool) -> Table | None:
    """All of the table, or None when something is wrong with it."""
    with closing(file.lines(first)) as stream:
        lines = _all_but_last(stream) if trailer else stream
        begin = next((line for line in lines if line.strip()), None)
        if begin is None:
            return None
        try:
            table = np.loadtxt(chain([begin], lines), delimiter=delimiter, comments=None, ndmin=2)
        except MeasurementError:
            raise
        except ValueError:
            return None
    # min and max are NaN or infinite when any number is, and need no array of their own
    return table if math.isfinite(table.min()) and math.isfinite(table.max()) else None


def _all_but_last(lines: Iterable[str]) -> Generator[str, None, None]:
    """The lines before the last one that is not blank."""
    held: list[str] = []
    for line in lines:
        if held and line.strip():
            yield from held
            held = []
        if held or line.strip():
            held.append(line)
        else:
            yield line


def _checked_slowly(
    file: SourceFile, first: int, columns: int, used: int, delimiter: str | None, trailer: bool
) -> Table:
    """Parse line by line; raise on the first cell or line that is wrong."""
    numbers = array.array("d")
    with closing(file.lines(first)) as stream:
        lines = _all_but_last(stream) if trailer else stream
        for number, line in enumerate(lines, start=first + 1):
            if not line.strip():
                continue
            found = cells(line, delimiter)
            if len(found) != columns:
                is_last = not any(line.strip() for line in lines)
                remedy = "the file is truncated; copy it again" if is_last else "repair that line"
                raise MeasurementError(
                    f"{file.name}: line {number} has {_columns(len(found))} where the lines before have {columns}; "
                    f"{remedy}."
                )
            numbers.extend(_number(cell, number, file.name) for cell in found[:used])
    return np.frombuffer(numbers, dtype=np.float64).reshape(-1, used)


def _columns(count: int) -> str:
    return f"{count} column" if count == 1 else f"{count} columns"


def _number(cell: str, line: int, source: str) -> float:
    """The finite number in a cell, or a sentence naming line and cell."""
    shown = cell if len(cell) <= SHOWN_CELL else cell[:SHOWN_CELL] + "..."
    shown = printable(shown)
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


def check_increasing(column: NDArray[np.float64], name: str, first_line: int | None, source: str) -> None:
    """Raise unless the column increases from row to row; rows are taken to stand on consecutive lines.

    `first_line` is the number of the first row's line, or None where the numbers do not stand in lines.
    """
    steps = np.diff(column)
    wrong = np.flatnonzero(steps <= 0.0)
    if wrong.size:
        row = int(wrong[0]) + 1
        what = "repeats" if steps[row - 1] == 0.0 else "goes back"
        line = "" if first_line is None else f" (about line {first_line + row})"
        raise MeasurementError(
            f"{source}: the {name} {what} at data row {row + 1}{line}, "
            f"to {column[row]:.9g} after {column[row - 1]:.9g}; sort the rows and remove duplicates."
        )


def check_rate(given: float | None, found: float, source: str) -> None:
    """Raise when a sample rate is given that contradicts the one in the file."""
    if given is not None and abs(given - found) > RATE_TOLERANCE * found:
        raise MeasurementError(
            f"{source}: sample_rate={given:g} Hz was given, but the file itself says {found:.6g} Hz; "
            "leave sample_rate out."
        )


def check_fixed_decimals(file: SourceFile) -> None:
    """Raise when the last number of a fixed-format file is shorter than the one above it: the file was cut there."""
    if len(file.tail) < 2:
        return
    before, last = (line.rpartition(",")[2].strip() for line in file.tail[-2:])
    if len(last.partition(".")[2]) < len(before.partition(".")[2]):
        number = max(number for number, line in enumerate(file.lines(), start=1) if line.strip())
        raise MeasurementError(
            f"{file.name}: the last line ({number}) is cut in the middle of a number; the file is truncated, "
            "copy it again."
        )


def printable(text: str) -> str:
    """The text with a question mark for what a terminal would not print, so that a message stays one line."""
    return "".join(sign if sign.isprintable() else "?" for sign in text)
