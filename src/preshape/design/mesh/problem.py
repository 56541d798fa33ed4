"""What is asked on a servo grid: modes, orders and slots; and which asks end before any search."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.checks import positive, whole_number
from preshape.engine.basis import Basis
from preshape.engine.constraints import ServoGrid
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike

__all__ = ["GridProblem", "orders_of"]

HIGHEST_ORDER = 6

MOST_SLOTS = 100_000
"""Least squares on this many slots takes seconds; a servo period that needs more is far finer than any mode needs."""

SAME = 1e-9
"""A time that exceeds a multiple of dt by less than this fraction is that multiple."""


@dataclass(frozen=True)
class GridProblem:
    """Zero vibration of `orders` at `modes`, impulses at multiples of the servo period.

    Parameters
    ----------
    modes : Modes
        Where the residual vibration is to vanish.
    orders : tuple of int
        Derivatives that vanish with it, one a mode.
    grid : ServoGrid
        The slots.
    """

    modes: Modes
    orders: tuple[int, ...]
    grid: ServoGrid

    @classmethod
    def checked(cls, modes: ModesLike, order: int | Iterable[int], dt: float) -> GridProblem:
        """The problem, or a sentence about what is wrong with it."""
        wanted = Modes(modes)
        problem = cls(wanted, orders_of(wanted, order), ServoGrid(positive("dt", dt, "s")))
        fastest = min(wanted, key=lambda mode: mode.damped_period)
        half = fastest.damped_period / 2.0
        if problem.dt > half * (1.0 + SAME):
            raise InputError(
                f"dt is {problem.dt:.6g} s, coarser than half a period of the fastest mode ({fastest}): such a grid "
                f"cannot tell how it moves; give a servo period of at most {_down(half):.6g} s."
            )
        if problem.enough > MOST_SLOTS:
            coarser = problem.dt * problem.enough / MOST_SLOTS * 1.01
            raise InputError(
                f"dt = {problem.dt:.6g} s makes {problem.enough} slots, more than {MOST_SLOTS}: give a servo period of "
                f"at least {coarser:.2g} s."
            )
        return problem

    @property
    def dt(self) -> float:
        """The servo period [s]."""
        return self.grid.dt

    @property
    def too_few(self) -> int:
        """Slots that are too few for the slowest mode alone: it needs order + 1 half periods."""
        longest = max((q + 1) * mode.damped_period / 2.0 for mode, q in zip(self.modes, self.orders, strict=True))
        return math.ceil(longest / self.dt * (1.0 - SAME)) - 1

    @property
    def enough(self) -> int:
        """Slots that are enough for one zero-vibration shaper after the other, each on the grid."""
        return sum(
            (q + 1) * half_period_slots(mode.damped_period, self.dt)
            for mode, q in zip(self.modes, self.orders, strict=True)
        )

    def slots_in(self, duration: float) -> int:
        """How many slots fit into `duration` [s]."""
        slots = math.floor(positive("duration", duration, "s") / self.dt * (1.0 + SAME))
        if slots > MOST_SLOTS:
            raise InputError(
                f"duration {duration:g} s is {slots} slots of {self.dt:g} s, more than {MOST_SLOTS}: give at most "
                f"{_down(MOST_SLOTS * self.dt):.6g} s; {self.enough * self.dt:.6g} s are always enough."
            )
        return slots

    def leads(self, slots: int) -> NDArray[np.float64]:
        """0, dt, ..., slots dt [s] before the last slot."""
        return self.grid.leads(slots)

    def basis(self, slots: int) -> Basis:
        """The constraint functions, orthonormal over `slots` slots."""
        return Basis(self.modes, self.orders, max(slots, 1) * self.dt)


def half_period_slots(period: float, dt: float) -> int:
    """Slots that hold a zero-vibration shaper of a mode of this damped period: half of it, rounded up."""
    return math.ceil(period / 2.0 / dt * (1.0 - SAME))


def orders_of(modes: Modes, order: int | Iterable[int]) -> tuple[int, ...]:
    """One order a mode."""
    given = [order] * len(modes) if isinstance(order, int) else list(order)
    if len(given) != len(modes):
        raise InputError(f"{len(given)} orders for {len(modes)} modes: give one number, or one a mode.")
    return tuple(whole_number("order", value, 0, HIGHEST_ORDER) for value in given)


def _down(value: float) -> float:
    """Rounded down to six digits, so that the number in a sentence may be used as it is."""
    unit = 10.0 ** (math.floor(math.log10(value)) - 5)
    return math.floor(value / unit * (1.0 + 1e-12)) * unit
