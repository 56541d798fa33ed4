"""Tuning one family to measured spectra: every frequency tried at once, the best kept by Klipper's rule."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.export.klipper.scoring import (
    ACCELERATION,
    CornerMoments,
    KlipperScore,
    combined,
    maximum_acceleration,
    remaining_fraction,
)
from preshape.export.klipper.spectra import Spectrum
from preshape.shaper import Shaper

__all__ = ["KlipperFit", "Scan"]

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
    ) -> Scan:
        """The scan, over all candidates and bins at once."""
        slowest = pulses(1.0, damping)
        parts = [
            remaining_fraction(slowest, spectrum.up_to(maximum_frequency), frequencies, dampings)
            for spectrum in spectra
        ]
        smoothing = CornerMoments.of(slowest).smoothing(frequencies, ACCELERATION, square_corner_velocity)
        return cls(name, pulses, damping, square_corner_velocity, frequencies, np.max(parts, axis=0), smoothing)

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
