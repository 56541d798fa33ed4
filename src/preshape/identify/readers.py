"""The list of file formats, and the reader that chooses among them by content."""

from __future__ import annotations

import os
from typing import Protocol

import numpy as np

from preshape.errors import InputError, MeasurementError
from preshape.identify import generic_csv, klipper_raw, klipper_spectrum, rrf_capture
from preshape.identify.measurement import Measurement
from preshape.identify.text import load_text

__all__ = ["READERS", "Reader", "read"]


class Reader(Protocol):
    """What a file format's module offers."""

    FORMAT: str

    def recognises(self, lines: list[str], /) -> bool:
        """Whether a file that begins with these lines (at least one, not blank) is of this format."""

    def read(self, lines: list[str], source: str, sample_rate: float | None, /) -> Measurement:
        """The measurement in these lines; raises MeasurementError."""


READERS: tuple[Reader, ...] = (klipper_raw, klipper_spectrum, rrf_capture, generic_csv)
"""The formats, the most particular first. To add one: write its module, and put it in here."""


def read(path: str | os.PathLike[str], *, sample_rate: float | None = None) -> Measurement:
    """Read a vibration measurement; the content decides on the format, not the name.

    Known are Klipper's raw data, its resonances and calibration data, RepRapFirmware's captures, and tables with a time
    column or a known sample rate.

    Parameters
    ----------
    path : str or path-like
        The file.
    sample_rate : float, optional
        Samples per second [Hz], for a table without a time column.

    Returns
    -------
    TimeSeries or Spectrum
        What the file holds.

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
    if sample_rate is not None and not (np.isfinite(sample_rate) and sample_rate > 0.0):
        raise InputError(f"sample_rate {sample_rate!r} Hz is not usable: give a finite rate above 0 Hz.")
    source = os.fspath(path)
    # split("\n"), not splitlines(): line numbers must be those an editor shows.
    lines = load_text(path).replace("\r\n", "\n").replace("\r", "\n").split("\n")
    for reader in READERS:
        if reader.recognises(lines):
            if sum(1 for line in lines[:8] if line.strip()) < 2:
                raise MeasurementError(
                    f"{source}: the file has only one line; a measurement needs many, record it again."
                )
            try:
                return reader.read(lines, source, sample_rate)
            except MeasurementError:
                raise
            except InputError as error:  # what a measurement refuses, said of the file
                raise MeasurementError(f"{source}: {error}") from None
    if sum(1 for line in lines if line.strip()) < 2:
        raise MeasurementError(f"{source}: the file has only one line; a measurement needs many, record it again.")
    known = ", ".join(reader.FORMAT for reader in READERS)
    raise MeasurementError(
        f"{source}: the first line {lines[0].strip()[:40]!r} is not that of a known measurement "
        f"({known}); check the file."
    )
