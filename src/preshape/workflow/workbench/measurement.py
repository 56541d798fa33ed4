"""A dropped file, from its bytes to the spectrum that is drawn and the modes in it; it is never on a disk."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape import identify
from preshape.errors import InputError, MeasurementError
from preshape.identify import IdentifiedMode
from preshape.workflow.workbench.state import MOST_MODES

__all__ = ["LARGEST_FILE", "Measured", "measured"]

LARGEST_FILE = identify.MAXIMUM_FILE_SIZE
"""Bytes of a file that are read unless the caller allows fewer."""

MOST_DRAWN = 2000
"""Points of a spectrum that are drawn; a longer one shows the largest of each stretch, so that no peak is lost."""

LONGEST_NAME = 80

MOST_FOUND = 4
"""Modes that are looked for, unless asked otherwise."""


@dataclass(frozen=True, eq=False)
class Measured:
    """What a file holds.

    Parameters
    ----------
    name, format : str
        Of the file.
    frequencies : ndarray, shape (frequency,)
        [Hz], increasing.
    density : ndarray, shape (frequency,)
        Power spectral density, summed over the channels, in `unit`.
    fitted : ndarray, shape (frequency,)
        The modes' own curve in the same unit; NaN outside the band that was fitted.
    unit : str
        Of both; empty when the file does not say.
    modes : tuple of IdentifiedMode
        The strongest first, with their 95 % intervals.
    method : str
        How they were found.
    clear : bool
        False when they should not be trusted.
    trouble : tuple of str
        Sentences on what is wrong with the measurement or the machine.
    """

    name: str
    format: str
    frequencies: NDArray[np.float64]
    density: NDArray[np.float64]
    fitted: NDArray[np.float64]
    unit: str
    modes: tuple[IdentifiedMode, ...]
    method: str
    clear: bool
    trouble: tuple[str, ...]


def measured(
    content: bytes,
    name: str,
    *,
    sample_rate: float | None = None,
    part: str | None = None,
    damping: float | None = None,
    maximum: int = MOST_FOUND,
    largest: int = LARGEST_FILE,
) -> Measured:
    """Read a measurement from memory and find its modes.

    Parameters
    ----------
    content : bytes
        The file; any format that :func:`preshape.identify.read` knows.
    name : str
        What it is called, for messages only.
    sample_rate : float, optional
        Samples per second [Hz], for a table without a time column.
    part : str, optional
        Name of the measurement, or its beginning, for a file that holds several.
    damping : float, optional
        Damping ratio [-] of all modes, if known better than the measurement shows it.
    maximum : int
        Most modes to find, up to the twelve of a workbench.
    largest : int
        Bytes that are taken.

    Raises
    ------
    MeasurementError
        If the file is too large, cannot be read as a measurement, or holds nothing that can be identified.
    InputError
        If an option is out of range.

    Examples
    --------
    >>> times = np.arange(1000) / 1000.0
    >>> decay = np.exp(-8.0 * times) * np.sin(2 * np.pi * 30.0 * times)
    >>> rows = "".join(f"{t:.3f},{x:.9f}\\n" for t, x in zip(times, decay))
    >>> found = measured(("time,x [g]\\n" + rows).encode(), "bump.csv")
    >>> round(found.modes[0].mode.frequency, 2)
    30.03
    """
    called = _plain(name)
    if len(content) > largest:
        raise MeasurementError(
            f"{called}: the file has {len(content) / 1e6:.4g} MB and the limit is {largest / 1e6:.4g} MB; cut the part "
            "that holds the vibration."
        )
    if not 1 <= maximum <= MOST_MODES:
        raise InputError(f"maximum is {maximum}: give 1 to {MOST_MODES} modes.")
    try:
        measurement = identify.read_bytes(content, called, sample_rate=sample_rate, part=part)
        found = identify.find_modes(measurement, damping=damping, maximum=maximum)
    except MemoryError:
        raise MeasurementError(
            f"{called}: the file does not fit into memory; cut the part that holds the vibration."
        ) from None
    spectrum = found.spectrum
    frequencies, rows = _thinned(spectrum.frequencies, np.array([spectrum.total, found.fitted]))
    return Measured(
        name=called,
        format=measurement.format,
        frequencies=frequencies,
        density=rows[0],
        fitted=rows[1],
        unit=spectrum.unit,
        modes=found.modes,
        method=found.method,
        clear=found.clear,
        trouble=tuple(dict.fromkeys((*measurement.remarks, *found.trouble))),
    )


def _plain(name: str) -> str:
    """The last part of a file's name, as far as it can be shown."""
    last = name.replace("\\", "/").rsplit("/", 1)[-1]
    shown = "".join(letter for letter in last if letter.isprintable())[:LONGEST_NAME]
    return shown or "the file"


def _thinned(
    frequencies: NDArray[np.float64], rows: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The largest value of the first row in each stretch, with its frequency, and the other rows there."""
    size = -(-frequencies.size // MOST_DRAWN)
    if size == 1:
        return frequencies, rows
    starts = np.arange(0, frequencies.size, size)
    places = np.array([start + int(np.argmax(rows[0, start : start + size])) for start in starts])
    return frequencies[places], rows[:, places]
