"""Klipper spectra: `resonances_*.csv` and every variant of `calibration_data_*.csv`.

klippy/extras/shaper_calibrate.py writes them. The shaper columns are passed over: in the single-dataset files of
mainline since 2025-10 they stand on another grid than the rows. Their presence alone tells that the density has been
divided by the frequency already.
"""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from preshape.errors import MeasurementError
from preshape.identify.measurement import PrintedSpectrum, Spectrum
from preshape.identify.source_file import SourceFile
from preshape.identify.text import LONGEST_NAME, cells, check_fixed_decimals, check_increasing, parse_table
from preshape.identify.wanted import Wanted

__all__ = ["FORMAT", "read", "recognises"]

FORMAT = "Klipper spectrum"
AXES = ("psd_x", "psd_y", "psd_z")
TOTAL = "psd_xyz"
ROUNDING = 0.05
"""Frequencies are rounded to 0.1 Hz in the file, so each is wrong by at most this much [Hz]."""

ROUNDING_SLACK = 1e-6
"""Room for binary fractions in that comparison [Hz]."""

NOMINAL_WINDOW = 0.64
"""Length of Klipper's window at the nominal 3200 Hz [s], for files that were interpolated to another grid."""

FINEST_GRID = 1.0
"""Klipper's window is between 0.5 and 1 s long, so a finer spacing [Hz] than this is an interpolated grid."""

MINIMUM_ROWS = 8
_SHAPER = re.compile(
    r"(?:\w+(?:\s*\([^()]*=[^()]*\))?\s*\(\s*[\d.]+\s*(?:hz)?\s*\)|[23]hump_ei|m?zv|zvd|ei)$", re.IGNORECASE
)


def recognises(file: SourceFile) -> bool:
    """True for a file whose first line begins with a frequency column."""
    first = file.head[0].strip().lower()
    return first.startswith(("freq,", '"freq",')) or first == "freq"


def read(file: SourceFile, wanted: Wanted) -> Spectrum:
    """Read a spectrum: the density of three axes, or of several datasets."""
    source = file.name
    if wanted.sample_rate is not None:
        raise MeasurementError(f"{source}: this is a spectrum, which has no sample rate; leave sample_rate out.")
    header = cells(file.head[0])
    names = header[1:]
    shapers = next((i for i, name in enumerate(names) if name.lower() == "shapers:" or _is_shaper(name)), None)
    data = names if shapers is None else names[:shapers]
    lowered = [name.lower() for name in data]
    if any(name.startswith("psd_") for name in lowered):
        missing = [name for name in AXES if name not in lowered]
        if missing:
            raise MeasurementError(
                f"{source}: the columns {', '.join(missing)} are missing; export the spectrum again."
            )
        picked = [lowered.index(name) for name in AXES]
        channels = tuple(name.removeprefix("psd_") for name in AXES)
        scored = [lowered.index(TOTAL)] if TOTAL in lowered else []
    else:
        picked = list(range(len(data)))
        channels = tuple(data)
        scored = picked
    if not channels:
        raise MeasurementError(f"{source}: the header names no density column after 'freq'; export the spectrum again.")
    table = parse_table(file, 1, len(header), used=1 + len(data))
    check_fixed_decimals(file)
    if len(table) < MINIMUM_ROWS:
        raise MeasurementError(
            f"{source}: the spectrum has {len(table)} rows and at least {MINIMUM_ROWS} are needed; export it again."
        )
    check_increasing(table[:, 0], "frequency", 2, source)
    density = table[:, [1 + column for column in picked]].T
    if table[0, 0] < 0.0 or np.any(density < 0.0):
        row = int(np.flatnonzero((table[:, 0] < 0.0) | np.any(density < 0.0, axis=0))[0])
        raise MeasurementError(
            f"{source}: data row {row + 1} (about line {row + 2}) holds a value below zero; "
            "a spectrum has none, export it again."
        )
    frequencies = true_grid(table[:, 0])
    spacing = float(frequencies[-1] - frequencies[0]) / (len(frequencies) - 1)
    normalised = shapers is not None
    return Spectrum(
        frequencies,
        density,
        channels,
        unit="(mm/s^2)^2/Hz" if not normalised else "(mm/s^2)^2/Hz^2",
        normalised=normalised,
        window_duration=1.0 / spacing if spacing >= FINEST_GRID else NOMINAL_WINDOW,
        excitation_exponent=1.0 if normalised else 2.0,
        source=source,
        format=FORMAT,
        printed=PrintedSpectrum(table[:, 0], table[:, [1 + column for column in scored]].T) if scored else None,
    )


def _is_shaper(name: str) -> bool:
    return len(name) <= LONGEST_NAME and bool(_SHAPER.match(name))


def true_grid(rounded: NDArray[np.float64]) -> NDArray[np.float64]:
    """The uniform grid k * df behind frequencies rounded to 0.1 Hz; the input itself where no such grid exists.

    Every rounded frequency confines df to an interval; the middle of the intersection is returned.
    """
    spacing = float(rounded[-1] - rounded[0]) / (len(rounded) - 1)
    index = np.round(rounded[0] / spacing) + np.arange(len(rounded))
    known = index > 0
    low = float(np.max((rounded[known] - ROUNDING) / index[known]))
    high = float(np.min((rounded[known] + ROUNDING) / index[known]))
    if high < low - ROUNDING_SLACK or abs(rounded[0] - index[0] * spacing) > 2.0 * ROUNDING:
        return rounded
    return np.asarray(index * (0.5 * (low + high)))
