"""A rest-to-rest command as a table that a controller plays back."""

from __future__ import annotations

import csv
import io
import os
from pathlib import Path

from preshape.command.rest_to_rest import RestToRest
from preshape.files import write_atomically

__all__ = ["save_force"]


def save_force(move: RestToRest, path: str | os.PathLike[str], dt: float, rest: float = 0.0) -> Path:
    """Write the sampled force: time [s] and force [N], with full digits.

    Parameters
    ----------
    move : RestToRest
        Any of them.
    path : path
        CSV to write; an older file is replaced only when the new one is complete.
    dt : float
        Sample interval [s]; how a switch between two samples is kept says :meth:`RestToRest.sample`.
    rest : float
        How long at least the 0 after the move is kept [s].

    Raises
    ------
    InputError
        If `dt` is out of range or the file cannot be written.
    """
    samples = move.sample(dt, rest)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["time [s]", "force [N]"])
    writer.writerows(zip(samples.times.round(12).tolist(), samples.values.tolist(), strict=True))
    return write_atomically(Path(path), text.getvalue())
