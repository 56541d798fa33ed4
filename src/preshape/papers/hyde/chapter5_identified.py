"""Hyde, section 5.3.2: frequencies of the non-linear MACE model from white noise, as he did it and by `identify`."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from preshape.identify import IdentifiedMode, TimeSeries, operational_modes, ring_down
from preshape.mode import Mode
from preshape.plant.mace import CALIBRATED_GAINS, Mace

__all__ = ["Averaged", "Spectra", "article", "at_work", "averaged_spectrum", "closed_loop", "open_loop", "rung_down"]

DT = 2e-3
"""Of the noise and the simulation [s]."""

NOISE = 0.05
"""Standard deviation of the torque, at the gimbal and in the attitude unit [N m]."""

SENSORS = ("left sensor", "right sensor")

LISTED = (1.2, 22.0)
"""Where peaks are looked for [Hz]: above the loops' own slow modes, a little beyond Hyde's highest."""

PROMINENT = 2.0
"""A peak counts when it stands out of its surroundings by this factor; the mean of forty amplitudes scatters by 8 %."""

SMALL = 0.02
"""Peaks below this part of the highest, of the velocity's amplitude, are not read from a spectrum by eye."""

SHAKEN, FREE = 3.0, 6.0
"""Noise, and then none [s], for `identify`."""

SAME = 0.05
"""Modes nearer than this part of their frequency are one, which moves with the payload."""

LIGHT = 0.15
"""What is damped more does not show."""

SMOOTHED = 0.25
"""Width [Hz] over which a spectrum finer than that is averaged before its peaks are read."""

DECIMATED = 10
"""Samples put into one before modes are fitted: they end at 20 Hz, the samples at 250."""


@dataclass(frozen=True, eq=False)
class Averaged:
    """Amplitude spectra averaged over runs and sensors.

    Attributes
    ----------
    frequencies : ndarray, shape (frequency,)
        [Hz].
    amplitude : ndarray, shape (frequency,)
        Of the sensors' velocity [m], mean over runs and sensors.
    peaks : tuple of float
        Where it stands out [Hz].
    velocities : ndarray, shape (sensor, sample)
        What was averaged, run after run, each from rest [m/s].
    """

    frequencies: NDArray[np.float64]
    amplitude: NDArray[np.float64]
    peaks: tuple[float, ...]
    velocities: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Spectra:
    """One configuration: Hyde's spectra, modes fitted to free vibration, and to the shaken records themselves."""

    plant: Mace
    averaged: Averaged
    rung: tuple[Mode, ...]
    working: tuple[IdentifiedMode, ...]


@cache
def open_loop() -> Spectra:
    """Payloads vertical, gains zero, six 30 s runs: "several"."""
    return _seen(article(), 6, 30.0, seed=51)


@cache
def closed_loop(angle: float) -> Spectra:
    """At a payload angle [deg], twenty 6 s runs."""
    return _seen(article(angle), 20, 6.0, seed=52)


def article(angle: float | None = None) -> Mace:
    """The model with both loops closed and the payload at an angle [deg]; without one, vertical and with open loops.

    One element a strut: its frequencies up to 20 Hz are those of finer ones to 2e-4.
    """
    if angle is None:
        return Mace(elements=1)
    return Mace(CALIBRATED_GAINS, angle=math.radians(angle), elements=1)


def averaged_spectrum(plant: Mace, runs: int, duration: float, *, seed: int) -> Averaged:
    """White torques into gimbal and attitude unit from rest, and the mean of the sensors' amplitude spectra.

    Parameters
    ----------
    plant : Mace
    runs : int
    duration : float
        Of each [s].
    seed : int
        Of the noise.
    """
    generator = np.random.default_rng(seed)
    count = round(duration / DT)
    window = np.hanning(count)
    total = np.zeros(count // 2 + 1)
    velocities: list[NDArray[np.float64]] = []
    for _ in range(runs):
        outputs = plant.simulate(_command(plant, NOISE * generator.standard_normal((2, count))), DT, step=DT).outputs
        velocities.append(np.array([np.gradient(outputs[name], DT) for name in SENSORS]))
        total += np.abs(np.fft.rfft(window * velocities[-1], axis=-1)).sum(axis=0)
    frequencies = np.fft.rfftfreq(count, DT).astype(float)
    width = max(1, round(SMOOTHED * duration / 2.0) * 2 - 1) if duration > 10.0 else 1
    mean = total * DT / (runs * len(SENSORS))
    amplitude = np.convolve(mean, np.full(width, 1.0 / width), mode="same").astype(float)
    return Averaged(frequencies, amplitude, _peaks(frequencies, amplitude), np.concatenate(velocities, axis=-1))


def at_work(averaged: Averaged) -> tuple[IdentifiedMode, ...]:
    """Modes of the shaken records, both sensors together, the slowest first.

    The runs are joined: covariances reach over a fraction of a second, so a few seams in minutes do not matter.
    """
    from scipy.signal import decimate

    values = decimate(averaged.velocities, DECIMATED, axis=-1)
    found = operational_modes(TimeSeries(1.0 / (DT * DECIMATED), 0.0, values, SENSORS, "m/s"), maximum=8)
    kept = [each for each in found.modes if LISTED[0] < each.mode.frequency < LISTED[1] and each.mode.damping < LIGHT]
    return tuple(sorted(kept, key=lambda each: each.mode.frequency))


@cache
def rung_down(plant: Mace, *, seed: int = 53) -> tuple[Mode, ...]:
    """Modes of the free vibration after three seconds of the same noise, the slowest first."""
    from scipy.signal import decimate

    shaken, free = round(SHAKEN / DT), round(FREE / DT)
    noise = np.zeros((2, shaken + free))
    noise[:, :shaken] = NOISE * np.random.default_rng(seed).standard_normal((2, shaken))
    outputs = plant.simulate(_command(plant, noise), DT, step=DT).outputs
    rates = np.array([decimate(np.gradient(outputs[name], DT)[shaken:], DECIMATED) for name in SENSORS])
    rates /= np.abs(rates).max(axis=1, keepdims=True)
    found = ring_down(TimeSeries(1.0 / (DT * DECIMATED), 0.0, rates, SENSORS), maximum=6)
    kept: list[Mode] = []
    for mode in (each.mode for each in found.modes):  # the strongest first
        apart = all(abs(mode.frequency / other.frequency - 1.0) > SAME for other in kept)
        if LISTED[0] < mode.frequency < LISTED[1] and mode.damping < LIGHT and apart:
            kept.append(mode)
    return tuple(sorted(kept, key=lambda mode: mode.frequency))


def _seen(plant: Mace, runs: int, duration: float, *, seed: int) -> Spectra:
    averaged = averaged_spectrum(plant, runs, duration, seed=seed)
    return Spectra(plant, averaged, rung_down(plant), at_work(averaged))


def _command(plant: Mace, torques: NDArray[np.float64]) -> NDArray[np.float64]:
    if plant.gains is None:
        return torques
    return np.vstack([np.full(torques.shape[1], plant.angle), torques])


def _peaks(frequencies: NDArray[np.float64], amplitude: NDArray[np.float64]) -> tuple[float, ...]:
    """Where the amplitude stands out, between the bins by the parabola through the logarithms of three."""
    from scipy.signal import find_peaks

    logs = np.log(np.maximum(amplitude, 1e-300))
    inside = (frequencies > LISTED[0]) & (frequencies < LISTED[1])
    high = logs > logs[inside].max() + math.log(SMALL)
    places, _ = find_peaks(logs, prominence=math.log(PROMINENT))
    found = []
    for k in places[inside[places] & high[places]]:
        before, at, after = logs[k - 1 : k + 2]
        shift = 0.5 * (before - after) / (before - 2.0 * at + after)
        found.append(float(frequencies[k] + shift * (frequencies[1] - frequencies[0])))
    return tuple(found)
