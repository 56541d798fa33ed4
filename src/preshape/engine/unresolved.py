"""What remains certain when modes are too near each other, or too many for the time, to be told apart in doubles.

Divided differences tell near-equal modes apart, but where modes fill a frequency range so densely that their functions
nearly span everything on the interval, the constraint rows differ by less than the rounding of a double. A search would
then call far too short an interval enough. Two shapers for half of the modes each, convolved, meet the constraints
exactly, and the shortest shaper for fewer constraints is a lower bound.
"""

from __future__ import annotations

import math
from functools import reduce

import numpy as np

from preshape.engine.basis import Basis
from preshape.mode import Mode, Modes
from preshape.shaper import Shaper

__all__ = ["convolved_positive", "halves", "is_resolved", "thinned"]

RESOLVED = 1e-7
"""Rounding of the orthonormal rows up to which a distance of zero can be told from a small one."""


def is_resolved(basis: Basis) -> bool:
    """Whether double precision tells these constraints apart on the interval of `basis`."""
    return basis.rounding <= RESOLVED


def halves(modes: Modes, orders: tuple[int, ...]) -> list[tuple[Modes, tuple[int, ...]]]:
    """Every other mode, and those between them: each half is twice as far apart."""
    order = sorted(range(len(modes)), key=lambda i: modes[i].frequency)
    return [(Modes([modes[i] for i in half]), tuple(orders[i] for i in half)) for half in (order[::2], order[1::2])]


def convolved_positive(modes: Modes, orders: tuple[int, ...]) -> Shaper:
    """(1 + K q)^(order + 1) / (1 + K)^(order + 1) for each mode, multiplied: q a delay of half its damped period."""

    def one(mode: Mode, order: int) -> Shaper:
        index = np.arange(order + 2)
        weights = np.array([math.comb(order + 1, int(i)) for i in index]) * mode.decay_per_half_period**index
        return Shaper.normalised(index * mode.damped_period / 2.0, weights)

    return reduce(Shaper.convolve, [one(mode, order) for mode, order in zip(modes, orders, strict=True)])


def thinned(modes: Modes, orders: tuple[int, ...], duration: float) -> tuple[Modes, tuple[int, ...]]:
    """The constraints without those that double precision cannot tell from the others on [0, duration] [s]."""
    while len(modes) > 1 and not is_resolved(Basis(modes, orders, duration)):
        modes, orders = _with_fewer(modes, orders)
    return modes, orders


def _with_fewer(modes: Modes, orders: tuple[int, ...]) -> tuple[Modes, tuple[int, ...]]:
    """One order less at one of the two nearest modes, or one of them left out."""
    poles = np.array([mode.pole for mode in modes])
    distance = np.abs(poles[:, None] - poles[None, :]) + np.diag(np.full(poles.size, np.inf))
    nearest = int(np.argmin(distance.min(axis=1)))
    partner = int(np.argmin(distance[nearest]))
    victim = max((nearest, partner), key=lambda i: orders[i])
    if orders[victim] > 0:
        return modes, tuple(order - (i == victim) for i, order in enumerate(orders))
    kept = [i for i in range(len(modes)) if i != victim]
    return Modes([modes[i] for i in kept]), tuple(orders[i] for i in kept)
