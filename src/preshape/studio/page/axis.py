"""Where the frequency axes end: a round number, that stays while it suits the modes."""

from __future__ import annotations

import math

__all__ = ["axis_end"]

CURVES_END = 1.6
"""A view's curves end at this multiple of the highest mode."""

STAYS = (0.63, 0.85)
"""While the highest mode is between these parts of the axis, it stays."""

ROUND = (1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0)
"""Digits that an axis may end with."""


def axis_end(highest: float, before: float) -> float:
    """The end of the axes [Hz] for a highest mode [Hz], after they ended at `before`; 0 if there was none.

    Examples
    --------
    >>> axis_end(47.3, 0.0), axis_end(50.0, 60.0), axis_end(55.0, 60.0)
    (60.0, 60.0, 80.0)
    """
    if STAYS[0] * before <= highest <= STAYS[1] * before:
        return before
    size = 10.0 ** math.floor(math.log10(CURVES_END * highest))
    return max(size * digits for digits in ROUND if size * digits <= CURVES_END * highest)
