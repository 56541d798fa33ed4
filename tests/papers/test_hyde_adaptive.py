"""Shapers that follow a sweep: the laws of what they leave, from the phase of the vibration, and a second solver."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from preshape import design
from preshape.papers.hyde import chapter6_sweep
from preshape.papers.hyde.chapter6_sweep import RATES, laws


@pytest.fixture(scope="module")
def found() -> dict[str, tuple[float, ...]]:
    return dict(laws())


@pytest.mark.parametrize(("name", "slope"), [("order 0", 1), ("order 1", 1), ("order 2", 2)])
@pytest.mark.parametrize("ahead", ["", ", ahead"])
def test_the_order_of_what_is_left_in_the_rate_of_the_sweep(
    name: str, slope: int, ahead: str, found: dict[str, tuple[float, ...]]
) -> None:
    assert np.polyfit(np.log(RATES), np.log(found[name + ahead]), 1)[0] == pytest.approx(slope, abs=0.1)


@pytest.mark.parametrize(
    ("name", "coefficient"),
    [
        ("order 0", math.sqrt(math.pi**2 + 1.0) / 8.0),
        ("order 0, ahead", 1.0 / 8.0),
        ("order 1", math.pi / 8.0),
        ("order 1, ahead", math.pi / 8.0),
    ],
)
def test_its_size_is_what_the_phase_says(name: str, coefficient: float, found: dict[str, tuple[float, ...]]) -> None:
    """The phase 2 pi (t + r t^2 / 2) and the amplitude sqrt(f) of the vibration that an impulse leaves, to first order.

    Order 0, impulses at 0 and T/2: phase r pi / 4 too much, amplitude r / 4 too large, half of each remains. Made for
    the frequency between, the phase is right. Order 1 is blind to what is linear in time; of the rest, pi r t^2 at 0,
    T/2 and T with weights 1, -2, 1 over 4, pi r / 8 remains.
    """
    assert found[name][0] / RATES[0] == pytest.approx(coefficient, rel=0.03)


def test_the_residual_of_one_case_is_what_a_runge_kutta_solver_finds() -> None:
    rate = RATES[-1]
    shaper = design.zvd((1.0, 0.0))
    state, at = np.zeros(2), 0.0
    for level, end in zip(np.cumsum(shaper.amplitudes), [*shaper.times[1:], 2.2], strict=True):

        def slope(t: float, y: np.ndarray, u: float = float(level)) -> list[float]:
            return [y[1], -((2.0 * math.pi * (1.0 + rate * min(t, 1.0))) ** 2) * (y[0] - u)]

        state = solve_ivp(slope, (at, end), state, method="DOP853", rtol=1e-11, atol=1e-13, max_step=0.05).y[:, -1]
        at = end
    last = 2.0 * math.pi * (1.0 + rate)
    plain = solve_ivp(
        lambda t, y: [y[1], -((2.0 * math.pi * (1.0 + rate * min(t, 1.0))) ** 2) * (y[0] - 1.0)],
        (0.0, 2.2), [0.0, 0.0], method="DOP853", rtol=1e-11, atol=1e-13, max_step=0.05,
    ).y[:, -1]  # fmt: skip
    left = math.hypot(state[0] - 1.0, state[1] / last) / math.hypot(plain[0] - 1.0, plain[1] / last)
    assert chapter6_sweep._one_step(1, rate, 0.0) == pytest.approx(left, rel=2e-3)
