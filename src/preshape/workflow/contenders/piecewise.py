"""Smooth commands as profiles: pieces of degree five through the exact acceleration, to a part in 1e10 of its peak."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.profile import Profile

__all__ = ["interpolated"]

DEGREE = 5
"""Of the pieces: a profile takes orders up to six, and the speed must be one too."""

AGREED = 1e-10
"""Difference between the pieces and the acceleration, in parts of its peak, at which they are the same."""

FIRST_PIECES, MOST_PIECES = 1, 2048
"""Pieces of each stretch, doubled until they agree: no finer than that, for the fifth derivative of a much finer
neighbour leaves rounding in that of a coarse one."""

NODES: NDArray[np.float64] = 0.5 - 0.5 * np.cos(np.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))
"""Chebyshev's: interpolation there is nearly the best there is."""

CHECKS = np.array([0.0, *(0.5 * (NODES[1:] + NODES[:-1])), 1.0])
"""Between the nodes and at the ends, where the error is largest."""


def interpolated(acceleration: Callable[[NDArray[np.float64]], ArrayLike], breaks: Sequence[float]) -> Profile:
    """A profile that agrees with a function that is smooth between `breaks`, and is 0 outside.

    Parameters
    ----------
    acceleration : callable
        Of an array of times [s] inside the stretches; at the breaks it is not asked.
    breaks : sequence of float
        Where it may jump or bend [s], increasing; the first is where it begins, the last where it ends.

    Examples
    --------
    >>> half_wave = interpolated(lambda t: np.sin(np.pi * t), [0.0, 1.0])
    >>> bool(abs(half_wave(0.3) - np.sin(0.3 * np.pi)) < 1e-10), abs(half_wave.final_value) < 1e-15
    (True, True)
    """
    knots, rows = [], []
    peak = max(_highest(acceleration, a, b) for a, b in zip(breaks[:-1], breaks[1:], strict=True))
    for begin, end in zip(breaks[:-1], breaks[1:], strict=True):
        pieces = FIRST_PIECES
        while True:
            starts, taylor, wrong = _pieces(acceleration, begin, end, pieces)
            if wrong <= AGREED * peak or pieces >= MOST_PIECES:
                break
            pieces *= 2
        knots.append(starts)
        rows.append(taylor)
    times = np.append(np.concatenate(knots), breaks[-1])
    wanted = np.concatenate([*rows, np.zeros((1, DEGREE + 1))])
    return _stepping(times, wanted)


def _stepping(times: NDArray[np.float64], wanted: NDArray[np.float64]) -> Profile:
    """The profile with these derivatives, shape (time, order), from each time to the next.

    Each step leads from what the profile has become, in the profile's own arithmetic, not from what it should have:
    the fifth derivative is large where the filter is fast, and its rounding would grow with the fifth power of time.
    """
    gaps = np.diff(times)
    become, steps = np.zeros_like(wanted), np.zeros_like(wanted)
    for n in range(DEGREE, -1, -1):
        grown = np.zeros(gaps.size)
        for k in range(DEGREE, n, -1):
            grown = (become[:-1, k] + grown) * gaps / (k - n)
        now = 0.0
        for at, (there, more) in enumerate(zip(wanted[:, n].tolist(), [0.0, *grown.tolist()], strict=True)):
            step = (there - now) - more
            now += step + more
            steps[at, n], become[at, n] = step, now
    orders = np.arange(DEGREE + 1)
    return Profile(np.repeat(times, orders.size), steps.ravel(), np.tile(orders, times.size))


def _highest(acceleration: Callable[[NDArray[np.float64]], ArrayLike], begin: float, end: float) -> float:
    inside = np.asarray(begin + (end - begin) * (np.arange(64) + 0.5) / 64.0, dtype=np.float64)
    return float(np.abs(np.asarray(acceleration(inside))).max())


def _pieces(
    acceleration: Callable[[NDArray[np.float64]], ArrayLike], begin: float, end: float, count: int
) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Starts, derivatives at the starts, and the largest error found of `count` pieces."""
    width = (end - begin) / count
    starts = np.asarray(begin + width * np.arange(count), dtype=np.float64)
    powers = NODES[:, None] ** np.arange(DEGREE + 1)
    values = np.asarray(acceleration(np.ravel(starts[:, None] + width * NODES)), dtype=float).reshape(count, -1)
    coefficients = np.linalg.solve(powers, values.T).T
    # Not at the very ends of the stretch, where the function may be the neighbour's.
    looks = starts[:, None] + width * np.clip(CHECKS, 1e-9, 1.0 - 1e-9)
    found = coefficients @ (CHECKS[:, None] ** np.arange(DEGREE + 1)).T
    wrong = float(np.abs(np.asarray(acceleration(looks.ravel())).reshape(count, -1) - found).max())
    scale = np.array([math.factorial(n) / width**n for n in range(DEGREE + 1)])
    return starts, coefficients * scale, wrong
