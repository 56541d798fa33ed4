"""Klipper's resonance test as a command: acceleration that is constant over each quarter of a rising period."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.checks import not_negative, positive
from preshape.errors import InputError

__all__ = ["Sweep"]

MOST_PULSES = 1_000_000
"""A sweep of more quarter periods than this is a mistake (Klipper's slowest and widest has 900,000)."""

_Array = NDArray[np.float64]


@dataclass(frozen=True, slots=True)
class Sweep:
    """What the toolhead is told to do in TEST_RESONANCES.

    Two quarter periods of 0.25 / f with accelerations of +a f and -a f make a half period, the next one has the
    opposite signs; after each, f grows by the rate times its duration. A slow square wave may lie over it: Klipper's
    "sweeping", whose first reversals come after sqrt(2)/8 and sqrt(2)/8 + 1/4 of its period, and then every half.

    Parameters
    ----------
    lowest, highest : float
        Frequencies at start and end [Hz] (min_freq or FREQ_START, max_freq or FREQ_END).
    rate : float
        Growth of the frequency [Hz/s] (hz_per_sec).
    acceleration_per_hertz : float
        Amplitude over frequency [mm/s^2/Hz] (accel_per_hz).
    slow_acceleration : float
        Of the slow square wave [mm/s^2] (sweeping_accel).
    slow_period : float
        Of the slow square wave [s], 0 for none (sweeping_period).

    Raises
    ------
    InputError
        If a value is out of its range.

    References
    ----------
    klippy/extras/resonance_tester.py, behaviour as of 2025.

    Examples
    --------
    >>> sweep = Sweep()
    >>> round(sweep.duration, 1)
    130.0
    """

    lowest: float = 5.0
    highest: float = 135.0
    rate: float = 1.0
    acceleration_per_hertz: float = 60.0
    slow_acceleration: float = 400.0
    slow_period: float = 0.0

    def __post_init__(self) -> None:
        positive("lowest", self.lowest, "Hz")
        positive("rate", self.rate, "Hz/s")
        positive("acceleration_per_hertz", self.acceleration_per_hertz, "mm/s^2/Hz")
        not_negative("slow_acceleration", self.slow_acceleration, "in mm/s^2")
        not_negative("slow_period", self.slow_period, "in s")
        if not (math.isfinite(self.highest) and self.highest > self.lowest):
            raise InputError(
                f"highest {self.highest!r} Hz does not lie above lowest {self.lowest:g} Hz: a sweep rises, as from 5 "
                "to 135 Hz."
            )
        if 2.0 * (self.highest**2 - self.lowest**2) / self.rate > MOST_PULSES:
            raise InputError(
                f"a sweep from {self.lowest:g} to {self.highest:g} Hz at {self.rate:g} Hz/s has more than "
                f"{MOST_PULSES:,} pulses: raise the rate or lower the end."
            )

    @property
    def duration(self) -> float:
        """About when it ends [s]."""
        return (self.highest - self.lowest) / self.rate

    def velocity(self) -> tuple[_Array, _Array]:
        """Times [s] and the commanded velocity [mm/s] at them, linear in between, shape (time,); it stays as it ends.

        The last velocity is 0 without the slow wave.
        """
        durations, accelerations = self._pulses()
        times = np.concatenate([[0.0], np.cumsum(durations)])
        velocities = np.concatenate([[0.0], np.cumsum(durations * accelerations)])
        if self.slow_period > 0.0:
            first = math.sqrt(2.0) / 8.0
            reversals = self.slow_period * np.concatenate(
                [[0.0, first], first + np.arange(0.5, times[-1] / self.slow_period + 1.0, 0.5) + first - 0.25]
            )
            signs = np.where(np.arange(reversals.size) % 2 == 0, 1.0, -1.0)
            heights = np.concatenate([[0.0], np.cumsum(np.diff(reversals) * signs[:-1])]) * self.slow_acceleration
            inside = reversals < times[-1]
            both = np.union1d(times, reversals[inside])
            velocities = np.interp(both, times, velocities) + np.interp(both, reversals, heights)
            times = both
        return times, velocities

    def _pulses(self) -> tuple[_Array, _Array]:
        """Durations [s] and accelerations [mm/s^2] of the quarter periods, shape (pulse,)."""
        frequencies = []
        frequency, step = self.lowest, 0.5 * self.rate
        while frequency <= self.highest + 1e-6:
            frequencies.append(frequency)
            frequency += step / frequency
        each = np.array(frequencies)
        signs = np.where(np.arange(each.size) % 2 == 0, 1.0, -1.0)
        heights = self.acceleration_per_hertz * each * signs
        return np.repeat(0.25 / each, 2), np.stack([heights, -heights], axis=1).ravel()

    def sampled(self, rate: float, start: float, count: int) -> _Array:
        """Mean acceleration over the sample period before each sample [mm/s^2], shape (sample,).

        Parameters
        ----------
        rate : float
            Samples per second [Hz].
        start : float
            When the sweep starts, after the first sample [s].
        count : int
            Samples.
        """
        times, velocities = self.velocity()
        edges = np.arange(-1, count) / rate - start
        return np.diff(np.interp(edges, times, velocities)) * rate
