"""A batch: points that one process computes in a row, and the Parquet file that comes of it."""

from __future__ import annotations

import io
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from preshape.campaign.kind import Kind
from preshape.errors import InputError

if TYPE_CHECKING:
    import pyarrow

__all__ = ["DIGEST", "Batch", "BatchDone", "ATTEMPT", "ERROR", "POINT", "lost_batch", "run_batch", "written_table"]

POINT, ATTEMPT, ERROR = "point", "attempt", "error"
"""Columns of every file before its own: the point's number; how often it was tried; what was wrong, or nothing."""

DIGEST = b"preshape campaign"
"""Key of the campaign's digest in the file's metadata."""

LONGEST_ERROR = 1000
"""Letters that are kept of what was wrong."""


@dataclass(frozen=True)
class Batch:
    """Which points, in order, and how often each will have been tried."""

    points: tuple[int, ...]
    attempts: tuple[int, ...]


@dataclass(frozen=True)
class BatchDone:
    """What came of a batch.

    Attributes
    ----------
    batch : Batch
    content : bytes
        The file.
    failed : tuple of int
        Points without a result.
    seconds, processor : float
        That the points took by the clock, and of the processor [s], without the file.
    """

    batch: Batch
    content: bytes
    failed: tuple[int, ...]
    seconds: float
    processor: float


def run_batch(kind: Kind, digest: str, batch: Batch) -> BatchDone:
    """Compute the points of a batch; what one raises is recorded, and the others go on.

    Parameters
    ----------
    kind : Kind
        What is computed.
    digest : str
        Of the campaign.
    batch : Batch
        Which points.
    """
    start, began = time.perf_counter(), time.thread_time()
    rows: list[dict[str, Any]] = []
    for point in batch.points:
        try:
            rows.append({**kind.row(point), ERROR: None})
        except InputError as error:
            rows.append({ERROR: str(error)[:LONGEST_ERROR]})
        except Exception as error:  # a fault of ours in one point must not cost the others
            rows.append({ERROR: f"{type(error).__name__}: {error}"[:LONGEST_ERROR]})
    took = time.perf_counter() - start, time.thread_time() - began
    return _done(kind, digest, batch, rows, took)


def lost_batch(kind: Kind, digest: str, batch: Batch, reason: str) -> BatchDone:
    """The record of a batch whose process died again and again."""
    return _done(kind, digest, batch, [{ERROR: reason[:LONGEST_ERROR]} for _ in batch.points], (0.0, 0.0))


def written_table(table: pyarrow.Table) -> bytes:
    """A table as a Parquet file."""
    import pyarrow.parquet

    buffer = io.BytesIO()
    pyarrow.parquet.write_table(table, buffer, compression="zstd")
    return buffer.getvalue()


def _done(
    kind: Kind, digest: str, batch: Batch, rows: Sequence[dict[str, Any]], took: tuple[float, float]
) -> BatchDone:
    import pyarrow

    own = [(column.name, pyarrow.string() if column.text else pyarrow.float64()) for column in kind.columns]
    fields = [(POINT, pyarrow.int64()), (ATTEMPT, pyarrow.int32()), (ERROR, pyarrow.string()), *own]
    schema = pyarrow.schema(fields, metadata={DIGEST: digest.encode()})
    given: list[list[Any]] = [list(batch.points), list(batch.attempts)]
    given += [[row.get(name) for row in rows] for name, _ in fields[2:]]
    arrays = [pyarrow.array(values, kind_of) for values, (_, kind_of) in zip(given, fields, strict=True)]
    table = pyarrow.Table.from_arrays(arrays, schema=schema)
    failed = tuple(point for point, row in zip(batch.points, rows, strict=True) if row[ERROR] is not None)
    return BatchDone(batch, written_table(table), failed, *took)
