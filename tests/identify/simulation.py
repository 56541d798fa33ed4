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


def sweep_velocity(lowest, highest, acceleration_per_hertz, hertz_per_second, slow=None):
    """Times and velocities of the commanded sweep, pulse by pulse; `slow` (acceleration, period) lies over it."""
    times, velocities, frequency, sign = [0.0], [0.0], lowest, 1.0
    reverse, level, fraction = (np.inf, 0.0, 0.0) if slow is None else (slow[1] * np.sqrt(2) / 8, slow[0], None)
    while frequency <= highest:
        for direction in (sign, -sign):
            end = times[-1] + 0.25 / frequency
            acceleration = direction * acceleration_per_hertz * frequency
            while reverse <= end:
                velocities.append(velocities[-1] + (acceleration + level) * (reverse - times[-1]))
                times.append(reverse)
                fraction = np.sqrt(2) / 8 + 0.25 if fraction is None else 0.5
                reverse, level = reverse + fraction * slow[1], -level
            velocities.append(velocities[-1] + (acceleration + level) * (end - times[-1]))
            times.append(end)
        frequency += 0.5 / frequency * hertz_per_second
        sign = -sign
    return np.array(times), np.array(velocities)


def clean_record(
    modes, gains, *, rate=3200.0, start=0.37, drift=2e-5, wobble=5e-5, lowest=5.0, highest=133.3, speed=1.0, slow=None
):
    """As `swept_machine` without noise: unknown start, an accelerometer's clock that is fast and wanders [s]."""
    times, velocities = sweep_velocity(lowest, highest, 75.0, speed, slow)
    duration = times[-1] + start + 0.5
    ticks = np.arange(-1, int(duration * rate)) / rate
    edges = ticks * (1.0 + drift) + wobble * np.sin(np.pi * ticks / duration)
    base = np.diff(np.interp(edges - start, times, velocities)) / np.diff(edges)
    responses = [carried(base, rate, mode) for mode in modes]
    x = sum(gain * response for gain, response in zip(gains, responses, strict=True))
    return np.array([x, 0.1 * responses[-1], 0.05 * responses[0]])


def noisy(clean, rng, *, rate=3200.0, noise_density=100.0, quantum=38.0, remarks=()):
    """Klipper's raw data of it: white noise, the ADXL345's steps of 4 mg, gravity on z."""
    values = clean + rng.normal(size=clean.shape) * np.sqrt(0.5 * noise_density * rate)
    values[2] += 9806.65
    values = quantum * np.round(values / quantum)
    return TimeSeries(rate, 0.0, values, ("x", "y", "z"), "mm/s^2", "", "Klipper raw data", remarks)


def working(modes, shapes, rng, *, rate=50.0, samples=30_000, noise=0.05):
    """Velocities (channel, sample) of modes that white forces shake, two of them, exact for forces held over a sample.

    `shapes` (channel, mode) are also how the first two channels' forces act on the modes; noise relative to each
    channel's deviation.
    """
    from scipy.signal import lfilter

    forces = shapes[:2].T @ rng.normal(size=(2, samples))
    values = np.zeros((len(shapes), samples))
    for (frequency, damping), shape, force in zip(modes, shapes.T, forces, strict=True):
        omega = 2 * np.pi * frequency
        block = np.array([[0.0, 1.0, 0.0], [-(omega**2), -2 * damping * omega, 1.0], [0.0, 0.0, 0.0]])
        step = expm(block / rate)
        a, b = step[:2, :2], step[:2, 2]
        trace, determinant = np.trace(a), np.linalg.det(a)
        numerator = [0.0, b[1], (a @ b)[1] - trace * b[1]]
        values += np.outer(shape, lfilter(numerator, [1.0, -trace, determinant], force))
    return values + noise * values.std(axis=1, keepdims=True) * rng.normal(size=values.shape)
