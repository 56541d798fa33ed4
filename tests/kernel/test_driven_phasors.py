"""phi functions against exact rational sums, driven phasors against the matrix exponential."""

import cmath
import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm

from preshape.kernel import driven_phasors, phi_functions


def phi_by_fractions(z: complex, order: int) -> complex:
    """sum z^n / (n + k)! without any rounding before the last step."""
    x, y = Fraction(z.real), Fraction(z.imag)
    real, imag = Fraction(0), Fraction(0)
    a, b = Fraction(1), Fraction(0)
    for n in range(int(4 * abs(z)) + 40):
        factorial = math.factorial(n + order)
        real, imag = real + a / factorial, imag + b / factorial
        a, b = a * x - b * y, a * y + b * x
    return complex(float(real), float(imag))


@pytest.mark.parametrize("size", [0.0, 1e-12, 1e-5, 0.1, 1.0, 2.4999, 2.5, 4.0, 12.0])
@pytest.mark.parametrize("turn", [0.5, 0.6, 0.85, 1.0])
def test_phi_functions_are_good_to_the_last_digits(size: float, turn: float) -> None:
    z = size * cmath.exp(1j * math.pi * turn)
    for count in (1, 2, 4, 7):
        values = phi_functions(np.array([z]), count)
        for order, value in enumerate(values):
            exact = phi_by_fractions(z, order)
            scale = min(1.0 / math.factorial(order), 1.0 / max(size, 1e-300))
            assert abs(value[0] - exact) < 2e-14 * max(abs(exact), 0.1 * scale), (count, order)


poles = st.builds(complex, st.floats(-5.0, 0.0), st.floats(0.1, 40.0))


@given(
    st.lists(poles, min_size=1, max_size=3),
    st.lists(
        st.tuples(st.floats(0.0, 1.5), st.lists(st.floats(-3.0, 3.0), min_size=4, max_size=4)), min_size=1, max_size=5
    ),
)
def test_phasors_agree_with_the_matrix_exponential(s: list[complex], pieces: list[tuple[float, list[float]]]) -> None:
    starts = np.cumsum([gap for gap, _ in pieces])
    taylor = np.array([row for _, row in pieces])
    run = driven_phasors(np.array(s), starts, taylor)
    looks = np.linspace(starts[0], starts[-1] + 2.0, 23)
    segment = run.segment(looks)
    (values, rates), forces = run.look(segment, looks - starts[segment], 1)
    np.testing.assert_allclose(rates, np.array(s)[:, None] * values + forces[0], rtol=0, atol=1e-12 * 40)
    for pole, row in zip(s, values, strict=True):
        # The state is (q, f, f', f'', f'''): the input is a state that only the segments change.
        system = np.diag(np.ones(4, dtype=complex), 1)
        system[0, 0] = pole
        q, expected = 0.0j, []
        for k, start in enumerate(starts):
            for look in looks[segment == k]:
                expected.append((expm(system * (look - start)) @ [q, *taylor[k]])[0])
            if k + 1 < len(starts):
                q = (expm(system * (starts[k + 1] - start)) @ [q, *taylor[k]])[0]
        np.testing.assert_allclose(row, expected, rtol=0, atol=1e-11 * max(1.0, np.abs(expected).max()))


def test_a_slow_pole_loses_no_digits() -> None:
    # As s -> 0 the phasor is the plain integral of the input; its polynomial solution has f / s^4 in it.
    taylor = np.array([[0.0, 0.0, 0.0, 6.0], [1.0, 0.0, -1.0, 0.0]])
    run = driven_phasors(np.array([-1e-9 + 1e-7j]), np.array([0.0, 1.0]), taylor)
    # t^4/4 + s t^5/20 + ...
    assert run.at_start[0, 1].real == pytest.approx(0.25 - 1e-9 / 20, rel=1e-14, abs=0.0)
    assert run.at_start[0, 1].imag == pytest.approx(1e-7 / 20, rel=1e-8, abs=0.0)


def test_kicks_come_with_the_segment_and_nothing_is_before_the_first() -> None:
    starts, kicks = np.array([0.5, 0.5, 2.0]), np.array([[1.0, 2.0, -1.0j]])
    run = driven_phasors(np.array([-1.0 + 3.0j]), starts, np.zeros((3, 1)), kicks)
    assert run.segment(np.array([0.4, 0.5, 1.9, 2.0])).tolist() == [-1, 1, 1, 2]
    expected = [1.0, 3.0, 3.0 * cmath.exp((-1.0 + 3.0j) * 1.5) - 1.0j]
    np.testing.assert_allclose(run.at_start[0], expected, rtol=1e-15)
