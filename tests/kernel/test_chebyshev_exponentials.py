"""Chebyshev series of exponentials against 160 digits: values, slopes, the span, and what is left of near rates."""

from __future__ import annotations

import math
from decimal import Decimal, localcontext

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.kernel.high_precision import CONTEXT, Exact, orthonormal

from preshape.kernel import chebyshev_derivative, chebyshev_values, orthonormal_series

DENSE = [(1.0, 0.01), (1.0005, 0.01), (1.0005 * (1.0 + 1e-6), 0.01), (1.1, 0.05), (1.2, 0.0), (1.3, 0.2)]
"""Near and very near modes; on a few periods little is left of each beside the others."""


def rates_of(modes: list[tuple[float, float]]) -> np.ndarray:
    return np.array([2.0 * math.pi * f * complex(z, math.sqrt(1.0 - z**2)) for f, z in modes])


def bessel(z: Exact, degree: int, derivative: int) -> Exact:
    """d^k/dz^k of the modified Bessel function I_n, by its power series, term by term."""
    half, total = z * Decimal("0.5"), Exact(Decimal(0))
    powers = [Exact(Decimal(1))]
    terms = 60 + 2 * int(abs(complex(z)))
    for _ in range(degree + 2 * terms):
        powers.append(powers[-1] * half)
    for m in range(terms):
        exponent = degree + 2 * m
        if exponent < derivative:
            continue
        falling = math.perm(exponent, derivative)
        term = powers[exponent - derivative] * Decimal(falling) / (math.factorial(m) * math.factorial(m + degree))
        total = total + term * Decimal("0.5") ** derivative
    return total


def series(rate: complex, power: int, duration: float, count: int) -> tuple[list[Decimal], list[Decimal]]:
    """Chebyshev coefficients of x^k exp(z (x - 1)), z = s T / 2: 2 I_n^(k)(z) exp(-z), the first one halved."""
    z = Exact.of(rate) * duration / 2
    shrink = (Exact.of(0) - z).exp()
    parts = [bessel(z, n, power) * shrink * (2 if n else 1) for n in range(count)]
    return [part.re for part in parts], [part.im for part in parts]


@given(st.integers(1, 40), st.floats(0.1, 10.0), st.integers(0, 10**6))
def test_values_are_the_polynomials_inside_and_beyond_the_interval(count: int, duration: float, seed: int) -> None:
    leads = duration * np.random.default_rng(seed).uniform(-0.02, 1.02, 20)
    wanted = np.polynomial.chebyshev.chebvander(1.0 - 2.0 * leads / duration, count - 1).T
    found = chebyshev_values(leads, duration, count)
    np.testing.assert_allclose(found, wanted, rtol=1e-9, atol=1e-11)
    ends = chebyshev_values(np.array([0.0, duration]), duration, count)
    np.testing.assert_allclose(ends[:, 0], 1.0, rtol=0.0, atol=1e-15)
    np.testing.assert_allclose(ends[:, 1], (-1.0) ** np.arange(count), rtol=0.0, atol=1e-13)


def test_values_keep_every_digit_beside_the_last_impulse() -> None:
    """At a lead of 1e-9 the polynomial differs from 1 by 2 n^2 u / T: x = 1 - 2 u / T itself would have lost that."""
    lead, count = 1.2345678901234567e-9, 60
    x = 1 - 2 * Decimal(lead)
    with localcontext(CONTEXT):
        wanted = [Decimal(1), x]
        for _ in range(count - 2):
            wanted.append(2 * x * wanted[-1] - wanted[-2])
    found = chebyshev_values(np.array([lead]), 1.0, count)[:, 0]
    np.testing.assert_allclose(found, [float(value) for value in wanted], rtol=0.0, atol=2e-16)


def test_the_derivative_is_that_of_numpys_series() -> None:
    count, duration = 30, 0.37
    matrix = chebyshev_derivative(count, duration)
    for degree in range(count):
        wanted = np.zeros(count)
        slope = np.polynomial.chebyshev.chebder(np.eye(count)[degree])
        wanted[: slope.size] = slope
        np.testing.assert_allclose(matrix[degree], wanted * (-2.0 / duration), rtol=1e-14)


@pytest.mark.parametrize(
    ("modes", "orders", "duration", "dependent"),
    [
        ([(1.0, 0.0), (9.0, 0.3)], (1, 0), 0.8, 0),
        ([(1.0, 0.01), (1.0005, 0.01)], (1, 1), 1.0, 0),
        ([(1.0, 0.01), (1.0 + 1e-6, 0.01)], (0, 0), 1.0, 0),
        ([(1.0, 0.01), (1.0 + 1e-6, 0.01)], (1, 1), 1.5, 0),
        ([(0.2, 0.0), (20.0, 0.0)], (2, 1), 1.0, 0),
        (DENSE, (1, 0, 0, 1, 1, 1), 3.0, 0),
        (DENSE[:4], (1, 1, 1, 0), 2.0, 2),
    ],
)
def test_the_rows_are_orthonormal_and_span_the_exponentials_to_all_digits(
    modes: list[tuple[float, float]], orders: tuple[int, ...], duration: float, dependent: int
) -> None:
    """The span of all functions, but of those of which less than 1e-22 is left beside the others."""
    rates = rates_of(modes)
    rows = orthonormal_series(rates, orders, duration)
    exact: list[list[Decimal]] = []
    for rate, order in zip(rates, orders, strict=True):
        for k in range(order + 1):
            exact += series(complex(rate), k, duration, rows.shape[1])
    reference, left = orthonormal(exact)
    assert rows.shape[0] == len(exact) - dependent
    assert (left[: rows.shape[0]] > 1e-22).all() and (left[rows.shape[0] :] < 1e-22).all()
    reference, smallest = reference[: rows.shape[0]], left[rows.shape[0] - 1]
    error = 1e-14 + 5e-31 / smallest  # what is left of 32 digits, after so many were lost
    np.testing.assert_allclose(rows @ rows.T, np.eye(len(rows)), rtol=0.0, atol=error)
    assert np.abs(rows - (rows @ reference.T) @ reference).max() < error
    assert np.abs(reference - (reference @ rows.T) @ rows).max() < error
    functions = np.array([[float(x) for x in vector] for vector in exact])
    np.testing.assert_allclose((functions @ rows.T) @ rows, functions, rtol=0.0, atol=error)


def test_plain_doubles_would_not_do() -> None:
    """The same span in sixteen digits is wrong in all of them: QR of the functions of the dense case."""
    rates, orders, duration = rates_of(DENSE), (1, 0, 0, 1, 1, 1), 3.0
    rows = orthonormal_series(rates, orders, duration)
    plain = np.array(
        [
            [float(x) for x in part]
            for rate, order in zip(rates, orders, strict=True)
            for k in range(order + 1)
            for part in series(complex(rate), k, duration, rows.shape[1])
        ]
    )
    naive = np.linalg.qr(plain.T)[0].T
    assert np.abs(naive - (naive @ rows.T) @ rows).max() > 1e-3


def test_a_rate_given_twice_asks_for_nothing_more() -> None:
    rates = rates_of([(1.0, 0.02), (1.0, 0.02), (3.0, 0.0)])
    assert orthonormal_series(rates, (0, 0, 0), 1.3).shape[0] == 4
    assert orthonormal_series(rates, (1, 0, 0), 1.3).shape[0] == 6
    assert orthonormal_series(rates[[0, 2]], (1, 0), 1.3).shape[0] == 6


@pytest.mark.parametrize("duration", [0.05, 1.0, 40.0])
def test_the_series_reproduce_the_exponentials_at_any_length(duration: float) -> None:
    """From a twentieth of a period, where they are nearly polynomials, to hundreds of radians."""
    rates, leads = rates_of([(1.0, 0.1), (2.7, 0.0)]), np.linspace(0.0, duration, 101)
    rows = orthonormal_series(rates, (1, 1), duration) @ chebyshev_values(
        leads, duration, orthonormal_series(rates, (1, 1), duration).shape[1]
    )
    for rate in rates:
        for k in range(2):
            wave = (leads / duration) ** k * np.exp(-rate * leads)
            for wanted in (wave.real, wave.imag):
                fitted = np.linalg.lstsq(rows.T, wanted, rcond=None)[0] @ rows
                np.testing.assert_allclose(fitted, wanted, rtol=0.0, atol=1e-13 * (1.0 + abs(rate) * duration))
