"""Any other table of numbers over time: a time column and channels, or channels and a known sample rate."""

from __future__ import annotations

import re

import numpy as np

from preshape.errors import MeasurementError
from preshape.identify.measurement import TimeSeries
from preshape.identify.source_file import SourceFile
from preshape.identify.text import LONGEST_NAME, cells, check_increasing, check_rate, parse_table
from preshape.identify.time_column import uniform
from preshape.identify.wanted import Wanted

__all__ = ["FORMAT", "read", "recognises"]

FORMAT = "time series"
MINIMUM_ROWS = 2
DELIMITERS = (",", ";", "\t")

_RATE = re.compile(r"#\s*sample[_ ]?rate\s*[:=]\s*(\S+?)\s*(?:hz)?\s*$", re.IGNORECASE)
_TIME = re.compile(r"(?:time|t|seconds|timestamps?)(?:[\s_]*[\[(]?(s|ms|us|sec|seconds)[\])]?)?$", re.IGNORECASE)
_COUNTERS = frozenset({"sample", "index", "n", "#"})
_UNIT = re.compile(r"^(.*?)\s*[\[(]([^\])]+)[\])]$")
_SECONDS = {"ms": 1e-3, "us": 1e-6}


def recognises(file: SourceFile) -> bool:
    """True when the first or second line below the comments is a row of numbers."""
    lines = file.head
    top = _first_data_line(lines)
    for line in lines[top : top + 2]:
        found = cells(line, _delimiter(line))
        if found and all(_is_number(cell) for cell in found):
            return True
    return top < len(lines) - 1 and any(_TIME.match(cell) for cell in cells(lines[top], _delimiter(lines[top])))


def read(file: SourceFile, wanted: Wanted) -> TimeSeries:
    """Read a table; a sample rate [Hz], or a comment `# sample_rate: 1000`, stands in for a time column."""
    lines, source = file.head, file.name
    rate = wanted.sample_rate if wanted.sample_rate is not None else _commented_rate(lines, source)
    top = _first_data_line(lines)
    delimiter = _table_delimiter(lines, top)
    names = [cell.lstrip("#").strip() for cell in cells(lines[top], delimiter)]
    has_header = not all(_is_number(cell) for cell in names)
    first = top + has_header
    table = parse_table(file, first, len(names), delimiter=delimiter)
    if len(table) < MINIMUM_ROWS:
        raise MeasurementError(
            f"{source}: the file has {len(table)} rows of numbers; a measurement needs many, record it again."
        )
    if has_header:
        time = next((i for i, name in enumerate(names) if _TIME.match(name)), None)
        if time is None and rate is None:
            raise MeasurementError(
                f"{source}: no column is named 'time' and no sample rate is known; "
                "name the time column [s] or give sample_rate [Hz]."
            )
    else:
        time = 0 if rate is None else None
        names = ["time" if i == time else f"channel {i + 1 - (time == 0)}" for i in range(len(names))]
    kept = [i for i, name in enumerate(names) if i != time and name.lower() not in _COUNTERS]
    if not kept:
        raise MeasurementError(
            f"{source}: there is no column besides the time; a measurement needs at least one channel."
        )
    channels, unit = _units([names[i] for i in kept])
    values = table[:, kept].T
    start = 0.0
    if time is not None:
        match = _TIME.match(names[time])
        scale = _SECONDS.get((match[1] or "").lower(), 1.0) if match else 1.0
        times = scale * table[:, time]
        check_increasing(times, "time", first + 1, source)
        found, values = uniform(times, values, first + 1, source)
        check_rate(rate, found, source)
        rate, start = found, float(times[0])
    assert rate is not None
    return TimeSeries(rate, start, values, channels, unit, source, FORMAT)


def _first_data_line(lines: list[str]) -> int:
    """Index of the first line that is neither blank nor a comment; a `#time` header is no comment."""
    for index, line in enumerate(lines):
        stripped = line.strip()
        named = cells(stripped[1:], _delimiter(stripped)) if stripped.startswith("#") else []
        if stripped and (not stripped.startswith("#") or (named and _TIME.match(named[0]))):
            return index
    return len(lines) - 1


def _delimiter(line: str) -> str | None:
    return next((mark for mark in DELIMITERS if mark in line), None)


def _table_delimiter(lines: list[str], top: int) -> str | None:
    """The delimiter of the table; blanks in the header of a single column (`ax [g]`) separate nothing."""
    below = lines[top + 1] if top + 1 < len(lines) else ""
    single = _delimiter(lines[top]) is None and len(below.split()) == 1
    return DELIMITERS[0] if single else _delimiter(lines[top])


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _commented_rate(lines: list[str], source: str) -> float | None:
    """The rate in a `# sample_rate: 1000` comment above the table."""
    for line in lines[: _first_data_line(lines)]:
        match = _RATE.match(line.strip()) if len(line) <= LONGEST_NAME else None
        if match:
            if not _is_number(match[1]) or not (np.isfinite(float(match[1])) and float(match[1]) > 0.0):
                raise MeasurementError(
                    f"{source}: the comment {line.strip()!r} gives no usable rate; write '# sample_rate: 1000' [Hz]."
                )
            return float(match[1])
    return None


def _units(names: list[str]) -> tuple[tuple[str, ...], str]:
    """Channel names and their unit when all have the same one; names with their units otherwise."""
    matches = [_UNIT.match(name) if len(name) <= LONGEST_NAME else None for name in names]
    units = {match[2].strip() if match else "" for match in matches}
    if len(units) > 1:
        return tuple(names), ""
    return tuple(match[1].strip() if match else name for match, name in zip(matches, names, strict=True)), units.pop()
