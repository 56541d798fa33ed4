"""How many impulses are needed at least: windows of leads, one after the other, none of which can be left empty.

A window without which the constraints cannot be met holds at least one impulse, whatever the others do; so disjoint
windows of that kind are a proved lower bound on the number of impulses. Each is found by bisection on its end.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

__all__ = ["needed_windows"]


def needed_windows(count: int, can_do: Callable[[NDArray[np.bool_]], bool], seconds: float = math.inf) -> list[slice]:
    """Disjoint windows of the `count` places, each as short as possible, that all need an impulse.

    Parameters
    ----------
    count : int
        Number of places.
    can_do : callable
        Whether the constraints can be met with impulses only where a mask of shape (place,) is true.
    seconds : float
        The windows found in this time are returned; every one counts by itself.
    """
    windows: list[slice] = []
    start, end = 0, time.monotonic() + seconds

    def needed(stop: int) -> bool:
        kept = np.ones(count, dtype=bool)
        kept[start:stop] = False
        return not (kept.any() and can_do(kept))

    while start < count and time.monotonic() < end and needed(count):
        low, high = start, count
        while high - low > 1:
            middle = (low + high) // 2
            if needed(middle):
                high = middle
            else:
                low = middle
        windows.append(slice(start, high))
        start = high
    return windows
