"""Batches on Dask: worker processes of this machine, or any cluster by the address of its scheduler."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import queue
from concurrent.futures import CancelledError
from types import TracebackType
from typing import TYPE_CHECKING

from preshape.campaign.batch import Batch, BatchDone, run_batch
from preshape.campaign.campaign_file import Campaign
from preshape.campaign.executor import BatchLost
from preshape.campaign.kind import Kind
from preshape.errors import InputError

if TYPE_CHECKING:
    from distributed import Client, Future, LocalCluster

__all__ = ["OnDask", "require_dask"]

CONNECTED_WITHIN = 10.0
"""How long is waited for a scheduler [s]."""

WORKERS_WITHIN = 30.0
"""How long is waited for a worker, at first and when all have gone [s]."""

LOOKED_AFTER = 5.0
"""Without a batch done for this long [s], it is looked whether the cluster is still there."""


def require_dask() -> None:
    """InputError with the remedy when what a campaign needs is not installed."""
    from importlib.util import find_spec

    for module in ("distributed", "pyarrow"):
        if find_spec(module) is None:
            raise InputError(f"a campaign needs {module}, which is not installed: pip install 'preshape[campaign]'.")


QUIET = {
    "distributed.worker.profile.enabled": False,
    "distributed.worker.memory.monitor-interval": "1s",
    "distributed.admin.tick.interval": "1s",
    "distributed.admin.tick.limit": "60s",
    "distributed.admin.system-monitor.interval": "10s",
    "distributed.admin.system-monitor.gil.enabled": False,
    "distributed.scheduler.active-memory-manager.start": False,
    "distributed.scheduler.work-stealing-interval": "1s",
}
"""What Dask watches by itself, for its web page, takes 4 % of a core when nothing runs, and with this 1 %. Its profile
looks a hundred times a second where a worker is and keeps that for an hour: memory would grow."""


class OnDask:
    """Runs batches as Dask tasks.

    What is computed is itself a task, from the campaign's inputs: a worker that comes late, or in place of a dead one,
    gets it from another or makes it again.

    Parameters
    ----------
    campaign : Campaign
        What is computed.
    workers : int
        Processes on this machine, where no address is given.
    scheduler : str, optional
        Address of a scheduler, such as "tcp://10.0.0.5:8786".
    """

    def __init__(self, campaign: Campaign, workers: int, scheduler: str | None = None) -> None:
        self._campaign, self._workers, self._address = campaign, workers, scheduler
        self._cluster: LocalCluster | None = None
        self._client: Client | None = None
        self._kind: Future | None = None
        self._running: set[Future] = set()
        self._done: queue.SimpleQueue[tuple[Batch, Future]] = queue.SimpleQueue()
        self._without_workers = 0.0
        self.cores = workers

    @property
    def client(self) -> Client:
        """Of the cluster, as long as this context lasts."""
        assert self._client is not None
        return self._client

    def __enter__(self) -> OnDask:
        try:
            self._start()
        except BaseException:
            self._stop()
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._stop()

    def submit(self, batch: Batch) -> None:
        try:
            future = self.client.submit(run_batch, self._kind, self._campaign.digest, batch, pure=False)
        except OSError as error:
            raise self._gone() from error
        self._running.add(future)
        future.add_done_callback(lambda done: self._done.put((batch, done)))

    def next_done(self) -> BatchDone | BatchLost:
        from distributed import KilledWorker

        while True:
            try:
                batch, future = self._done.get(timeout=LOOKED_AFTER)
            except queue.Empty:
                self._look()
                continue
            self._without_workers = 0.0
            self._running.discard(future)
            if future.status == "cancelled":
                raise self._gone()
            try:
                found = self._fetched(future)
            except KilledWorker as error:
                return BatchLost(batch, f"its process died {error.allowed_failures + 1} times while it ran")
            finally:
                future.release()
            return found

    def _fetched(self, future: Future) -> BatchDone:
        """The result of a batch that is done; if its worker has gone with it, it is computed once more."""
        while True:
            try:
                found: BatchDone = future.result(timeout=LOOKED_AFTER)
                return found
            except TimeoutError:
                self._look()
            except (CancelledError, asyncio.CancelledError, OSError) as error:
                raise self._gone() from error

    def _start(self) -> None:
        import dask
        from distributed import Client, LocalCluster

        if self._address is None:
            # One thread each: the points are Python, and linear algebra on small matrices wants none of its own (Dask
            # sets OMP_NUM_THREADS and the like to 1 in the processes it starts). Its web page gets any free port of the
            # loopback: the usual one may be taken, and is open to the network.
            with dask.config.set(QUIET):  # scheduler and nannies take it from here when they are made
                self._cluster = LocalCluster(
                    n_workers=self._workers, threads_per_worker=1, processes=True, dashboard_address="127.0.0.1:0",
                    silence_logs=logging.CRITICAL,
                )  # fmt: skip
        where = self._cluster if self._cluster is not None else self._address
        try:
            self._client = Client(where, timeout=CONNECTED_WITHIN, set_as_default=False)
            self._client.wait_for_workers(1, timeout=WORKERS_WITHIN)
        except (OSError, ValueError, TypeError) as error:
            raise self._not_there(error) from None
        self._check_versions(self._client)
        if self._cluster is not None:
            self._client.register_worker_callbacks(setup=_uninterrupted)
        self.cores = sum(self._client.nthreads().values())
        self._kind = self._client.submit(_kind_of, self._campaign, pure=False)

    def _check_versions(self, client: Client) -> None:
        """InputError unless all workers can compute what this process would."""
        try:
            found = client.run(_version, on_error="return")
        except OSError as error:
            raise self._gone() from error
        for other in found.values():
            if isinstance(other, Exception):
                reason = str(other.__cause__ or other).splitlines()[:1]
                raise InputError(
                    f"the workers of {self._address} cannot run preshape ({', '.join(reason)}): pip install "
                    "'preshape[campaign]' where they run."
                )
        ours = _version()
        for other in sorted(set(found.values()) - {ours}):
            raise InputError(f"the workers of {self._address} have preshape {other}, and this is {ours}: install one.")

    def _not_there(self, error: Exception) -> InputError:
        if self._client is not None:
            return InputError(
                f"the scheduler at {self._address} has no worker within {WORKERS_WITHIN:g} s: start some there, with "
                f"dask worker {self._address}."
            )
        return InputError(
            f"no Dask scheduler answers at {self._address} ({str(error).splitlines()[0] if str(error) else error!r}): "
            "start one with dask scheduler, and give the address that it prints, such as tcp://10.0.0.5:8786."
        )

    def _look(self) -> None:
        """InputError if the scheduler has gone, or all workers for too long."""
        if self.client.status != "running":
            raise self._gone()
        try:
            there = bool(self.client.nthreads())
        except OSError as error:
            raise self._gone() from error
        self._without_workers = 0.0 if there else self._without_workers + LOOKED_AFTER
        if self._without_workers >= WORKERS_WITHIN:
            raise self._gone()

    def _gone(self) -> InputError:
        where = f"the cluster at {self._address}" if self._address is not None else "the worker processes"
        return InputError(f"{where} cannot be reached any more: start it again.")

    def _stop(self) -> None:
        with contextlib.suppress(Exception):  # what it cannot close any more has gone
            if self._client is not None and self._client.status == "running":
                self._client.cancel(list(self._running))
        self._running.clear()
        self._kind = None
        for one in (self._client, self._cluster):
            with contextlib.suppress(Exception):
                if one is not None:
                    one.close(timeout=CONNECTED_WITHIN)


def _version() -> str:
    from importlib.metadata import version

    return version("preshape")


def _uninterrupted() -> None:
    """Control-C goes to all processes of a terminal; it is the client that stops its workers, without their say."""
    import signal

    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _kind_of(campaign: Campaign) -> Kind:
    return campaign.kind()
