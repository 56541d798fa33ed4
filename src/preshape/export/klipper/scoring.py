"""Klipper's three measures of a shaper (vibration left, smoothing of corners, acceleration) and their one number.

They apply to any shaper, not only to Klipper's. Note that Klipper measures the vibration at the last impulse, so a
tiny impulse added late looks like an improvement; see that a designed shaper does not owe its score to one.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.export.klipper.spectra import MAXIMUM_FREQUENCY, SpectraLike, Spectrum, as_spectra
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = [
    "TESTED_DAMPINGS",
    "CornerMoments",
    "KlipperScore",
    "combined",
    "maximum_acceleration",
    "remaining_fraction",
    "remaining_vibration",
    "score",
    "smoothing",
]

TESTED_DAMPINGS = (0.075, 0.1, 0.15)
"""The machine's damping is not known, so the worst of these ratios [-] counts."""

VIBRATION_REDUCTION = 20.0
"""Power below the highest peak divided by this is free: it counts neither before nor after shaping."""

ACCELERATION = 5000.0
"""Acceleration at which smoothing is compared [mm/s^2]."""

SQUARE_CORNER_VELOCITY = 5.0
"""Klipper's default speed through a right-angled corner [mm/s]."""

TARGET_SMOOTHING = 0.12
"""The largest smoothing that Klipper finds acceptable [mm]."""


@dataclass(frozen=True)
class KlipperScore:
    """What Klipper thinks of a shaper on some spectra.

    Parameters
    ----------
    remaining_vibration : float
        Fraction of the vibration left [-], in the worst case.
    smoothing : float
        Corner deviation [mm] at 5000 mm/s^2.
    maximum_acceleration : float
        At which the smoothing reaches its limit [mm/s^2]; infinite for a shaper of one impulse.
    value : float
        Klipper's combined score, less is better.
    """

    remaining_vibration: float
    smoothing: float
    maximum_acceleration: float
    value: float


def remaining_vibration(
    shaper: Shaper,
    spectra: SpectraLike,
    dampings: Iterable[float] = TESTED_DAMPINGS,
    *,
    maximum_frequency: float = MAXIMUM_FREQUENCY,
) -> float:
    """Fraction of the measured vibration that the shaper leaves, by Klipper's measure.

    With the threshold h = max(psd) / 20: sum max(V psd - h, 0) / sum max(psd - h, 0), the largest over the damping
    ratios and over the datasets.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    spectra : SpectraLike
        Normalised spectra (see :func:`preshape.export.klipper.normalise_to_frequencies`), any unit of power:
        (frequencies [Hz], psd) with psd of shape (frequency,) or (dataset, frequency), or a list of such pairs.
    dampings : iterable of float
        Damping ratios to try [-].
    maximum_frequency : float
        Vibration above it is not looked at [Hz].

    Returns
    -------
    float
        0 to 1 for a shaper of positive impulses.

    Raises
    ------
    InputError
        If the spectrum or a damping ratio is not usable.

    References
    ----------
    ECOSYSTEM 1.8.

    Examples
    --------
    >>> from preshape.export.klipper import zv
    >>> remaining_vibration(zv(50.0, 0.1), ([40.0, 50.0, 60.0], [0.0, 1.0, 0.0]), dampings=[0.1])
    0.0
    """
    ratios = tuple(dampings)
    return max(
        float(remaining_fraction(shaper, spectrum.up_to(maximum_frequency), np.ones(1), ratios)[0])
        for spectrum in as_spectra(spectra)
    )


def smoothing(
    shaper: Shaper,
    acceleration: float = ACCELERATION,
    square_corner_velocity: float = SQUARE_CORNER_VELOCITY,
) -> float:
    """How far the shaped path stays off a corner [mm], by Klipper's measure.

    The larger of two deviations, both at the moment when the path delayed by the shaper's centroid is in the corner:
    of a reversal (180 degrees) from full acceleration to full acceleration, and of a right angle passed at the
    square corner velocity.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    acceleration : float
        Of the move before and after the corner [mm/s^2].
    square_corner_velocity : float
        Speed in the corner of a right angle [mm/s].

    Raises
    ------
    InputError
        If the acceleration or the velocity is negative or not finite.

    References
    ----------
    ECOSYSTEM 1.8.

    Examples
    --------
    >>> from preshape.export.klipper import zv
    >>> round(smoothing(zv(86.2)), 4)
    0.027
    """
    _not_negative("acceleration", acceleration, "mm/s^2")
    _not_negative("square corner velocity", square_corner_velocity, "mm/s")
    return float(CornerMoments.of(shaper).smoothing(np.ones(1), acceleration, square_corner_velocity)[0])


def maximum_acceleration(
    shaper: Shaper,
    target_smoothing: float = TARGET_SMOOTHING,
    square_corner_velocity: float = SQUARE_CORNER_VELOCITY,
) -> float:
    """The acceleration at which :func:`smoothing` reaches its target [mm/s^2].

    Smoothing is the larger of two straight lines over acceleration, so this is exact where Klipper bisects.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    target_smoothing : float
        [mm], above zero.
    square_corner_velocity : float
        Speed in the corner of a right angle [mm/s].

    Returns
    -------
    float
        0 where the corner velocity alone exceeds the target; infinite where no acceleration does.

    Raises
    ------
    InputError
        If the target is not above zero, or the velocity is negative.

    Examples
    --------
    >>> from preshape.export.klipper import zv
    >>> round(maximum_acceleration(zv(86.2)))
    28957
    """
    if not (math.isfinite(target_smoothing) and target_smoothing > 0.0):
        raise InputError(f"target smoothing {target_smoothing:g} mm: give a deviation above 0 mm; Klipper's is 0.12.")
    _not_negative("square corner velocity", square_corner_velocity, "mm/s")
    moments = CornerMoments.of(shaper)
    left_over = target_smoothing - math.sqrt(2.0) * square_corner_velocity * moments.late_first
    if left_over < 0.0:
        return 0.0
    slopes = ((0.5 * moments.second, target_smoothing), (0.5 * math.sqrt(2.0) * moments.late_second, left_over))
    return min((room / slope for slope, room in slopes if slope > 0.0), default=math.inf)


def score(
    shaper: Shaper,
    spectra: SpectraLike,
    dampings: Iterable[float] = TESTED_DAMPINGS,
    *,
    square_corner_velocity: float = SQUARE_CORNER_VELOCITY,
    maximum_frequency: float = MAXIMUM_FREQUENCY,
) -> KlipperScore:
    """All of Klipper's measures of any shaper; parameters and errors as for :func:`remaining_vibration`.

    Examples
    --------
    >>> from preshape.export.klipper import zv
    >>> score(zv(50.0, 0.1), ([40.0, 50.0, 60.0], [0.0, 1.0, 0.0]), dampings=[0.1]).remaining_vibration
    0.0
    """
    vibration = remaining_vibration(shaper, spectra, dampings, maximum_frequency=maximum_frequency)
    deviation = smoothing(shaper, square_corner_velocity=square_corner_velocity)
    limit = maximum_acceleration(shaper, square_corner_velocity=square_corner_velocity)
    return KlipperScore(vibration, deviation, limit, combined(vibration, deviation))


Number = TypeVar("Number", float, NDArray[np.float64])


def combined(vibration: Number, deviation: Number) -> Number:
    """Klipper's one number of remaining vibration [-] and smoothing [mm], both of any shape; less is better."""
    value: Number = deviation * (vibration**1.5 + 0.2 * vibration + 0.01)
    return value


def remaining_fraction(
    shaper: Shaper, spectrum: Spectrum, frequencies: NDArray[np.float64], dampings: Sequence[float]
) -> NDArray[np.float64]:
    """Remaining vibration of `shaper` sped up by each of the factors `frequencies`, shape (factor,).

    A shaper designed for 1 Hz and sped up f times is the one for f hertz: V depends on the ratio alone, so a scan over
    frequencies is one evaluation of one shaper.
    """
    ratios = np.array(dampings, dtype=float)
    if ratios.size == 0:
        raise InputError("no damping ratio to test was given: give one or more, such as 0.1.")
    threshold = spectrum.psd.max() / VIBRATION_REDUCTION
    before = np.maximum(spectrum.psd - threshold, 0.0).sum()
    # V cannot exceed the sum of |amplitudes|: bins that cannot reach the threshold need no exponential.
    loud = spectrum.psd * shaper.magnitude > threshold
    relative = spectrum.frequencies[loud] / frequencies[:, np.newaxis]
    vibration = residual_vibration(shaper, relative[np.newaxis], ratios[:, np.newaxis, np.newaxis])
    left = np.maximum(vibration * spectrum.psd[loud] - threshold, 0.0).sum(axis=-1) / before
    worst: NDArray[np.float64] = left.max(axis=0)
    return worst


@dataclass(frozen=True)
class CornerMoments:
    """Moments of a shaper about its centroid, all that smoothing depends on.

    Parameters
    ----------
    second : float
        Sum of amplitude x distance^2 [s^2]: the reversal.
    late_first, late_second : float
        Sums of amplitude x distance [s] and x distance^2 [s^2] of the impulses after the centroid: the right angle.
    """

    second: float
    late_first: float
    late_second: float

    @classmethod
    def of(cls, shaper: Shaper) -> CornerMoments:
        """The moments of `shaper`."""
        distance, a = shaper.times - shaper.centroid, shaper.amplitudes
        late = np.maximum(distance, 0.0)
        moments = np.array([a @ distance**2, a @ late, a @ late**2])
        for box in shaper.boxes:
            start, end = box.start - shaper.centroid, box.end - shaper.centroid
            s, e = max(start, 0.0), max(end, 0.0)
            moments += box.density * np.array([(end**3 - start**3) / 3.0, (e**2 - s**2) / 2.0, (e**3 - s**3) / 3.0])
        return cls(*moments.tolist())

    def smoothing(
        self, frequencies: NDArray[np.float64], acceleration: float, square_corner_velocity: float
    ) -> NDArray[np.float64]:
        """Smoothing [mm] of the shaper sped up by each of the factors `frequencies`, shape (factor,)."""
        half = 0.5 * acceleration / frequencies**2
        corner = square_corner_velocity / frequencies * self.late_first + half * self.late_second
        return np.maximum(half * self.second, math.sqrt(2.0) * corner)


def _not_negative(name: str, value: float, unit: str) -> None:
    if not (math.isfinite(value) and value >= 0.0):
        raise InputError(f"{name} {value:g} {unit}: give a finite value, 0 {unit} or more.")
