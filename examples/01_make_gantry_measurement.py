"""Example 1: a vibration measurement of a machine that we know, because we simulate it.

A belt-driven gantry: motor, belt, toolhead, with a second mode from the frame. It is shaken like Klipper shakes a
printer (a train of acceleration pulses of rising frequency) and recorded like an ADXL345 on the toolhead records it.
The simulation is exact: the commanded acceleration is piecewise constant, and the plant's response to it is computed at
the sensor's own instants. Two files come out of it, byte for byte the same on each run:

    python examples/01_make_gantry_measurement.py              # data/gantry_x.csv, Klipper's raw_data format
    python examples/01_make_gantry_measurement.py --ring-down  # data/ring_down.csv, time and acceleration after a stop
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Modes
from preshape.plant import ModalPlant

Array = NDArray[np.float64]

DATA = Path(__file__).parent / "data"

MODES = Modes([(47.3, 0.045), (78.6, 0.060)])
"""The belt and the frame: what an identification should find."""
PARTICIPATION = (0.7, 0.3)
"""Shares of the modes in the toolhead's motion; they sum to 1, so that slowly the toolhead follows the motor."""

START_FREQUENCY, END_FREQUENCY = 5.0, 135.0  # [Hz]
ACCELERATION_PER_HERTZ = 60.0  # [mm/s^2 / Hz]
SWEEP_RATE = 2.0  # [Hz/s], the fastest that Klipper allows: half the file of its default
QUIET = 0.5  # [s] at rest before and after the sweep

SENSOR_RATE = 1600.0  # [Hz], one of the ADXL345's own
GRAVITY = 9806.65  # [mm/s^2]
LEAST_BIT = np.array([0.003774, 0.003774, 0.003906]) * GRAVITY  # [mm/s^2] a bit, axes x, y, z
NOISE = np.array(
    [115.0, 115.0, 168.0]
)  # [mm/s^2] rms: 0.41 and 0.6 mg/sqrt(Hz), from the data sheet's 0.75 and 1.1 LSB
FULL_SCALE = 16.0 * GRAVITY  # [mm/s^2]
MOUNTING = np.array([1.0, 0.04, 0.025])  # what each sensor axis sees of the motion along x
SEED = 20260901


def sweep(start: float = START_FREQUENCY, end: float = END_FREQUENCY) -> tuple[Array, Array]:
    """Acceleration of the motor: times [s] of its steps, from 0, and their heights [mm/s^2].

    A half period at frequency f is two stretches of 1/(4 f) at +a and -a with a = 60 f, so the motor moves and stops;
    the next goes back. The frequency rises by the rate times the duration of each half period.
    """
    durations, levels = [], []
    frequency, sign = start, 1.0
    while frequency <= end:
        quarter = 0.25 / frequency
        durations += [quarter, quarter]
        levels += [sign * ACCELERATION_PER_HERTZ * frequency, -sign * ACCELERATION_PER_HERTZ * frequency]
        frequency += 2.0 * quarter * SWEEP_RATE
        sign = -sign
    times = np.concatenate([[0.0], np.cumsum(durations)])
    return times, np.diff(np.array([0.0, *levels, 0.0]))


def toolhead_acceleration(times: Array, steps: Array, at: Array) -> Array:
    """Acceleration of the toolhead [mm/s^2] at the times `at`, shape (sample,).

    Each modal coordinate follows the motor's position by x'' + 2 z w x' + w^2 x = w^2 r. Differentiated twice, the same
    equation takes the motor's acceleration to the modal one: it is the response to a staircase.
    """
    return ModalPlant(MODES, PARTICIPATION).step_train(times, steps, at=at).output


def normal(count: int, stream: int) -> Array:
    """Gaussian noise, shape (count,), by Box and Muller from raw bits: NumPy promises those, not its normal()."""
    bits = np.random.PCG64([SEED, stream]).random_raw(2 * count)
    uniform = ((bits >> np.uint64(11)).astype(float) + 0.5) / 2.0**53
    radius = np.sqrt(-2.0 * np.log(uniform[:count]))
    return np.asarray(radius * np.cos(2.0 * np.pi * uniform[count:]), dtype=float)


def record(acceleration: Array) -> Array:
    """What the sensor says of the motion along x [mm/s^2], shape (axis, sample)."""
    noise = np.array([normal(acceleration.size, axis) for axis in range(3)])
    felt = MOUNTING[:, np.newaxis] * acceleration + NOISE[:, np.newaxis] * noise
    felt[2] += GRAVITY
    bit = LEAST_BIT[:, np.newaxis]
    return np.asarray(np.round(np.clip(felt, -FULL_SCALE, FULL_SCALE) / bit) * bit + 0.0)  # + 0.0: never "-0.0"


def gantry_csv(start: float = START_FREQUENCY, end: float = END_FREQUENCY) -> str:
    """The sweep as a Klipper raw_data file.

    Klipper writes six decimals; of the accelerations one is kept here, 1/370 of the sensor's least bit, for two thirds
    of the size.
    """
    times, steps = sweep(start, end)
    count = int((times[-1] + 2.0 * QUIET) * SENSOR_RATE)
    instants = np.arange(count) / SENSOR_RATE
    axes = record(toolhead_acceleration(times + QUIET, steps, instants))
    rows = [f"{t:.6f},{x:.1f},{y:.1f},{z:.1f}" for t, x, y, z in zip(instants, *axes, strict=True)]
    return "\n".join(["#time,accel_x,accel_y,accel_z", *rows, ""])


def ring_down_csv() -> str:
    """One second after a stop from 80 mm/s at 5 m/s^2: `time,accel` [s, m/s^2] at 2 kHz, 40 dB signal to noise."""
    stop = 0.016  # [s]
    instants = np.arange(2000) / 2000.0
    ringing = toolhead_acceleration(np.array([-stop, 0.0]), np.array([-5.0, 5.0]), instants)
    noise = 0.01 * np.sqrt(np.mean(ringing**2)) * normal(instants.size, 3)
    rows = [f"{t:.4f},{a:.5f}" for t, a in zip(instants, ringing + noise, strict=True)]
    return "\n".join(["time,accel", *rows, ""])


def main() -> None:
    parser = argparse.ArgumentParser(description="Simulate the measurements in examples/data.")
    parser.add_argument("--ring-down", action="store_true", help="the ring-down instead of the sweep")
    parser.add_argument("--out", type=Path, help="file to write, instead of the one in examples/data")
    options = parser.parse_args()
    text = ring_down_csv() if options.ring_down else gantry_csv()
    path = options.out or DATA / ("ring_down.csv" if options.ring_down else "gantry_x.csv")
    path.write_text(text, encoding="ascii", newline="\n")
    print(f"{path}: {len(text) / 1e6:.2f} MB; true modes: {'; '.join(map(str, MODES))}")


if __name__ == "__main__":
    main()
