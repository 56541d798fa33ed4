"""How few slots are enough, by bisection as Hyde did (3.4.2.b), and the proof that one fewer is not.

Non-negative least squares decides: when the constraints cannot be met, what it misses is a polynomial that is positive
on every slot, and no positive shaper on these slots can make its sum vanish. That proof covers the grid, which is all
that a mesh shaper may use.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from preshape.design.mesh.problem import GridProblem, half_period_slots
from preshape.engine.basis import Basis
from preshape.engine.projection import nearest_on
from preshape.engine.unresolved import is_resolved
from preshape.mode import Modes

__all__ = ["SlotImpulses", "convolved_on_slots", "impulses_in", "shortest_slots"]

MUCH_SHORTER = 0.8
"""Fewer slots than this part of those searched call for functions that are orthonormal on fewer slots."""


@dataclass(frozen=True)
class SlotImpulses:
    """Positive impulses on slots.

    Parameters
    ----------
    slots : int
        How many slots they may span.
    places : ndarray of int, shape (impulse,)
        Slots before the last one, increasing.
    amplitudes : ndarray, shape (impulse,)
        [-].
    excluded : int
        A number of slots that is proved to be too few.
    separation : float
        How clearly it is: the least value over these slots of the polynomial that separates them [-].
    resolved : bool
        Whether the arithmetic could tell the modes apart; if not, these are one shaper after the other.
    """

    slots: int
    places: NDArray[np.intp]
    amplitudes: NDArray[np.float64]
    excluded: int = 0
    separation: float = 0.0
    resolved: bool = True

    @property
    def shortest(self) -> bool:
        """Whether one slot fewer is proved to be too few."""
        return self.excluded == self.slots - 1


def impulses_in(problem: GridProblem, slots: int) -> SlotImpulses | None:
    """Impulses within `slots` slots that meet the constraints, at most one more than there are equations; or None."""
    if slots <= problem.too_few:
        return None
    basis, leads = problem.basis(slots), problem.leads(slots)
    return _found(basis, leads, basis(leads), slots) if is_resolved(basis) else None


def shortest_slots(problem: GridProblem) -> SlotImpulses | None:
    """The fewest slots; None when the arithmetic cannot tell the modes apart."""
    low, high = problem.too_few, problem.enough
    while True:
        basis, leads = problem.basis(high), problem.leads(high)
        if not is_resolved(basis):
            return None
        rows, searched = basis(leads), high
        found = _found(basis, leads, rows, high)
        if found is None:
            return None
        while high - low > 1:
            middle = (low + high) // 2
            trial = _found(basis, leads, rows, middle)
            if trial is None:
                low = middle
            else:
                high, found = middle, trial
        if high >= MUCH_SHORTER * searched:
            break
        low = max(problem.too_few, low - 1)
    excluded, separation = _excluded(basis, leads, rows, problem.too_few, high - 1)
    return replace(found, slots=high, excluded=excluded, separation=separation)


def convolved_on_slots(problem: GridProblem) -> SlotImpulses:
    """One zero-vibration shaper on the grid after the other: exact however near to each other the modes are."""
    amplitudes = np.ones(1)
    for mode, order in zip(problem.modes, problem.orders, strict=True):
        one = GridProblem(Modes(mode), (0,), problem.grid)
        slots = half_period_slots(mode.damped_period, problem.dt)
        leads = problem.leads(slots)
        nearest = nearest_on(one.basis(slots), leads)
        dense = np.zeros(slots + 1)
        dense[np.rint(nearest.leads / problem.dt).astype(int)] = nearest.amplitudes
        for _ in range(order + 1):
            amplitudes = np.convolve(amplitudes, dense)
    places = np.flatnonzero(amplitudes)
    return SlotImpulses(problem.enough, places, amplitudes[places], problem.too_few, resolved=False)


def _found(basis: Basis, leads: NDArray[np.float64], rows: NDArray[np.float64], slots: int) -> SlotImpulses | None:
    nearest = nearest_on(basis, leads[: slots + 1], rows[:, : slots + 1])
    if nearest.distance > basis.rounding:
        return None
    places = np.flatnonzero(np.isin(leads[: slots + 1], nearest.leads))
    return SlotImpulses(slots, places, nearest.amplitudes)


def _excluded(
    basis: Basis, leads: NDArray[np.float64], rows: NDArray[np.float64], low: int, high: int
) -> tuple[int, float]:
    """The most slots up to `high` that are proved too few, and how clearly; `low` ones are known to be."""
    separation = _separation(basis, leads, rows, high)
    if separation > 0.0:
        return high, separation
    while high - low > 1:
        middle = (low + high) // 2
        found = _separation(basis, leads, rows, middle)
        if found > 0.0:
            low, separation = middle, found
        else:
            high = middle
    return low, separation


def _separation(basis: Basis, leads: NDArray[np.float64], rows: NDArray[np.float64], slots: int) -> float:
    """Least value of the separating polynomial over slots 0 ... `slots`, or 0 when rounding could be all of it."""
    nearest = nearest_on(basis, leads[: slots + 1], rows[:, : slots + 1])
    least = float((nearest.multipliers @ rows[:, : slots + 1]).min())
    return least if least > basis.zero else 0.0
