"""Clusters that are not there, go away, have no workers or other versions: one sentence, and nothing done is lost."""

from __future__ import annotations

import logging
import os
import signal
import subprocess
import sys
import time
import types
from pathlib import Path

import pytest
from distributed import LocalCluster
from tests.campaign.campaigns import campaign, mode_map

from preshape.campaign import on_dask, run_campaign
from preshape.errors import InputError


def in_threads(workers: int) -> LocalCluster:
    """A cluster of threads of this process, started in no time."""
    return LocalCluster(
        n_workers=workers,
        threads_per_worker=1,
        processes=False,
        dashboard_address="127.0.0.1:0",
        silence_logs=logging.CRITICAL,
    )


@pytest.mark.parametrize("address", ["tcp://127.0.0.1:9", "nonsense", "127.0.0.1:99999", "gopher://here:1"])
def test_no_scheduler_at_the_address(address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(on_dask, "CONNECTED_WITHIN", 0.5)
    with pytest.raises(InputError, match=r"no Dask scheduler answers at .*: start one with dask scheduler") as caught:
        run_campaign(campaign(mode_map(3)), tmp_path, scheduler=address)
    assert address in str(caught.value) and "\n" not in str(caught.value)


def test_a_scheduler_without_workers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(on_dask, "WORKERS_WITHIN", 0.5)
    with in_threads(0) as cluster, pytest.raises(InputError, match="has no worker within 0.5 s: start some there"):
        run_campaign(campaign(mode_map(3)), tmp_path, scheduler=cluster.scheduler_address)


def test_workers_that_have_another_version(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def version() -> str:
        import threading

        return "0.1.0" if threading.current_thread() is threading.main_thread() else "9.9.9"

    monkeypatch.setattr(on_dask, "_version", version)
    with in_threads(1) as cluster, pytest.raises(InputError, match=r"have preshape 9.9.9, and this is 0.1.0: install"):
        run_campaign(campaign(mode_map(3)), tmp_path, scheduler=cluster.scheduler_address)


def test_workers_without_preshape(cluster: LocalCluster, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As Dask has it: what is sent is a name, and the module of that name is not there."""
    absent = types.ModuleType("only_here")
    exec("def version():\n    return '0.1.0'", absent.__dict__)
    monkeypatch.setitem(sys.modules, "only_here", absent)
    monkeypatch.setattr(on_dask, "_version", absent.version)
    with pytest.raises(InputError, match=r"cannot run preshape \(.*only_here.*\): pip install 'preshape\[campaign\]'"):
        run_campaign(campaign(mode_map(3)), tmp_path, scheduler=cluster.scheduler_address)


def test_a_cluster_that_goes_away_loses_no_batch(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(on_dask, "LOOKED_AFTER", 0.2)
    asked = campaign(mode_map(300))
    cluster = in_threads(1)
    kept = 0

    def close(done: int, failed: int, points: int) -> None:
        nonlocal kept
        kept = done
        if done > 3:
            cluster.close()

    with pytest.raises(InputError, match=r"cannot be reached any more: start it again. (\d+) of 300 points are kept"):
        run_campaign(asked, tmp_path, scheduler=cluster.scheduler_address, progress=close)
    assert 3 < kept < 300
    run = run_campaign(asked, tmp_path, workers=0)
    assert (run.kept, run.summary.done) == (kept, 300)


def test_all_workers_gone_for_good(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(on_dask, "LOOKED_AFTER", 0.1)
    monkeypatch.setattr(on_dask, "WORKERS_WITHIN", 1.0)
    with in_threads(1) as cluster:

        def dismiss(done: int, failed: int, points: int) -> None:
            for worker in list(cluster.workers.values()):
                cluster.sync(worker.close)

        with pytest.raises(InputError, match=r"cannot be reached any more: start it again. \d+ of 300 points are kept"):
            run_campaign(campaign(mode_map(300)), tmp_path, scheduler=cluster.scheduler_address, progress=dismiss)


def test_interrupting_the_command_keeps_what_is_done(tmp_path: Path) -> None:
    """Control-C goes to all processes of the terminal, the workers too."""
    (tmp_path / "map.toml").write_text(
        'schema = "preshape/campaign/1"\n[machine]\nplant = "pendulum"\n[shaper]\nfamily = "zvd"\n'
        "[map]\ntolerance = 0.05\naxes.length = { low = 1.0, high = 9.0, count = 100000 }\n"
    )
    line = [sys.executable, "-m", "preshape", "campaign", "map.toml", "--out", "out", "--workers", "1"]
    running = subprocess.Popen(
        line, cwd=tmp_path, start_new_session=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        # Tests that run in the background inherit that Control-C is ignored.
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
    )  # fmt: skip
    until = time.monotonic() + 120.0
    while not list(tmp_path.glob("out/batches-*/*.parquet")) and time.monotonic() < until:
        time.sleep(0.1)
    os.killpg(running.pid, signal.SIGINT)
    out, error = running.communicate(timeout=120.0)
    assert running.returncode == 130, error
    assert "Traceback" not in error
    assert "of 100000 points are kept; the same command goes on." in error
    assert "Interrupted" in error and out == ""
    kept = list(tmp_path.glob("out/batches-*/*.parquet"))
    assert kept and not list(tmp_path.glob("out/batches-*/.*"))
