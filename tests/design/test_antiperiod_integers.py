"""The integers behind an antiperiod: common frequency and existence tests, each against brute force."""

from __future__ import annotations

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from preshape import Mode
from preshape.design.antiperiod import all_odd, common_frequency, diophantine_divisors
from preshape.design.antiperiod.common_frequency import simplest_fraction
from preshape.errors import InputError


@given(st.lists(st.integers(1, 40), min_size=1, max_size=4, unique=True))
@example([6, 21, 77])
def test_odd_integers_are_necessary_and_sufficient(integers: list[int]) -> None:
    """Brute force: y(t + T) = -y(t) for some odd number of half periods T of the first mode, within one period."""
    t = np.random.default_rng(1).uniform(0.0, 2.0 * math.pi, 40)
    candidates = math.pi * np.arange(1, 2 * integers[0], 2) / integers[0]
    m = np.array(integers)[:, np.newaxis]
    y = np.sin(m * t).sum(axis=0)
    misses = [np.abs(np.sin(m * (t + delay)).sum(axis=0) + y).max() for delay in candidates]
    assert all_odd(integers) == (min(misses) < 1e-9)


def minors(rows: list[list[int]]) -> int:
    """Greatest common divisor of all determinants of as many columns as rows, by the definition."""

    def determinant(matrix: list[list[int]]) -> int:
        if not matrix:
            return 1
        signs = itertools.cycle((1, -1))
        rest = [[row[:j] + row[j + 1 :] for row in matrix[1:]] for j in range(len(matrix))]
        return sum(s * x * determinant(r) for s, x, r in zip(signs, matrix[0], rest, strict=False) if x)

    columns = itertools.combinations(range(len(rows[0])), len(rows))
    return math.gcd(*(determinant([[row[j] for j in chosen] for row in rows]) for chosen in columns))


def equations(m: list[int], pairs: list[tuple[int, int]]) -> tuple[list[list[int]], list[list[int]]]:
    """The rows 2 m_j v_i - 2 m_i v_j = m_i - m_j of (12), without and with the right-hand side."""
    rows = []
    for i, j in pairs:
        row = [0] * len(m)
        row[i], row[j] = 2 * m[j], -2 * m[i]
        rows.append(row)
    return rows, [[*row, m[i] - m[j]] for row, (i, j) in zip(rows, pairs, strict=True)]


@given(st.lists(st.integers(1, 99), min_size=2, max_size=4))
def test_the_diophantine_test_is_the_determinants_and_agrees_with_the_odd_test(integers: list[int]) -> None:
    rows, augmented = equations(integers, [(0, j) for j in range(1, len(integers))])
    divisors = diophantine_divisors(integers)
    assert divisors == (minors(rows), minors(augmented))
    assert (divisors[0] == divisors[1]) == all_odd(integers)
    if len(integers) == 3:  # it does not matter which two rows are picked, though both divisors change
        others = equations(integers, [(0, 1), (1, 2)])
        assert (minors(others[0]) == minors(others[1])) == all_odd(integers)


@settings(max_examples=60)
@given(st.lists(st.floats(1.0, 6.0), min_size=2, max_size=3), st.sampled_from([1e-3, 5e-3, 0.02]))
def test_the_integers_are_the_smallest_ones(frequencies: list[float], tolerance: float) -> None:
    """Brute force: every m_1, every m_i in reach, the exact condition on all pairs."""
    modes = [Mode(f, 0.1 * i) for i, f in enumerate(frequencies)]
    f = [Fraction(mode.omega_d) for mode in modes]
    lowest, limit = f.index(min(f)), int(0.25 / tolerance)
    spread = (1 + Fraction(tolerance)) / (1 - Fraction(tolerance))
    expected: tuple[int, ...] | None = None
    for first in range(1, limit + 1):
        base = f[lowest] / first
        reach = [range(math.ceil(x / base / spread), math.floor(x / base * spread) + 1) for x in f]
        reach[lowest] = range(first, first + 1)
        fits = [
            m
            for m in itertools.product(*reach)
            if max(q := [x / n for x, n in zip(f, m, strict=True)]) <= spread * min(q) and max(m) <= limit
        ]
        if fits:
            assert len(fits) == 1, "the limit makes the integers unique"
            expected = fits[0]
            break
    found = common_frequency(modes, tolerance)
    assert (found.integers if found else None) == expected
    if found:
        assert max(map(abs, found.deviations)) <= tolerance * (1.0 + 1e-9) and math.gcd(*found.integers) == 1


@given(st.fractions(Fraction(1, 20), 20, max_denominator=200), st.fractions(0, 1, max_denominator=1000))
def test_the_continued_fraction_finds_the_smallest_terms(low: Fraction, width: Fraction) -> None:
    high = low + width
    found = simplest_fraction(low, high)
    denominator = next(q for q in itertools.count(1) if math.ceil(low * q) <= high * q)
    assert found == Fraction(math.ceil(low * denominator), denominator)
    assert low <= found <= high


def test_an_integer_is_a_whole_number_above_zero() -> None:
    for wrong in ([1, 0], [1, 2.5], []):
        for test in (all_odd, diophantine_divisors):
            with pytest.raises(InputError, match="integer"):
                test(wrong)
