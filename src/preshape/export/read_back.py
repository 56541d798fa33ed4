"""From the taps in an exported file back to a shaper."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from preshape.checks import positive
from preshape.errors import InputError
from preshape.shaper import Shaper

__all__ = ["MOST_BYTES", "SUM_TOLERANCE", "numbers_in", "shaper_of_taps", "text_of"]

MOST_BYTES = 10_000_000
"""Longer files are not ours: a hundred thousand taps take three megabytes."""

SUM_TOLERANCE = 1e-5
"""How far weights rounded to single precision may be from a sum of 1."""


def text_of(files: Mapping[str, str | bytes], wanted: str, suffixes: tuple[str, ...]) -> str:
    """The text of the only file whose name ends with one of `suffixes` and that holds the string `wanted`."""
    found = []
    for name, content in files.items():
        if name.lower().endswith(suffixes) and len(content) <= MOST_BYTES:
            text = content if isinstance(content, str) else content.decode("utf-8", errors="replace")
            if wanted in text:
                found.append(text)
    if len(found) != 1:
        raise InputError(
            f"{len(found)} of {len(files)} files named *{' or *'.join(suffixes)} hold a table of preshape's: give the "
            "files of one export, as they were written."
        )
    return found[0]


def numbers_in(text: str, what: str) -> list[float]:
    """The numbers of a list separated by commas."""
    try:
        return [float(word) for word in text.split(",")]
    except ValueError:
        raise InputError(f"the {what} in the file are not numbers: export it again.") from None


def shaper_of_taps(dt: float, delays: Sequence[float], weights: Sequence[float]) -> Shaper:
    """The shaper of taps as a target uses them: in single precision the last weight is what the others leave of 1.

    Parameters
    ----------
    dt : float
        Sample time [s].
    delays : sequence of float, shape (tap,)
        Delays [samples].
    weights : sequence of float, shape (tap,)
        Weights [-]; of sum 1, or nearly, if they were rounded to single precision.

    Raises
    ------
    InputError
        If they are no shaper.
    """
    positive("the sample time in the file", dt, "s")
    d, w = np.array(delays, dtype=float), np.array(weights, dtype=float)
    if d.size != w.size or d.size == 0 or not (d == np.rint(d)).all():
        raise InputError(
            f"the file holds {d.size} delays and {w.size} weights: one of each a tap is needed, delays whole."
        )
    with np.errstate(over="ignore"):
        single = bool((w.astype(np.float32) == w).all())
    if single and abs(w.sum() - 1.0) <= SUM_TOLERANCE:
        w[-1] = 1.0 - math.fsum(w[:-1])
    if d[0] > 0.0:  # a shaper starts with the command
        d, w = np.concatenate([[0.0], d]), np.concatenate([[0.0], w])
    return Shaper(d * np.float64(dt), w)
