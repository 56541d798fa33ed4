"""What is drawn is what the physics says: every curve against an independent road to it."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape import design
from preshape.mode import Mode
from preshape.plant import ModalPlant
from preshape.vibration import residual_vibration, zeros_near
from preshape.workflow.workbench import (
    AskedDesign,
    Controller,
    Move,
    Plant,
    Workbench,
    plain_view,
    view_of,
)
from preshape.workflow.workbench.curves import response

MODES = (Mode(9.8, 0.02), Mode(17.0, 0.01), Mode(31.7, 0.015), Mode(52.0, 0.03))
FOUR = (
    AskedDesign("A", "direct", (("order", 0),)),
    AskedDesign("B", "ei", (("tolerance", 0.1),)),
    AskedDesign("C", "um_zv"),
    AskedDesign("D", "sd_zv"),
)
WORKBENCH = Workbench(MODES, FOUR)


def test_every_design_is_drawn_or_says_why_not() -> None:
    view = view_of(WORKBENCH)
    assert [one.asked.name for one in view.designs] == list("ABCD")
    assert [one.drawn is None for one in view.designs] == [False, False, False, True]
    assert view.designs[3].trouble == "family sd_zv needs deflection_ratio: give a number."
    assert view.designs[0].drawn is not None and view.designs[0].drawn.proved
    assert view.designs[1].drawn is not None and not view.designs[1].drawn.proved


def test_the_step_and_the_move_are_those_of_an_independent_simulation() -> None:
    """The recursion over held samples of the shaped command, a road that shares no formula with the exact motion."""
    view = view_of(
        Workbench(MODES, (AskedDesign("A", "zv", (("dt", 0.0005),)),), Plant("driven", (0.4, 0.3, 0.2, 0.1)))
    )
    drawn = view.designs[0].drawn
    assert drawn is not None
    plant = ModalPlant(MODES, (0.4, 0.3, 0.2, 0.1))
    count = int(view.step_times[-1] / 0.0005) + 2
    on_grid = plant.response(drawn.shaper.shape(np.ones(count), 0.0005), 0.0005)
    expected = np.interp(view.step_times, on_grid.times, on_grid.output)
    np.testing.assert_allclose(drawn.step.position, expected, atol=2e-3)  # the interpolation's (w dt)^2 / 8
    train = plant.step_train(drawn.shaper.times, drawn.shaper.amplitudes)
    assert drawn.step.residual == pytest.approx(float(train.output_residual), abs=1e-12)
    assert view.unshaped_step.residual > 0.9


def test_a_carried_load_bends_by_the_acceleration_and_comes_to_rest() -> None:
    """Newton's law in the drawn points: the second difference of the deflection against the command's acceleration."""
    mode = Mode(3.0, 0.05)
    bench = Workbench((mode,), (AskedDesign("A", "zvd"),), Plant("carried"), Move(0.4, 0.5, 2.0))
    view = view_of(bench)
    drawn, t = view.designs[0].drawn, view.move_times
    assert drawn is not None
    h = t[1] - t[0]
    d, u = drawn.move.deflection, drawn.move.command
    accelerations = (np.diff(d, 2) + np.diff(u, 2)) / h**2
    rates = (d[2:] - d[:-2]) / (2.0 * h)
    left_over = accelerations + 2.0 * mode.damping * mode.omega * rates + mode.omega**2 * d[1:-1]

    assert np.median(np.abs(left_over)) < 1e-3 * np.abs(accelerations).max()
    np.testing.assert_allclose(drawn.move.position, u + d, atol=1e-12)
    assert abs(d[-1]) < 1e-9 and drawn.move.position[-1] == pytest.approx(0.4, abs=1e-9)
    assert np.abs(d).max() <= drawn.move.peak_deflection * (1.0 + 1e-9)
    assert drawn.move.peak_deflection < view.unshaped_move.peak_deflection


def test_the_sensitivity_curve_passes_through_what_is_left_at_each_mode() -> None:
    view = view_of(WORKBENCH)
    for one in view.designs:
        if one.drawn is None:
            continue
        for mode, at in zip(MODES, one.drawn.modes, strict=True):
            place = int(np.searchsorted(view.frequencies, mode.frequency))
            assert view.frequencies[place] == mode.frequency
            assert view.dampings[place] == pytest.approx(mode.damping)
            assert one.drawn.vibration[place] == pytest.approx(at.residual, abs=1e-12)
            independent = ModalPlant(mode).impulse_residual(one.drawn.shaper.times, one.drawn.shaper.amplitudes)
            assert at.residual == pytest.approx(float(independent[0]), abs=1e-9)
            assert at.low <= mode.frequency <= at.high


@pytest.mark.parametrize("family", ["zv", "zvd", "zvdd", "direct", "um_zv"])
def test_a_zero_of_the_family_s_order_lies_on_every_pole(family: str) -> None:
    shaper = design.FAMILIES[family](MODES)
    order = {"zv": 1, "zvd": 2, "zvdd": 3, "direct": 2, "um_zv": 1}[family]
    found = zeros_near(shaper, MODES)
    for mode in MODES:
        nearest = min(found, key=lambda zero: abs(zero.place - mode.pole))
        assert abs(nearest.place - mode.pole) < 1e-6 / shaper.duration
        assert nearest.order == order


def test_an_ei_shaper_has_its_zeros_beside_the_pole_and_on_no_pole() -> None:
    mode = Mode(10.0, 0.0)
    found = [zero for zero in zeros_near(design.ei(mode, 0.05), mode) if abs(zero.place - mode.pole) < 0.5 * mode.omega]
    assert len(found) == 2
    # Undamped, V = |A1 exp(..) ...| is zero where cos(pi f / f0 + pi) = (1 - tol) / (1 + tol) of the EI amplitudes.
    outer = math.acos((1.0 - 0.05) / (1.0 + 0.05)) / math.pi
    for zero, sign in zip(found, (-1.0, 1.0), strict=True):
        assert zero.place.imag == pytest.approx(mode.omega * (1.0 + sign * outer), rel=1e-9)
        assert abs(zero.place.real) < 1e-9 * mode.omega


@settings(max_examples=25)
@given(st.lists(st.tuples(st.floats(0.5, 80.0), st.floats(0.0, 0.6)), min_size=1, max_size=4, unique_by=lambda m: m[0]))
def test_every_zero_is_one_and_json_can_say_the_view(given_modes: list[tuple[float, float]]) -> None:
    modes = tuple(Mode(*pair) for pair in given_modes)
    families = ("zv", "mzv", "zvd", "ps_zv")
    designs = tuple(AskedDesign(name, family) for name, family in zip("ABCD", families, strict=True))
    view = view_of(Workbench(modes, designs))
    text = json.dumps(plain_view(view), allow_nan=False)
    assert json.loads(text)["frequencies"][0] == 0.0
    for one in view.designs:
        assert one.drawn is not None
        shaper = one.drawn.shaper
        for zero in one.drawn.zeros:
            terms = shaper.amplitudes * np.exp(-zero.place * (shaper.times - shaper.duration))
            assert abs(terms.sum()) <= 1e-8 * np.abs(terms).sum()


def test_what_the_controller_cannot_hold_is_said() -> None:
    limits = Controller(most_impulses=10, longest=0.2, negative=False)
    designs = (AskedDesign("A", "direct"), AskedDesign("B", "zvd"), AskedDesign("C", "um_zv"))
    first, second, third = view_of(Workbench(MODES[:3], designs, controller=limits)).designs
    assert first.drawn is not None and first.drawn.misfit == ""
    assert second.drawn is not None and "27 impulses and the controller holds 10" in second.drawn.misfit
    assert third.drawn is not None and "impulses" in third.drawn.misfit


def test_a_convolution_that_would_fill_the_memory_is_refused_at_once() -> None:
    modes = tuple(Mode(float(k), 0.01) for k in range(1, 13))
    many = view_of(Workbench(modes, (AskedDesign("A", "zvdk", (("order", 30),)),))).designs[0]
    assert many.drawn is None and "more than 4096 impulses" in many.trouble


def test_designs_for_bands_cover_them_and_follow_the_modes() -> None:
    bench = Workbench(MODES[:2], (AskedDesign("A", "si", (("tolerance", 0.05),), band_width=0.2),))
    drawn = view_of(bench).designs[0].drawn
    assert drawn is not None and drawn.proved
    for mode in MODES[:2]:
        band = np.linspace(0.9, 1.1, 201) * mode.frequency
        assert residual_vibration(drawn.shaper, band, mode.damping).max() <= 0.05 * (1.0 + 1e-6)


def test_only_what_depends_on_a_change_is_computed_anew() -> None:
    base = Workbench(MODES, FOUR[:2])
    view_of(base)
    before = response.cache_info().misses
    again = view_of(Workbench(MODES, FOUR[:2], controller=Controller(most_impulses=5)))
    assert response.cache_info().misses == before
    assert again.designs[0].drawn is not None and again.designs[0].drawn.misfit
    moved = view_of(Workbench(MODES, FOUR[:2], move=Move(0.2)))
    assert response.cache_info().misses == before + 3  # one move without a shaper, one of each design; no step
    assert moved.designs[0].drawn is not None
    assert moved.designs[0].drawn.vibration is again.designs[0].drawn.vibration
