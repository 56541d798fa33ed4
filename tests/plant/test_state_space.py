"""LinearPlant: against scipy's own simulation, closed forms of poles, and systems that rounding would spoil."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import block_diag
from scipy.signal import cont2discrete, lsim

from preshape.errors import InputError
from preshape.plant import Diverged, FlexibleStructure, LinearPlant, Output

OMEGA = 2.0 * math.pi


def oscillator(frequency: float, damping: float) -> np.ndarray:
    w = OMEGA * frequency
    return np.array([[0.0, 1.0], [-(w**2), -2.0 * damping * w]])


@dataclass
class LikeControl:
    """As much of a python-control StateSpace as is looked at."""

    A: object
    B: object
    C: object
    D: object
    dt: object = 0
    input_labels: list[str] = field(default_factory=lambda: ["u[0]"])
    output_labels: list[str] = field(default_factory=lambda: ["y[0]"])


@pytest.mark.parametrize("hold", ["zero", "linear"])
def test_a_random_stable_system_agrees_with_scipy(hold: str) -> None:
    rng = np.random.default_rng(3)
    a = rng.normal(size=(7, 7))
    a -= (np.linalg.eigvals(a).real.max() + 0.3) * np.eye(7)
    b, c, d = rng.normal(size=(7, 2)), rng.normal(size=(3, 7)), rng.normal(size=(3, 2))
    command, dt = rng.normal(size=(2, 400)), 0.05
    found = LinearPlant(a, b, c, d).simulate(command, dt, hold=hold)
    _, wanted, _ = lsim((a, b, c, d), command.T, found.times, interp=hold == "linear")
    np.testing.assert_allclose(np.array(list(found.outputs.values())), wanted.T, rtol=0, atol=1e-12 * abs(wanted).max())


def test_a_million_samples_agree_with_the_modal_recursion_and_report_their_progress() -> None:
    modes = [(1.0, 0.001), (7.7, 0.01), (23.0, 0.0)]
    a = block_diag(*[oscillator(*mode) for mode in modes])
    b = np.tile([0.0, 1.0], 3)
    c = np.tile([1.0, 0.0], 3)
    command = np.random.default_rng(5).normal(size=1_000_000)
    told: list[float] = []
    found = LinearPlant(a, b, c).simulate(command, 1e-3, progress=told.append).outputs["output"]
    wanted = FlexibleStructure(modes, np.ones(3), {"y": Output((1.0, 1.0, 1.0))}).simulate(command, 1e-3).outputs["y"]
    assert np.abs(found - wanted).max() < 1e-9 * np.abs(wanted).max()
    assert told == sorted(told) and told[-1] == 1.0 and len(told) > 20


@given(
    st.lists(
        st.tuples(st.floats(0.1, 50.0), st.floats(0.0, 0.9)), min_size=1, max_size=4, unique_by=lambda m: round(m[0], 1)
    ),
    st.integers(0, 3),
    st.integers(0, 2**31),
)  # fmt: skip
def test_modes_are_found_in_any_coordinates(modes: list, rigid: int, seed: int) -> None:
    """Turned coordinates, and rigid bodies with them, whose double poles at 0 stay out of sight."""
    blocks = [oscillator(*mode) for mode in modes] + [np.array([[0.0, 1.0], [0.0, 0.0]])] * rigid
    a = block_diag(*blocks)
    turn, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=a.shape))
    size = np.abs(a).max()
    found = LinearPlant(turn.T @ a @ turn, np.ones(len(a)), np.ones(len(a)), accuracy=1e-13).modes()
    assert len(found) == len(modes)
    for mode, (frequency, damping) in zip(found, sorted(modes), strict=True):
        # Rounding of the turned matrix is relative to its largest entry, w^2 of the fastest mode, of which a slow
        # oscillator in these coordinates, (0 1; -w^2 0), takes the root.
        slack = 1e-13 * size * (1.0 + 1.0 / (OMEGA * frequency)) / (1.0 - damping**2)
        assert abs(mode.pole - complex(-damping, math.sqrt(1 - damping**2)) * OMEGA * frequency) < slack + 1e-9


def test_equal_modes_are_one_and_participation_adds_up() -> None:
    a = block_diag(oscillator(2.0, 0.01), oscillator(2.0, 0.01), oscillator(5.0, 0.02))
    plant = LinearPlant(a, np.array([0, 1, 0, 1, 0, 1.0]), [[1, 0, 1, 0, 0, 0.0], [0, 0, 0, 0, 0, 1.0]])
    assert [round(m.frequency, 9) for m in plant.modes()] == [2.0, 5.0]
    damped = OMEGA * np.array([2.0 * math.sqrt(1 - 1e-4), 5.0 * math.sqrt(1 - 4e-4)])
    np.testing.assert_allclose(plant.participation("output 1"), [2.0 / damped[0], 0.0], atol=1e-12)
    np.testing.assert_allclose(plant.participation("output 2"), [0.0, OMEGA * 5.0 / damped[1]], atol=1e-12)


def test_participation_is_the_amplitude_that_an_impulse_leaves() -> None:
    """Also beside a rigid body, whose vectors mix with the mode's."""
    stiff = 30.0 * np.array([[-1.0, 1.0], [0.5, -0.5]])
    a = np.block([[np.zeros((2, 2)), np.eye(2)], [stiff, np.zeros((2, 2))]])
    plant = LinearPlant(a, [0.0, 0.0, 1.0, 0.0], [0.0, 1.0, 0.0, 0.0])
    dt, omega = 1e-4, math.sqrt(45.0)
    found = plant.simulate(np.concatenate([[1.0 / dt], np.zeros(100_000)]), dt)
    t = found.times[1:]
    columns = np.array([np.ones_like(t), t, np.cos(omega * t), np.sin(omega * t)]).T
    parts, *_ = np.linalg.lstsq(columns, found.outputs["output"][1:], rcond=None)
    assert math.hypot(*parts[2:]) == pytest.approx(plant.participation()[0], rel=1e-6)
    assert parts[1] == pytest.approx(1.0 / 3.0)  # 1 and 2 kg coast together
    assert plant.static_gain[0, 0] == math.inf


def test_a_sampled_system_has_the_modes_of_the_continuous_one() -> None:
    a, b, c = oscillator(3.0, 0.05), np.array([[0.0], [OMEGA**2 * 9.0]]), np.array([[1.0, 0.0]])
    step = 0.02
    ad, bd, *_ = cont2discrete((a, b, c, np.zeros((1, 1))), step)
    plant, continuous = LinearPlant(ad, bd, c, sample_time=step), LinearPlant(a, b, c)
    assert plant.modes()[0].pole == pytest.approx(continuous.modes()[0].pole, rel=1e-12)
    assert plant.static_gain == pytest.approx(np.ones((1, 1))) and continuous.static_gain == pytest.approx(1.0)
    command = np.random.default_rng(4).normal(size=300)
    np.testing.assert_allclose(
        plant.simulate(command, step).outputs["output"],
        continuous.simulate(command, step).outputs["output"],
        atol=1e-12,
    )
    delayed = LinearPlant(
        block_diag(ad, np.eye(5, k=1)), np.concatenate([bd, np.ones((5, 1))]), np.ones((1, 7)), sample_time=step
    )
    assert len(delayed.modes()) == 1, "a delay is no mode"
    with pytest.raises(InputError, match="sampled every 0.02 s: give the plant's own step"):
        plant.simulate(command, 0.01)
    with pytest.raises(InputError, match="leave hold at 'zero'"):
        plant.simulate(command, step, hold="linear")


@pytest.mark.parametrize("dt", [0, None, 0.01])
def test_a_python_control_system_plugs_in(dt: float | None) -> None:
    a = oscillator(3.0, 0.05) if not dt else np.array([[0.9, 0.3], [-0.3, 0.9]])
    plant = LinearPlant.from_control(LikeControl(a, [[0.0], [1.0]], [[1.0, 0.0]], [[0.0]], dt))
    assert dict(plant.inputs) == {"u[0]": ""} and dict(plant.outputs) == {"y[0]": ""}
    assert plant.sample_time == (dt or None) and len(plant.modes()) == 1
    named = LinearPlant.from_control(
        LikeControl(a, [[0.0], [1.0]], [[1.0, 0.0]], [[0.0]], dt), inputs={"force": "N"}, outputs={"tip": "m"}
    )
    assert dict(named.inputs) == {"force": "N"} and dict(named.outputs) == {"tip": "m"}


def test_the_real_python_control_plugs_in() -> None:
    control = pytest.importorskip("control")
    system = control.ss(oscillator(3.0, 0.05), [[0.0], [1.0]], [[1.0, 0.0]], [[0.0]])
    assert LinearPlant.from_control(system).modes()[0].frequency == pytest.approx(3.0)


def test_what_is_no_state_space_system_is_refused() -> None:
    with pytest.raises(InputError, match=r"dict has no matrices A, B, C, D.*control\.ss"):
        LinearPlant.from_control({})
    with pytest.raises(InputError, match="dt is True"):
        LinearPlant.from_control(LikeControl(np.eye(2), [[0.0], [1.0]], [[1.0, 0.0]], [[0.0]], True))


def test_an_unstable_plant_says_so_and_keeps_what_it_has() -> None:
    plant = LinearPlant(block_diag(oscillator(1.0, -0.2), [[-1.0]]), [0.0, 1.0, 1.0], [1.0, 0.0, 0.0])
    with pytest.raises(InputError, match=r"unstable: a motion at 0\.9798 Hz grows as exp\(1\.257 t\)"):
        plant.modes()
    with pytest.raises(InputError, match=r"unstable: a motion grows as exp\(2 t\)"):
        LinearPlant([[2.0]], [1.0], [1.0]).modes()
    with pytest.raises(Diverged, match=r"diverged at 56\d\.\d* s: the plant is unstable") as stop:
        plant.simulate(np.ones(100_000), 0.01)
    partial = stop.value.partial
    assert partial.times.size == round(stop.value.time / 0.01) and np.isfinite(partial.outputs["output"]).all()
    assert partial.command.shape == (1, partial.times.size)
    short = plant.simulate(np.ones(500), 0.01).outputs["output"]
    np.testing.assert_array_equal(short, partial.outputs["output"][:500])


@pytest.mark.parametrize(
    ("matrices", "sentence"),
    [
        (([[0, 1]], [1], [1]), r"A has shape \(1, 2\): give a square matrix"),
        (([[0, 1], [1]], [1], [1]), "A is not a matrix of numbers: give rows of equal length"),
        (([[0, math.nan], [1, 0]], [0, 1], [1, 0]), "A holds nan in row 0, column 1"),
        (([[0, 1], [-1, 0]], [0, 1, 2], [1, 0]), r"B has shape \(3, 1\) and C \(1, 2\) for 2 state"),
        (([[0, 1], [-1, 0]], [0, 1], [1, 0], [[0, 0]]), r"D has shape \(1, 2\)"),
        (([["a"]], [1], [1]), "A is not a matrix of numbers"),
        ((np.zeros((0, 0)), [], []), "A has shape"),
        ((np.zeros((1001, 1001)), [], []), "A has 1001 states: give at most 1000"),
    ],
)
def test_matrices_that_do_not_fit_are_refused(matrices: tuple, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        LinearPlant(*matrices)


def test_names_that_do_not_fit_are_refused() -> None:
    plant = LinearPlant([[0, 1], [-1, 0]], [0, 1], [1, 0])
    with pytest.raises(InputError, match="2 inputs are named"):
        LinearPlant([[0, 1], [-1, 0]], [0, 1], [1, 0], inputs={"a": "", "b": ""})
    with pytest.raises(InputError, match="output is 'tip': this plant has output"):
        plant.participation("tip")
    with pytest.raises(InputError, match="nothing vibrates"):
        LinearPlant([[-1.0]], [1.0], [1.0]).modes()
    with pytest.raises(InputError, match="hold is 'cubic'"):
        plant.simulate([1.0], 0.1, hold="cubic")


def test_other_modes_leave_shapes_and_rigid_bodies_where_they_are() -> None:
    """A body on two dampers and springs that floats: its poles go where they are told, its vectors and zeros stay."""
    stiff = 30.0 * np.array([[1.0, -1.0, 0.0], [-1.0, 3.0, -2.0], [0.0, -2.0, 2.0]])
    damp = np.array([[0.2, -0.2, 0.0], [-0.2, 0.2, 0.0], [0.0, 0.0, 0.0]])
    a = np.block([[np.zeros((3, 3)), np.eye(3)], [-stiff, -damp]])
    plant = LinearPlant(a, [0.0, 0.0, 0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    wanted = [(1.1 * plant.modes()[0].frequency, 0.03), (0.9 * plant.modes()[1].frequency, 0.002)]
    moved = plant.with_modes(wanted)
    for mode, (frequency, damping) in zip(moved.modes(), wanted, strict=True):
        assert mode.frequency == pytest.approx(frequency, rel=1e-9)
        assert mode.damping == pytest.approx(damping, rel=1e-6)
    assert moved.poles.size == plant.poles.size == 4, "the rigid body's two stay at 0"
    assert moved.participation() == pytest.approx(plant.participation(), rel=1e-6), "residues stay"
    late = np.ones(2000)
    drift = [p.simulate(late, 0.01).outputs["output"][-1] for p in (plant, moved)]
    assert drift[1] == pytest.approx(drift[0], rel=0.01), "and the whole is as heavy as it was"
    with pytest.raises(InputError, match="1 mode.* are given: give 2"):
        plant.with_modes((1.0, 0.0))
