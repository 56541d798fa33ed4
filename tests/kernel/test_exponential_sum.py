from __future__ import annotations

import cmath

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape.kernel import exponential_sum, exponential_sum_uniform


def naive(amplitudes: np.ndarray, times: np.ndarray, rate: complex) -> complex:
    return sum(a * cmath.exp(rate * t) for a, t in zip(amplitudes.tolist(), times.tolist(), strict=True))


@given(st.integers(1, 12), st.integers(1, 40), st.floats(0.0, 3.0), st.floats(-20.0, 20.0), st.integers(0, 10**6))
def test_both_forms_agree_with_the_plain_sum(n: int, count: int, growth: float, step: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    amplitudes, times = rng.normal(size=n), -rng.random(n)
    first, increment = complex(0.0, 3.0), complex(growth, step)
    rates = first + increment * np.arange(count)
    expected = np.array([naive(amplitudes, times, complex(rate)) for rate in rates])
    scale = np.abs(amplitudes).sum() * 1e-13 * (1.0 + np.abs(rates).max())
    np.testing.assert_allclose(exponential_sum(amplitudes, times, rates), expected, atol=scale)
    uniform = exponential_sum_uniform(amplitudes, times, first, increment, count)
    np.testing.assert_allclose(uniform, expected, atol=scale)


def test_long_lists_are_evaluated_block_by_block_with_no_seam() -> None:
    rng = np.random.default_rng(3)
    amplitudes, times = rng.random(5), -rng.random(5)
    rates = 1j * rng.random(10_000) * 50.0
    whole = exponential_sum(amplitudes, times, rates)
    for index in (0, 4095, 4096, 8191, 8192, 9999):
        assert whole[index] == pytest.approx(naive(amplitudes, times, complex(rates[index])), abs=1e-13)
