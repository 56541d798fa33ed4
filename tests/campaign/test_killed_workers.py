"""Workers that are killed lose their running task and nothing else; one that a point kills harms no other point."""

from __future__ import annotations

import os
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet
import pytest
from distributed import Client, LocalCluster
from tests.campaign.campaigns import campaign, mode_map

from preshape.campaign import run_campaign
from preshape.campaign.batch import Batch, BatchDone
from preshape.campaign.executor import BatchLost
from preshape.campaign.here import Here

POINTS = 600


def killed(address: str) -> int:
    """SIGKILL for the first worker of the cluster; its process number."""
    with Client(address, set_as_default=False) as client:
        pids = client.run(os.getpid)
    pid = int(next(iter(pids.values())))
    os.kill(pid, signal.SIGKILL)
    return pid


def test_results_are_those_of_an_undisturbed_run_bit_for_bit(cluster: LocalCluster, tmp_path: Path) -> None:
    asked = campaign(mode_map(POINTS))
    undisturbed = run_campaign(asked, tmp_path / "here", workers=0)
    seen: list[int] = []
    pids: list[int] = []

    def kill(done: int, failed: int, points: int) -> None:
        seen.append(done)
        if len(seen) in (4, 6):
            pids.append(killed(cluster.scheduler_address))

    disturbed = run_campaign(asked, tmp_path / "there", scheduler=cluster.scheduler_address, progress=kill)
    assert len(set(pids)) == 2, "two processes died"
    assert seen[5] < POINTS, "and in mid-run"
    assert undisturbed.summary.done == disturbed.summary.done == POINTS
    tables = [pyarrow.parquet.read_table(tmp_path / name / "results.parquet") for name in ("here", "there")]
    assert tables[0].equals(tables[1])
    assert set(tables[1]["attempt"].to_pylist()) == {1}, "no point failed on the way"
    assert (tmp_path / "here" / "figure.svg").read_bytes() == (tmp_path / "there" / "figure.svg").read_bytes()


def test_a_batch_that_is_given_up_is_done_point_by_point(cluster: LocalCluster, tmp_path: Path) -> None:
    asked = campaign(mode_map(POINTS))
    whole = run_campaign(asked, tmp_path / "here", workers=0)
    seen: list[int] = []

    def kill(done: int, failed: int, points: int) -> None:
        seen.append(done)
        if len(seen) == 5:
            killed(cluster.scheduler_address)

    usual = cluster.scheduler.allowed_failures
    cluster.scheduler.allowed_failures = 0  # the scheduler gives a task up when its process dies once
    try:
        run = run_campaign(asked, tmp_path / "there", scheduler=cluster.scheduler_address, progress=kill)
    finally:
        cluster.scheduler.allowed_failures = usual
    sizes = np.diff([0, *seen])
    assert sizes.max() > 20 and (sizes[5:] == 1).sum() > 20, "the rest of a long batch went one by one"
    assert run.summary.done == whole.summary.done
    tables = [pyarrow.parquet.read_table(tmp_path / name / "results.parquet") for name in ("here", "there")]
    assert tables[0].equals(tables[1])


class Deadly(Here):
    """As Dask reports it: a batch with point 13 in it takes its process along, whenever it is tried."""

    cores = 2

    def next_done(self) -> BatchDone | BatchLost:  # type: ignore[override]
        batch: Batch = self._waiting[0]
        if 13 in batch.points:
            self._waiting.popleft()
            return BatchLost(batch, "its process died 4 times while it ran")
        return super().next_done()


def test_a_point_that_kills_its_process_is_recorded_and_the_others_are_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked = campaign(mode_map(40))
    monkeypatch.setattr("preshape.campaign.run.Here", Deadly)
    run = run_campaign(asked, tmp_path, workers=0)
    assert (run.summary.done, run.summary.failures) == (39, (("its process died 4 times while it ran", 1),))
    table: Any = pyarrow.parquet.read_table(tmp_path / "results.parquet")
    assert [p for p, e in zip(table["point"].to_pylist(), table["error"].to_pylist(), strict=True) if e] == [13]
    monkeypatch.undo()
    again = run_campaign(asked, tmp_path, workers=0)
    assert (again.summary.done, again.computed, again.kept, again.summary.failed) == (40, 1, 39, 0)
