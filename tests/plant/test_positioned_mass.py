"""A mass under PD control with a position input: its equation, closed forms of step and ramp, the trapezoid move."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from preshape.errors import InputError
from preshape.mode import Mode
from preshape.plant import PositionedMass
from preshape.profile import Profile

modes = st.tuples(st.floats(0.1, 20.0), st.floats(0.0, 0.9))
SPEED = 2.0 / 1.5


def trapezoid() -> Profile:
    """Robertson's: 2 units in 1.5 s, a dwell of 2 s, back in 1.5 s."""
    return Profile.steps([0.0, 1.5, 3.5, 5.0], SPEED * np.array([1.0, -1.0, -1.0, 1.0]), order=1)


def test_the_equation_of_the_mass_integrated_numerically() -> None:
    m, k, c = 2.0, 30.0, 1.5
    position = Profile(np.array([0.0, 0.3, 0.3, 1.1]), np.array([1.0, -2.0, 0.7, 1.0]), np.array([1, 2, 0, 2]))
    motion = PositionedMass.from_gains(m, k, c).motion(position)
    state, edges = np.zeros(2), [0.0, 0.3, 1.1, 3.0]
    for low, high in zip(edges, edges[1:], strict=False):
        inside = high * (1 - 1e-15)  # at the end itself the command has already stepped
        if low == 0.3:
            state[1] += c / m * 0.7  # the jump of 0.7 is an impulse through the damper

        def rates(t: float, y: np.ndarray, inside: float = inside) -> list[float]:
            t = min(t, inside)
            force = k * (float(position(t)) - y[0]) + c * (float(position(t, 1)) - y[1])
            return [y[1], force / m]

        run = solve_ivp(rates, (low, high), state, "DOP853", rtol=1e-13, atol=1e-14, dense_output=True)
        looks = np.linspace(low, inside, 9)
        x, v = run.sol(looks)
        state = run.y[:, -1]
        np.testing.assert_allclose(motion("position", looks), x, rtol=0, atol=2e-11)
        np.testing.assert_allclose(motion("deflection", looks), position(looks) - x, rtol=0, atol=2e-11)
        np.testing.assert_allclose(motion("position", looks, 1), v, rtol=0, atol=1e-10)


@given(modes, st.floats(-3.0, 3.0).filter(lambda v: abs(v) > 0.01))
def test_the_ramp_and_step_in_closed_form(pair: tuple[float, float], size: float) -> None:
    plant = PositionedMass(pair)
    w, z, wd = plant.mode.omega, plant.mode.damping, plant.mode.omega_d
    t = np.linspace(0.0, 3.0 / pair[0], 31)
    decay, root = np.exp(-z * w * t), math.sqrt(1.0 - z**2)
    ramp = plant.motion(Profile.steps([0.0], [size], order=1))
    np.testing.assert_allclose(
        ramp("deflection", t), size / wd * decay * np.sin(wd * t), rtol=0, atol=1e-12 * abs(size) / wd
    )
    assert ramp.peak("deflection").value == pytest.approx(plant.ramp_deflection(size), rel=1e-12)
    step = plant.motion(Profile.steps([0.0], [size]))
    expected = size * decay * (np.cos(wd * t) - z / root * np.sin(wd * t))
    np.testing.assert_allclose(step("deflection", t), expected, rtol=0, atol=1e-12 * abs(size) / root)
    np.testing.assert_allclose(step("position", t), size - expected, rtol=0, atol=1e-12 * abs(size) / root)
    # The command jumps, and so does the deflection; the mass does not.
    assert step.peak("deflection").value >= abs(size) * (1 - 1e-14)
    assert step("position", 0.0) == pytest.approx(0.0, abs=1e-14 * abs(size))


def test_the_trapezoid_move() -> None:
    plant = PositionedMass((1.0, 0.1))
    assert round(plant.ramp_deflection(SPEED), 5) == 0.18305
    motion = plant.motion(trapezoid())
    assert round(motion.peak("deflection").value, 5) == 0.28168  # deceleration adds to what acceleration left
    assert motion("position", 60.0) == pytest.approx(0.0, abs=1e-12)
    first = motion("deflection", np.linspace(0.0, 1.5, 100001))
    assert np.abs(first).max() == pytest.approx(plant.ramp_deflection(SPEED), rel=1e-8)


def test_settling_of_a_step_reference() -> None:
    # 5 % settling, z = 0.05, in periods of the undamped mode: unshaped and after a zero-vibration pair.
    mode = Mode(1.0, 0.05)
    plant, decay = PositionedMass(mode), mode.decay_per_half_period

    def settled(times: list[float], jumps: list[float]) -> float:
        # The command without its damper term is that of `ModalPlant`; here the damper sees the step as well.
        from preshape.plant import ModalPlant

        return ModalPlant(mode).motion(Profile.steps(times, jumps)).settling_time("output", 0.05)

    assert settled([0.0], [1.0]) == pytest.approx(9.53, abs=0.006)
    pair = [1.0 / (1.0 + decay), decay / (1.0 + decay)]
    assert settled([0.0, math.pi / mode.omega_d], pair) == pytest.approx(0.426, abs=6e-4)
    assert plant.motion(Profile.steps([0.0], [1.0])).settling_time("position", 0.05) > 9.0


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: PositionedMass.from_gains(0.0, 1.0), "mass is 0 kg"),
        (lambda: PositionedMass.from_gains(1.0, -1.0), "stiffness is -1 N/m"),
        (lambda: PositionedMass.from_gains(1.0, 1.0, 2.0), "from 2 N s/m on this mass does not vibrate"),
        (lambda: PositionedMass([(1.0, 0.1), (2.0, 0.1)]), "2 modes were given"),
        (lambda: PositionedMass((1.0, 0.1)).retuned(0.0), "frequency_ratio is 0"),
        (lambda: PositionedMass((1.0, 0.1)).retuned(1.0, 1.2), "damping ratio 1.2"),
    ],
)
def test_wrong_input_is_named(call: object, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        call()  # type: ignore[operator]
