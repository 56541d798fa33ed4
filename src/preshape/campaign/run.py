"""A campaign from its file to its folder: points in batches, each kept when done, the open ones next time."""

from __future__ import annotations

import os
from collections import Counter, deque
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from preshape.campaign.batch import Batch, BatchDone, lost_batch, written_table
from preshape.campaign.campaign_file import Campaign, read_campaign
from preshape.campaign.executor import BatchLost, Executor
from preshape.campaign.here import Here
from preshape.campaign.kind import Kind
from preshape.campaign.on_dask import OnDask, require_dask
from preshape.campaign.sizes import BatchSizes
from preshape.campaign.store import Store, results_of
from preshape.checks import whole_number
from preshape.errors import InputError
from preshape.files import write_atomically
from preshape.report import CampaignSummary, campaign_figure, figure_bytes

__all__ = ["CampaignRun", "Progress", "run_campaign"]

Progress = Callable[[int, int, int], object]
"""Is told how many points are done, how many of them in this run failed, and how many there are."""

RESULTS, FIGURE = "results.parquet", "figure.svg"

AHEAD = 2
"""Batches that wait for each core, so that none waits for us."""

MOST_WORKERS = 1024


@dataclass(frozen=True, eq=False)
class CampaignRun:
    """What a run leaves.

    Attributes
    ----------
    summary : CampaignSummary
        Of all points that have a result, from this run or an earlier one.
    computed, kept : int
        Points with a result of this run, and of earlier ones.
    files : tuple of Path
        results.parquet, figure.svg and what the kind writes.
    """

    summary: CampaignSummary
    computed: int
    kept: int
    files: tuple[Path, ...]


def run_campaign(
    file: str | os.PathLike[str] | Campaign,
    folder: str | os.PathLike[str],
    *,
    workers: int | None = None,
    scheduler: str | None = None,
    retries: int = 0,
    progress: Progress | None = None,
) -> CampaignRun:
    """Compute what is open of a campaign, and sum up all that is done.

    Every batch that is done is kept at once, so that a run can be stopped at any time, and the next one goes on. The
    results are the same for any number of workers, any batches and any interruption.

    Parameters
    ----------
    file : path-like or Campaign
        A campaign file, or what :func:`preshape.campaign.read_campaign` made of one.
    folder : path-like
        Where batches, results and figure are kept; made if it does not exist. What other inputs have left in it stays.
    workers : int, optional
        Processes on this machine, as many as it has cores unless given; 0 for this process alone, without Dask.
    scheduler : str, optional
        Address of a Dask scheduler, such as "tcp://10.0.0.5:8786", instead of workers here.
    retries : int
        How often a point that failed is tried again in this run; the next run tries it again in any case.
    progress : function, optional
        Called with the points done, the points failed, and all points, after each batch.

    Returns
    -------
    CampaignRun

    Raises
    ------
    InputError
        If the file is wrong, the folder cannot be written, or the cluster cannot be reached. What is done until then is
        kept.
    """
    require_dask()
    campaign = file if isinstance(file, Campaign) else read_campaign(file)
    kind = campaign.kind()
    if workers is not None and scheduler is not None:
        raise InputError("workers are of this machine and scheduler is another's: give one of them.")
    processes = whole_number("workers", (os.cpu_count() or 1) if workers is None else workers, 0, MOST_WORKERS)
    again = whole_number("retries", retries, 0, 1000)
    store = Store(folder, campaign)
    finished, tried, damaged = store.attempts(kind.count)
    before = int(finished.sum())
    open_ones = np.flatnonzero(~finished)
    if open_ones.size:
        here = processes == 0 and scheduler is None
        executor: Executor = Here(kind, campaign.digest) if here else OnDask(campaign, processes, scheduler)
        points = _Points(open_ones, tried, again)
        told = (lambda: None) if progress is None else lambda: progress(before + points.good, points.bad, kind.count)
        try:
            with executor:
                _compute(executor, points, store, kind, campaign.digest, told)
        except InputError as error:
            kept = before + points.good
            raise InputError(f"{error} {kept} of {kind.count} points are kept; the same command goes on.") from error
    summary, files = _summed_up(store, kind, damaged)
    return CampaignRun(summary, summary.done - before, before, files)


class _Points:
    """The points of a run: those that are open, and those that failed and are tried again."""

    def __init__(self, open_ones: NDArray[np.int64], tried: NDArray[np.int32], retries: int) -> None:
        self._open, self._next, self._tried = open_ones, 0, tried
        self._last = tried + 1 + retries
        self._again: deque[Batch] = deque()
        self.good = self.bad = 0

    @property
    def left(self) -> int:
        return self._open.size - self._next + sum(len(batch.points) for batch in self._again)

    def take(self, count: int) -> Batch:
        """The next batch, of up to `count` points."""
        if self._next < self._open.size:
            chosen = self._open[self._next : self._next + count]
            self._next += chosen.size
            self._tried[chosen] += 1
            return Batch(tuple(chosen.tolist()), tuple(self._tried[chosen].tolist()))
        return self._again.popleft()

    def put_back(self, batch: Batch) -> None:
        """Each point of a lost batch on its own, so that the one that kills its process harms no other."""
        self._again.extend(Batch((point,), (n,)) for point, n in zip(batch.points, batch.attempts, strict=True))

    def done(self, done: BatchDone) -> None:
        """Count; what failed is tried again, once more than before, as long as it may be."""
        self.good += len(done.batch.points) - len(done.failed)
        for point in done.failed:
            if self._tried[point] < self._last[point]:
                self._tried[point] += 1
                self._again.append(Batch((point,), (int(self._tried[point]),)))
            else:
                self.bad += 1


def _compute(
    executor: Executor, points: _Points, store: Store, kind: Kind, digest: str, told: Callable[[], object]
) -> None:
    """All points through the executor; each batch is kept as soon as it is done."""
    sizes, running = BatchSizes(executor.cores), 0
    while points.left or running:
        while points.left and running < AHEAD * executor.cores:
            executor.submit(points.take(sizes.next(points.left)))
            running += 1
        found = executor.next_done()
        running -= 1
        if isinstance(found, BatchLost):
            if len(found.batch.points) > 1:
                points.put_back(found.batch)
                continue
            found = lost_batch(kind, digest, found.batch, found.reason)
        else:
            sizes.learn(len(found.batch.points), found.seconds)
        store.add(found)
        points.done(found)
        told()


def _summed_up(store: Store, kind: Kind, damaged: list[Path]) -> tuple[CampaignSummary, tuple[Path, ...]]:
    table = store.table(kind.count)
    results = results_of(table, kind)
    notes = [f"{path.name} was damaged and is set aside; its points were computed again." for path in damaged]
    if store.others:
        names = ", ".join(path.name for path in store.others)
        notes.append(
            f"the inputs have changed since an earlier run: its points stay in {names}, and none is used here."
        )
    failures = tuple(Counter(results.failed.values()).most_common())
    files = {RESULTS: written_table(table)}
    if not results.points.size:
        summary = CampaignSummary(kind.title, kind.count, 0, (), (), failures, tuple(notes))
    else:
        told = kind.told(results)
        done = int(results.points.size)
        numbers, panels = told.numbers, told.panels
        summary = CampaignSummary(kind.title, kind.count, done, numbers, panels, failures, (*told.notes, *notes))
        files |= {FIGURE: figure_bytes(campaign_figure(summary), "svg"), **told.files}
    return summary, tuple(write_atomically(store.folder / name, content) for name, content in files.items())
