"""Modes from simulated measurements against what people use: damping and frequency errors, intervals, and time.

Sweeps: Shake&Tune's damping ratio, (f2 - f1) / (2 f0) with f1 and f2 where the power spectral density has fallen to its
maximum over sqrt(2), and our own fit of the spectrum alone. Machines at work: pyOMA2 where it is installed
(`pip install pyOMA_2`), told the frequencies. `--seeds N` sets the number of records.
"""

from __future__ import annotations

import contextlib
import importlib
import io
import logging
import sys
import time
import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from timing import best_of

from preshape.identify import Identification, Sweep, TimeSeries, find_modes, spectrum

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))
simulation = importlib.import_module("tests.identify.simulation")

SEEDS = int(sys.argv[sys.argv.index("--seeds") + 1]) if "--seeds" in sys.argv else 8
NOISE = 100.0
"""Of the accelerometer [(mm/s^2)^2/Hz], as MEASURE_AXES_NOISE finds good ones."""

MACHINES: list[tuple[list[tuple[float, float]], list[float]]] = [
    *(([(frequency, damping)], [1.0]) for frequency in (40.0, 80.0, 115.0) for damping in (0.02, 0.05, 0.15)),
    ([(40.0, 0.005)], [1.0]),
    ([(50.0, 0.03), (52.0, 0.05)], [0.5, 0.5]),
    ([(90.0, 0.02), (91.5, 0.02)], [0.5, 0.5]),
    ([(38.0, 0.04), (70.0, 0.06)], [0.7, 0.3]),
]

WORKING = [(1.5, 0.01), (4.2, 0.02), (8.8, 0.008)]
SHAPES = np.array([[0.33, 0.74, 0.59], [0.60, 0.33, -0.74], [0.74, -0.59, 0.33]])

_Array = NDArray[np.float64]


def half_power(series: TimeSeries) -> list[tuple[float, float]]:
    """Frequency and damping ratio of the highest peak as Shake&Tune reads it from Klipper's spectrum."""
    found = spectrum(series)
    power = found.total / (found.frequencies + 0.1)
    inside = (found.frequencies > 10.0) & (found.frequencies < 130.0)
    top = int(np.flatnonzero(inside)[power[inside].argmax()])
    level = power[top] / np.sqrt(2.0)
    below = top - int(np.argmax(power[top::-1] < level))
    above = top + int(np.argmax(power[top:] < level))
    low = np.interp(level, power[[below, below + 1]], found.frequencies[[below, below + 1]])
    high = np.interp(-level, -power[[above - 1, above]], found.frequencies[[above - 1, above]])
    centre = float(found.frequencies[top])
    return [(centre, float(high - low) / (2.0 * centre))]


def modes_of(found: Identification) -> list[tuple[float, float]]:
    """Frequencies and damping ratios."""
    return [(float(mode.mode.frequency), float(mode.mode.damping)) for mode in found.modes]


def errors(found: list[tuple[float, float]], truth: list[tuple[float, float]]) -> _Array:
    """Relative errors of frequency and damping ratio of the nearest mode found, shape (mode, 2)."""
    nearest = [nearest_to(frequency, found) for frequency, _ in truth]
    return np.asarray(np.array(nearest) / np.array(truth) - 1.0, dtype=np.float64)


def nearest_to(frequency: float, found: list[tuple[float, float]]) -> tuple[float, float]:
    """The mode whose frequency is nearest."""
    return min(found, key=lambda one: abs(one[0] - frequency))


def percent(rows: list[_Array]) -> str:
    """Root mean square error of frequency and of damping ratio, the worst mode."""
    frequency, damping = np.sqrt(np.mean(np.square(rows), axis=0)).max(axis=0)
    return f"{100.0 * frequency:7.3f} {100.0 * damping:7.2f}"


def sweeps() -> None:
    """A table of errors, and the coverage of the intervals."""
    print(f"Sweeps, {SEEDS} records a row, root mean square errors [%] of frequency and damping ratio (worst mode)")
    print(f"{'modes':34s} {'response':>15s} {'spectrum':>15s} {'half power':>15s}  intervals hold the truth")
    for modes, gains in MACHINES:
        clean = simulation.clean_record(modes, gains)
        ours, plain, peer, covered = [], [], [], []
        for seed in range(SEEDS):
            series = simulation.noisy(clean, np.random.default_rng(seed), noise_density=NOISE)
            found = find_modes(series)
            ours.append(errors(modes_of(found), modes))
            plain.append(errors(modes_of(find_modes(spectrum(series))), modes))
            peer.append(errors(half_power(series), modes))
            for frequency, damping in modes:
                mode = min(found.modes, key=lambda one: abs(one.mode.frequency - frequency))  # noqa: B023
                covered.append(mode.frequency_interval[0] <= frequency <= mode.frequency_interval[1])
                covered.append(mode.damping_interval[0] <= damping <= mode.damping_interval[1])
        name = ", ".join(f"{f:g} Hz {z:g}" for f, z in modes)
        held = f"{100.0 * np.mean(covered):.0f} % of {len(covered)}"
        print(f"{name:34s} {percent(ours)} {percent(plain)} {percent(peer)}  {held}", flush=True)


def working_machine() -> None:
    """Three modes, two white forces, three velocities with 5 % noise, 600 s at 50 Hz."""
    records = [simulation.working(WORKING, SHAPES, np.random.default_rng(seed)) for seed in range(SEEDS)]

    def ours(values: _Array) -> list[tuple[float, float]]:
        return modes_of(find_modes(TimeSeries(50.0, 0.0, values, ("a", "b", "c"))))

    _report("ours, unaided", ours, records)
    try:
        from pyoma2.algorithms import SSI
        from pyoma2.setup.single import SingleSetup
    except ImportError:
        print("pyOMA2 is not installed: pip install pyOMA_2")
        return

    def peer(values: _Array) -> list[tuple[float, float]]:
        with contextlib.redirect_stderr(io.StringIO()), warnings.catch_warnings():
            warnings.simplefilter("ignore")
            setup, method = SingleSetup(values.T, fs=50.0), SSI(name="ssi", method="cov", br=20, ordmax=30)
            setup.add_algorithms(method)
            setup.run_by_name("ssi")
            setup.mpe("ssi", sel_freq=[f for f, _ in WORKING], order_in="find_min")
        return list(zip(np.ravel(method.result.Fn).tolist(), np.ravel(method.result.Xi).tolist(), strict=True))

    logging.disable(logging.CRITICAL)
    _report("pyOMA2 SSI-cov, told the frequencies, without intervals", peer, records)


def _report(name: str, method: Callable[[_Array], list[tuple[float, float]]], records: list[_Array]) -> None:
    start = time.process_time()
    found = [method(values) for values in records]
    seconds = (time.process_time() - start) / len(records)
    missed = sum(len(each) < len(WORKING) for each in found)
    rows = [errors(each, WORKING) for each in found if len(each) >= len(WORKING)]
    frequency, damping = 100.0 * np.sqrt(np.mean(np.square(rows), axis=0)).T
    print(
        f"{name}: frequency {np.round(frequency, 2)} %, damping {np.round(damping, 1)} %, "
        f"{missed} of {len(records)} missed a mode, {1e3 * seconds:.0f} ms",
        flush=True,
    )


def finding() -> None:
    """The modes of a raw file of 128 s, 410,000 rows; all of `calibrate` is in calibrate.py."""
    clean = simulation.clean_record([(48.0, 0.06), (79.0, 0.04)], [0.7, 0.3])
    series = simulation.noisy(clean, np.random.default_rng(0))
    found = best_of(lambda: find_modes(series), runs=3)
    known = best_of(lambda: find_modes(series, excitation=Sweep(5.0, 133.3)), runs=3)
    plain = best_of(lambda: spectrum(series), runs=3)
    print(
        f"finding the modes in {series.values.shape[-1]:,} rows: {found:.2f} s, {known:.2f} s when the sweep is named; "
        f"the spectrum alone {plain:.2f} s"
    )


if __name__ == "__main__":
    sweeps()
    working_machine()
    finding()
