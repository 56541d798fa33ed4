"""Divided exponentials against 160 digits, against plain exponentials, and where rates run into each other."""

from __future__ import annotations

import math
from decimal import Decimal

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.kernel.high_precision import Exact, divided_difference

from preshape.kernel import DividedExponentials, near_rates
from preshape.kernel.divided_exponentials import RADIUS

APART = Decimal(10) ** -25
"""Equal rates are told apart by this much in the reference: its error is of this size, beyond any double's."""

NEAR = [1.0005, 1.0 + 1e-6, 1.0 + 1e-12, 1.03]


def rate(frequency: float, damping: float) -> complex:
    """s = z w + i w sqrt(1 - z^2)."""
    return 2.0 * math.pi * frequency * complex(damping, math.sqrt(1.0 - damping**2))


def reference(group: list[complex], duration: float, lead: float | Exact) -> list[Exact]:
    """exp(-s u) n! [d_0 ... d_n] exp(d x) as documented, in 160 digits."""
    real, imaginary = [r.real for r in group], [r.imag for r in group]
    centre = (Exact.of(complex(min(real), min(imaginary))) + complex(max(real), max(imaginary))) / 2
    half = Exact.of(duration) / 2
    x = Exact.of(1) - Exact.of(lead) * 2 / duration
    nodes = [(Exact.of(r) - centre) * half + APART * k for k, r in enumerate(group)]
    values = [(node * x).exp() for node in nodes]
    wave = (Exact.of(0) - centre * lead).exp()
    return [wave * divided_difference(nodes[: n + 1], values[: n + 1]) * math.factorial(n) for n in range(len(group))]


def table(group: list[complex], duration: float, leads: np.ndarray) -> np.ndarray:
    """The reference rounded to doubles, shape (function, lead)."""
    return np.array([[complex(value) for value in reference(group, duration, float(lead))] for lead in leads]).T


@pytest.mark.parametrize(
    "group",
    [
        [rate(1.0, 0.0)] * 4,
        [rate(1.0, 0.3)] * 2,
        *[[rate(1.0, 0.02), rate(1.0, 0.02), rate(ratio, 0.02), rate(ratio, 0.02)] for ratio in NEAR],
        [rate(1.0, 0.0), rate(1.0, 1e-7)],
        [rate(f, z) for f, z in ((1.0, 0.05), (1.04, 0.0), (1.05, 0.1), (1.1, 0.02)) for _ in range(3)],
    ],
)
def test_every_function_is_the_divided_difference(group: list[complex]) -> None:
    duration = 2.0
    leads = np.array([0.0, 0.31, 1.0, 1.77, 2.0, 2.1])
    found = DividedExponentials([group], duration)(leads)
    wanted = table(group, duration, leads)
    np.testing.assert_allclose(found, wanted, rtol=0.0, atol=2e-14 * np.abs(wanted).max())


def test_rates_far_from_each_other_are_plain_exponentials_times_powers() -> None:
    rates, duration = [rate(1.0, 0.1), rate(9.3, 0.02)], 1.7
    assert near_rates(rates, duration) == ((0,), (1,))
    leads = np.linspace(0.0, duration, 40)
    found = DividedExponentials([[rates[0]] * 3, [rates[1]]], duration)(leads)
    x = 1.0 - 2.0 * leads / duration
    wanted = [x**n * np.exp(-rates[0] * leads) for n in range(3)] + [np.exp(-rates[1] * leads)]
    np.testing.assert_allclose(found, np.array(wanted), atol=1e-13)


@pytest.mark.parametrize("ratio", NEAR)
@pytest.mark.parametrize("order", [0, 1, 2])
def test_near_rates_span_what_they_should_and_stay_independent(ratio: float, order: int) -> None:
    """Every u^k exp(-s_j u) is a combination of the functions; and these are not nearly parallel, as those are."""
    pair, duration = [rate(1.0, 0.01), rate(ratio, 0.01)], 1.5
    assert near_rates(pair, duration) == ((0, 1),)
    leads = np.linspace(0.0, duration, 200)
    functions = DividedExponentials([[s for s in pair for _ in range(order + 1)]], duration)(leads)
    plain = np.array([(leads / duration) ** k * np.exp(-s * leads) for s in pair for k in range(order + 1)])
    combination = np.linalg.lstsq(functions.T, plain.T, rcond=None)[0]
    np.testing.assert_allclose(combination.T @ functions, plain, atol=1e-12)
    scaled = functions / np.linalg.norm(functions, axis=1)[:, None]
    assert np.linalg.cond(scaled) < 10.0 ** (order + 1.5)
    if ratio < 1.001:
        assert np.linalg.cond(plain) > 100.0 * np.linalg.cond(scaled)


@pytest.mark.parametrize("distance", [1e-4, 1e-7, 1e-10, 1e-15])
def test_rates_that_run_into_each_other_give_the_functions_of_one(distance: float) -> None:
    duration, leads = 2.0, np.linspace(0.0, 2.0, 50)
    one = DividedExponentials([[rate(1.0, 0.05)] * 4], duration)(leads)
    near = rate(1.0, 0.05) * (1.0 + distance)
    two = DividedExponentials([[rate(1.0, 0.05), near] * 2], duration)(leads)
    size = 2.0 * np.pi * duration * distance
    np.testing.assert_allclose(two, one, atol=2.0 * size + 2e-14)


@pytest.mark.parametrize("ratio", NEAR)
def test_the_derivative_is_that_of_the_functions(ratio: float) -> None:
    """The matrix against differences of the reference over 1e-30 s, where nothing of a double is left."""
    groups, duration = [[rate(1.0, 0.02)] * 2 + [rate(ratio, 0.02)] * 2, [rate(7.7, 0.1)] * 3], 1.9
    functions, h = DividedExponentials(groups, duration), Decimal(10) ** -30
    for lead in (0.0, 0.7, 1.9):
        found = functions.derivative @ functions(np.array([lead]))[:, 0]
        wanted = []
        for group in groups:
            after, before = (reference(group, duration, Exact.of(lead) + step) for step in (h, -h))
            wanted += [complex((a - b) / (2 * h)) for a, b in zip(after, before, strict=True)]
        np.testing.assert_allclose(found, wanted, rtol=0.0, atol=1e-14 * duration * np.abs(functions.rates).max() ** 2)


@settings(max_examples=60)
@given(
    st.lists(st.tuples(st.floats(0.5, 20.0), st.floats(0.0, 0.3)), min_size=1, max_size=9),
    st.floats(0.05, 10.0),
    st.randoms(use_true_random=False),
)
def test_groups_are_a_partition_by_distance_alone(modes: list[tuple[float, float]], duration: float, chance) -> None:
    rates = [rate(*mode) for mode in modes]
    groups = near_rates(rates, duration)
    assert sorted(i for group in groups for i in group) == list(range(len(rates)))
    for group in groups:
        assert all(abs(rates[i] - rates[k]) * duration / 2.0 <= RADIUS for i in group for k in group)
    for a in groups:
        for b in groups:
            if a != b and len(a) == len(b) == 1:
                assert abs(rates[a[0]] - rates[b[0]]) * duration / 2.0 > 1.5
    stretched = near_rates([r * 0.5 for r in rates], duration * 2.0)  # only rate times duration counts
    assert stretched == groups
    order = list(range(len(rates)))
    chance.shuffle(order)
    again = near_rates([rates[i] for i in order], duration)
    assert {frozenset(rates[order[i]] for i in group) for group in again} == {
        frozenset(rates[i] for i in group) for group in groups
    }


def test_a_group_as_wide_as_it_may_be_keeps_its_digits() -> None:
    """Rates up to the radius apart, four functions each: the power series still has thirteen digits."""
    duration = 2.0
    group = [complex(0.3, w) for w in (5.0, 5.0 + RADIUS / 3.0, 5.0 + 2.0 * RADIUS / 3.0, 5.0 + RADIUS) for _ in (0, 1)]
    leads = np.array([0.0, 0.4, 1.1, 2.0])
    found = DividedExponentials([group], duration)(leads)
    wanted = table(group, duration, leads)
    for row, (a, b) in enumerate(zip(found, wanted, strict=True)):
        np.testing.assert_allclose(a, b, rtol=0.0, atol=1e-13 * np.abs(b).max(), err_msg=str(row))
