"""SD-ZV shapers: nothing left, the deflection exactly at its limit, the printed anchors, and the engine's optimum."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from preshape import Mode, Shaper, design
from preshape.engine import ImpulsesBetween, ServoGrid, ZeroVibration, deflection_at_most, minimum_duration
from preshape.errors import InputError
from preshape.plant import ModalPlant, PositionedMass
from preshape.profile import Profile
from preshape.vibration import deflection_ratio, insensitivity, ramp_deflection, residual_vibration

FORMS = ("impulses", "box")
dampings = st.one_of(st.just(0.0), st.floats(1e-6, 0.7))
shares = st.floats(0.03, 1.0)
"""Of the largest ratio, 1/(1 + K)."""

# A mass under PD control, f = 1 Hz, z = 0.1: amplitudes and times as derived from the paper's description.
ANCHORS = [
    (0.1, 0.4, [0.4, 0.308301, 0.291699], [0.0, 0.31010, 0.64994]),
    (0.1, 0.3, [0.3, 0.481226, 0.218774], [0.0, 0.43335, 0.88205]),
    (0.0, 0.4, [0.4, 0.2, 0.4], [0.0, 0.290215, 0.580431]),
    (0.0, 0.3, [0.3, 0.4, 0.3], [0.0, 0.366140, 0.732280]),
    (0.0, 0.25, [0.25, 0.5, 0.25], [0.0, 0.5, 1.0]),
]
# 5 % insensitivity at f = 1 Hz, Robertson's figures 13 and 14: (ratio, damping, low, high).
BANDS = [
    (0.4, 0.0, 0.9649, 1.0357),
    (0.4, 0.1, 0.9526, 1.0507),
    (0.4, 0.2, 0.9318, 1.0826),
    (0.3, 0.0, 0.9535, 1.0514),
    (0.3, 0.05, 0.9389, 1.0785),
    (0.3, 0.1, 0.9097, 1.2912),
]


def largest_ratio(damping: float) -> float:
    return 1.0 / (1.0 + Mode(1.0, damping).decay_per_half_period)


@pytest.mark.parametrize(("damping", "ratio", "amplitudes", "times"), ANCHORS)
def test_the_anchors(damping: float, ratio: float, amplitudes: list[float], times: list[float]) -> None:
    shaper = design.sd_zv((1.0, damping), ratio)
    np.testing.assert_allclose(shaper.amplitudes, amplitudes, rtol=0.0, atol=1e-6)
    np.testing.assert_allclose(shaper.times, times, rtol=0.0, atol=1e-5)


@pytest.mark.parametrize(("ratio", "damping", "low", "high"), BANDS)
def test_the_insensitivities(ratio: float, damping: float, low: float, high: float) -> None:
    found = insensitivity(design.sd_zv((1.0, damping), ratio), (1.0, damping), 0.05)
    assert (found.low, found.high) == pytest.approx((low, high), abs=1e-4)


@pytest.mark.parametrize("form", FORMS)
@given(dampings, shares, st.floats(0.1, 100.0))
def test_nothing_is_left_and_the_ratio_is_exact(form: str, damping: float, share: float, frequency: float) -> None:
    mode, ratio = Mode(frequency, damping), share * largest_ratio(damping)
    shaper = design.sd_zv(mode, ratio, form)
    assert float(residual_vibration(shaper, frequency, damping)) < 1e-12
    plant = PositionedMass(mode)
    for order, unshaped in ((1, plant.ramp_deflection(1.0)), (0, 1.0)):  # a ramp, and a step of position
        motion = plant.motion(Profile.steps([0.0], [1.0], order=order).shaped(shaper))
        assert motion.peak("deflection").value == pytest.approx(ratio * unshaped, rel=1e-12)
        assert motion.residual("deflection") < 1e-12 * unshaped
    assert deflection_ratio(shaper, mode) == pytest.approx(ratio, rel=1e-12)
    assert shaper.design.settings["deflection_reached"][0] == pytest.approx(ratio, rel=1e-12)
    assert shaper.design.status == "exact" and shaper.design.residual < 1e-12
    assert (shaper.amplitudes > 0.0).all()


def test_the_limit_holds_in_a_step_by_step_integration() -> None:
    """d'' + 2 z w d' + w^2 d = r'' for a ramp of speed 1: impulses kick d', the box pushes it."""
    mode, ratio = Mode(1.0, 0.1), 0.3
    shaper = design.sd_zv(mode, ratio, "box")
    ((start, end, density),) = shaper.boxes
    state, peak = np.array([0.0, shaper.amplitudes[0]]), 0.0
    for a, b, push in ((0.0, start, 0.0), (start, end, density), (end, shaper.times[1], 0.0)):
        run = solve_ivp(
            lambda t, y, f: [y[1], f - 2.0 * mode.damping * mode.omega * y[1] - mode.omega**2 * y[0]],
            (a, b), state, args=(push,), rtol=1e-11, atol=1e-14, max_step=0.01,
        )  # fmt: skip
        peak, state = max(peak, float(np.abs(run.y[0]).max())), run.y[:, -1]
    assert peak == pytest.approx(ratio * ramp_deflection(mode), rel=1e-8)
    assert np.abs(state + [0.0, shaper.amplitudes[1]]).max() < 1e-9


def test_a_move_and_return_keeps_the_limit_and_what_an_error_does_to_it() -> None:
    """Robertson's move: 2 units in 1.5 s, 2 s dwell, back; peak over limit for a frequency off by a ratio."""
    move = Profile.steps([0.0, 1.5, 3.5, 5.0], np.array([1.0, -1.0, -1.0, 1.0]) * 2.0 / 1.5, order=1)
    plant = PositionedMass((1.0, 0.1))
    for ratio, printed in ((0.4, {0.9: 1.264, 1.0: 1.0, 1.2: 0.833, 1.4: 0.746}), (0.3, {0.9: 1.313, 1.6: 1.071})):
        shaped = design.sd_zv((1.0, 0.1), ratio).shape(move)
        limit = ratio * plant.ramp_deflection(2.0 / 1.5)
        for frequency, expected in printed.items():
            peak = plant.retuned(frequency).motion(shaped).peak("deflection").value
            assert peak / limit == pytest.approx(expected, abs=1e-3)
        assert plant.motion(shaped).residual("deflection") < 1e-12


@given(dampings, shares)
def test_the_box_is_the_limit_of_ever_more_impulses_and_shorter_than_all(damping: float, share: float) -> None:
    mode, ratio = Mode(1.0, damping), share * largest_ratio(damping)
    box, impulses = design.sd_zv(mode, ratio, "box"), design.sd_zv(mode, ratio)
    assert box.duration <= impulses.duration * (1.0 + 1e-12)
    waves = len(impulses) - 1
    low, high = impulses.design.settings["ratio_range"]
    assert low * (1.0 - 1e-12) <= ratio <= high * (1.0 + 1e-12)
    assert low == pytest.approx(largest_ratio(damping) / waves, rel=1e-12)


@pytest.mark.parametrize("damping", [0.0, 0.1, 0.3])
@pytest.mark.parametrize("ratio", [0.12, 0.3, 0.45])
def test_the_box_is_the_optimum_of_the_engine_to_a_slot(damping: float, ratio: float) -> None:
    mode, dt = Mode(1.0, damping), 0.01 if ratio > 0.2 else 0.04
    exact = design.sd_zv(mode, ratio, "box").duration
    asked = [ZeroVibration(mode), ImpulsesBetween(0.0, 1.0), deflection_at_most(mode, ratio, dt), ServoGrid(dt)]
    found = minimum_duration(asked)
    assert found.status == "optimal"
    assert exact - dt <= found.times[-1] <= exact + dt
    gridded = design.sd_zv(mode, ratio, dt=dt)
    assert exact - 1e-9 <= gridded.duration <= exact + 2.0 * dt
    assert gridded.design.settings["deflection_reached"][0] <= ratio
    assert gridded.design.residual < 1e-9


@pytest.mark.parametrize("damping", [0.0, 0.05, 0.3])
def test_at_the_ends_of_a_range_it_is_what_it_borders_on(damping: float) -> None:
    mode, most = Mode(1.0, damping), largest_ratio(damping)
    zv = design.zv(mode)
    for form in FORMS:
        at = design.sd_zv(mode, most, form)
        np.testing.assert_allclose(at.times, zv.times, rtol=1e-15)
        np.testing.assert_allclose(at.amplitudes, zv.amplitudes, rtol=1e-14)
        near = design.sd_zv(mode, most * (1.0 - 1e-10), form)
        assert near.duration == pytest.approx(zv.duration, rel=1e-9)
        assert near.design.residual < 1e-12
    kept = mode.decay_per_half_period
    half = design.sd_zv(mode, most / 2.0)
    np.testing.assert_allclose(half.amplitudes, np.array([1.0, 1.0 + kept, kept]) * most / 2.0, rtol=1e-12)
    np.testing.assert_allclose(half.times, np.arange(3) * mode.damped_period / 2.0, rtol=1e-12)
    assert len(design.sd_zv(mode, most / 2.0 * (1.0 - 1e-9))) == 4


@given(st.floats(0.0, 0.2), st.floats(0.0, 0.2), st.floats(0.1, 0.5), st.floats(1.3, 4.0))
def test_convolved_for_several_modes_no_deflection_is_above_the_limit(
    first: float, second: float, ratio: float, high: float
) -> None:
    modes = [(1.0, first), (high, second)]
    assume(ratio <= min(largest_ratio(first), largest_ratio(second)))
    shaper = design.sd_zv(modes, ratio)
    assert shaper.design.residual < 1e-12
    assert max(shaper.design.settings["deflection_reached"]) <= ratio * (1.0 + 1e-12)
    for mode in modes:
        peak = PositionedMass(mode).motion(Profile.steps([0.0], [1.0], order=1).shaped(shaper)).peak("deflection")
        assert peak.value <= ratio * ramp_deflection(mode) * (1.0 + 1e-12)


def test_on_a_grid_for_several_modes_it_is_shorter_and_keeps_every_limit() -> None:
    modes, dt = [(1.0, 0.0), (2.3, 0.02)], 0.02
    shaper = design.sd_zv(modes, 0.3, dt=dt)
    assert shaper.design.status == "optimal" and shaper.design.settings["dt"] == dt
    assert shaper.duration < design.sd_zv(modes, 0.3).duration
    np.testing.assert_allclose(shaper.times / dt, np.rint(shaper.times / dt), atol=1e-9)
    plant = ModalPlant(modes)
    assert plant.impulse_residual(shaper.times, shaper.amplitudes).max() < 1e-9
    for mode in modes:
        peak = PositionedMass(mode).motion(Profile.steps([0.0], [1.0], order=1).shaped(shaper)).peak("deflection")
        assert peak.value <= 0.3 * ramp_deflection(mode)


def test_the_record_survives_a_file() -> None:
    for shaper in (design.sd_zv((1.0, 0.1), 0.3, "box"), design.sd_zv((1.0, 0.1), 0.3)):
        again = Shaper.from_dict(shaper.to_dict())
        assert again == shaper and again.design == shaper.design
        assert again.design.settings["deflection_ratio"] == 0.3


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (((1.0, 0.1), 0.6), r"no limiting is needed .* \(zv\) has 0.578286"),
        (([(1.0, 0.1), (2.0, 0.0)], 0.55), r"no limiting is needed at 2 Hz, damping 0: zero vibration \(zv\) has 0.5"),
        (((1.0, 0.1), 0.0), "above 0"),
        (((1.0, 0.1), -0.3), "above 0"),
        (((1.0, 0.1), math.nan), "above 0"),
        (((1.0, 0.1), "half"), "above 0"),
        (((1.0, 0.1), 1e-4), "form='box'"),
        (((1.0, 0.1), 0.3, "sphere"), "'impulses' or 'box'"),
        (([(1.0, 0.1), (2.0, 0.0)], 0.3, "box"), "for one mode"),
    ],
)
def test_wrong_input_gets_a_sentence(arguments: tuple[object, ...], words: str) -> None:
    with pytest.raises(InputError, match=words):
        design.sd_zv(*arguments)  # type: ignore[arg-type]


def test_grids_that_cannot_do_it() -> None:
    with pytest.raises(InputError, match="coarser than half a period"):
        design.sd_zv((1.0, 0.0), 0.3, dt=0.6)
    with pytest.raises(InputError, match="leave form out"):
        design.sd_zv((1.0, 0.0), 0.3, "box", dt=0.01)
    with pytest.raises(InputError, match="dt is -1"):
        design.sd_zv((1.0, 0.0), 0.3, dt=-1.0)
