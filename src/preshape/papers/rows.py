"""Rows with computed verdicts: a number against the printed one, a claim against what is found, a result of our own."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from preshape.papers.reproduction import Row

__all__ = ["ROUNDING", "Because", "beyond", "claim", "difference", "number", "shown"]

NUMBER = re.compile(r"[-+]?\d+(?:\.(\d+))?")

ROUNDING_SLACK = 1e-9
"""A value half a unit of the last printed digit away, but for rounding of its own, still rounds to what is printed."""

ROUNDING = 1e-12
"""What counts as zero in sums of a few impulses whose terms are about one."""


def shown(value: float) -> str:
    """A value that should be zero: "0" within rounding, so that the table is the same on every machine."""
    return "0" if abs(value) < ROUNDING else f"{value:.1e}"


def difference(found: ArrayLike, expected: ArrayLike) -> float:
    """Largest difference of two rows of numbers; infinite when there are more of one than of the other."""
    a, b = np.asarray(found, dtype=float), np.asarray(expected, dtype=float)
    return float(np.abs(a - b).max()) if a.shape == b.shape else math.inf


@dataclass(frozen=True)
class Because:
    """Why something differs, and whether the numbers bear it out; a reason that they do not bear out explains nothing.

    So a row whose difference is known goes red when the library stops finding that very difference.
    """

    text: str
    holds: bool


def number(
    source: str,
    what: str,
    printed: str,
    value: float,
    unit: str = "",
    *,
    within: float | None = None,
    digits: int = 2,
    because: Because | None = None,
    note: str = "",
) -> Row:
    """Compare a computed value with the first number in `printed`.

    Parameters
    ----------
    source, what : str
        Where it stands, a section as its bare number, and what it is.
    printed : str
        As the paper prints it, with its unit: "12.76 s", "about 20 %".
    value : float
        Ours, in the same unit.
    unit : str
        Shown after ours.
    within : float, optional
        Tolerance in the unit, for what the paper calls "about"; half a unit of the last printed digit unless given.
    digits : int
        How many digits more than printed are shown.
    because : Because, optional
        Why it differs, if it does.
    note : str
        What was assumed, if it does not.
    """
    found = NUMBER.search(printed)
    assert found is not None, f"no number in {printed!r}"
    decimals = len(found.group(1) or "")
    tolerance = 0.5 * 10.0**-decimals if within is None else within
    agrees = abs(value - float(found.group())) <= tolerance * (1.0 + ROUNDING_SLACK)
    computed = f"{value:.{decimals + digits}f} {unit}".strip()
    return _judged(source, what, printed, computed, agrees, because, note)


def claim(
    source: str, what: str, printed: str, computed: str, holds: bool, *, because: Because | None = None, note: str = ""
) -> Row:
    """Say whether a statement in words holds; `computed` shows the numbers that decide."""
    return _judged(source, what, printed, computed, bool(holds), because, note)


def beyond(source: str, what: str, computed: str, holds: bool, *, printed: str = "-", note: str = "") -> Row:
    """What the paper does not say; `holds` is our own check of it, and when it fails the row is a difference."""
    if not holds:
        return Row(_where(source), what, printed, computed, "differs")
    return Row(_where(source), what, printed, computed, "beyond the paper", note)


def _judged(
    source: str, what: str, printed: str, computed: str, agrees: bool, because: Because | None, note: str
) -> Row:
    if agrees:
        return Row(_where(source), what, printed, computed, "reproduced", note)
    reason = because.text if because is not None and bool(because.holds) else ""
    return Row(_where(source), what, printed, computed, "differs", reason)


def _where(source: str) -> str:
    return f"§ {source}" if source[:1].isdigit() else source
