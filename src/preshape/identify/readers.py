"""The list of file formats, and the reader that chooses among them by content."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Protocol

import numpy as np

from preshape.errors import InputError, MeasurementError
from preshape.identify import (
    generic_csv,
    klipper_raw,
    klipper_spectrum,
    matlab,
    numpy_arrays,
    prusa_sweep,
    rrf_capture,
    shaketune,
    universal_file,
    wav,
)
from preshape.identify.measurement import Measurement, TimeSeries
from preshape.identify.sensor_checks import sensor_trouble
from preshape.identify.source_file import SourceFile, open_source, source_in_memory
from preshape.identify.text import printable
from preshape.identify.wanted import Wanted

__all__ = ["READERS", "Reader", "read", "read_bytes"]


class Reader(Protocol):
    """What a file format's module offers."""

    FORMAT: str

    def recognises(self, file: SourceFile, /) -> bool:
        """Whether a file is of this format; looks at `file.begin`, or at `file.head` if the format is text."""

    def read(self, file: SourceFile, wanted: Wanted, /) -> Measurement:
        """The measurement in the file; raises MeasurementError."""


READERS: tuple[Reader, ...] = (
    shaketune,
    numpy_arrays,
    matlab,
    wav,
    universal_file,  # binary until here; `file.head` says so of what is not text
    klipper_raw,
    prusa_sweep,
    klipper_spectrum,
    rrf_capture,
    generic_csv,
)
"""The formats, the most particular first. To add one: write its module, and put it in here."""

CONTAINERS: tuple[Reader, ...] = (shaketune, numpy_arrays, matlab, universal_file)
"""Those whose files may hold several measurements."""


def read(path: str | os.PathLike[str], *, sample_rate: float | None = None, part: str | None = None) -> Measurement:
    """Read a vibration measurement; the content decides on the format, not the name.

    Known are Klipper's raw data, its resonances and calibration data, Shake&Tune's .stdata, RepRapFirmware's captures,
    Prusa's M958 report, universal files (dataset 58), NumPy and MATLAB arrays, WAV, and tables with a time column or a
    known sample rate. The reference page on measurement files says what each must hold.

    Parameters
    ----------
    path : str or path-like
        The file.
    sample_rate : float, optional
        Samples per second [Hz], for a table without a time column.
    part : str, optional
        Name of the measurement, or its beginning, for a file that holds several.

    Returns
    -------
    TimeSeries or Spectrum
        What the file holds; `remarks` says what is wrong with it: missing samples, a clipped sensor, a wrong unit,
        aliasing.

    Raises
    ------
    MeasurementError
        If the file cannot be read as a measurement; one sentence says where and why.
    InputError
        If `sample_rate` is not a rate.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "bump.csv"
    >>> _ = path.write_text("time,x [g]\\n0.000,0.0\\n0.001,0.5\\n0.002,0.1\\n")
    >>> read(path).sample_rate
    1000.0
    """
    _check_rate(sample_rate)
    return _measurement(open_source(path), Wanted(sample_rate, part))


def read_bytes(content: bytes, name: str, *, sample_rate: float | None = None, part: str | None = None) -> Measurement:
    """Read a measurement from the bytes of a file, in memory; everything else as :func:`read`.

    Parameters
    ----------
    content : bytes
        What the file holds.
    name : str
        What messages call it.
    sample_rate, part
        As for :func:`read`.

    Examples
    --------
    >>> read_bytes(b"time,x [g]\\n0.000,0.0\\n0.001,0.5\\n0.002,0.1\\n", "bump.csv").sample_rate
    1000.0
    """
    _check_rate(sample_rate)
    return _measurement(source_in_memory(content, name), Wanted(sample_rate, part))


def _check_rate(sample_rate: float | None) -> None:
    if sample_rate is not None and not (np.isfinite(sample_rate) and sample_rate > 0.0):
        raise InputError(f"sample_rate {sample_rate!r} Hz is not usable: give a finite rate above 0 Hz.")


def _measurement(file: SourceFile, wanted: Wanted) -> Measurement:
    for reader in READERS:
        if reader.recognises(file):
            # Absurd numbers overflow on the way; what they come to is refused, so no warning is needed.
            with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
                measurement = _read(reader, file, wanted)
                found = sensor_trouble(measurement) if isinstance(measurement, TimeSeries) else ()
            return replace(measurement, remarks=(*measurement.remarks, *found)) if found else measurement
    _check_lines(file)
    known = ", ".join(reader.FORMAT for reader in READERS)
    raise MeasurementError(
        f"{file.name}: the first line {printable(file.head[0].strip()[:40])!r} is not that of a known measurement "
        f"({known}); check the file."
    )


def _read(reader: Reader, file: SourceFile, wanted: Wanted) -> Measurement:
    if reader not in CONTAINERS:
        if reader is not wav:
            _check_lines(file)
        if wanted.part is not None:
            raise MeasurementError(
                f"{file.name}: part={wanted.part!r} was given, but this file ({reader.FORMAT}) holds one measurement; "
                "leave part out."
            )
    try:
        return reader.read(file, wanted)
    except MeasurementError:
        raise
    except InputError as error:  # what a measurement refuses, said of the file
        raise MeasurementError(f"{file.name}: {error}") from None


def _check_lines(file: SourceFile) -> None:
    """Raise when a text file has a single line."""
    if file.size <= len(file.begin) and sum(1 for line in file.head if line.strip()) < 2:
        raise MeasurementError(f"{file.name}: the file has only one line; a measurement needs many, record it again.")
