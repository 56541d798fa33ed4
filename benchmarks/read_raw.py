"""A Klipper raw file of 100 MB, read and transformed: time against polars and NumPy, memory against the file's size.

Polars is not in the lock files (170 MB): `pip install polars` into the environment, or its row is left out. It reads
with all cores; its processor time counts here, not the clock. Each job runs in a process of its own, so that the peak
of its memory is its own. The transforms are the power spectral densities of the three axes.
"""

from __future__ import annotations

import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

SIZE = 100_000_000
RUNS = 3


def transformed(rate: float, values: np.ndarray[tuple[int, ...], np.dtype[np.float64]]) -> None:
    """The power spectral densities of the three axes, the same for all."""
    from preshape.identify import TimeSeries, spectrum

    spectrum(TimeSeries(rate, 0.0, values, ("x", "y", "z")))


def ours(path: str) -> None:
    """With every check of the file and the sensor."""
    from preshape.identify import TimeSeries, read, spectrum

    series = read(path)
    assert isinstance(series, TimeSeries)
    mark("read")
    spectrum(series)


def polars(path: str) -> None:
    """Its table as a NumPy array."""
    import polars

    table = polars.read_csv(path).to_numpy()
    mark("read")
    transformed(len(table) / (table[-1, 0] - table[0, 0]), table[:, 1:].T)


def numpy(path: str) -> None:
    """np.loadtxt, as anybody would write it."""
    table = np.loadtxt(path, delimiter=",")
    mark("read")
    transformed(len(table) / (table[-1, 0] - table[0, 0]), table[:, 1:].T)


def mark(what: str) -> None:
    """Print processor time [s] and peak memory [bytes] so far."""
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024
    print(json.dumps([what, time.process_time(), peak]), flush=True)


def job(name: str, path: str) -> None:
    """One reader in this process: imports first, and a small file to warm up what is loaded late."""
    import scipy.signal  # noqa: F401

    import preshape.identify  # noqa: F401

    jobs = {"preshape": ours, "polars": polars, "NumPy": numpy}
    if name == "polars":
        import polars as _  # noqa: F401
    mark("start")
    jobs[name](path)
    mark("transformed")


def measured(name: str, path: Path) -> dict[str, tuple[float, float]] | None:
    """Seconds and bytes beyond the start, for reading and for both, best of several runs; None where it cannot run."""
    best: dict[str, tuple[float, float]] = {}
    for _ in range(RUNS):
        done = subprocess.run([sys.executable, __file__, name, str(path)], capture_output=True, text=True, check=False)
        if done.returncode:
            return None
        marks = {what: (seconds, peak) for what, seconds, peak in map(json.loads, done.stdout.splitlines())}
        start = marks.pop("start")
        for what, (seconds, peak) in marks.items():
            now = (seconds - start[0], peak - start[1])
            best[what] = min(best.get(what, now), now)
    return best


def write(path: Path) -> None:
    """What Klipper writes: time and three accelerations with six decimals."""
    rng = np.random.default_rng(0)
    with path.open("w") as stream:
        stream.write("#time,accel_x,accel_y,accel_z\n")
        count = 0
        while stream.tell() < SIZE:
            block = rng.normal(0.0, 3000.0, (50_000, 3)) + [0.0, 0.0, 9806.65]
            times = 100.0 + np.arange(count, count + len(block)) / 3206.4
            rows = zip(times.tolist(), block.tolist(), strict=True)
            stream.write("".join(f"{t:.6f},{a:.6f},{b:.6f},{c:.6f}\n" for t, (a, b, c) in rows))
            count += len(block)


def main() -> None:
    """All of it."""
    if len(sys.argv) == 3:
        job(sys.argv[1], sys.argv[2])
        return
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "raw_data_x.csv"
        write(path)
        size = path.stat().st_size
        mine = measured("preshape", path)
        assert mine is not None
        print(
            f"{size / 1e6:.0f} MB raw data: read {mine['read'][0]:.2f} s, and transformed "
            f"{mine['transformed'][0]:.2f} s; peak memory {mine['read'][1] / size:.2f} x the file when read (below 2), "
            f"{mine['transformed'][1] / size:.2f} x when transformed"
        )
        for peer in ("polars", "NumPy"):
            theirs = measured(peer, path)
            if theirs is None:
                print(f"{peer} is not installed: no comparison")
                continue
            print(
                f"{peer}: read {theirs['read'][0]:.2f} s, and transformed {theirs['transformed'][0]:.2f} s, memory "
                f"{theirs['read'][1] / size:.2f} and {theirs['transformed'][1] / size:.2f} x; ours takes "
                f"{mine['transformed'][0] / theirs['transformed'][0]:.2f} x its time for both, "
                f"{mine['read'][0] / theirs['read'][0]:.2f} x for reading (claim: both within 3 x)"
            )


if __name__ == "__main__":
    main()
