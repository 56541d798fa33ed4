"""The constraint functions: orthonormal, spanning what the papers ask, rounding known; far, near and dense modes."""

from __future__ import annotations

import math

import numpy as np
import pytest

from preshape import Modes
from preshape.engine.basis import Basis, plain_rows

FAR = Modes([(1.0, 0.05), (2.3, 0.0)])
NEAR = Modes([(14.25, 0.01), (15.25, 0.01)])
VERY_NEAR = Modes([(1.0, 0.01), (1.0005, 0.02), (1.0005 * (1.0 + 1e-6), 0.02)])
DENSE = Modes([(1.0 + 0.1 * i, 0.01) for i in range(10)])

CASES = [
    pytest.param(FAR, (1, 1), 0.9, ((0,), (1,)), id="far"),
    pytest.param(FAR, (3, 0), 0.9, ((0,), (1,)), id="mixed orders"),
    pytest.param(NEAR, (1, 1), 0.2, ((0, 1),), id="near"),
    pytest.param(VERY_NEAR, (1, 1, 0), 2.0, ((0, 1, 2),), id="very near"),
    pytest.param(DENSE, (1,) * 10, 5.0, (), id="dense"),
]
"""Modes, orders, duration, and the groups that they should fall into."""


def plain(modes: Modes, orders: tuple[int, ...], leads: np.ndarray, duration: float) -> np.ndarray:
    """(u/T)^k exp(-s u), real and imaginary parts, written out anew."""
    rows = []
    for mode, order in zip(modes, orders, strict=True):
        w = 2.0 * math.pi * mode.frequency
        s = complex(mode.damping * w, w * math.sqrt(1.0 - mode.damping**2))
        for k in range(order + 1):
            wave = (leads / duration) ** k * np.exp(-s * leads)
            rows += [wave.real, wave.imag]
    return np.array(rows)


def gram(rows: np.ndarray) -> np.ndarray:
    """Mean of g g^T over even leads by the trapezoidal rule, shape (row, row)."""
    weights = np.ones(rows.shape[1])
    weights[[0, -1]] = 0.5
    return (rows * (weights / weights.sum())) @ rows.T


@pytest.mark.parametrize(("modes", "orders", "duration", "groups"), CASES)
def test_rows_are_nearly_orthonormal_on_the_whole_interval(
    modes: Modes, orders: tuple[int, ...], duration: float, groups: tuple[tuple[int, ...], ...]
) -> None:
    """They are orthonormal on the leads that were sampled: no combination is larger or smaller between by much."""
    basis = Basis(modes, orders, duration)
    assert basis.groups == groups
    assert basis.size == 2 * sum(order + 1 for order in orders)
    leads = np.linspace(0.0, duration, 20_001)
    sizes = np.linalg.eigvalsh(gram(basis(leads)))
    assert 0.05 < sizes.min() and sizes.max() < 5.0
    scaled = plain(modes, orders, leads, duration)
    scaled /= np.linalg.norm(scaled, axis=1)[:, None]
    assert np.linalg.cond(scaled) > 3.0 * math.sqrt(sizes.max() / sizes.min())


@pytest.mark.parametrize(("modes", "worst"), [(NEAR, 1e3), (Modes([(14.25, 0.01), (14.25 * 1.0005, 0.01)]), 1e8)])
def test_near_equal_modes_stay_independent_where_scaled_rows_are_parallel(modes: Modes, worst: float) -> None:
    basis, leads = Basis(modes, (1, 1), 0.2), np.linspace(0.0, 0.2, 2001)
    assert np.linalg.cond(basis(leads)) < 10.0
    scaled = plain(modes, (1, 1), leads, 0.2)
    assert np.linalg.cond(scaled / np.linalg.norm(scaled, axis=1)[:, None]) > worst


@pytest.mark.parametrize(("modes", "orders", "duration", "groups"), CASES)
def test_rows_span_what_the_papers_ask_and_nothing_else(
    modes: Modes, orders: tuple[int, ...], duration: float, groups: object
) -> None:
    """Each plain row is a combination of g; and as g has no more rows than these, g of them."""
    leads = np.linspace(0.0, duration, 1001)
    g, rows = Basis(modes, orders, duration)(leads), plain(modes, orders, leads, duration)
    combination = np.linalg.lstsq(g.T, rows.T, rcond=None)[0]
    np.testing.assert_allclose(combination.T @ g, rows, rtol=0.0, atol=1e-12)
    assert g.shape == rows.shape


@pytest.mark.parametrize(("modes", "orders", "duration", "groups"), CASES)
@pytest.mark.parametrize("derivative", [1, 2, 3])
def test_derivatives_are_those_of_the_rows(
    derivative: int, modes: Modes, orders: tuple[int, ...], duration: float, groups: object
) -> None:
    basis = Basis(modes, orders, duration)
    leads, h = duration * np.linspace(0.1, 0.9, 7), 1e-5 * duration
    after, before = (basis.slopes(basis.raw(leads + step), derivative - 1) for step in (h, -h))
    found = basis.slopes(basis.raw(leads), derivative)
    np.testing.assert_allclose(found, (after - before) / (2.0 * h), rtol=0.0, atol=1e-5 * np.abs(found).max())
    np.testing.assert_array_equal(basis.values(basis.raw(leads)), basis(leads))


@pytest.mark.parametrize(("modes", "orders", "duration", "groups"), CASES)
def test_weights_give_a_combination_and_its_derivatives(
    modes: Modes, orders: tuple[int, ...], duration: float, groups: object
) -> None:
    basis = Basis(modes, orders, duration)
    c = np.random.default_rng(1).normal(size=basis.size)
    raw = basis.raw(np.linspace(0.0, duration, 11))
    for n, weight in enumerate(basis.weights(c, 3)):
        wanted = c @ basis.slopes(raw, n)
        np.testing.assert_allclose(weight @ raw, wanted, rtol=0.0, atol=1e-9 * np.abs(wanted).max())


@pytest.mark.parametrize(("modes", "orders", "duration", "groups"), CASES)
def test_coefficients_lead_back_to_the_combination(
    modes: Modes, orders: tuple[int, ...], duration: float, groups: object
) -> None:
    basis = Basis(modes, orders, duration)
    c = np.random.default_rng(2).normal(size=basis.size)
    c /= np.linalg.norm(c)
    again = Basis(modes, orders, duration, basis.groups)
    coefficients = 3.0 * np.array(again.coefficients(c))
    np.testing.assert_allclose(again.multipliers(coefficients), c, rtol=0.0, atol=1e-10)


def test_coefficients_of_far_modes_are_those_of_plain_exponentials() -> None:
    basis, orders, duration = Basis(FAR, (1, 0), 1.1), (1, 0), 1.1
    c, leads = np.random.default_rng(3).normal(size=basis.size), np.linspace(0.0, 1.07, 50)
    total, position, x = np.zeros(50), 0, 1.0 - 2.0 * leads / duration
    coefficients = basis.coefficients(c)
    for mode, order in zip(FAR, orders, strict=True):
        for k in range(order + 1):
            total += np.real(coefficients[position] * x**k * np.exp(mode.pole.conjugate() * leads))
            position += 1
    assert position == len(coefficients)
    np.testing.assert_allclose(total, c @ basis(leads), rtol=0.0, atol=1e-12)


def test_coefficients_of_dense_modes_are_those_of_a_chebyshev_series() -> None:
    basis = Basis(DENSE, (1,) * 10, 5.0)
    c, leads = np.random.default_rng(4).normal(size=basis.size), np.linspace(0.0, 5.0, 50)
    coefficients = np.array(basis.coefficients(c))
    assert not coefficients.imag.any()
    total = np.polynomial.chebyshev.chebval(1.0 - 2.0 * leads / 5.0, coefficients.real)
    np.testing.assert_allclose(total, c @ basis(leads), rtol=0.0, atol=1e-11)


def test_coefficients_of_something_else_are_no_combination() -> None:
    """A constant is no combination of exponentials; and there must be as many coefficients as functions."""
    dense, far = Basis(DENSE, (1,) * 10, 5.0), Basis(FAR, (1, 1), 0.9)
    length = len(dense.coefficients(np.zeros(dense.size)))
    assert not dense.multipliers(np.eye(length, dtype=complex)[0]).any()
    assert not dense.multipliers(np.ones(length + 1, dtype=complex)).any()
    valid = np.array(dense.coefficients(np.eye(dense.size)[0]))
    assert dense.multipliers(valid).any() and not dense.multipliers(valid * 1j).any()
    assert not far.multipliers(np.zeros(4, dtype=complex)).any()


@pytest.mark.parametrize(("modes", "orders", "duration", "groups"), CASES)
def test_rounding_bounds_what_a_last_digit_of_the_lead_changes(
    modes: Modes, orders: tuple[int, ...], duration: float, groups: object
) -> None:
    basis = Basis(modes, orders, duration)
    leads = duration * np.linspace(0.0, 1.0, 2001)[1:]
    change = np.abs(basis(leads * (1.0 + np.finfo(float).eps)) - basis(leads)).max(axis=0)
    assert change[leads < 0.9 * duration].max() <= basis.rounding
    assert change.max() <= basis.zero  # a polynomial is steep at the far end
    assert 1e-15 < basis.rounding < 1e-11
    assert basis.zero >= 1e-12 and basis.zero > basis.rounding


def test_dense_modes_lose_in_doubles_what_the_series_keep() -> None:
    """Forced into exponentials they would be known to few digits only: that is what the groups () are for."""
    exponentials = Basis(DENSE, (1,) * 10, 5.0, tuple((i,) for i in range(10)))
    assert exponentials.groups and exponentials.rounding > 1e3 * Basis(DENSE, (1,) * 10, 5.0).rounding


def test_plain_rows_are_the_papers_equations_with_their_slopes() -> None:
    leads, h = np.linspace(0.01, 1.2, 9), 1e-6
    rows, slopes = plain_rows(FAR, (2, 1), leads, 1.3)
    wanted = plain(FAR, (2, 1), leads, 1.3)
    np.testing.assert_allclose(rows, np.concatenate([wanted[::2], wanted[1::2]]), rtol=0.0, atol=1e-15)
    after, before = (plain_rows(FAR, (2, 1), leads + step, 1.3)[0] for step in (h, -h))
    np.testing.assert_allclose(slopes, (after - before) / (2.0 * h), rtol=0.0, atol=1e-8 * np.abs(slopes).max())
