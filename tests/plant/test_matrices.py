"""Plants from mass, damping and stiffness: against the full state space, closed forms, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.signal import lsim

from preshape.errors import InputError
from preshape.plant import FlexibleStructure, LinearPlant, from_matrices
from preshape.profile import Profile

MASS = np.diag([2.0, 1.0, 0.5])
STIFFNESS = np.array([[900.0, -400.0, 0.0], [-400.0, 600.0, -200.0], [0.0, -200.0, 200.0]])
ENDS = {"first": 0, "bend": [-1.0, 0.0, 1.0]}
LOOKS = np.array([[1.0, 0.0, 0.0], [-1.0, 0.0, 1.0]])


def spring_mass(count: int, seed: int, floating: bool) -> tuple[np.ndarray, np.ndarray]:
    """A chain with a full mass matrix, to the wall or not."""
    rng = np.random.default_rng(seed)
    root = np.eye(count) + 0.3 * rng.normal(size=(count, count))
    mass = root @ root.T + np.eye(count)
    stiffness = np.zeros((count, count))
    for k, spring in enumerate(rng.uniform(100.0, 1000.0, count - 1)):
        stiffness[k : k + 2, k : k + 2] += spring * np.array([[1.0, -1.0], [-1.0, 1.0]])
    if not floating:
        stiffness[0, 0] += 300.0
    return mass, stiffness


@given(st.integers(2, 6), st.integers(0, 10**6), st.booleans(), st.sampled_from(["none", "rayleigh", "one place"]))
def test_any_structure_moves_as_its_full_state_space(count: int, seed: int, floating: bool, kind: str) -> None:
    mass, stiffness = spring_mass(count, seed, floating)
    damper = np.zeros_like(mass)
    if kind == "rayleigh":
        damper = 1e-3 * stiffness
    elif kind == "one place":
        damper[0, 0] = 5.0
    plant = from_matrices(mass, damper, stiffness, input=count - 1, outputs={"first": 0, "last": count - 1})
    assert isinstance(plant, LinearPlant) == (kind == "one place")
    command = np.random.default_rng(seed).normal(size=200)
    found = plant.simulate(command, 0.01)
    zero, inverse = np.zeros_like(mass), np.linalg.inv(mass)
    a = np.block([[zero, np.eye(count)], [-inverse @ stiffness, -inverse @ damper]])
    b = np.concatenate([np.zeros(count), inverse[:, count - 1]])[:, np.newaxis]
    _, wanted, _ = lsim((a, b, np.eye(2 * count)[[0, count - 1]], np.zeros((2, 1))), command, found.times, interp=False)
    scale = np.abs(wanted).max()
    np.testing.assert_allclose(np.array(list(found.outputs.values())), wanted.T, rtol=0, atol=1e-10 * scale)
    assert len(plant.modes()) <= count - floating


def test_two_masses_and_a_spring_have_the_frequency_of_the_book() -> None:
    plant = from_matrices([[2.0, 0.0], [0.0, 1.0]], 0.0, [[6.0, -6.0], [-6.0, 6.0]], input=0, outputs={"x": 0})
    assert isinstance(plant, FlexibleStructure) and len(plant.modes()) == 1
    assert plant.modes()[0].omega == pytest.approx(3.0, rel=1e-14)  # sqrt(k (1 / m1 + 1 / m2))
    # A newton for a second: 3 kg coast at 1/3 m/s from then on, and have no drift but that.
    motion = plant.motion(Profile.steps([0.0, 1.0], [1.0, -1.0]))
    assert motion("x", 1e6) == pytest.approx(1e6 / 3.0 - 1.0 / 6.0, abs=1.0)


def test_a_rigid_body_is_rigid_beside_stiff_springs_in_any_units() -> None:
    """Displacement and angle in one matrix, a spring 1e9 times the other: still one rigid body, and the slow mode."""
    stiffness = 1e9 * np.array([[1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [0.0, 0.0, 0.0]])
    stiffness[1:, 1:] += np.array([[1.0, -1.0], [-1.0, 1.0]])
    units = np.diag([1.0, 1.0, 1e4])
    plant = from_matrices(np.eye(3) @ units**2, 0.0, units @ stiffness @ units, input=0, outputs={"x": [1.0, 0.0, 0.0]})
    slow, fast = plant.modes()
    assert slow.omega == pytest.approx(math.sqrt(1.5), rel=1e-6) and fast.omega == pytest.approx(
        math.sqrt(2e9), rel=1e-9
    )


def test_modal_damping_is_what_every_flexible_mode_has() -> None:
    plant = from_matrices(MASS, 0.02, STIFFNESS, input=0, outputs=ENDS)
    assert isinstance(plant, FlexibleStructure)
    assert [mode.damping for mode in plant.modes()] == pytest.approx([0.02] * 3)
    squares = np.sort(np.linalg.eigvals(np.linalg.inv(MASS) @ STIFFNESS).real)
    np.testing.assert_allclose([mode.omega for mode in plant.modes()], np.sqrt(squares), rtol=1e-13)
    bent = LOOKS @ np.linalg.solve(STIFFNESS, [1.0, 0.0, 0.0])
    np.testing.assert_allclose([plant.static_deflections(name).sum() for name in ENDS], bent, atol=1e-15)


def test_equal_modes_of_a_symmetric_machine_become_one() -> None:
    """Two equal pendulums on a frame: of the pair, one combination moves with the input and that is kept."""
    plant = from_matrices(np.eye(2), 0.01, 100.0 * np.eye(2), input=[3.0, 4.0], outputs={"a": 0, "b": 1})
    assert isinstance(plant, FlexibleStructure) and len(plant.modes()) == 1
    found = plant.simulate(np.ones(100), 0.01).outputs
    one = from_matrices([[1.0]], 0.01, [[100.0]], input=0, outputs={"x": 0}).simulate(np.ones(100), 0.01).outputs["x"]
    np.testing.assert_allclose(found["a"], 3.0 * one, atol=1e-14)
    np.testing.assert_allclose(found["b"], 4.0 * one, atol=1e-14)


def test_overdamped_and_braked_motion_needs_the_state_space() -> None:
    slow = from_matrices(MASS, 0.1 * STIFFNESS, STIFFNESS, input=0, outputs=ENDS)
    assert isinstance(slow, LinearPlant)
    squares = np.linalg.eigvals(np.linalg.inv(MASS) @ STIFFNESS).real
    assert len(slow.modes()) == np.count_nonzero(0.05 * np.sqrt(squares) < 1.0)
    coasting = from_matrices([[2.0]], [[0.5]], [[0.0]], input=0, outputs={"x": 0})
    found = coasting.simulate(np.ones(1001), 0.01)
    t = found.times
    np.testing.assert_allclose(found.outputs["x"], 2.0 * t - 8.0 * (1.0 - np.exp(-t / 4.0)), atol=1e-11)
    with pytest.raises(InputError, match="nothing vibrates"):
        coasting.modes()


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        ({"mass": [[1.0, 0.5], [0.0, 1.0]]}, "mass is not symmetric: it holds 0.5 in row 0, column 1 and 0 in row 1"),
        ({"stiffness": [[1.0, -2.0], [-1.0, 2.0]]}, "stiffness is not symmetric"),
        ({"mass": [[1.0, 0.0], [0.0, 0.0]]}, "not positive definite: coordinate 1 has the mass 0"),
        ({"mass": [[1.0, 2.0], [2.0, 1.0]]}, "not positive definite: some motion has no mass"),
        ({"stiffness": [[1.0, 0.0], [0.0, -1.0]]}, "stiffness is indefinite: in one direction it pushes away"),
        ({"damping": [[1.0, 0.0], [0.0, -1.0]]}, "damping is indefinite: in one direction it drives the motion"),
        ({"damping": np.eye(3)}, r"do not fit: mass is \(2, 2\), damping \(3, 3\)"),
        ({"damping": -0.1}, r"damping ratio -0.1 is outside \[0, 1\)"),
        ({"damping": 1.0}, r"damping ratio 1 is outside \[0, 1\)"),
        ({"stiffness": [[1.0, math.nan], [math.nan, 1.0]]}, "stiffness holds nan in row 0, column 1"),
        ({"stiffness": [[1.0, 2.0, 3.0]]}, r"stiffness has shape \(1, 3\): give a square matrix"),
        ({"mass": "heavy"}, "mass is not a matrix of numbers"),
        ({"input": 2}, "the coordinate of input is 2: give a whole number from 0 to 1"),
        ({"input": [1.0]}, r"input has 1 weight\(s\) for 2 coordinate"),
        ({"outputs": {"tip": -1}}, "the coordinate of output 'tip' is -1"),
        ({"outputs": {}}, "no outputs"),
    ],
)
def test_what_is_no_machine_is_refused_in_a_sentence(changed: dict, sentence: str) -> None:
    given_: dict = {
        "mass": np.eye(2), "damping": 0.01, "stiffness": [[2.0, -1.0], [-1.0, 1.0]], "input": 0, "outputs": {"x": 1},
    } | changed  # fmt: skip
    with pytest.raises(InputError, match=sentence):
        from_matrices(**given_)


def test_rounded_matrices_are_taken_as_they_are_meant() -> None:
    """As a file prints them, with seven digits: symmetric, and the floating body still at rest."""
    stiffness = np.array([[400.0, -400.0], [-400.00001, 400.0]])
    assert len(from_matrices(np.eye(2), 0.0, stiffness, input=0, outputs={"x": 0}).modes()) >= 1
