"""RepRapFirmware accelerometer captures: `Sample,X,Y,Z` in g, closed by a line with the rate (M956 writes them)."""

from __future__ import annotations

import re

import numpy as np

from preshape.errors import MeasurementError
from preshape.identify.measurement import TimeSeries
from preshape.identify.motor_lines import without_motor_lines
from preshape.identify.source_file import SourceFile
from preshape.identify.text import cells, check_increasing, check_rate, parse_table
from preshape.identify.wanted import Wanted

__all__ = ["FORMAT", "read", "recognises"]

FORMAT = "RepRapFirmware capture"
BAD_SAMPLES = 1
"""Sample 0 is taken before the accelerometer has settled and is wrong in every capture."""

MINIMUM_ROWS = 2
_HEADER = re.compile(r"sample(,[xyz])*\s*$", re.IGNORECASE)
_TRAILER = re.compile(r"rate:?\s*(\d{1,9}(?:\.\d{1,9})?)\s*,?\s*overflows:?\s*(\d{1,9})\s*$", re.IGNORECASE)


def recognises(file: SourceFile) -> bool:
    """True for a file whose first line is a sample column and axes."""
    return bool(_HEADER.match(file.head[0].strip().replace(" ", "")))


def read(file: SourceFile, wanted: Wanted) -> TimeSeries:
    """Read a capture; the rate comes from its last line, or from `wanted` when that line is missing.

    The lines of the motors are taken out (:mod:`preshape.identify.motor_lines`), and a remark says which.
    """
    source = file.name
    axes = tuple(name.lower() for name in cells(file.head[0])[1:])
    if not axes:
        raise MeasurementError(f"{source}: the header has no axis column; a capture needs at least one of X, Y, Z.")
    last = file.tail[-1].strip() if file.tail else ""
    trailer = _TRAILER.match(last)
    remarks: list[str] = []
    rate = wanted.sample_rate
    if trailer:
        rate = float(trailer[1])
        if rate <= 0.0:
            raise MeasurementError(
                f"{source}: the last line says {last!r}; a rate of 0 means a failed capture, repeat it."
            )
        check_rate(wanted.sample_rate, rate, source)
        if int(trailer[2]):
            remarks.append(f"samples were lost while recording: the capture counts {trailer[2]} overflows.")
    elif last[:1].isalpha() and not last.lower().startswith("sample"):
        raise MeasurementError(
            f"{source}: the capture ends with {last[:60]!r} instead of 'Rate ..., overflows ...'; repeat the capture."
        )
    table = parse_table(file, 1, 1 + len(axes), trailer=bool(trailer))
    if rate is None:
        raise MeasurementError(
            f"{source}: the last line 'Rate ..., overflows ...' is missing, so the sample rate is unknown; "
            "copy the file again or give sample_rate [Hz]."
        )
    if len(table) < BAD_SAMPLES + MINIMUM_ROWS:
        raise MeasurementError(f"{source}: the capture has {len(table)} samples; a measurement needs many, repeat it.")
    check_increasing(table[:, 0], "sample number", 2, source)
    missing = round(float(table[-1, 0] - table[0, 0])) + 1 - len(table)
    if missing > 0:
        gaps = int(np.count_nonzero(np.diff(table[:, 0]) > 1.5))
        remarks.append(f"samples are missing: the sample numbers skip {missing} in {gaps} places.")
    values, removed = without_motor_lines(table[BAD_SAMPLES:, 1:].T, rate)
    return TimeSeries(rate, BAD_SAMPLES / rate, values, axes, "g", source, FORMAT, (*remarks, *removed))
