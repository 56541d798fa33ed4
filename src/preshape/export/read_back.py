"""From exported files back to what stands in them: the text that counts, and its taps."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from preshape.checks import positive
from preshape.errors import InputError
from preshape.export.target import EPSILON, Files, Taps

__all__ = ["LARGEST_FILE", "MOST_TAPS", "numbers_in", "only_text", "taps_in"]

LARGEST_FILE = 20_000_000
"""Bytes; MOST_TAPS taps take 5 MB."""

MOST_TAPS = 1 << 16
"""More are neither written nor read."""

LONGEST = 1 << 31
"""Samples of delay that are read."""

SUM_TOLERANCE = 1e-9
"""How far weights may sum from 1 beside what rounding them does, as of a Shaper."""


def only_text(files: Files, *endings: str, holding: str = "", most: int = LARGEST_FILE) -> str:
    """The text of the only file whose name ends like this, in whatever case, and that holds the string `holding`.

    What is no UTF-8 is replaced: comments may hold anything, and settings and tables are ASCII.

    Raises
    ------
    InputError
        If there is not exactly one, or it is longer than `most`.
    """
    sign = holding.encode()
    named = [
        name
        for name, content in files.items()
        if name.lower().endswith(endings) and (holding in content if isinstance(content, str) else sign in content)
    ]
    if len(named) != 1:
        kind = f"are named *{' or *'.join(endings)}" + (" and hold a table of preshape's" if holding else "")
        raise InputError(f"{len(named)} of {len(files)} files {kind}: give those of one export, as they were written.")
    content = files[named[0]]
    if len(content) > most:
        raise InputError(f"{named[0]} is larger than {most // 1_000_000} MB: it is not of preshape export.")
    return content.decode("utf-8", errors="replace") if isinstance(content, bytes) else content


def numbers_in(text: str, what: str) -> list[float]:
    """The numbers of a list separated by commas; a last comma may stand behind them.

    Raises
    ------
    InputError
        If something else stands there, or more than MOST_TAPS.
    """
    words = text.rstrip().removesuffix(",").split(",")
    if len(words) > MOST_TAPS:
        raise InputError(f"the file holds {len(words)} {what}: up to {MOST_TAPS} are read.")
    try:
        return [float(word) for word in words]
    except ValueError:
        raise InputError(f"the {what} in the file are not numbers: export it again.") from None


def taps_in(dt: float, delays: Sequence[float], weights: Sequence[float], precision: str = "double") -> Taps:
    """The taps that stand in a file, number for number.

    Parameters
    ----------
    dt : float
        Sample time [s].
    delays : sequence of float, shape (tap,)
        Delays [samples].
    weights : sequence of float, shape (tap,)
        Weights [-]; of sum 1 to what their precision leaves of it.
    precision : {"double", "single"}
        Of the controller's numbers.

    Raises
    ------
    InputError
        If they are no taps of a shaper.
    """
    positive("the sample time in the file", dt, "s")
    d, w = np.array(delays, dtype=float), np.array(weights, dtype=float)
    if d.size != w.size or d.size == 0 or not (np.isfinite(d).all() and (d == np.rint(d)).all()):
        raise InputError(
            f"the file holds {d.size} delays and {w.size} weights: one of each a tap is needed, delays whole."
        )
    if d[0] != 0.0 or (np.diff(d) <= 0.0).any() or d[-1] > LONGEST:
        raise InputError("the delays in the file do not increase from 0: export it again.")
    if not np.isfinite(w).all():
        raise InputError("the file holds a weight that is not finite: export it again.")
    total, size = math.fsum(w), float(np.abs(w).sum())
    if not abs(total - 1.0) <= SUM_TOLERANCE + w.size * EPSILON[precision] * size:
        raise InputError(f"the weights in the file sum to {total:.9g}, not 1: export it again.")
    return Taps(float(dt), d.astype(np.uint32), w, precision)
