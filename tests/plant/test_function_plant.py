"""Plants from Python functions: against exact linear motion and a pendulum's closed form; how they end that fail."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.special import ellipj, ellipk

from preshape.errors import InputError
from preshape.plant import (
    Diverged,
    FloatingOscillator,
    FunctionPlant,
    LinearPlant,
    SampledPlant,
    SimulatorPlant,
    from_matrices,
    linear_mace,
)

MASS = np.diag([2.0, 1.0])
STIFFNESS = np.array([[300.0, -300.0], [-300.0, 300.0]])


def floating(t: float, x: np.ndarray, u: np.ndarray) -> np.ndarray:
    force = -STIFFNESS @ x[:2] + np.array([u[0], 0.0])
    return np.concatenate([x[2:], np.linalg.solve(MASS, force)])


def pendulum(t: float, x: np.ndarray, u: np.ndarray) -> list[float]:
    return [x[1], -math.sin(x[0]) + u[0]]


@pytest.mark.parametrize("hold", ["zero", "linear"])
def test_a_linear_function_moves_as_its_matrices_do(hold: str) -> None:
    command = np.concatenate([np.ones(20), -np.ones(20), np.linspace(0.0, 1.0, 30), np.zeros(30)])
    plant = FunctionPlant(floating, np.zeros(4), {"first": 0, "last": 1}, scale=0.1, tolerance=1e-10)
    found = plant.simulate(command, 0.01, hold=hold).outputs
    exact = from_matrices(MASS, 0.0, STIFFNESS, input=0, outputs={"first": 0, "last": 1})
    wanted = exact.simulate(command, 0.01, hold=hold).outputs
    for name, values in wanted.items():
        np.testing.assert_allclose(found[name], values, rtol=0, atol=1e-9 * np.abs(values).max())


def test_linearised_it_has_the_modes_of_its_matrices_and_no_rigid_ones() -> None:
    for start in (np.zeros(4), np.array([3.0, 3.1, 0.2, -0.4])):
        plant = FunctionPlant(floating, start, {"bend": lambda x, u: x[1] - x[0]}, output_units={"bend": "m"})
        assert len(plant.modes()) == 1 and plant.modes()[0].omega == pytest.approx(math.sqrt(450.0), rel=1e-8)
        small = plant.linearised()
        assert isinstance(small, LinearPlant) and dict(small.outputs) == {"bend": "m"}
        np.testing.assert_allclose(small.C, [[-1.0, 1.0, 0.0, 0.0]], atol=1e-9)


def test_a_pendulum_swings_as_the_elliptic_function_says() -> None:
    """Released at 2 rad: sin(angle / 2) = k sn(K - t, k^2), k = sin(1)."""
    plant = FunctionPlant(pendulum, [0.0, 0.0], {"angle": 0}, tolerance=1e-10)
    found = plant.simulate(np.zeros(1000), 0.01, configuration=[2.0, 0.0])
    parameter = math.sin(1.0) ** 2
    sn, *_ = ellipj(ellipk(parameter) - found.times, parameter)
    np.testing.assert_allclose(found.outputs["angle"], 2.0 * np.arcsin(math.sin(1.0) * sn), atol=1e-8)
    assert plant.modes([1.0, 0.0])[0].omega == pytest.approx(math.sqrt(math.cos(1.0)), rel=1e-8)
    with pytest.raises(InputError, match=r"unstable: a motion grows as exp\(1 t\)"):
        plant.modes([math.pi, 0.0])


def test_progress_is_told_and_no_step_bridges_a_jump() -> None:
    """A pulse of one sample in a long quiet command: an integrator that steps over it would see nothing."""
    told: list[float] = []
    command = np.zeros(2000)
    command[1000] = 1.0
    plant = FunctionPlant(pendulum, [0.0, 0.0], {"speed": 1})
    found = plant.simulate(command, 0.01, progress=told.append).outputs["speed"]
    assert not found[:1001].any() and found[1001] == pytest.approx(0.01, rel=1e-4)
    assert told == sorted(told) and told[-1] == 1.0 and len(told) == 3


@pytest.mark.parametrize("method", ["DOP853", "RK45", "LSODA", "Radau", "BDF"])
def test_a_state_that_runs_away_is_stopped_with_what_there_is(method: str) -> None:
    """x' = x^2 from 1 is infinite at 1 s; wrong gains make 50 / s of e-foldings."""
    burst = FunctionPlant(lambda t, x, u: x**2, [1.0], {"x": 0}, method=method)
    with pytest.raises(Diverged, match=r"diverged at (1|0\.9)[.\d]* s: ") as stop:
        burst.simulate(np.zeros(300), 0.01)
    partial = stop.value.partial
    assert 95 <= partial.times.size <= 101
    np.testing.assert_allclose(partial.outputs["x"][:95], 1.0 / (1.0 - partial.times[:95]), rtol=1e-3)
    wrong = FunctionPlant(lambda t, x, u: 50.0 * x + u, [0.0], {"x": 0}, method=method)
    with pytest.raises(Diverged, match=r"diverged at 0\.6[.\d]* s: the state has run away"):
        wrong.simulate(np.ones(300), 0.01)


def test_a_function_that_fails_or_leaves_the_numbers_says_when() -> None:
    def falls(t: float, x: np.ndarray, u: np.ndarray) -> list[float]:
        return [math.nan if t > 0.5 else 1.0]

    def breaks(t: float, x: np.ndarray, u: np.ndarray) -> list[float]:
        return [math.exp(1000.0) if t > 0.5 else 1.0]

    command = np.tile([0.0, 1.0], 50)
    for function, words in ((falls, "cannot be followed"), (breaks, "the derivative failed")):
        with pytest.raises(Diverged, match=rf"diverged at 0\.[45][.\d]* s: .*{words}") as stop:
            FunctionPlant(function, [0.0], {"x": 0}).simulate(command, 0.01)
        assert stop.value.partial.times.size in (50, 51)


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: FunctionPlant(lambda t, x, u: [1.0, 2.0], [0.0], {"x": 0}), "derivative has shape"),
        (lambda: FunctionPlant(pendulum, [0.0, 0.0], {"x": 2}), "output 'x' is 2: give the number of a state, 0 to 1"),
        (lambda: FunctionPlant(pendulum, [0.0, 0.0], {"x": lambda x, u: x}), "an output is not one number"),
        (lambda: FunctionPlant(pendulum, [0.0, 0.0], {}), "no inputs or no outputs"),
        (lambda: FunctionPlant(pendulum, [], {"x": 0}), "do not make a state"),
        (lambda: FunctionPlant(pendulum, [0.0, 0.0], {"x": 0}, scale=-1.0), "scales above 0"),
        (lambda: FunctionPlant(pendulum, [0.0, math.nan], {"x": 0}), "initial holds nan"),
        (lambda: FunctionPlant(pendulum, [0.0, 0.0], {"x": 0}, method="Euler"), "method is 'Euler'"),
        (lambda: FunctionPlant(pendulum, [0.0, 0.0], {"x": 0}).modes([0.0]), "configuration has 1 numbers"),
        (lambda: SimulatorPlant(lambda u, dt: {}, inputs={}, outputs={"x": ""}), "no inputs or no outputs"),
    ],
)
def test_what_is_no_plant_is_refused(make: object, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        make()  # type: ignore[operator]


def test_a_simulator_is_checked_at_its_word() -> None:
    def simulator(answer: dict) -> SimulatorPlant:
        return SimulatorPlant(lambda u, dt: answer, inputs={"u": "m"}, outputs={"x": "m", "y": "m"})

    with pytest.raises(InputError, match="returned no y"):
        simulator({"x": [0.0, 1.0]}).simulate([0.0, 1.0], 0.1)
    with pytest.raises(InputError, match=r"returned y of shape \(1,\) for 2 samples"):
        simulator({"x": [0.0, 1.0], "y": [0.0]}).simulate([0.0, 1.0], 0.1)
    with pytest.raises(Diverged, match=r"diverged at 0.1 s") as stop:
        simulator({"x": [0.0, 1.0], "y": [0.0, math.inf]}).simulate([0.0, 1.0], 0.1)
    assert stop.value.partial.outputs["x"].tolist() == [0.0]
    with pytest.raises(InputError, match="identify_plant"):
        simulator({}).modes()
    assert simulator({}).with_modes((2.0, 0.1)).modes()[0].frequency == 2.0


@pytest.mark.parametrize("hold", ["zero", "linear"])
def test_exact_motion_at_samples_is_the_recursion(hold: str) -> None:
    command = np.random.default_rng(2).normal(size=300)
    found = SampledPlant(FloatingOscillator(2.0, 1.0, 300.0), "force", "N").simulate(command, 0.01, hold=hold).outputs
    exact = from_matrices(MASS, 0.0, STIFFNESS, input=0, outputs={"first_position": 0, "second_position": 1})
    for name, values in exact.simulate(command, 0.01, hold=hold).outputs.items():
        np.testing.assert_allclose(found[name], values, rtol=0, atol=1e-11 * np.abs(values).max())
    assert len(linear_mace().modes()) == 12
