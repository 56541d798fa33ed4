"""Tuning one family to measured spectra: every frequency tried at once, the best kept by Klipper's rule."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.export.klipper.families import DEFAULT_DAMPING
from preshape.export.klipper.scoring import (
    ACCELERATION,
    SQUARE_CORNER_VELOCITY,
    TESTED_DAMPINGS,
    CornerMoments,
    KlipperScore,
    combined,
    maximum_acceleration,
    worst_fraction,
)
from preshape.export.klipper.spectra import MAXIMUM_FREQUENCY, SpectraLike, Spectrum, as_spectra
from preshape.shaper import Shaper

__all__ = ["KlipperFit", "Scan", "tune"]

VIBRATION_SLACK = (1.1, 0.0005)
"""A fit may leave up to this factor times the least vibration plus this [-] if that gives a better score."""


@dataclass(frozen=True)
class KlipperFit:
    """One of Klipper's families, tuned to the spectra.

    Parameters
    ----------
    name : str
        What `shaper_type` holds.
    frequency : float
        What `shaper_freq` holds [Hz].
    shaper : Shaper
        The pulses as Klipper executes them.
    score : KlipperScore
        On the spectra.
    """

    name: str
    frequency: float
    shaper: Shaper
    score: KlipperScore


def tune(
    name: str,
    pulses: Callable[[float, float], Shaper],
    spectra: SpectraLike,
    frequencies: ArrayLike,
    *,
    damping: float = DEFAULT_DAMPING,
    dampings: Iterable[float] = TESTED_DAMPINGS,
    square_corner_velocity: float = SQUARE_CORNER_VELOCITY,
    maximum_frequency: float = MAXIMUM_FREQUENCY,
    frequency_error: float = 0.0,
) -> KlipperFit:
    """Tune any single-mode family to the spectra by Klipper's rule, over frequencies of your own.

    Parameters
    ----------
    name : str
        For the result.
    pulses : callable
        (frequency [Hz], damping [-]) -> Shaper, whose times scale with 1 / frequency.
    frequencies : array_like, shape (candidate,)
        Frequencies to try [Hz], rising.
    spectra, damping, dampings, square_corner_velocity, maximum_frequency
        As for :func:`preshape.export.klipper.fit`.
    frequency_error : float
        As for :func:`preshape.export.klipper.remaining_vibration`; the result's score includes it.

    Examples
    --------
    >>> from preshape import design
    >>> frequencies = np.arange(0.05, 2.0, 0.01)
    >>> psd = 1.0 / ((1.0 - (frequencies / 0.55) ** 2) ** 2 + (0.2 * frequencies / 0.55) ** 2)
    >>> zvd = tune("zvd", lambda f, z: design.zvd((f, z)), (frequencies, psd), np.linspace(0.3, 0.9, 601))
    >>> round(zvd.frequency, 2), zvd.score.remaining_vibration < 0.01
    (0.63, True)
    """
    ratios, grid = tuple(dampings), np.asarray(frequencies, dtype=float)
    scan = Scan.of(name, pulses, grid, as_spectra(spectra), damping, ratios, square_corner_velocity, maximum_frequency)
    return scan.fit(scan.tuned())


@dataclass(frozen=True, eq=False)
class Scan:
    """One family at all its frequencies, shape (candidate,), rising."""

    name: str
    pulses: Callable[[float, float], Shaper]
    damping: float
    square_corner_velocity: float
    frequencies: NDArray[np.float64]
    vibration: NDArray[np.float64]
    smoothing: NDArray[np.float64]

    @classmethod
    def of(
        cls,
        name: str,
        pulses: Callable[[float, float], Shaper],
        frequencies: NDArray[np.float64],
        spectra: tuple[Spectrum, ...],
        damping: float,
        dampings: tuple[float, ...],
        square_corner_velocity: float,
        maximum_frequency: float,
        frequency_error: float = 0.0,
    ) -> Scan:
        """The scan, over all candidates and bins at once."""
        slowest = pulses(1.0, damping)
        heard = [spectrum.up_to(maximum_frequency) for spectrum in spectra]
        vibration = worst_fraction(slowest, heard, frequencies, dampings, frequency_error)
        smoothing = CornerMoments.of(slowest).smoothing(frequencies, ACCELERATION, square_corner_velocity)
        return cls(name, pulses, damping, square_corner_velocity, frequencies, vibration, smoothing)

    def tuned(self) -> int:
        """The candidate with the best score of those that leave nearly the least vibration."""
        factor, extra = VIBRATION_SLACK
        near = np.flatnonzero(self.vibration < self.vibration.min() * factor + extra)
        return int(near[np.argmin(combined(self.vibration[near], self.smoothing[near]))])

    def better_in_both(self, best: KlipperScore) -> int | None:
        """Of the candidates that beat `best` in vibration and in smoothing, the one that leaves the least vibration."""
        beat = (self.vibration < best.remaining_vibration) & (self.smoothing < best.smoothing)
        where = np.flatnonzero(beat)
        return int(where[np.argmin(self.vibration[where])]) if where.size else None

    def fit(self, index: int) -> KlipperFit:
        """Candidate `index` as a result."""
        frequency = float(self.frequencies[index])
        shaper = self.pulses(frequency, self.damping)
        vibration, deviation = self.vibration[index], self.smoothing[index]
        limit = maximum_acceleration(shaper, square_corner_velocity=self.square_corner_velocity)
        value = float(combined(vibration, deviation))
        return KlipperFit(self.name, frequency, shaper, KlipperScore(float(vibration), float(deviation), limit, value))
