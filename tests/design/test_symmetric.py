"""Symmetric closed forms, against the engine's certified optimum and an independent plant."""

from __future__ import annotations

import math
from collections import Counter

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import Mode, Modes, Shaper, design
from preshape.design import symmetric_three_modes, symmetric_two_modes
from preshape.engine import shortest_positive
from preshape.errors import InputError
from preshape.plant import ModalPlant

ratios = st.floats(1.05, 2.95)
scales = st.floats(0.5, 20.0)
orders = st.integers(0, 1)


def undamped(*frequencies: float) -> Modes:
    return Modes([(f, 0.0) for f in frequencies])


def with_decay(damped_frequency: float, rate: float) -> Mode:
    """The mode exp(-rate t) sin(2 pi damped_frequency t)."""
    omega = math.hypot(rate, 2.0 * math.pi * damped_frequency)
    return Mode(omega / (2.0 * math.pi), rate / omega)


def at_rest(shaper: Shaper, modes: Modes, order: int) -> None:
    """No vibration by exact simulation, and the derivative of the residual zero by its definition."""
    assert ModalPlant(modes).impulse_residual(shaper.times, shaper.amplitudes).max() < 1e-13
    for mode in modes:
        waves = shaper.amplitudes * np.exp(mode.pole.conjugate() * (shaper.duration - shaper.times))
        slope = 2.0 * math.pi * mode.frequency * abs(waves @ (shaper.duration - shaper.times))
        assert slope < 1e-11 if order == 1 else slope > 1e-3


def same(found: Shaper, optimum: Shaper, tolerance: float = 1e-8) -> bool:
    return (
        len(found) == len(optimum)
        and np.abs(found.times - optimum.times).max() < tolerance * optimum.duration
        and np.abs(found.amplitudes - optimum.amplitudes).max() < tolerance
    )


@settings(max_examples=60)
@given(ratios, scales, orders)
def test_two_modes_are_the_shortest_shaper(ratio: float, scale: float, order: int) -> None:
    modes = undamped(scale, ratio * scale)
    found, optimum = symmetric_two_modes(modes, order), shortest_positive(modes, (order, order))
    searched = Shaper.normalised(optimum.times, optimum.amplitudes)  # found without knowing the closed form
    assert optimum.certificate is not None and optimum.certificate.holds and same(found, searched)
    assert same(found, design.direct(modes, order)) and design.direct(modes, order).design.status == "optimal"
    assert found.duration == pytest.approx((2.0 + 2.0 * order) / (scale + ratio * scale), rel=1e-14)
    assert found.design.status == "exact" and found.design.modes == modes and (found.amplitudes > 0.0).all()
    at_rest(found, modes, order)


def test_the_printed_example_of_two_modes() -> None:
    np.testing.assert_allclose(symmetric_two_modes(undamped(1.0, 2.0)).amplitudes, np.array([1, 2, 3, 2, 1]) / 9.0)
    np.testing.assert_allclose(symmetric_two_modes(undamped(2.0, 1.0), 0).amplitudes, [1 / 3, 1 / 3, 1 / 3])


def test_zero_slope_for_two_modes_is_the_convolution_with_itself() -> None:
    modes = undamped(1.0, 2.3)
    once, twice = symmetric_two_modes(modes, 0), symmetric_two_modes(modes, 1)
    assert same(once * once, twice, 1e-14)


def test_three_times_the_frequency_is_the_limit() -> None:
    for order, amplitudes in ((0, [0.5, 0.5]), (1, [0.25, 0.5, 0.25])):
        for scale in (1.0, 0.1, 7.3):
            found = symmetric_two_modes(undamped(scale, 3.0 * scale), order)
            np.testing.assert_allclose(found.amplitudes, amplitudes, rtol=1e-14)
            assert found.duration == pytest.approx(0.5 * (1 + order) / scale, rel=1e-12)
        with pytest.raises(InputError, match="more than three times"):
            symmetric_two_modes(undamped(1.0, 3.000001), order)


@settings(max_examples=40)
@given(st.floats(1.05, 1.9), st.floats(1.05, 1.55), scales, orders)
def test_three_modes_within_a_factor_of_three_are_the_shortest_shaper(
    first: float, second: float, scale: float, order: int
) -> None:
    modes = undamped(scale, first * scale, first * second * scale)
    found, optimum = symmetric_three_modes(modes, order), design.direct(modes, order)
    assert len(found) == 4 + 3 * order and found.design.status == "exact" and found.design.settings["start"] == "mean"
    at_rest(found, modes, order)
    if optimum.design.status == "optimal":
        assert same(found, optimum)
    else:
        assert found.duration <= optimum.duration


@pytest.mark.parametrize("order", [0, 1])
def test_wider_spacing_is_never_shorter_than_the_optimum_and_sometimes_longer(order: int) -> None:
    """Hyde: occasionally not as short. Of 1500 triples with f3 <= 5 f1, 86 % (order 0) and 60 % (order 1) are."""
    random, outcome = np.random.default_rng(7), Counter[str]()
    for _ in range(60):
        modes = undamped(1.0, *np.sort(random.uniform(1.1, 5.0, 2)).tolist())
        try:
            found = symmetric_three_modes(modes, order)
        except InputError:
            outcome["none"] += 1
            continue
        optimum = design.direct(modes, order)
        at_rest(found, modes, order)
        if optimum.design.status == "optimal":
            assert found.duration >= optimum.duration * (1.0 - 1e-9)
            outcome["shortest" if same(found, optimum) else "longer"] += 1
    assert outcome["shortest"] >= 30 and outcome["longer"] >= 3


@pytest.mark.parametrize(("order", "longer"), [(0, 1.2), (1, 1.3)])
def test_a_case_in_which_another_number_of_impulses_is_shorter(order: int, longer: float) -> None:
    modes = undamped(1.0, 2.293, 4.516) if order == 0 else undamped(1.0, 2.123, 4.448)
    found, optimum = symmetric_three_modes(modes, order), design.direct(modes, order)
    assert len(found) < len(optimum) and optimum.design.status == "optimal"
    assert longer < found.duration / optimum.duration < longer + 0.05


@pytest.mark.parametrize("order", [0, 1])
def test_the_middle_mode_at_the_mean_is_a_closed_form(order: int) -> None:
    """(1 - 2 c q + q^2)(1 + q) with q a delay of 1 / (f1 + f3)."""
    c = math.cos(2.0 * math.pi / 3.9)
    amplitudes = np.convolve([1.0, -2.0 * c, 1.0], [1.0, 1.0])
    amplitudes = np.convolve(amplitudes, amplitudes) if order else amplitudes
    found = symmetric_three_modes(undamped(1.0, 1.95, 2.9), order)
    np.testing.assert_allclose(found.times, np.arange(amplitudes.size) / 3.9, rtol=1e-12)
    np.testing.assert_allclose(found.amplitudes, amplitudes / amplitudes.sum(), rtol=1e-12)


def test_two_impulses_meet_in_the_middle_where_three_are_enough() -> None:
    """f3 = f1 + 2 f2 is an alias of f1 for impulses 1 / (f1 + f2) apart; beyond it the middle impulse is two."""
    at = symmetric_three_modes(undamped(1.0, 1.4, 3.8), 0)
    assert at.design.settings["start"] == "meeting" and same(at, symmetric_two_modes(undamped(1.0, 1.4), 0))
    beyond = symmetric_three_modes(undamped(1.0, 1.4, 3.9), 0)
    assert len(beyond) == 4 and same(beyond, design.direct(undamped(1.0, 1.4, 3.9), 0))


@settings(max_examples=20)
@given(ratios, scales, orders, st.floats(0.01, 1.0))
def test_equal_decay_rates_are_as_good_as_none(ratio: float, scale: float, order: int, per_cycle: float) -> None:
    pair = Modes([with_decay(f * scale, per_cycle * scale) for f in (ratio, 1.0)])
    found = symmetric_two_modes(pair, order)
    at_rest(found, pair, order)
    assert same(found, design.direct(pair, order))
    three = Modes([with_decay(f * scale, per_cycle * scale) for f in (1.0, 0.5 + 0.5 * ratio, ratio)])
    at_rest(symmetric_three_modes(three, order), three, order)


def test_wrong_input_is_refused() -> None:
    for function, count in ((symmetric_two_modes, 2), (symmetric_three_modes, 3)):
        with pytest.raises(InputError, match=f"{count} are expected"):
            function(undamped(1.0, 2.0, 3.0, 4.0))
        with pytest.raises(InputError, match="decay rates"):
            function([(1.0 + 0.5 * i, 0.01) for i in range(count)])
        with pytest.raises(InputError, match="order is 2"):
            function(undamped(*range(2, 2 + count)), 2)
    with pytest.raises(InputError, match="no positive symmetric shaper with 4 impulses"):
        symmetric_three_modes(undamped(1.0, 8.3, 9.9), 0)
