"""Sums, products, quotients and roots of double-doubles against exact fractions."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from preshape.kernel.double_double import DoubleDouble

LOST = Fraction(1, 2**102)
"""Largest relative error of one operation: two to four units in the 106th binary digit, a little more for a product."""


def exact(value: DoubleDouble) -> Fraction:
    """The one number of a double-double of shape () or (1,), as a fraction."""
    return Fraction(float(np.ravel(value.high)[0])) + Fraction(float(np.ravel(value.low)[0]))


def normal(value: DoubleDouble) -> bool:
    """Whether low is what rounding to high left over."""
    return bool((value.high + value.low == value.high).all())


sizes = st.floats(1e-30, 1e30)
signs = st.sampled_from([-1.0, 1.0])
tails = st.floats(-1.0, 1.0)


@st.composite
def double_doubles(draw: st.DrawFn) -> DoubleDouble:
    """high + low with low up to half a unit in the last place of high."""
    high = draw(sizes) * draw(signs)
    low = draw(tails) * float(np.spacing(abs(high))) / 2.0
    return DoubleDouble(np.array([high]), np.array([low])) + DoubleDouble.of(np.zeros(1))


def test_doubles_are_taken_exactly() -> None:
    given_values = np.array([0.1, -3.0, 1e300, 5e-324])
    taken = DoubleDouble.of(given_values)
    np.testing.assert_array_equal(taken.high, given_values)
    np.testing.assert_array_equal(taken.low, 0.0)
    assert exact(DoubleDouble.of(0.1)) == Fraction(0.1)
    assert exact(-taken[1]) == 3


@given(double_doubles(), double_doubles())
def test_sums_and_differences_keep_thirty_digits_of_the_result(a: DoubleDouble, b: DoubleDouble) -> None:
    for found, wanted in ((a + b, exact(a) + exact(b)), (a - b, exact(a) - exact(b))):
        assert abs(exact(found) - wanted) <= LOST * abs(wanted)
        assert normal(found)


@given(double_doubles(), st.integers(-50, 50))
def test_cancellation_loses_nothing_that_was_there(a: DoubleDouble, ulps: int) -> None:
    """Neighbours differ by their last digits, and the difference shows just these."""
    b = DoubleDouble(a.high + ulps * np.spacing(np.abs(a.high)), a.low)
    wanted = exact(a) - exact(b)
    assert abs(exact(a - b) - wanted) <= LOST * abs(wanted)


@given(double_doubles(), double_doubles())
def test_products_and_quotients_keep_thirty_digits(a: DoubleDouble, b: DoubleDouble) -> None:
    product, quotient = a * b, a / b
    assert abs(exact(product) - exact(a) * exact(b)) <= 4 * LOST * abs(exact(a) * exact(b))
    assert abs(exact(quotient) - exact(a) / exact(b)) <= 8 * LOST * abs(exact(a) / exact(b))
    assert normal(product) and normal(quotient)


@given(double_doubles())
def test_roots_square_back(a: DoubleDouble) -> None:
    assume(exact(a) > 0)
    root = a.sqrt()
    assert exact(root) > 0 and normal(root)
    assert abs(exact(root) ** 2 - exact(a)) <= 16 * LOST * exact(a)


def test_what_a_double_cannot_see() -> None:
    """1 + 1e-25 - 1, a third times three, the square of the root of two."""
    one, tiny = DoubleDouble.of(np.ones(1)), DoubleDouble.of(np.array([1e-25]))
    assert exact(one + tiny - one) == pytest.approx(Fraction(1e-25), rel=1e-6)
    third = one / DoubleDouble.of(np.array([3.0]))
    assert abs(exact(third) - Fraction(1, 3)) < Fraction(1, 2**105)
    two = DoubleDouble.of(np.array([2.0]))
    assert abs(exact(two.sqrt()) ** 2 - 2) < Fraction(1, 2**102)


@pytest.mark.parametrize("count", [1, 2, 3, 7, 64, 101])
def test_sums_over_the_last_axis_equal_those_of_fractions(count: int) -> None:
    rng = np.random.default_rng(count)
    high = rng.normal(size=(3, count)) * 10.0 ** rng.uniform(-12.0, 12.0, (3, count))
    low = rng.uniform(-0.5, 0.5, high.shape) * np.spacing(np.abs(high))
    total = DoubleDouble(high, low).sum()
    assert total.high.shape == (3,)
    for row in range(3):
        parts = [Fraction(float(x)) + Fraction(float(y)) for x, y in zip(high[row], low[row], strict=True)]
        assert abs(exact(total[row]) - sum(parts)) <= count * LOST * sum(abs(part) for part in parts)


def test_arrays_broadcast_and_are_indexed_like_their_parts() -> None:
    column, row = DoubleDouble.of(np.array([[1.0], [3.0]])), DoubleDouble.of(np.array([[7.0, 9.0, 11.0]]))
    table = column / row
    assert table.high.shape == (2, 3)
    assert abs(exact(table[1, 2]) - Fraction(3, 11)) < LOST
    assert exact(table[:, 0].sum()) == pytest.approx(Fraction(4, 7), rel=1e-30)
