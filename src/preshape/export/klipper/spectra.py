"""What Klipper's scoring takes: one or several normalised spectra, checked once at the border."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError

__all__ = ["MAXIMUM_FREQUENCY", "SpectraLike", "Spectrum", "as_spectra", "datasets"]

MAXIMUM_FREQUENCY = 200.0
"""Klipper does not look at vibration above this frequency [Hz]."""


@dataclass(frozen=True, eq=False)
class Spectrum:
    """One dataset: the vibration's power over frequency.

    Parameters
    ----------
    frequencies : array_like, shape (frequency,)
        [Hz], increasing, 0 or more.
    psd : array_like, shape (frequency,)
        Power [any unit], 0 or more, not all zero. For Klipper's numbers: the sum over x, y and z, normalised once by
        :func:`preshape.export.klipper.normalise_to_frequencies`.

    Raises
    ------
    InputError
        If the two do not obey these rules.
    """

    frequencies: NDArray[np.float64]
    psd: NDArray[np.float64]

    def __init__(self, frequencies: ArrayLike, psd: ArrayLike) -> None:
        f, p = _numbers("frequencies", frequencies), _numbers("psd", psd)
        if f.ndim != 1 or f.size == 0 or p.shape != f.shape:
            raise InputError(
                f"a spectrum with frequencies of shape {f.shape} and psd of shape {p.shape}: "
                "give two flat lists of the same length."
            )
        if (f < 0.0).any() or (np.diff(f) <= 0.0).any():
            raise InputError(
                "the spectrum's frequencies must increase from 0 Hz or more: sort them, drop repeated ones."
            )
        if (p < 0.0).any():
            raise InputError(f"the psd is negative at {f[np.argmin(p)]:g} Hz: give power, not decibels.")
        if not p.any():
            raise InputError(
                "the psd is zero at every frequency: there is no vibration in it; check the sensor's column."
            )
        f.flags.writeable = p.flags.writeable = False
        object.__setattr__(self, "frequencies", f)
        object.__setattr__(self, "psd", p)

    def up_to(self, maximum_frequency: float) -> Spectrum:
        """The part at and below `maximum_frequency` [Hz]; InputError if nothing vibrates there."""
        if not maximum_frequency > 0.0:
            raise InputError(f"maximum frequency {maximum_frequency:g} Hz: give a frequency above 0 Hz.")
        keep = self.frequencies <= maximum_frequency
        if keep.all():
            return self
        if not self.psd[keep].any():
            raise InputError(
                f"the spectrum holds no vibration at or below {maximum_frequency:g} Hz: raise the maximum frequency."
            )
        return Spectrum(self.frequencies[keep], self.psd[keep])


SpectraLike: TypeAlias = "Spectrum | tuple[ArrayLike, ArrayLike] | Iterable[Spectrum | tuple[ArrayLike, ArrayLike]]"
"""A Spectrum, a (frequencies, psd) pair whose psd may have shape (dataset, frequency), or several of these."""


def as_spectra(spectra: SpectraLike) -> tuple[Spectrum, ...]:
    """Every dataset of `spectra`, checked.

    Parameters
    ----------
    spectra : SpectraLike
        A Spectrum; a tuple (frequencies, psd) with psd of shape (frequency,) or (dataset, frequency); or several.

    Raises
    ------
    InputError
        If there is none, or one is not a spectrum.
    """
    if isinstance(spectra, Spectrum):
        return (spectra,)
    if isinstance(spectra, tuple) and len(spectra) == 2 and _is_vector(spectra[0]):
        found = list(datasets(*cast("tuple[ArrayLike, ArrayLike]", spectra)))
    elif isinstance(spectra, str | bytes) or not isinstance(spectra, Iterable):
        raise InputError(f"{spectra!r} is not a spectrum: give a pair (frequencies [Hz], psd), or a list of pairs.")
    else:
        found = []
        for item in spectra:
            if not isinstance(item, Spectrum) and not (isinstance(item, tuple) and len(item) == 2):
                raise InputError(
                    f"an item of type {type(item).__name__} is not a spectrum: give a tuple (frequencies [Hz], psd)."
                )
            found.extend(as_spectra(item))
    if not found:
        raise InputError("no spectrum was given: give a pair (frequencies [Hz], psd), or a list of pairs.")
    return tuple(found)


def datasets(frequencies: ArrayLike, psd: ArrayLike) -> tuple[Spectrum, ...]:
    """One spectrum for each row of `psd`, shape (frequency,) or (dataset, frequency); InputError as for Spectrum."""
    rows = _numbers("psd", psd)
    if rows.ndim == 2 and rows.shape[0] == 0:
        raise InputError("the psd has no dataset: give an array of shape (dataset, frequency) with at least one row.")
    return tuple(Spectrum(frequencies, row) for row in (rows if rows.ndim == 2 else [rows]))


def _is_vector(values: object) -> bool:
    """Whether these are a flat list of numbers, and not a Spectrum or a pair."""
    try:
        return np.asarray(values, dtype=float).ndim == 1
    except (TypeError, ValueError):
        return False


def _numbers(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """A copy of `values` as finite floats, or a clear refusal."""
    try:
        array = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"the {name} of a spectrum must be numbers in rows of equal length.") from None
    if not np.isfinite(array).all():
        raise InputError(f"the {name} of a spectrum hold NaN or infinity: drop those lines of the measurement.")
    return array
