"""The folder of a campaign: a file for each batch, below the campaign's digest, so that nothing old is mixed in."""

from __future__ import annotations

import os
import re
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from preshape.campaign.batch import ATTEMPT, DIGEST, ERROR, POINT, BatchDone
from preshape.campaign.campaign_file import Campaign
from preshape.campaign.kind import Kind, Results
from preshape.errors import InputError
from preshape.files import write_atomically

if TYPE_CHECKING:
    import pyarrow

__all__ = ["Store", "results_of"]

INPUTS = "inputs.json"

DAMAGED = ".damaged"

NAME = re.compile(r"batches-[0-9a-f]{12}")


class Store:
    """What a campaign has kept.

    Parameters
    ----------
    folder : path-like
        Of the campaign; made if it does not exist.
    campaign : Campaign
        Whose batches are kept; those of others stay beside them.

    Raises
    ------
    InputError
        If the folder cannot be made or read.
    """

    def __init__(self, folder: str | os.PathLike[str], campaign: Campaign) -> None:
        self.folder, self._digest = Path(folder), campaign.digest
        self.batches = self.folder / f"batches-{campaign.digest[:12]}"
        try:
            self.batches.mkdir(parents=True, exist_ok=True)
            self.others = sorted(
                one for one in self.folder.iterdir() if NAME.fullmatch(one.name) and one != self.batches
            )
        except OSError as error:
            raise InputError(
                f"cannot make the folder {self.batches}: {error.strerror or error}; choose another."
            ) from error
        write_atomically(self.batches / INPUTS, campaign.inputs)

    def add(self, done: BatchDone) -> None:
        """Keep a batch: all of its file, or InputError."""
        batch = done.batch
        # The same points tried the same number of times give the same file: two runs at once do no harm.
        mark = zlib.crc32(np.array([batch.points, batch.attempts], dtype=np.int64).tobytes())
        name = f"{batch.points[0]:08d}-{batch.points[-1]:08d}-{mark:08x}.parquet"
        write_atomically(self.batches / name, done.content)

    def attempts(self, count: int) -> tuple[NDArray[np.bool_], NDArray[np.int32], list[Path]]:
        """Which of `count` points have a result, how often each was tried, and files that were damaged.

        A damaged file is set aside: its points count as never tried.
        """
        finished, tried = np.zeros(count, dtype=bool), np.zeros(count, dtype=np.int32)
        damaged = []
        for path in self._files():
            table = self._read(path, [POINT, ATTEMPT, ERROR])
            if table is None:
                damaged.append(path)
                try:
                    path.rename(path.with_name(path.name + DAMAGED))
                except OSError as error:
                    raise InputError(
                        f"{path} is damaged and cannot be set aside ({error.strerror or error}): remove it."
                    ) from None
                continue
            points = table[POINT].to_numpy()
            kept = points < count
            finished[points[kept]] |= table[ERROR].is_null().to_numpy()[kept]
            np.maximum.at(tried, points[kept], table[ATTEMPT].to_numpy()[kept])
        return finished, tried, damaged

    def table(self, count: int) -> pyarrow.Table:
        """One row for each of the first `count` points that were tried, in order: its result, or its last failure."""
        import pyarrow

        tables = [table for path in self._files() if (table := self._read(path, None)) is not None]
        if not tables:
            raise InputError(f"{self.batches} holds no finished batch: run the campaign first.")
        whole = pyarrow.concat_tables(tables)
        points, attempts = whole[POINT].to_numpy(), whole[ATTEMPT].to_numpy()
        good = whole[ERROR].is_null().to_numpy()
        # A result counts more than any failure, then the later attempt; of equal ones any will do.
        order = np.lexsort((attempts, good, points))
        last = np.flatnonzero(np.append(np.diff(points[order]) != 0, True))
        chosen = order[last]
        return whole.take(pyarrow.array(chosen[points[chosen] < count]))

    def _files(self) -> Iterator[Path]:
        try:
            yield from sorted(self.batches.glob("*.parquet"))
        except OSError as error:
            raise InputError(f"cannot read {self.batches}: {error.strerror or error}.") from None

    def _read(self, path: Path, columns: list[str] | None) -> pyarrow.Table | None:
        """A batch, or None if its file is damaged or not of this campaign."""
        import pyarrow
        import pyarrow.parquet

        try:
            table = pyarrow.parquet.ParquetFile(path).read(columns)
        except (pyarrow.ArrowException, OSError):
            return None
        return table if (table.schema.metadata or {}).get(DIGEST) == self._digest.encode() else None


def results_of(table: pyarrow.Table, kind: Kind) -> Results:
    """The finished rows of :meth:`Store.table` as arrays, and the failures."""
    good = table[ERROR].is_null().to_numpy()
    failures = {
        int(point): str(text)
        for point, text in zip(table[POINT].to_numpy()[~good], table[ERROR].filter(~good).to_pylist(), strict=True)
    }
    done = table.filter(good)
    return Results(
        points=done[POINT].to_numpy(),
        numbers={c.name: done[c.name].to_numpy() for c in kind.columns if not c.text},
        texts={c.name: done[c.name].to_pylist() for c in kind.columns if c.text},
        failed=failures,
    )
