"""Are the negative shapers the shortest of their kind? A linear programme that knows nothing of them is asked.

A shaper's partial sums are the shaped unit step s(t), 1 from T on. Zero vibration of order q says that
integral d[(t - T)^k exp(r (t - T))] s = 1, 0, ... for k = 0 ... q, linear in s: so "is there a step within these bounds
that leaves nothing after T" is a linear programme over s, constant on the cells of a grid. A grid allows less than the
continuum, so its answer is never below the shortest duration, and above it only by what the grid costs.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from scipy.optimize import linprog

from preshape import Shaper, design

STEP = 1.0 / 1000.0


def is_feasible(cells: int, damping: float, order: int, low: float, high: float) -> bool:
    t = (np.arange(cells + 1) - cells) * STEP
    rate = 2.0 * math.pi * complex(damping, math.sqrt(1.0 - damping**2))
    rows = np.array([np.diff(t**k * np.exp(rate * t)) for k in range(order + 1)])
    wanted = np.zeros(2 * (order + 1))
    wanted[0] = 1.0
    answer = linprog(
        np.zeros(cells),
        A_eq=np.concatenate([rows.real, rows.imag]),
        b_eq=wanted,
        bounds=(low, high),
        method="highs-ipm",
    )
    assert answer.status in (0, 2), answer.message
    return bool(answer.status == 0)


def shortest(damping: float, order: int, low: float, high: float) -> float:
    """The fewest cells with a solution, by bisection: where zero is within the bounds, waiting first never hurts."""
    too_few, enough = 1, round(1.5 / STEP)
    while enough - too_few > 1:
        middle = (too_few + enough) // 2
        too_few, enough = (too_few, middle) if is_feasible(middle, damping, order, low, high) else (middle, enough)
    return enough * STEP


@pytest.mark.parametrize("damping", [0.0, 0.1, 0.5])
@pytest.mark.parametrize(
    ("build", "order", "low", "high"),
    [
        (design.um_zv, 0, 0.0, 1.0),
        (design.um_zvd, 1, 0.0, 1.0),
        (design.ps_zv, 0, -1.0, 1.0),
        (design.ps_zvd, 1, -1.0, 1.0),
        (lambda mode: design.sna_zv(mode, 1.5), 0, -0.25, 1.25),
    ],
)
def test_no_step_within_the_same_bounds_is_shorter(
    build: Callable[[tuple[float, float]], Shaper], order: int, low: float, high: float, damping: float
) -> None:
    ours = build((1.0, damping)).duration
    assert ours - 1e-6 <= shortest(damping, order, low, high) <= ours + STEP


@pytest.mark.parametrize("damping", [0.0, 0.1])
def test_a_specified_amplitude_below_one_is_not_the_shortest_within_its_partial_sums(damping: float) -> None:
    """Its first partial sum, (1 + b)/2, is on neither bound: 1, -(1 + b)/2, (1 + b)/2 would be shorter."""
    assert shortest(damping, 0, 0.25, 1.0) < design.sna_zv((1.0, damping), 0.5).duration - 20.0 * STEP
