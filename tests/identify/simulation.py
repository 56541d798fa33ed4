"""Measurements made from known modes, by closed form or exact discretisation, independent of the package."""

from pathlib import Path

import numpy as np
from scipy.linalg import expm

from preshape.identify import TimeSeries

REAL = Path(__file__).resolve().parents[2].parent / "shared" / "data"


def decay(modes, amplitudes, rng, *, rate=3200.0, duration=1.0, channels=1, noise=0.01):
    """Decaying cosines of random phase with white noise; `noise` relative to an amplitude of one (0.01 = 40 dB)."""
    times = np.arange(int(duration * rate)) / rate
    values = np.zeros((channels, times.size))
    for (frequency, damping), amplitude in zip(modes, amplitudes, strict=True):
        omega = 2 * np.pi * frequency
        wave = omega * np.sqrt(1 - damping**2) * times
        for channel in range(channels):
            size = amplitude if channel == 0 else amplitude * rng.uniform(-1, 1)
            phase = rng.uniform(0, 2 * np.pi)
            values[channel] += size * np.exp(-damping * omega * times) * np.cos(wave + phase)
    values += noise * rng.normal(size=values.shape)
    return TimeSeries(rate, 0.0, values, tuple("xyz"[:channels]))


def sweep(rate=3200.0, lowest=5.0, highest=133.3, acceleration_per_hertz=75.0, hertz_per_second=1.0):
    """Klipper's resonance test (ECOSYSTEM.md 1.5): pairs of opposite acceleration steps of 0.25/f each, [mm/s^2].

    Each sample is the mean acceleration over its period, so no step between samples is lost.
    """
    times, steps = [0.0], []
    frequency, sign = lowest, 1.0
    while frequency <= highest:
        quarter = 0.25 / frequency
        for direction in (sign, -sign):
            times.append(times[-1] + quarter)
            steps.append(direction * acceleration_per_hertz * frequency)
        frequency += 2 * quarter * hertz_per_second
        sign = -sign
    velocity = np.concatenate([[0.0], np.cumsum(np.array(steps) * np.diff(times))])
    edges = np.arange(int((times[-1] + 0.3) * rate) + 1) / rate
    return np.diff(np.interp(edges, times, velocity)) * rate


def carried(base, rate, mode):
    """Acceleration of a mass on a spring and damper whose base accelerates, exact for steps held over a sample."""
    from scipy.signal import lfilter

    omega, damping = 2 * np.pi * mode[0], mode[1]
    block = np.zeros((3, 3))  # relative displacement q, its rate, and the held base acceleration
    block[0, 1] = 1.0
    block[1] = [-(omega**2), -2 * damping * omega, -1.0]
    step = expm(block / rate)
    a, b = step[:2, :2], step[:2, 2]
    output = np.array([-(omega**2), -2 * damping * omega])  # absolute acceleration of the mass
    trace, determinant = np.trace(a), np.linalg.det(a)
    numerator = [0.0, output @ b, output @ (a @ b) - trace * (output @ b)]
    return lfilter(numerator, [1.0, -trace, determinant], base)


def swept_machine(modes, gains, rng, *, rate=3200.0, noise_density=100.0):
    """A printer's sweep over a belt-driven gantry, as Klipper's raw data: x shaken, y and z a little, gravity on z."""
    base = sweep(rate)
    responses = [carried(base, rate, mode) for mode in modes]
    x = sum(gain * response for gain, response in zip(gains, responses, strict=True))
    values = np.array([x, 0.1 * responses[-1], 0.05 * responses[0]])
    values += rng.normal(size=values.shape) * np.sqrt(0.5 * noise_density * rate)
    values[2] += 9806.65
    return TimeSeries(rate, 0.0, values, ("x", "y", "z"), "mm/s^2", "", "Klipper raw data")
