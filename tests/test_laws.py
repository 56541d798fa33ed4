"""The laws that every family obeys, from the list in laws.py."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from tests.laws import DERIVATIVE_FAMILIES, FAMILIES, HUMP_FAMILIES, ZERO_FAMILIES, Family, damped_cases

from preshape import Modes, Shaper
from preshape.plant import ModalPlant
from preshape.vibration import insensitivity, residual_vibration

SEVERAL = Modes([(1.0, 0.02), (2.7, 0.05), (4.1, 0.0)])


def ids(value: object) -> str:
    return value.name if isinstance(value, Family) else f"z={value}"


def damped(family: Family, damping: float) -> Shaper:
    return family.build(Modes((10.0, damping)))


@pytest.mark.parametrize(("family", "damping"), damped_cases(FAMILIES), ids=ids)
def test_is_a_shaper_of_gain_one_with_impulses_as_promised(family: Family, damping: float) -> None:
    shaper = damped(family, damping)
    assert shaper.times[0] == 0.0
    assert (np.diff(shaper.times) > 0.0).all()
    signs = (-1.0) ** np.arange(len(shaper)) if family.negative else np.ones(len(shaper))
    np.testing.assert_array_equal(np.sign(shaper.amplitudes), signs)
    assert shaper.amplitudes.sum() == pytest.approx(1.0, abs=1e-14)
    sums, (low, high) = np.cumsum(shaper.amplitudes), family.partial_sums
    assert low - 1e-14 <= sums.min() and sums.max() <= high + 1e-14


@pytest.mark.parametrize(("family", "damping"), damped_cases(ZERO_FAMILIES), ids=ids)
def test_no_vibration_at_the_mode(family: Family, damping: float) -> None:
    assert residual_vibration(damped(family, damping), 10.0, damping) < 1e-12


@pytest.mark.parametrize("family", ZERO_FAMILIES, ids=ids)
def test_no_vibration_at_several_modes(family: Family) -> None:
    shaper = family.build(SEVERAL)
    for mode in SEVERAL:
        assert residual_vibration(shaper, mode.frequency, mode.damping) < 1e-12


@pytest.mark.parametrize(("family", "damping"), damped_cases(ZERO_FAMILIES, (0.0, 0.1, 0.3)), ids=ids)
def test_the_independent_plant_is_at_rest_after_the_last_impulse(family: Family, damping: float) -> None:
    shaper = damped(family, damping)
    plant = ModalPlant(Modes((10.0, damping)))
    assert plant.impulse_residual(shaper.times, shaper.amplitudes)[0] < 1e-9


@pytest.mark.parametrize("family", FAMILIES, ids=ids)
@pytest.mark.parametrize("offset", [0.8, 1.13])
def test_the_formula_agrees_with_the_independent_plant_off_the_mode(family: Family, offset: float) -> None:
    shaper = damped(family, 0.1)
    plant = ModalPlant(Modes((10.0 * offset, 0.1)))
    simulated = plant.impulse_residual(shaper.times, shaper.amplitudes)[0]
    assert simulated == pytest.approx(float(residual_vibration(shaper, 10.0 * offset, 0.1)), abs=1e-9)


@pytest.mark.parametrize(("family", "damping"), damped_cases(DERIVATIVE_FAMILIES, (0.0, 0.05, 0.2)), ids=ids)
def test_vibration_grows_with_the_promised_power_of_the_frequency_error(family: Family, damping: float) -> None:
    """The slope of log V against log error is order + 1: 1, 2, 3 for ZV, ZVD, ZVDD."""
    shaper = damped(family, damping)
    reach = 10.0 ** (-7.0 / (family.order + 1.0))
    errors = np.geomspace(reach, 3.0 * reach, 9)
    slopes = []
    for sign in (1.0, -1.0):
        vibration = residual_vibration(shaper, 10.0 * (1.0 + sign * errors), damping)
        slopes.append(np.polyfit(np.log(errors), np.log(vibration), 1)[0])
    assert np.mean(slopes) == pytest.approx(family.order + 1, abs=0.01)


@pytest.mark.parametrize(("family", "damping"), damped_cases(HUMP_FAMILIES), ids=ids)
def test_every_hump_is_exactly_the_tolerance_and_there_are_as_many_as_promised(family: Family, damping: float) -> None:
    from scipy.optimize import minimize_scalar

    shaper, tolerance = damped(family, damping), family.tolerance
    band = insensitivity(shaper, (10.0, damping), tolerance)
    frequencies = np.linspace(band.low, min(band.high, 60.0), 8001)[1:-1]
    vibration = residual_vibration(shaper, frequencies, damping)
    peaks = np.flatnonzero((vibration[1:-1] > vibration[:-2]) & (vibration[1:-1] >= vibration[2:])) + 1
    heights = []
    for peak in peaks:
        found = minimize_scalar(
            lambda f: -float(residual_vibration(shaper, f, damping)),
            bounds=(frequencies[peak - 1], frequencies[peak + 1]),
            method="bounded",
            options={"xatol": 1e-9},
        )
        heights.append(-found.fun)
    tallest = np.sort(heights)[::-1]
    assert np.abs(tallest[: family.humps] - tolerance).max() < 1e-10
    assert len(heights) >= family.humps
    assert (tallest[family.humps :] < tolerance).all()


@pytest.mark.parametrize("family", FAMILIES, ids=ids)
def test_time_scales_with_the_period(family: Family) -> None:
    slow, fast = family.build(Modes((1.0, 0.1))), family.build(Modes((50.0, 0.1)))
    np.testing.assert_allclose(fast.times * 50.0, slow.times, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(fast.amplitudes, slow.amplitudes, rtol=1e-7)


@pytest.mark.parametrize("family", FAMILIES, ids=ids)
def test_a_file_gives_back_the_same_shaper_and_design(family: Family) -> None:
    shaper = family.build(SEVERAL)
    again = Shaper.from_dict(json.loads(json.dumps(shaper.to_dict())))
    assert again == shaper
    assert again.design == shaper.design


@pytest.mark.parametrize("family", FAMILIES, ids=ids)
def test_a_constant_command_stays_constant_and_a_step_arrives(family: Family) -> None:
    shaper, dt = family.build(SEVERAL), 0.013
    rounding = 1e-14 * np.abs(shaper.amplitudes).sum()
    steady = shaper.shape(np.full(50, 3.25), dt, initial=3.25)
    np.testing.assert_allclose(steady, 3.25, rtol=rounding)
    step = shaper.shape(np.ones(5), dt)
    assert step.size == 5 + math.ceil(shaper.duration / dt)
    assert step[-1] == pytest.approx(1.0, abs=rounding)
    if family.negative:
        settings = shaper.design.settings
        assert settings["lowest_partial_sum"] - rounding <= step.min()
        assert step.max() <= settings["highest_partial_sum"] + rounding
    else:
        assert (np.diff(step) >= -1e-15).all()


@pytest.mark.parametrize("family", FAMILIES, ids=ids)
def test_the_design_says_what_was_asked_and_how_it_went(family: Family) -> None:
    shaper = family.build(SEVERAL)
    assert shaper.design.modes == SEVERAL
    assert shaper.design.status in ("exact", "optimal")
    worst = max(float(residual_vibration(shaper, mode.frequency, mode.damping)) for mode in SEVERAL)
    assert shaper.design.residual == pytest.approx(worst, rel=1e-12, abs=1e-14)
    if shaper.design.status == "optimal" and "proved" not in shaper.design.settings:  # on a grid: proved in words
        assert shaper.design.certificate is not None and shaper.design.certificate.holds
