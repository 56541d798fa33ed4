"""A campaign of four-mode designs on two processes against a plain loop over the same designs in this one.

Processor time is compared: what all processes of the campaign take together, over what the loop takes for as many
points, and over what the points themselves take in the workers, where other work disturbs both alike. On two free cores
the clock shows the same. `campaign.py 100000` takes ten minutes there; 10,000 points unless said otherwise.
"""

from __future__ import annotations

import heapq
import sys
import tempfile
import time
from functools import partial
from pathlib import Path
from unittest import mock

import numpy as np
import psutil
from timing import once

from preshape.campaign import Campaign, campaign_of, run_campaign
from preshape.campaign.batch import Batch, BatchDone
from preshape.campaign.on_dask import OnDask
from preshape.campaign.run import AHEAD
from preshape.campaign.sizes import BatchSizes
from preshape.campaign.store import Store

MODES = ((0.20, 0.01), (0.26, 0.01), (0.45, 0.01), (0.59, 0.01))
"""Of the Shuttle's arm [Hz]; each moves with the workspace in its own way."""

LOOPED = 1000
"""Points of the loop, evenly over all."""

TASKS = 300
"""Batches of one cheap point each, for the overhead of a batch."""

MEGABYTE = 1e6

EVERY = 5.0
"""Between two looks at memory [s]."""


def four_modes(count: int) -> Campaign:
    """A design map over one number with so many points."""
    rows = [{"at": [s], "modes": [[f * s ** (k + 1), z] for k, (f, z) in enumerate(MODES)]} for s in (1.0, 1.3)]
    return campaign_of(
        {
            "schema": "preshape/campaign/1",
            "machine": {"parameters": {"s": ""}, "table": rows},
            "shaper": {"family": "direct", "order": 1},
            "map": {"axes": {"s": {"low": 1.0, "high": 1.3, "count": count}}},
        }
    )


class Counting(Store):
    """A store that adds up what the points took of the processor [s]."""

    processor = 0.0

    def add(self, done: BatchDone) -> None:
        super().add(done)
        Counting.processor += done.processor


class Watch:
    """Processor time and memory of this process and of its workers, every few seconds: looking takes time itself."""

    def __init__(self) -> None:
        self.rows: list[tuple[int, float, float, float, float]] = []
        self._next = 0.0

    def __call__(self, done: int, failed: int, points: int) -> None:
        del failed
        if time.perf_counter() < self._next and done < points:
            return
        self._next = time.perf_counter() + EVERY
        workers = 0.0
        memory = []
        for child in psutil.Process().children(recursive=True):
            try:
                times, used = child.cpu_times(), child.memory_info().rss
            except psutil.NoSuchProcess:
                continue
            workers += times.user + times.system
            memory.append(used)
        own = psutil.Process().memory_info().rss
        self.rows.append((done, time.process_time(), workers, own / MEGABYTE, max(memory, default=0) / MEGABYTE))


def rate(count: int) -> None:
    """Points a second of processor time, and memory over the run."""
    asked = four_modes(count)
    kind = asked.kind()
    points = [int(k) for k in np.linspace(0, count - 1, LOOPED)]
    kind.row(0)
    _, before = once(lambda: [kind.row(point) for point in points])
    watch, start, began = Watch(), time.perf_counter(), time.process_time()
    with tempfile.TemporaryDirectory() as folder, mock.patch("preshape.campaign.run.Store", Counting):
        run = run_campaign(asked, folder, workers=2, progress=watch)
        files = list(Path(folder).glob("batches-*/*.parquet"))
        size = sum(path.stat().st_size for path in files)
    clock = time.perf_counter() - start
    _, after = once(lambda: [kind.row(point) for point in points])
    loop = 0.5 * (before + after) / LOOPED
    first, last = watch.rows[0], watch.rows[-1]
    workers, client = last[2], last[1] - began
    running = last[2] - first[2] + last[1] - first[1]
    print(
        f"{run.summary.done} four-mode designs on 2 processes: {clock:.0f} s by the clock; processor time of workers "
        f"{workers:.1f} s, client and scheduler {client:.1f} s; loop {1e3 * loop:.3f} ms a point "
        f"(before {1e3 * before / LOOPED:.3f}, after {1e3 * after / LOOPED:.3f}), {count * loop:.1f} s for all"
    )
    own = Counting.processor
    print(
        f"the points took {own:.1f} s in the workers: {100.0 * own / running:.1f} % of all processes from the "
        f"first batch on, {100.0 * own / (workers + client):.1f} % with starting (claim: 90 %; whatever else runs)"
    )
    print(
        f"rate over twice the single-process rate: {100.0 * count * loop / (workers + client):.1f} % with starting, "
        f"{100.0 * (last[0] - first[0]) * loop / running:.1f} % from the first batch on (claim: 90 %); by the clock "
        f"{100.0 * count * loop / (2.0 * clock):.1f} %"
    )
    print(
        f"{len(files)} batches, {count / len(files):.0f} points each; {size / count:.0f} bytes a point in files; "
        f"client and scheduler {1e3 * (last[1] - first[1]) / len(files):.1f} ms a batch, that is "
        f"{100.0 * (last[1] - first[1]) / (count * loop):.2f} % of the points' time (claim: below 5 %)"
    )
    for part in (0.1, 0.25, 0.5, 0.75, 1.0):
        row = next(one for one in watch.rows if one[0] >= part * count)
        print(f"memory at {row[0]} points: this process {row[3]:.0f} MB, the larger worker {row[4]:.0f} MB", flush=True)


def overhead() -> tuple[float, float]:
    """What a batch costs client and worker whatever is in it [s], and what starting costs."""
    asked = campaign_of(
        {
            "schema": "preshape/campaign/1",
            "machine": {"plant": "pendulum"},
            "shaper": {"family": "zvd"},
            "map": {"axes": {"length": {"low": 1.0, "high": 2.0, "count": TASKS}}},
        }
    )
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as folder, OnDask(asked, 2) as executor:
        store = Store(folder, asked)
        executor.submit(Batch((0,), (1,)))
        executor.next_done()
        started = time.perf_counter() - start
        clock, own, watch = time.perf_counter(), time.process_time(), Watch()
        watch(0, 0, 0)
        computed, waiting = 0.0, 0
        for point in range(TASKS):
            executor.submit(Batch((point,), (1,)))
            waiting += 1
            while waiting >= 4 or (point == TASKS - 1 and waiting):
                done = executor.next_done()
                assert isinstance(done, BatchDone)
                computed += done.processor
                store.add(done)
                waiting -= 1
        clock, own = time.perf_counter() - clock, time.process_time() - own
        watch(0, 0, 0)
        workers = watch.rows[-1][2] - watch.rows[0][2] - computed
        assert isinstance(done, BatchDone)
        _, writing = once(partial(again, store, done))
    print(
        f"a batch: {1e3 * clock / TASKS:.2f} ms by the clock; processor time of client and scheduler "
        f"{1e3 * own / TASKS:.2f} ms ({1e3 * writing / 100:.2f} ms of it the file), of its worker "
        f"{1e3 * workers / TASKS:.2f} ms; starting to the first result {started:.1f} s by the clock",
        flush=True,
    )
    return own / TASKS, workers / TASKS


def simulated(points: int, each: float, cores: int, client: float, worker: float) -> float:
    """Seconds a campaign takes whose batches cost the one client and their worker so much each [s]."""
    sizes, left, now = BatchSizes(cores), points, 0.0
    sizes.learn(1, each)
    free, running = [0.0] * cores, list[float]()

    def submit() -> None:
        nonlocal left
        size = sizes.next(left)
        left -= size
        end = max(now, heapq.heappop(free)) + worker + size * each
        heapq.heappush(free, end)
        heapq.heappush(running, end)

    while left or running:
        if left and len(running) < AHEAD * cores:
            submit()
            continue
        now = max(now, heapq.heappop(running)) + client
    return now


def model(client: float, worker: float) -> None:
    """What the measured costs of a batch come to on more cores than there are here."""
    print(f"cost model: {1e3 * client:.1f} ms of the client and {1e3 * worker:.1f} ms of a worker a batch")
    for what, each, points in (
        ("four-mode designs, 3.3 ms", 3.3e-3, (10**5, 10**6, 10**7)),
        ("non-linear simulations, 1 s", 1.0, (10**4, 10**5, 10**6)),
    ):
        for count in points:
            parts = []
            for cores in (2, 10, 100, 1000):
                seconds = simulated(count, each, cores, client, worker)
                parts.append(f"{cores}: {seconds:.0f} s, {100.0 * count * each / (cores * seconds):.1f} %")
            print(f"{count} {what}: {'; '.join(parts)}", flush=True)


def again(store: Store, done: BatchDone) -> None:
    """The same file a hundred times."""
    for _ in range(100):
        store.add(done)


def main() -> None:
    """Overhead first, then the rate."""
    model(*overhead())
    rate(int(sys.argv[1]) if len(sys.argv) > 1 else 10_000)


if __name__ == "__main__":
    main()
