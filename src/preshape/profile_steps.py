"""The steps of a profile: checked, merged, and carried from one to the next."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError
from preshape.kernel import rested

__all__ = ["HIGHEST_ORDER", "checked_orders", "checked_vector", "merged_steps", "segments_of"]

HIGHEST_ORDER = 6
"""A step of this derivative is the highest a profile takes: jerk, integrated three times."""

SAME_TIME = 4.0 * np.finfo(float).eps
"""Steps closer than this fraction of the latest time are at the same time: sums of delays taken in another order."""


def segments_of(
    times: NDArray[np.float64], jumps: NDArray[np.float64], orders: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Starts and derivatives of the polynomials between steps, which :meth:`preshape.profile.Profile.segments` returns.

    Every derivative is carried from step to step, the highest first. The sum over all steps would cancel: after a long
    time it is the difference of large powers.
    """
    starts, at = np.unique(times, return_inverse=True)
    highest = int(orders.max(initial=0))
    stepped = np.zeros((starts.size, highest + 1))
    np.add.at(stepped, (at, orders), jumps)
    taylor = np.zeros_like(stepped)
    gaps = np.diff(starts)
    for order in range(highest, -1, -1):
        grown = np.zeros(gaps.size)
        for k in range(highest, order, -1):
            grown = (taylor[:-1, k] + grown) * gaps / (k - order)
        change = stepped[:, order]
        change[1:] += grown
        taylor[:, order] = np.cumsum(change)
    taylor = rested(taylor, _by_rounded_times(starts, stepped))
    starts.setflags(write=False)
    taylor.setflags(write=False)
    return starts, taylor


def _by_rounded_times(starts: NDArray[np.float64], stepped: NDArray[np.float64]) -> NDArray[np.float64]:
    """What steps at rounded times leave of each derivative at the end, at most, shape (order,).

    A step that is late by e takes e times itself from the next lower derivative, and that grows with the time left. A
    ramp that is short against the whole ends at a time that is rounded by a large part of it.
    """
    left = np.zeros(stepped.shape[1])
    if starts.size:
        late, since = SAME_TIME * np.abs(starts).max(), starts[-1] - starts
        sizes = np.abs(stepped)
        for order in range(stepped.shape[1] - 1):
            power = np.ones_like(since)
            for k in range(order + 1, stepped.shape[1]):
                left[order] += late * float(sizes[:, k] @ power)
                power = power * since / (k - order)
    return left


def merged_steps(
    times: NDArray[np.float64], jumps: NDArray[np.float64], orders: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.intp]]:
    """Steps in order of time, those of one order at one time added up, none of size 0."""
    if times.size:
        sequence = np.argsort(times, kind="stable")
        t = times[sequence]
        fresh = np.diff(t) > SAME_TIME * float(np.abs(t).max())
        first = np.concatenate([[0], np.flatnonzero(fresh) + 1])
        group = np.concatenate([[0], np.cumsum(fresh)])
        key, where = np.unique(group * (HIGHEST_ORDER + 1) + orders[sequence], return_inverse=True)
        summed = np.bincount(where, jumps[sequence])
        kept = summed != 0.0
        key, jumps = key[kept], summed[kept]
        times, orders = t[first[key // (HIGHEST_ORDER + 1)]], key % (HIGHEST_ORDER + 1)
    return times, jumps, orders


def checked_vector(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """A copy of `values` as a vector, or a clear refusal."""
    try:
        vector = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} must be numbers, one a step, not {values!r}.") from None
    if vector.ndim != 1:
        raise InputError(f"{name} has shape {vector.shape}: give a flat list, one number a step.")
    if not np.isfinite(vector).all():
        raise InputError(f"{name} holds NaN or infinity at step {int(np.argmin(np.isfinite(vector))) + 1}.")
    return vector


def checked_orders(values: ArrayLike) -> NDArray[np.intp]:
    """The orders as integers from 0 to the highest."""
    given = checked_vector("orders", values)
    if ((given != np.rint(given)) | (given < 0.0) | (given > HIGHEST_ORDER)).any():
        raise InputError(
            f"orders holds a number that is not whole or outside 0 to {HIGHEST_ORDER}: 0 steps the level, 1 the slope, "
            "2 the acceleration, 3 the jerk."
        )
    return given.astype(np.intp)
