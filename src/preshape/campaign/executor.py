"""Executor: where batches run. Here, one after the other, or on Dask; adding one is a file that has these three."""

from __future__ import annotations

from dataclasses import dataclass
from types import TracebackType
from typing import Protocol

from preshape.campaign.batch import Batch, BatchDone

__all__ = ["BatchLost", "Executor"]


@dataclass(frozen=True)
class BatchLost:
    """A batch whose process died each time it was tried, and why."""

    batch: Batch
    reason: str


class Executor(Protocol):
    """Runs batches, as a context: it starts what it needs, and leaves nothing running.

    Attributes
    ----------
    cores : int
        How many batches run at the same time.
    """

    @property
    def cores(self) -> int: ...

    def __enter__(self) -> Executor: ...

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None: ...

    def submit(self, batch: Batch) -> None:
        """Run a batch when a core is free."""

    def next_done(self) -> BatchDone | BatchLost:
        """Wait for the next of those submitted, in any order; InputError when they cannot be run any more."""
