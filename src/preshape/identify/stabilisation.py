"""Stabilisation diagram: which poles come back when the model grows, and the order that follows from it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.identify.covariance_subspace import Poles, Realisation

__all__ = ["Stabilisation", "stabilised"]

NEAR_FREQUENCY = 0.01
NEAR_DAMPING = 0.1
NEAR_SHAPE = 0.95
"""A pole has come back when frequency and damping ratio differ by less than these parts, and the modal assurance
criterion of the shapes is above this."""

SMALLEST_DIFFERENCE = 0.002
"""Damping ratios that differ by less are the same."""

SHORTEST_COLUMN = 5
"""Orders in which a pole must come back one after the other to be a mode."""

SMALLEST_SHARE = 0.005
"""Columns with less of the outputs' variance do not count when the order is chosen."""

TINY = float(np.finfo(float).tiny)
LARGEST_DAMPING = 0.35
"""Above, a pole describes the colour of the excitation, no resonance."""

_Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Stabilisation:
    """Poles over model orders.

    Attributes
    ----------
    orders : ndarray, shape (pole,)
        Model order to which each pole belongs.
    frequencies, dampings : ndarray, shape (pole,)
        Undamped natural frequency [Hz] and damping ratio.
    stable : ndarray of bool, shape (pole,)
        Whether it is in a column of poles that come back from order to order.
    order : int
        The one that was chosen; 0 when nothing is stable.
    chosen : ndarray of bool, shape (pole,)
        The modes at that order.
    """

    orders: NDArray[np.intp]
    frequencies: _Array
    dampings: _Array
    stable: NDArray[np.bool_]
    order: int
    chosen: NDArray[np.bool_]


def stabilised(realisation: Realisation, highest: int) -> Stabilisation:
    """Follow poles from order 2 to `highest` in steps of 2, and choose the lowest order that has most modes.

    Parameters
    ----------
    realisation : Realisation
        Models of every order.
    highest : int
        Highest order.
    """
    orders = np.arange(2, highest + 1, 2)
    diagram = [realisation.poles(int(order)) for order in orders]
    columns: list[list[tuple[int, int]]] = []
    open_columns: dict[int, int] = {}
    for row, poles in enumerate(diagram):
        following: dict[int, int] = {}
        before = diagram[row - 1] if row else None
        taken: set[int] = set()
        for pole in range(poles.natural.size):
            if not 0.0 < poles.damping[pole] < LARGEST_DAMPING:
                continue
            last = None if before is None else _same(before, poles, pole, taken)
            if last is not None:
                taken.add(last)
            if last is not None and last in open_columns:
                following[pole] = open_columns[last]
                columns[following[pole]].append((row, pole))
            else:
                following[pole] = len(columns)
                columns.append([(row, pole)])
        open_columns = following
    shares = [poles.power / max(float(np.maximum(poles.power, 0.0).sum()), TINY) for poles in diagram]
    long = [column for column in columns if len(column) >= SHORTEST_COLUMN]
    present = np.zeros(len(orders), dtype=int)
    for column in long:
        if np.median([shares[row][pole] for row, pole in column]) >= SMALLEST_SHARE:
            for row, _ in column[1:]:
                present[row] += 1
    row = int(np.argmax(present)) if present.any() else -1
    sizes = np.array([poles.natural.size for poles in diagram])
    first = np.concatenate([[0], np.cumsum(sizes)])
    stable, chosen = np.zeros(first[-1], dtype=bool), np.zeros(first[-1], dtype=bool)
    for column in long:
        for place, pole in column[1:]:
            stable[first[place] + pole] = True
            chosen[first[place] + pole] = place == row
    return Stabilisation(
        np.repeat(orders, sizes).astype(np.intp),
        np.concatenate([poles.natural for poles in diagram]),
        np.concatenate([poles.damping for poles in diagram]),
        stable,
        int(orders[row]) if row >= 0 else 0,
        chosen,
    )


def _same(before: Poles, now: Poles, pole: int, taken: set[int]) -> int | None:
    """The pole of the order before that `pole` continues, or None."""
    frequency = np.abs(before.natural / now.natural[pole] - 1.0)
    difference = np.abs(before.damping - now.damping[pole])
    damping = difference < np.maximum(NEAR_DAMPING * now.damping[pole], SMALLEST_DIFFERENCE)
    alike = np.abs(before.shapes.conj() @ now.shapes[pole]) ** 2 > NEAR_SHAPE
    good = np.flatnonzero((frequency < NEAR_FREQUENCY) & damping & alike)
    free = [int(each) for each in good if int(each) not in taken]
    return min(free, key=lambda each: float(frequency[each])) if free else None
