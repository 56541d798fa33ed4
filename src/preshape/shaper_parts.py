"""What a shaper is made of: impulses and boxes, checked and merged."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError

__all__ = [
    "COINCIDENT",
    "Box",
    "GivenBoxes",
    "boxes_shifted",
    "check_impulses",
    "check_one_each",
    "check_sum",
    "checked_boxes",
    "counted",
    "frozen_vector",
    "merged_impulses",
    "part_lines",
    "sum_of",
]

SUM_TOLERANCE = 1e-9
"""How far the amplitudes' sum may be from 1 [-]."""

COINCIDENT = 1e-9
"""Impulses closer than this fraction of the shaper's duration are one: set at their centroid, where moving them
changes the residual only in second order (below 1e-15). For opposite signs it would be first order: they must coincide
to rounding."""

SAME_EDGE = 4.0 * np.finfo(float).eps
"""Edges of boxes closer than this fraction of the latest one are one: sums of delays taken in another order."""


GivenBoxes = Iterable[tuple[float, float, float]]
"""Start [s], end [s] and density [1/s] of each."""


class Box(NamedTuple):
    """A part of constant density: it averages the command over the time from `start` to `end` before.

    Parameters
    ----------
    start, end : float
        Where it begins and ends [s].
    density : float
        [1/s]; times the length the box's share of the command.
    """

    start: float
    end: float
    density: float

    @property
    def mass(self) -> float:
        """Density times length [-], what an impulse's amplitude is."""
        return self.density * (self.end - self.start)


def frozen_vector(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """A read-only copy of `values` as a vector, or a clear refusal."""
    try:
        vector = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} must be numbers, one an impulse, not {values!r}.") from None
    if vector.ndim != 1 or vector.size == 0:
        raise InputError(f"{name} has shape {vector.shape}: give a flat list with at least one impulse.")
    if not np.isfinite(vector).all():
        raise InputError(f"{name} holds NaN or infinity at impulse {int(np.argmin(np.isfinite(vector))) + 1}.")
    vector.flags.writeable = False
    return vector


def check_one_each(times: NDArray[np.float64], amplitudes: NDArray[np.float64]) -> None:
    """Refuse lists of different lengths."""
    if times.size != amplitudes.size:
        raise InputError(f"{times.size} times and {amplitudes.size} amplitudes: a shaper needs one of each an impulse.")


def check_impulses(times: NDArray[np.float64], amplitudes: NDArray[np.float64]) -> None:
    """Refuse impulses that are not one amplitude a time, in order from 0."""
    check_one_each(times, amplitudes)
    if times[0] != 0.0:
        raise InputError(f"the first impulse is at {times[0]:g} s: shift the times so that it is at 0.")
    steps = np.diff(times)
    if (steps <= 0.0).any():
        late = int(np.argmax(steps <= 0.0)) + 1
        raise InputError(
            f"times must increase, but impulse {late + 1} at {times[late]:g} s does not come after "
            f"{times[late - 1]:g} s: sort them, and add up the amplitudes of equal times."
        )


def sum_of(amplitudes: NDArray[np.float64], boxes: Iterable[Box]) -> float:
    """What the parts sum to [-]."""
    return float(amplitudes.sum()) + sum(box.mass for box in boxes)


def check_sum(amplitudes: NDArray[np.float64], boxes: Sequence[Box]) -> None:
    """Refuse parts that do not sum to 1."""
    total = sum_of(amplitudes, boxes)
    if abs(total - 1.0) > SUM_TOLERANCE:
        shares = " and the boxes' shares" if boxes else ""
        raise InputError(
            f"the amplitudes{shares} sum to {total:.9g}, not 1: the command would not end where it should; "
            "Shaper.normalised(times, amplitudes) divides them by their sum."
        )


def checked_boxes(boxes: GivenBoxes, zero: float = 0.0) -> tuple[Box, ...]:
    """The boxes, counted from `zero` [s], if each is one and they come one after the other."""
    try:
        table = np.array([tuple(box) for box in boxes], dtype=float)
    except (TypeError, ValueError):
        raise InputError("boxes must be (start [s], end [s], density [1/s]), three numbers each.") from None
    if table.size == 0:
        return ()
    if table.ndim != 2 or table.shape[1] != 3:
        raise InputError("boxes must be (start [s], end [s], density [1/s]), three numbers each.")
    if not np.isfinite(table).all():
        raise InputError("a box holds NaN or infinity: give finite times [s] and densities [1/s].")
    result = tuple(Box(*row) for row in (table - np.array([zero, zero, 0.0])).tolist())
    free = 0.0
    for box in result:
        if not free <= box.start < box.end:
            raise InputError(
                f"the box from {box.start:g} s to {box.end:g} s must begin at or after {free:g} s and end later: sort "
                "boxes, and split those that overlap."
            )
        free = box.end
    return result


def merged_impulses(
    times: NDArray[np.float64], amplitudes: NDArray[np.float64], anchored: bool = False
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Sorted impulses, coincident ones added up at their centroid; `anchored` keeps a first one of amplitude 0."""
    order = np.argsort(times, kind="stable")
    t, a = times[order], amplitudes[order]
    nearness = np.where(a[1:] * a[:-1] > 0.0, COINCIDENT, np.finfo(float).eps) * max(float(t[-1]), np.finfo(float).tiny)
    group = np.concatenate([[0], np.cumsum(np.diff(t) > nearness)])
    total = np.bincount(group, a)
    size = np.bincount(group, np.abs(a))
    first = t[np.flatnonzero(np.diff(group, prepend=-1.0))]
    offset = np.bincount(group, np.abs(a) * (t - first[group]))
    centre = first + offset / np.where(size > 0.0, size, 1.0)
    keep = total != 0.0
    keep[0] |= anchored
    return centre[keep] - centre[keep][0], total[keep]


def boxes_shifted(boxes: Iterable[Box], times: NDArray[np.float64], amplitudes: NDArray[np.float64]) -> tuple[Box, ...]:
    """Boxes convolved with impulses, as boxes one after the other: where they overlap the densities are added up."""
    every = [
        Box(time + box.start, time + box.end, amplitude * box.density)
        for time, amplitude in zip(times.tolist(), amplitudes.tolist(), strict=True)
        for box in boxes
    ]
    if not every:
        return ()
    edges = np.unique([edge for box in every for edge in box[:2]])
    edges = edges[np.concatenate([[True], np.diff(edges) > SAME_EDGE * float(edges[-1])])]
    result: list[Box] = []
    for start, end in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        middle = 0.5 * (start + end)
        density = sum(box.density for box in every if box.start < middle < box.end)
        if density != 0.0:
            result.append(Box(start, end, density))
    return tuple(result)


def counted(times: NDArray[np.float64], boxes: Sequence[Box]) -> str:
    """How many parts there are, in words."""
    number = len(boxes)
    return f"{times.size} impulses" + (f" and {number} box{'es' * (number > 1)}" if number else "")


def part_lines(times: NDArray[np.float64], amplitudes: NDArray[np.float64], boxes: Sequence[Box]) -> list[str]:
    """The parts as a table of text."""
    lines = ["  time [s]      amplitude [-]"]
    lines += [f"  {t:<12.9f}  {a:+.9f}" for t, a in zip(times, amplitudes, strict=True)]
    if boxes:
        lines += ["", "  box from [s]  to [s]        density [1/s]"]
        lines += [f"  {start:<12.9f}  {end:<12.9f}  {density:+.9f}" for start, end, density in boxes]
    return lines
