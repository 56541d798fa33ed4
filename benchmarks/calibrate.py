"""All of `calibrate` a file, after start: modes, candidates, trade-off, settings; the peer reads and transforms it.

The peer is the least that any tool does with a record: np.loadtxt and scipy.signal.welch. Files that hold spectra are
read in no time, and have no ratio. Files: one that is simulated, examples/data, and ../shared/data where it is there.
"""

from __future__ import annotations

import importlib
import sys
import tempfile
from functools import partial
from pathlib import Path

import numpy as np
from timing import best_of

from preshape.identify import TimeSeries, read
from preshape.workflow import calibrate

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))
simulation = importlib.import_module("tests.identify.simulation")

CLAIM = 1.0
"""Seconds a file."""


def least(path: Path, rate: float) -> None:
    """Read the table, and Welch's method with Klipper's window of half a second."""
    from scipy.signal import welch

    with path.open() as stream:
        table = np.loadtxt((line for line in stream if line[0].isdigit()), delimiter=",")
    length = 1 << int(0.5 * rate).bit_length()
    welch(table[:, 1:].T, rate, ("kaiser", 6.0), min(length, len(table)))


def simulated(folder: Path) -> Path:
    """A raw file of 128 s, 410,000 rows."""
    clean = simulation.clean_record([(48.0, 0.06), (79.0, 0.04)], [0.7, 0.3])
    series = simulation.noisy(clean, np.random.default_rng(0))
    path = folder / "raw_data_x.csv"
    table = np.column_stack([series.times, series.values.T])
    np.savetxt(path, table, fmt="%.6f", delimiter=",", header="#time,accel_x,accel_y,accel_z", comments="")
    return path


def main() -> None:
    """A row a file, and the slowest."""
    with tempfile.TemporaryDirectory() as folder:
        files = [simulated(Path(folder)), ROOT / "examples" / "data" / "gantry_x.csv"]
        files += [ROOT / "examples" / "data" / "ring_down.csv"]
        files += sorted((ROOT.parent / "shared" / "data").glob("*.csv"))
        slowest = 0.0
        for path in files:
            measurement = read(path)
            ours = best_of(partial(calibrate, path), runs=3)
            slowest = max(slowest, ours)
            peer = ""
            if isinstance(measurement, TimeSeries):
                theirs = best_of(partial(least, path, measurement.sample_rate), runs=3)
                peer = f"; NumPy and Welch {1e3 * theirs:.1f} ms: {ours / theirs:.0f} x"
            print(f"{path.name:46s} {measurement.format:22s} {ours:5.2f} s{peer}", flush=True)
        print(f"the slowest of {len(files)} files: {slowest:.2f} s (claim: under {CLAIM:g} s)")


if __name__ == "__main__":
    main()
