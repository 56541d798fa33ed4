"""Batches in this process, one after the other: no Dask, and nothing to start."""

from __future__ import annotations

from collections import deque
from types import TracebackType

from preshape.campaign.batch import Batch, BatchDone, run_batch
from preshape.campaign.kind import Kind

__all__ = ["Here"]


class Here:
    """Runs each batch when it is asked for.

    Parameters
    ----------
    kind : Kind
        What is computed.
    digest : str
        Of the campaign.
    """

    cores = 1

    def __init__(self, kind: Kind, digest: str) -> None:
        self._kind, self._digest = kind, digest
        self._waiting: deque[Batch] = deque()

    def __enter__(self) -> Here:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._waiting.clear()

    def submit(self, batch: Batch) -> None:
        self._waiting.append(batch)

    def next_done(self) -> BatchDone:
        return run_batch(self._kind, self._digest, self._waiting.popleft())
