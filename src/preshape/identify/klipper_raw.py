"""Klipper raw data: `#time,accel_x,accel_y,accel_z`, seconds and mm/s^2 (klippy/extras/adxl345.py writes them)."""

from __future__ import annotations

import numpy as np

from preshape.errors import MeasurementError
from preshape.identify.measurement import TimeSeries
from preshape.identify.text import check_fixed_decimals, check_increasing, check_rate, parse_table

__all__ = ["FORMAT", "LOST", "read", "recognises"]

FORMAT = "Klipper raw data"
HEADER = ("#time", "accel_x", "accel_y", "accel_z")
LOST = "samples are missing"
"""How the remark on gaps begins: what comes after them stands at the wrong time."""

MINIMUM_ROWS = 2
GAP = 3.0
"""A step of time longer than this many mean steps means lost samples; smaller ones are the accelerometer's jitter."""


def recognises(lines: list[str]) -> bool:
    """True for a file whose first line names the time column as Klipper does."""
    return lines[0].strip().lower().startswith("#time,")


def read(lines: list[str], source: str, sample_rate: float | None) -> TimeSeries:
    """Read raw accelerometer data.

    The rate is N / (last time - first time), as Klipper's own spectra take it; the jitter of single time stamps
    is an artefact of the transmission, so samples are taken as uniform.
    """
    header = tuple(cell.strip().lower() for cell in lines[0].split(","))
    missing = [name for name in HEADER if name not in header]
    if missing or header != HEADER:
        raise MeasurementError(
            f"{source}: the header {lines[0].strip()!r} is not that of Klipper raw data; "
            f"it must be {','.join(HEADER)!r}."
        )
    table = parse_table(lines[1:], 2, len(HEADER), source)
    check_fixed_decimals(lines[1:], 2, source)
    if len(table) < MINIMUM_ROWS:
        raise MeasurementError(
            f"{source}: the file has {len(table)} data rows; a measurement needs many, record it again."
        )
    times = table[:, 0]
    check_increasing(times, "time", 2, source)
    found = len(times) / float(times[-1] - times[0])
    check_rate(sample_rate, found, source)
    gaps = int(np.count_nonzero(np.diff(times) > GAP / found))
    remarks = (f"{LOST}: the time stamps have {gaps} gaps.",) if gaps else ()
    return TimeSeries(found, float(times[0]), table[:, 1:].T, ("x", "y", "z"), "mm/s^2", source, FORMAT, remarks)
