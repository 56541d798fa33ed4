"""Impulses on a grid: what each method promises, on every family, and what it cannot do."""

from __future__ import annotations

import json
import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.laws import FAMILIES, Family
from tests.stream.streams import MODES, shaper_of

from preshape import Modes, Shaper, design
from preshape.errors import InputError
from preshape.plant import ModalPlant
from preshape.vibration import residual_vibration

METHODS = ["linear", "nearest", "exact", "optimised"]
IDS = [family.name for family in FAMILIES]


def residuals(shaper: Shaper) -> np.ndarray:
    return np.array([float(residual_vibration(shaper, mode.frequency, mode.damping)) for mode in MODES])


@pytest.mark.parametrize("family", FAMILIES, ids=IDS)
@settings(max_examples=6)
@given(dt=st.floats(0.002, 0.05))
def test_the_exact_split_leaves_what_the_shaper_leaves(family: Family, dt: float) -> None:
    """Zero stays zero and 5 % stay 5 %, against the transform and against an independent plant."""
    shaper = shaper_of(family.name)
    placed = design.on_grid(shaper, dt, "exact")
    later = placed.duration - shaper.duration  # what is left has decayed a little more by the later end
    decay = np.exp([-mode.damping * mode.omega * later for mode in MODES])
    np.testing.assert_allclose(residuals(placed), residuals(shaper) * decay, atol=1e-12 * shaper.magnitude)
    np.testing.assert_allclose(np.rint(placed.times / dt), placed.times / dt, atol=1e-9)
    assert placed.amplitudes.sum() == pytest.approx(1.0, abs=1e-13 * shaper.magnitude)
    for mode, factor in zip(MODES, decay, strict=True):
        left = ModalPlant(Modes(mode)).impulse_residual(placed.times, placed.amplitudes)[0]
        own = ModalPlant(Modes(mode)).impulse_residual(shaper.times, shaper.amplitudes)[0]
        assert left == pytest.approx(own * factor, abs=1e-9)


@pytest.mark.parametrize("name", ["zvd", "zvdd", "direct, order 1", "direct, order 2"])
def test_the_exact_split_keeps_the_derivatives_that_vanish(name: str) -> None:
    """An error of frequency e leaves e^(order + 1): halving it divides the residual by that power of two."""
    shaper = shaper_of(name)
    order = next(family.order for family in FAMILIES if family.name == name)
    placed = design.on_grid(shaper, 0.011, "exact")
    for mode in MODES:
        step = 10.0 ** (-9.0 / (order + 1))
        wide, narrow = (
            float(residual_vibration(placed, mode.frequency * (1.0 + e), mode.damping)) for e in (step, step / 2.0)
        )
        assert math.log2(wide / narrow) == pytest.approx(order + 1, abs=0.05)


@pytest.mark.parametrize("family", FAMILIES, ids=IDS)
@pytest.mark.parametrize("method", METHODS)
def test_each_method_says_what_it_costs(family: Family, method: str) -> None:
    shaper, dt = shaper_of(family.name), 0.013
    if method == "optimised" and (family.order < 0 or family.negative):
        with pytest.raises(InputError, match=r"aims at zero residual|keeps impulses positive"):
            design.on_grid(shaper, dt, method)
        return
    placed = design.on_grid(shaper, dt, method)
    told = placed.design.settings
    np.testing.assert_allclose(told["residuals"], residuals(placed), atol=1e-14 * shaper.magnitude)
    assert placed.design.residual == pytest.approx(max(told["residuals"]), abs=1e-14 * shaper.magnitude)
    assert told["samples_per_period"] == pytest.approx([mode.damped_period / dt for mode in MODES])
    assert (told["grid_method"], told["dt"]) == (method, dt)
    assert placed.design.modes == MODES and placed.design.certificate is None
    assert placed.design.status in ("feasible", "given")
    again = Shaper.from_dict(json.loads(json.dumps(placed.to_dict())))
    assert again == placed and again.design == placed.design
    np.testing.assert_array_equal(placed.taps(dt)[1], placed.amplitudes)  # a stream takes them as they are


def test_what_rounding_costs_is_a_number() -> None:
    """Singer and Hyde name the loss: first order in dt for the nearest sample, second for the split."""
    shaper, frequency = design.zvd((5.0, 0.02)), 5.0
    lost = {
        method: np.array([design.on_grid(shaper, dt, method).design.residual for dt in (4.1e-3, 0.41e-3)])
        for method in METHODS
    }
    assert lost["nearest"][0] > 10.0 * lost["linear"][0] > 1e4 * lost["exact"][0]
    assert (lost["nearest"] < math.pi * frequency * np.array([4.1e-3, 0.41e-3])).all()
    assert (lost["linear"] < (math.pi * frequency * np.array([4.1e-3, 0.41e-3])) ** 2 / 2.0).all()
    assert (lost["exact"] < 1e-14).all() and (lost["optimised"] < 1e-14).all()


def test_the_exact_split_of_zv_is_murphy_and_watanabe_s() -> None:
    """Two zeros at the pole's place in the plane of z and gain one fix the three taps of 0, n and n + 1."""
    frequency, damping, dt = 7.3, 0.05, 0.01
    placed = design.on_grid(design.zv((frequency, damping)), dt, "exact")
    slots = np.rint(placed.times / dt)
    z = np.exp(-Modes((frequency, damping))[0].pole * dt)
    rows = np.array([np.ones(3), (z**slots).real, (z**slots).imag])
    np.testing.assert_allclose(placed.amplitudes, np.linalg.solve(rows, [1.0, 0.0, 0.0]), atol=1e-13)


def test_impulses_on_the_grid_stay_where_they_are() -> None:
    shaper = design.zvd((1.0, 0.0))
    for method in METHODS:
        placed = design.on_grid(shaper, 0.25, method)
        np.testing.assert_allclose(placed.times, shaper.times, atol=1e-15)
        np.testing.assert_allclose(placed.amplitudes, shaper.amplitudes, atol=1e-15)


def test_one_impulse_on_the_grid_among_others_takes_neighbours() -> None:
    """The last impulse is on a sample and the middle one is not: two neighbours each would be one unknown too few."""
    placed = design.on_grid(design.zvd((1.0, 0.0)), 1.0 / 15.0, "exact")
    assert placed.design.residual < 1e-14 and len(placed) > 4
    assert float(residual_vibration(placed, 1.001)) < 1e-5


def test_boxes_keep_what_they_leave() -> None:
    shaper = design.sd_zv((1.0, 0.02), 0.3, form="box")
    placed = design.on_grid(shaper, 0.037, "exact")
    assert not placed.boxes and placed.design.residual < 1e-13 < 1e-6 < design.on_grid(shaper, 0.037).design.residual


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: design.on_grid(design.zv((1.0, 0.0)), 0.1, "best"), "method 'best' is not known"),
        (lambda: design.on_grid(Shaper([0.0, 0.5], [0.5, 0.5]), 0.1, "exact"), 'method "exact" needs the modes'),
        (
            lambda: design.on_grid(Shaper([0.0, 0.5], [0.5, 0.5]), 0.1, "optimised"),
            'method "optimised" needs the modes',
        ),
        (lambda: design.on_grid(design.zv((1.0, 0.0)), 0.6, "exact"), "more than half a period"),
        (lambda: design.on_grid(design.zv((1.0, 0.0)), 0.6, "optimised"), "coarser than half a period"),
        (lambda: design.on_grid(design.sd_zv((1.0, 0.0), 0.3, form="box"), 0.1, "nearest"), "impulses only"),
        *(
            (lambda method=method, dt=dt: design.on_grid(design.zv((1.0, 0.0)), dt, method), "dt is|sample time")
            for method in METHODS
            for dt in (0.0, -1.0, math.nan, math.inf)
        ),
    ],
)
def test_what_cannot_be_is_said_in_a_sentence(call: Callable[[], object], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        call()
