from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape import Shaper, design
from preshape.errors import InputError
from preshape.vibration import (
    damping_sensitivity_curve,
    residual_vibration,
    sensitivity_curve,
    sensitivity_map,
)


def robertson(shaper: Shaper, frequency: float, damping: float) -> float:
    """Robertson eq. 1-3 as printed: C and S sums, exp(-z w t_N) in front, + sign in the exponents."""
    w = 2.0 * math.pi * frequency
    wd = w * math.sqrt(1.0 - damping**2)
    c = sum(
        a * math.exp(damping * w * t) * math.cos(wd * t) for a, t in zip(shaper.amplitudes, shaper.times, strict=True)
    )
    s = sum(
        a * math.exp(damping * w * t) * math.sin(wd * t) for a, t in zip(shaper.amplitudes, shaper.times, strict=True)
    )
    return math.exp(-damping * w * shaper.times[-1]) * math.hypot(c, s)


@given(st.floats(0.0, 30.0), st.floats(0.0, 0.7))
def test_the_formula_is_robertson_s(frequency: float, damping: float) -> None:
    shaper = design.ei((7.0, 0.04))
    expected = robertson(shaper, frequency, damping)
    assert residual_vibration(shaper, frequency, damping) == pytest.approx(expected, rel=1e-9, abs=1e-13)


def test_the_wrong_sign_of_the_seeds_would_leave_much() -> None:
    """Hyde prints exp(-z w t): with it ZV's mirror image would come out, which leaves 1 - K (LITERATURE 4.1)."""
    right = design.zv((1.0, 0.1))
    mirrored = Shaper(right.times, right.amplitudes[::-1])
    assert residual_vibration(right, 1.0, 0.1) < 1e-15
    assert residual_vibration(mirrored, 1.0, 0.1) == pytest.approx(0.2708, abs=5e-5)


def test_long_and_heavily_damped_shapers_do_not_overflow() -> None:
    shaper = Shaper([0.0, 500.0], [0.5, 0.5])
    assert residual_vibration(shaper, 10.0, 0.9) == pytest.approx(0.5)


def test_curves_and_maps_are_the_same_function_on_even_and_uneven_grids() -> None:
    shaper = design.direct([(1.0, 0.02), (2.7, 0.0)])
    even = np.linspace(0.0, 5.0, 1000)
    uneven = np.sort(np.append(even, 2.34567))
    dampings = [0.0, 0.05, 0.3]
    grid = sensitivity_map(shaper, even, dampings)
    assert grid.vibration.shape == (3, 1000)
    for row, damping in zip(grid.vibration, dampings, strict=True):
        np.testing.assert_allclose(row, residual_vibration(shaper, uneven, damping)[uneven != 2.34567], atol=1e-12)
        np.testing.assert_array_equal(sensitivity_curve(shaper, even, damping).vibration[0], row)
    column = damping_sensitivity_curve(shaper, float(even[321]), dampings)
    np.testing.assert_allclose(column.vibration[:, 0], grid.vibration[:, 321], atol=1e-12)


def test_undamped_zv_and_zvd_follow_their_closed_curves() -> None:
    ratio = np.linspace(0.0, 2.0, 401)
    np.testing.assert_allclose(
        residual_vibration(design.zv((3.0, 0.0)), 3.0 * ratio), np.abs(np.cos(np.pi * ratio / 2.0)), atol=1e-13
    )
    np.testing.assert_allclose(
        residual_vibration(design.zvd((3.0, 0.0)), 3.0 * ratio), np.cos(np.pi * ratio / 2.0) ** 2, atol=1e-13
    )


def test_odd_harmonics_are_suppressed_without_damping_only() -> None:
    """Hyde, figures 3.4 and 3.6."""
    assert residual_vibration(design.zv((1.0, 0.0)), [3.0, 5.0, 7.0]).max() < 1e-14
    assert residual_vibration(design.zv((1.0, 0.1)), [3.0, 5.0, 7.0], 0.1).min() > 0.1


@pytest.mark.parametrize(
    ("frequency", "damping", "sentence"),
    [(-1.0, 0.0, "negative"), (math.nan, 0.0, "NaN"), (1.0, 1.0, r"\[0, 1\)"), (1.0, math.nan, r"\[0, 1\)")],
)
def test_impossible_modes_are_refused(frequency: float, damping: float, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        residual_vibration(design.zv((1.0, 0.0)), frequency, damping)
    with pytest.raises(InputError, match="flat lists"):
        sensitivity_map(design.zv((1.0, 0.0)), [[1.0]], [0.0])
