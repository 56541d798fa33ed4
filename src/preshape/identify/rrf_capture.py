"""RepRapFirmware accelerometer captures: `Sample,X,Y,Z` in g, closed by a line with the rate (M956 writes them)."""

from __future__ import annotations

import re

from preshape.errors import MeasurementError
from preshape.identify.measurement import TimeSeries
from preshape.identify.text import cells, check_increasing, check_rate, parse_table

__all__ = ["FORMAT", "read", "recognises"]

FORMAT = "RepRapFirmware capture"
BAD_SAMPLES = 1
"""Sample 0 is taken before the accelerometer has settled and is wrong in every capture."""

MINIMUM_ROWS = 2
_HEADER = re.compile(r"sample(,[xyz])*\s*$", re.IGNORECASE)
_TRAILER = re.compile(r"rate:?\s*(\d+(?:\.\d+)?)\s*,?\s*overflows:?\s*(\d+)\s*$", re.IGNORECASE)


def recognises(lines: list[str]) -> bool:
    """True for a file whose first line is a sample column and axes."""
    return bool(_HEADER.match(lines[0].strip().replace(" ", "")))


def read(lines: list[str], source: str, sample_rate: float | None) -> TimeSeries:
    """Read a capture; the rate comes from its last line, or from the argument when that line is missing."""
    axes = tuple(name.lower() for name in cells(lines[0])[1:])
    if not axes:
        raise MeasurementError(f"{source}: the header has no axis column; a capture needs at least one of X, Y, Z.")
    end = len(lines)
    while end > 1 and not lines[end - 1].strip():
        end -= 1
    last = lines[end - 1].strip()
    trailer = _TRAILER.match(last)
    remarks: tuple[str, ...] = ()
    rate = sample_rate
    if trailer:
        end -= 1
        rate = float(trailer[1])
        if rate <= 0.0:
            raise MeasurementError(
                f"{source}: the last line says {last!r}; a rate of 0 means a failed capture, repeat it."
            )
        check_rate(sample_rate, rate, source)
        if int(trailer[2]):
            remarks = (f"samples were lost while recording: the capture counts {trailer[2]} overflows.",)
    elif end > 1 and last[:1].isalpha():
        raise MeasurementError(
            f"{source}: the capture ends with {last[:60]!r} instead of 'Rate ..., overflows ...'; repeat the capture."
        )
    table = parse_table(lines[1:end], 2, 1 + len(axes), source)
    if rate is None:
        raise MeasurementError(
            f"{source}: the last line 'Rate ..., overflows ...' is missing, so the sample rate is unknown; "
            "copy the file again or give sample_rate [Hz]."
        )
    if len(table) < BAD_SAMPLES + MINIMUM_ROWS:
        raise MeasurementError(f"{source}: the capture has {len(table)} samples; a measurement needs many, repeat it.")
    check_increasing(table[:, 0], "sample number", 2, source)
    values = table[BAD_SAMPLES:, 1:].T
    return TimeSeries(rate, BAD_SAMPLES / rate, values, axes, "g", source, FORMAT, remarks)
