"""What remains certain when modes are too near each other for the arithmetic.

Near-equal modes make the constraint rows nearly parallel; with many derivatives they differ by less than the rounding
of a double. A search would then call far too short an interval enough. The convolved shaper meets the constraints
exactly whatever the distance of the modes, and the shortest shaper for fewer constraints is a lower bound.
"""

from __future__ import annotations

import math
from functools import reduce

import numpy as np

from preshape.engine.basis import Basis
from preshape.mode import Mode, Modes
from preshape.shaper import Shaper

__all__ = ["convolved_positive", "is_resolved", "with_fewer_constraints"]

RESOLVED = 1e-6
"""Rounding of the orthonormal rows up to which a distance of zero can be told from a small one."""


def is_resolved(modes: Modes, orders: tuple[int, ...], duration: float) -> bool:
    """Whether double precision tells these constraints apart on an interval of `duration` [s]."""
    return Basis(modes, orders, duration).rounding <= RESOLVED


def convolved_positive(modes: Modes, orders: tuple[int, ...]) -> Shaper:
    """(1 + K q)^(order + 1) / (1 + K)^(order + 1) for each mode, multiplied: q a delay of half its damped period."""

    def one(mode: Mode, order: int) -> Shaper:
        index = np.arange(order + 2)
        weights = np.array([math.comb(order + 1, int(i)) for i in index]) * mode.decay_per_half_period**index
        return Shaper.normalised(index * mode.damped_period / 2.0, weights)

    return reduce(Shaper.convolve, [one(mode, order) for mode, order in zip(modes, orders, strict=True)])


def with_fewer_constraints(modes: Modes, orders: tuple[int, ...]) -> tuple[Modes, tuple[int, ...]]:
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
