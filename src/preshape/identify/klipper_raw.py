"""Klipper raw data: `#time,accel_x,accel_y,accel_z`, seconds and mm/s^2 (klippy/extras/adxl345.py writes them)."""

from __future__ import annotations

import numpy as np

from preshape.errors import MeasurementError
from preshape.identify.measurement import TimeSeries
from preshape.identify.source_file import SourceFile
from preshape.identify.text import Table, check_fixed_decimals, check_increasing, check_rate, parse_table
from preshape.identify.wanted import Wanted

__all__ = ["FORMAT", "LOST", "accelerations", "read", "recognises"]

FORMAT = "Klipper raw data"
HEADER = ("#time", "accel_x", "accel_y", "accel_z")
LOST = "samples are missing"
"""How the remark on gaps begins: what comes after them stands at the wrong time."""

MINIMUM_ROWS = 2
GAP = 3.0
"""A step of time longer than this many mean steps means lost samples; smaller ones are the accelerometer's jitter."""


def recognises(file: SourceFile) -> bool:
    """True for a file whose first line names the time column as Klipper does."""
    return file.head[0].strip().lower().startswith("#time,")


def read(file: SourceFile, wanted: Wanted) -> TimeSeries:
    """Read raw accelerometer data."""
    header = tuple(cell.strip().lower() for cell in file.head[0].split(","))
    if header != HEADER:
        raise MeasurementError(
            f"{file.name}: the header {file.head[0].strip()[:80]!r} is not that of Klipper raw data; "
            f"it must be {','.join(HEADER)!r}."
        )
    table = parse_table(file, 1, len(HEADER))
    check_fixed_decimals(file)
    return accelerations(table, file.name, wanted.sample_rate, FORMAT, 2)


def accelerations(
    table: Table, source: str, sample_rate: float | None, name: str, first_line: int | None
) -> TimeSeries:
    """The time series in rows of time [s] and three accelerations [mm/s^2], shape (sample, 4).

    The rate is N / (last time - first time), as Klipper's own spectra take it; the jitter of single time stamps
    is an artefact of the transmission, so samples are taken as uniform.
    """
    if len(table) < MINIMUM_ROWS:
        rows = "1 data row" if len(table) == 1 else f"{len(table)} data rows"
        raise MeasurementError(f"{source}: the file has {rows}; a measurement needs many, record it again.")
    times = table[:, 0]
    check_increasing(times, "time", first_line, source)
    found = len(times) / float(times[-1] - times[0])
    check_rate(sample_rate, found, source)
    longer = np.diff(times)
    gaps = longer[longer > GAP / found]
    remarks = (
        (
            f"{LOST}: the time stamps have {gaps.size} gap{'s' if gaps.size > 1 else ''}, "
            f"{1e3 * float(gaps.sum()):.3g} ms together.",
        )
        if gaps.size
        else ()
    )
    table.flags.writeable = False  # so that it need not be copied
    return TimeSeries(found, float(times[0]), table[:, 1:].T, ("x", "y", "z"), "mm/s^2", source, name, remarks)
