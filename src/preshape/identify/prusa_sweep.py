"""Prusa's vibration report, `M958 K` and `M959 K`: the squared gain at each frequency that was excited.

The header is Klipper's with a column `mzv`, but the rows have no such cell, and the numbers are no power spectral
density: each is the squared ratio of the acceleration that was measured to the one that was commanded, printed with
five decimals (lib/Marlin/Marlin/src/gcode/calibrate/M958.cpp). The report is copied from a serial line, so messages of
the firmware stand between the rows.
"""

from __future__ import annotations

import numpy as np

from preshape.errors import MeasurementError
from preshape.identify.measurement import PrintedSpectrum, Spectrum
from preshape.identify.source_file import SourceFile
from preshape.identify.text import cells
from preshape.identify.wanted import Wanted

__all__ = ["FORMAT", "read", "recognises"]

FORMAT = "Prusa vibration report"
HEADER = ("freq", "psd_x", "psd_y", "psd_z", "psd_xyz", "mzv")
COLUMNS = 5
"""Numbers in a row; the header names one more."""

MINIMUM_ROWS = 8
CYCLES = 50.0
"""Periods that each frequency is excited and measured, unless the user asks for another number."""


def recognises(file: SourceFile) -> bool:
    """True when the header of the report is there and the first row below it has one cell less."""
    top = _top(file.head)
    row = next((line for line in file.head[top + 1 :] if _is_row(line)), None)
    return top < len(file.head) and row is not None and len(cells(row)) == COLUMNS


def read(file: SourceFile, wanted: Wanted) -> Spectrum:
    """Read the report; what begins with a letter is a message of the firmware and passed over."""
    source = file.name
    if wanted.sample_rate is not None:
        raise MeasurementError(f"{source}: this is a spectrum, which has no sample rate; leave sample_rate out.")
    if file.size > len(file.begin):
        raise MeasurementError(
            f"{source}: the report is longer than {len(file.begin) // 1024} KB; cut one sweep out of the log."
        )
    top = _top(file.head)
    rows = []
    for number, line in enumerate(file.head[top + 1 :], start=top + 2):
        if _is_header(line):
            raise MeasurementError(
                f"{source}: a second report begins at line {number}; give each sweep as a file of its own."
            )
        if _is_row(line):
            rows.append(_row(line, number, source))
    if len(rows) < MINIMUM_ROWS:
        raise MeasurementError(
            f"{source}: the report has {len(rows)} rows and at least {MINIMUM_ROWS} are needed; sweep more frequencies."
        )
    table = np.array(rows)
    steps = np.diff(table[:, 0])
    if np.any(steps <= 0.0):
        row = int(np.flatnonzero(steps <= 0.0)[0]) + 1
        raise MeasurementError(
            f"{source}: the frequency repeats or goes back to {table[row, 0]:g} Hz after {table[row - 1, 0]:g} Hz; "
            "give each sweep as a file of its own."
        )
    loudest = float(table[np.argmax(table[:, 4]), 0])
    if loudest <= 0.0 or not np.any(table[:, 4] > 0.0):
        raise MeasurementError(f"{source}: the gain is zero everywhere; check the accelerometer and sweep again.")
    return Spectrum(
        table[:, 0],
        table[:, 1:4].T,
        ("x", "y", "z"),
        unit="(m/s^2)^2/(m/s^2)^2",
        normalised=True,  # by the excitation itself: nothing is left to be divided out
        window_duration=CYCLES / loudest,
        excitation_exponent=0.0,
        source=source,
        format=FORMAT,
        printed=PrintedSpectrum(table[:, 0], table[:, 4:5].T),
    )


def _top(lines: list[str]) -> int:
    """Index of the header, or the number of lines."""
    return next((index for index, line in enumerate(lines) if _is_header(line)), len(lines))


def _is_header(line: str) -> bool:
    return tuple(line.strip().lower().split(",")) == HEADER


def _is_row(line: str) -> bool:
    return bool(line.strip()) and not line.strip()[0].isalpha()


def _row(line: str, number: int, source: str) -> list[float]:
    try:
        row = [float(cell) for cell in line.split(",")]
    except ValueError:
        row = []
    if len(row) != COLUMNS or not np.all(np.isfinite(row)) or min(row) < 0.0:
        raise MeasurementError(
            f"{source}: line {number} is not a frequency and four squared gains of zero or more; copy the report again."
        )
    return row
