"""FlexibleStructure: samples against exact motion, recursion and scipy's lsim; outputs of every kind; bad input."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import lsim
from tests.plant.beams import carrying

from preshape.errors import InputError
from preshape.kernel import scanned_outputs
from preshape.mode import Mode, Modes
from preshape.plant import Beam, FlexibleStructure, ModalPlant, Output
from preshape.profile import Profile

MODES = Modes([(3.0, 0.0), (10.0, 0.02), (41.0, 0.3), (230.0, 0.001)])


def test_samples_are_the_exact_motion_at_their_times() -> None:
    beam = carrying()
    plant = beam.plant(
        beam.payload_angle(0),
        {"tip": beam.displacement(1.2), "angle": beam.payload_angle(0)},
        damping=0.003,
        name="torque",
    )
    values, dt = np.random.default_rng(5).normal(size=300), 2e-3
    values[-1] = 0.0
    held = Profile.steps(dt * np.arange(values.size), np.diff(values, prepend=0.0))
    slopes = np.diff(values, append=0.0) / dt
    slopes[-1] = 0.0
    times = dt * np.arange(values.size)
    drawn = Profile(
        np.append(0.0, times),
        np.append(values[0], np.diff(slopes, prepend=0.0)),
        np.append(0, np.ones(values.size, int)),
    )
    assert dict(plant.inputs) == {"torque": "N m"} and dict(plant.outputs) == {"tip": "m", "angle": "rad"}
    for hold, profile in (("zero", held), ("linear", drawn)):
        found = plant.simulate(values, dt, hold=hold)
        motion = plant.motion(profile)
        for name in plant.outputs:
            exact = motion(name, found.times)
            np.testing.assert_allclose(found.outputs[name], exact, rtol=0, atol=1e-11 * np.abs(exact).max())
        assert found.command.shape == (1, 300) and found.units == plant.outputs


def test_fewer_modes_and_other_frequencies() -> None:
    beam = Beam(1.0, 6, 1.0, 1.0, supports={0.0: "clamped"})
    tip = beam.displacement(1.0)
    all_of_them, two = (beam.plant(tip, {"tip": tip}, count=count) for count in (None, 2))
    assert len(all_of_them.modes()) == 12 and two.modes() == all_of_them.modes()[:2]
    np.testing.assert_array_equal(two.gains, all_of_them.gains[:2])
    # Modes alternate in sign nowhere for load and output at one place: each adds to the deflection.
    assert (all_of_them.static_deflections("tip") > 0.0).all()
    assert two.static_deflections("tip").sum() == pytest.approx(1.0 / 3.0, rel=5e-3)
    softer = two.retuned(0.5, 0.02)
    assert softer.modes()[0].frequency == 0.5 * two.modes()[0].frequency and softer.modes()[1].damping == 0.02
    assert softer.static_deflections("tip").sum() == pytest.approx(4.0 * two.static_deflections("tip").sum(), rel=1e-12)


def test_rates_the_input_and_the_rigid_body_are_seen_exactly() -> None:
    look = Output(
        [0.3, -1.0, 0.0, 2.0], velocity=[0.0, 0.1, -0.2, 0.01], rigid=0.7, rigid_velocity=-0.3, command=0.05, unit="m"
    )
    structure = FlexibleStructure(MODES, [1.0, -2.0, 3.0, 0.0], {"y": look})
    values, dt = np.random.default_rng(2).normal(size=200), 4e-3
    exact = structure.motion(Profile.steps(dt * np.arange(200), np.diff(values, prepend=0.0)))
    found = structure.simulate(values, dt)
    np.testing.assert_allclose(found.outputs["y"], exact("y", found.times), rtol=0, atol=1e-12)


@given(count=st.integers(1, 400), seed=st.integers(0, 100), linear=st.booleans())
def test_blocks_are_the_recursion(count: int, seed: int, linear: bool) -> None:
    rng = np.random.default_rng(seed)
    command, dt = rng.normal(size=count), 10.0 ** rng.uniform(-5, -1)
    weights = rng.normal(size=(2, 4))
    plant = ModalPlant(MODES, weights, drive="acceleration")
    expected = plant.response(command, dt, hold="linear" if linear else "zero")
    poles = np.array([mode.pole for mode in MODES])
    outputs, last = scanned_outputs(poles, 1j * weights / poles.imag, command, dt, linear=linear)
    size = np.abs(expected.displacement).max() + dt**2
    np.testing.assert_allclose(outputs, expected.output, rtol=0, atol=1e-12 * size)
    np.testing.assert_allclose(-last.imag / poles.imag, expected.displacement[:, -1], rtol=0, atol=1e-12 * size)


def test_a_hundred_thousand_samples_are_those_of_lsim() -> None:
    modes = [(f, 0.0) for f in (9.8, 31.7, 66.2, 1362.0)]
    gains, weights = np.array([-4.0, 7.5, -11.0, -7.6]), np.array([-2.2, -2.2, -2.3, 6.6])
    structure = FlexibleStructure(modes, gains, {"left": Output(weights.tolist(), unit="m")}, unit="N m")
    a, b, c = np.zeros((8, 8)), np.zeros((8, 1)), np.zeros((1, 8))
    for k, (f, _) in enumerate(modes):
        a[2 * k : 2 * k + 2, 2 * k : 2 * k + 2] = [[0.0, 1.0], [-((2.0 * math.pi * f) ** 2), 0.0]]
        b[2 * k + 1, 0], c[0, 2 * k] = gains[k], weights[k]
    command, dt = np.random.default_rng(0).normal(size=100_000), 2e-5
    found = structure.simulate(command, dt)
    _, expected, _ = lsim((a, b, c, np.zeros((1, 1))), command, found.times, interp=False)
    gap = np.abs(found.outputs["left"] - expected).max()
    assert gap < 1e-9 * np.abs(expected).max()


def test_what_a_structure_says_of_itself() -> None:
    structure = FlexibleStructure(MODES, np.ones(4), {"a": Output(rigid=2.0, unit="m"), "b": Output([1, 2, 3, 4])})
    assert structure.modes() == structure.modes("any configuration") == MODES
    assert dict(structure.inputs) == {"load": "N"} and dict(structure.outputs) == {"a": "m", "b": ""}
    assert structure.weights("a").tolist() == [0.0] * 4 and structure.weights("b").tolist() == [1.0, 2.0, 3.0, 4.0]
    assert "4 modes" in repr(structure) and "a, b" in repr(structure)
    assert structure.modes()[1] == Mode(10.0, 0.02)


def one() -> FlexibleStructure:
    return FlexibleStructure([(1.0, 0.0)], [1.0], {"y": Output([1.0])})


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: FlexibleStructure([(1.0, 0.0)], [1.0, 2.0], {"y": Output([1.0])}), "gains has 2 value"),
        (lambda: FlexibleStructure([(1.0, 0.0)], [1.0], {}), "no outputs: name at least one"),
        (lambda: FlexibleStructure([(1.0, 0.0)], [1.0], {"y": Output([1.0, 2.0])}), "displacement of output 'y' has 2"),
        (lambda: one().simulate([1.0], 0.0), "dt is 0 s"),
        (lambda: one().simulate([], 0.1), "no samples"),
        (lambda: one().simulate([1.0, math.nan], 0.1), "command holds NaN or infinity at sample 1"),
        (lambda: one().simulate(np.zeros((2, 5)), 0.1), r"command has shape \(2, 5\) for 1 input"),
        (lambda: one().simulate([1.0], 0.1, hold="cubic"), "hold is 'cubic'"),
        (lambda: one().static_deflections("x"), "output is 'x': this structure has y"),
    ],
)
def test_wrong_input_is_answered_with_value_and_remedy(make, words: str) -> None:
    with pytest.raises(InputError, match=words):
        make()
