"""Klipper's measures of an impulse sequence together with their derivatives, for an optimiser to work on.

The formulas are those of :mod:`preshape.export.klipper.scoring`, written once more for times and amplitudes that move;
every result of an optimiser is scored by that module, which knows nothing of this one.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from preshape.export.klipper.scoring import (
    ACCELERATION,
    SQUARE_CORNER_VELOCITY,
    TARGET_SMOOTHING,
    TESTED_DAMPINGS,
    VIBRATION_REDUCTION,
)
from preshape.export.klipper.spectra import MAXIMUM_FREQUENCY, Spectrum

__all__ = ["Moving", "VibrationMeasure", "corner_deviations", "slownesses"]

Vector = NDArray[np.float64]

TINY = 1e-300
ROOM_FOR_ACCELERATION = 1e-3
"""Of the target smoothing, what is left for acceleration at least; a shaper that needs more is scored as very slow."""


@dataclass(frozen=True, eq=False)
class Moving:
    """Quantities of a shaper and how they change with it.

    Parameters
    ----------
    values : ndarray, shape (quantity,)
        In the units of what they measure.
    by_time, by_amplitude : ndarray, shape (quantity, impulse)
        Derivatives with respect to the times [1/s] and to the amplitudes.
    """

    values: Vector
    by_time: Vector
    by_amplitude: Vector


@dataclass(frozen=True, eq=False)
class VibrationMeasure:
    """What remains of measured vibration: one quantity a dataset and damping ratio.

    Parameters
    ----------
    rates : ndarray of complex, shape (bin,)
        s = z w + i w sqrt(1 - z^2) [1/s] of each bin above the threshold, dataset by dataset, ratio by ratio.
    weights, free : ndarray, shape (bin,)
        Power and threshold, relative to the vibration before shaping [-].
    starts : ndarray of int, shape (quantity,)
        First bin of each quantity.
    """

    rates: NDArray[np.complex128]
    weights: Vector
    free: Vector
    starts: NDArray[np.intp]

    @classmethod
    def of(cls, spectra: Sequence[Spectrum], dampings: Sequence[float] = TESTED_DAMPINGS) -> VibrationMeasure:
        """The measure on spectra; the worst of its quantities is Klipper's number."""
        rates, weights, free, sizes = [], [], [], []
        for whole in spectra:
            spectrum = whole.up_to(MAXIMUM_FREQUENCY)
            threshold = spectrum.psd.max() / VIBRATION_REDUCTION
            before = np.maximum(spectrum.psd - threshold, 0.0).sum()
            loud = spectrum.psd > threshold  # V of a positive shaper is at most 1: the others never count
            omega = 2.0 * math.pi * spectrum.frequencies[loud]
            for z in dampings:
                rates.append(omega * complex(z, math.sqrt(1.0 - z * z)))
                weights.append(spectrum.psd[loud] / before)
                free.append(np.full(omega.size, threshold / before))
                sizes.append(omega.size)
        starts = np.concatenate([[0], np.cumsum(sizes)[:-1]]).astype(np.intp)
        return cls(np.concatenate(rates), np.concatenate(weights), np.concatenate(free), starts)

    def stricter(self, margin: float) -> VibrationMeasure:
        """The same with a threshold that is lower by this fraction."""
        return replace(self, free=self.free * (1.0 - margin))

    def left(self, times: Vector, amplitudes: Vector) -> Moving:
        """The fraction left [-], measured at the last impulse."""
        early = np.minimum(times - times[-1], 0.0)  # an optimiser may try times out of order: nothing overflows
        decayed = np.exp(np.multiply.outer(self.rates, early))
        phasor = decayed @ amplitudes
        size = np.abs(phasor)
        over = size * self.weights - self.free
        counts = over > 0.0
        unit = np.where(counts, self.weights, 0.0) * np.conj(phasor) / np.maximum(size, TINY)
        by_amplitude = np.real(unit[:, np.newaxis] * decayed)
        by_time = np.real((unit * self.rates)[:, np.newaxis] * decayed * amplitudes)
        by_time[:, -1] -= by_time.sum(axis=1)  # the last impulse also moves the moment that counts
        return Moving(
            np.add.reduceat(np.where(counts, over, 0.0), self.starts),
            np.add.reduceat(by_time, self.starts),
            np.add.reduceat(by_amplitude, self.starts),
        )


def corner_deviations(times: Vector, amplitudes: Vector) -> Moving:
    """The two deviations of which smoothing is the larger [mm]: of a reversal, and of a right angle."""
    moments = _moments(times, amplitudes)
    half = 0.5 * ACCELERATION
    corner = math.sqrt(2.0) * np.array([0.0, SQUARE_CORNER_VELOCITY, half])
    return _combined(moments, np.array([[half, 0.0, 0.0], corner]))


def slownesses(times: Vector, amplitudes: Vector) -> Moving:
    """The reciprocals of the two accelerations [s^2/mm] that reach the target smoothing; the larger one limits."""
    moments = _moments(times, amplitudes)
    speed = math.sqrt(2.0) * SQUARE_CORNER_VELOCITY
    floor = ROOM_FOR_ACCELERATION * TARGET_SMOOTHING
    room = max(TARGET_SMOOTHING - speed * float(moments.values[1]), floor)
    late = 0.5 * math.sqrt(2.0) / room
    steeper = late * float(moments.values[2]) / room * speed if room > floor else 0.0
    values = np.array([0.5 * moments.values[0] / TARGET_SMOOTHING, late * moments.values[2]])
    slopes = np.array([[0.5 / TARGET_SMOOTHING, 0.0, 0.0], [0.0, steeper, late]])
    return Moving(values, slopes @ moments.by_time, slopes @ moments.by_amplitude)


def _combined(moments: Moving, weights: Vector) -> Moving:
    return Moving(weights @ moments.values, weights @ moments.by_time, weights @ moments.by_amplitude)


def _moments(times: Vector, a: Vector) -> Moving:
    """Second moment, and first and second moment after the centroid, of amplitudes that sum to 1."""
    distance = times - a @ times
    late = np.maximum(distance, 0.0)
    after = (distance > 0.0).astype(float)
    off, mass, first = float(a @ distance), float(a @ after), float(a @ late)
    values = np.array([a @ distance**2, first, a @ late**2])
    by_amplitude = np.array([distance**2 - 2.0 * off * times, late - mass * times, late**2 - 2.0 * first * times])
    by_time = a * np.array([2.0 * (distance - off), after - mass, 2.0 * (late - first)])
    return Moving(values, by_time, by_amplitude)
