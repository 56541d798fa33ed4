"""The modal plant under a sampled command: exact, by closed forms, energy and scipy's own simulation."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import simpson, solve_ivp
from scipy.signal import StateSpace, lsim

from preshape.errors import InputError
from preshape.mode import Mode, Modes
from preshape.plant import ModalPlant

EPS = float(np.finfo(float).eps)
DAMPINGS = [0.0, 0.01, 0.1, 0.3, 0.9]


def step_response(mode: Mode, t: np.ndarray) -> np.ndarray:
    w, z, wd = mode.omega, mode.damping, mode.omega_d
    return 1.0 - np.exp(-z * w * t) * (np.cos(wd * t) + z * w / wd * np.sin(wd * t))


def ramp_response(mode: Mode, t: np.ndarray) -> np.ndarray:
    w, z, wd = mode.omega, mode.damping, mode.omega_d
    free = 2 * z / w * np.cos(wd * t) + (2 * z**2 - 1) / wd * np.sin(wd * t)
    return t - 2 * z / w + np.exp(-z * w * t) * free


@pytest.mark.parametrize("damping", DAMPINGS)
def test_step_response_is_the_closed_form(damping: float) -> None:
    mode = Mode(12.5, damping)
    response = ModalPlant(mode).response(np.ones(2000), dt=1.7e-3)
    np.testing.assert_allclose(response.output, step_response(mode, response.times), rtol=0, atol=1e-12)


@pytest.mark.parametrize("damping", DAMPINGS)
def test_ramp_response_with_linear_hold_is_the_closed_form(damping: float) -> None:
    mode = Mode(12.5, damping)
    times = np.arange(2000) * 1.7e-3
    response = ModalPlant(mode).response(times, dt=1.7e-3, hold="linear")
    np.testing.assert_allclose(response.output, ramp_response(mode, times), rtol=0, atol=1e-12)


def test_fine_samples_lose_no_digits() -> None:
    # w dt = 6e-6: a real second-order recursion would be off by about eps / (w dt)^2 = 6e-6 here. What rounding the one
    # coefficient exp(s dt) allows is half an eps a sample.
    mode = Mode(1.0, 0.02)
    count = 300_000
    response = ModalPlant(mode).response(np.ones(count), dt=1e-6)
    np.testing.assert_allclose(response.output, step_response(mode, response.times), rtol=0, atol=0.5 * EPS * count)
    ramp = ModalPlant(mode).response(response.times, dt=1e-6, hold="linear")
    np.testing.assert_allclose(ramp.output, ramp_response(mode, response.times), rtol=0, atol=0.5 * EPS * count)


@pytest.mark.parametrize("hold", ["zero", "linear"])
@pytest.mark.parametrize("drive", ["position", "acceleration"])
def test_every_state_agrees_with_scipy_on_a_random_command(hold: str, drive: str) -> None:
    modes = Modes([(3.0, 0.0), (7.1, 0.03), (19.0, 0.2)])
    gains = np.array([[0.5, 0.3, 0.2], [1.0, -2.0, 0.7]])
    dt = 2e-3
    command = np.random.default_rng(20260901).normal(size=1500)
    response = ModalPlant(modes, gains, drive=drive).response(command, dt, hold=hold)
    displacements = []
    for k, mode in enumerate(modes):
        w, z = mode.omega, mode.damping
        force = w**2 if drive == "position" else -1.0
        system = StateSpace(
            [[0, 1], [-(w**2), -2 * z * w]],
            [[0], [force]],
            [[1, 0], [0, 1], [-(w**2), -2 * z * w]],
            [[0], [0], [force]],
        )
        _, states, _ = lsim(system, command, response.times, interp=hold == "linear")
        computed = np.array([response.displacement[k], response.velocity[k], response.acceleration[k]]).T
        for column in range(3):
            scale = np.abs(states[:, column]).max()
            np.testing.assert_allclose(computed[:, column], states[:, column], rtol=0, atol=1e-11 * scale)
        displacements.append(states[:, 0])
    np.testing.assert_allclose(
        response.output, gains @ np.array(displacements), rtol=0, atol=1e-11 * np.abs(displacements).max() * 3
    )
    assert response.output.shape == (2, 1500)


@pytest.mark.parametrize("damping", [0.0, 0.02, 0.3])
def test_energy_that_leaves_is_what_the_damper_takes(damping: float) -> None:
    mode = Mode(5.0, damping)
    plant = ModalPlant(mode)
    response = plant.response(np.zeros(20_001), dt=1e-4, displacement=[0.01], velocity=[-0.2])
    x, v = response.displacement[0], response.velocity[0]
    energy = 0.5 * v**2 + 0.5 * mode.omega**2 * x**2
    if damping:
        assert (np.diff(energy) <= 0.0).all()
    else:  # half an eps of amplitude a sample is one eps of energy
        assert np.ptp(energy) < EPS * energy.size * energy[0]
    taken = simpson(2 * damping * mode.omega * v**2, dx=1e-4)
    # Simpson's own error: (2 w dt)^4 / 180 of what swings at twice the frequency, below 1e-11.
    assert energy[0] - energy[-1] == pytest.approx(taken, rel=1e-10, abs=EPS * energy.size * energy[0])


def test_deflection_is_that_of_a_mass_on_a_moving_carrier() -> None:
    # The mass at X on a carrier at r, spring and damper between: X'' + 2 z w (X' - r') + w^2 (X - r) = 0.
    mode = Mode(4.0, 0.08)
    w, z = mode.omega, mode.damping
    acceleration = np.where(np.arange(1000) < 300, 2.0, np.where(np.arange(1000) < 600, -2.0, 0.0))
    response = ModalPlant(mode, drive="acceleration").response(acceleration, dt=1e-3)
    state = np.zeros(4)  # carrier position and speed, mass position and speed
    for first, last, a in ((0, 300, 2.0), (300, 600, -2.0), (600, 999, 0.0)):
        solution = solve_ivp(
            lambda _, y, a=a: [y[1], a, y[3], -2 * z * w * (y[3] - y[1]) - w**2 * (y[2] - y[0])],
            (0, (last - first) * 1e-3),
            state,
            method="DOP853",
            rtol=1e-12,
            atol=1e-15,
            t_eval=np.linspace(0, (last - first) * 1e-3, last - first + 1),
        )
        state = solution.y[:, -1]
        np.testing.assert_allclose(response.output[first : last + 1], solution.y[2] - solution.y[0], rtol=0, atol=1e-12)


@pytest.mark.parametrize("drive", ["position", "acceleration"])
@settings(deadline=None)
@given(damping=st.floats(0.0, 0.6), seed=st.integers(0, 2**32 - 1), held=st.floats(-2.0, 2.0))
def test_residual_amplitude_is_the_envelope_of_what_follows(drive: str, damping: float, seed: int, held: float) -> None:
    mode = Mode(10.0, damping)
    plant = ModalPlant(mode, drive=drive)
    command = np.append(np.random.default_rng(seed).normal(size=40), held)
    dt = 3e-3
    ended = plant.response(command, dt)
    assert ended.residual_time == 40 * dt
    quiet = plant.response(np.append(command, np.full(600, held)), dt)
    settled = held if drive == "position" else -held / mode.omega**2
    free = quiet.output[40:] - settled
    t = quiet.times[40:] - quiet.times[40]
    # Remove the decay and fit the sinusoid by least squares: amplitude and residuum of the fit are the test.
    basis = np.array([np.cos(mode.omega_d * t), np.sin(mode.omega_d * t)]).T * np.exp(
        -damping * mode.omega * t[:, np.newaxis]
    )
    fit, *_ = np.linalg.lstsq(basis, free, rcond=None)
    scale = np.abs(quiet.output).max()
    np.testing.assert_allclose(basis @ fit, free, rtol=0, atol=1e-12 * scale)
    assert ended.residual_amplitudes[0] == pytest.approx(np.hypot(*fit), abs=1e-12 * scale)
    # And later by the decay alone.
    left = math.exp(-damping * mode.omega * t[-1])
    assert quiet.residual_amplitudes[0] == pytest.approx(left * np.hypot(*fit), abs=1e-12 * scale)


def test_output_residual_bounds_the_output_and_is_the_amplitude_of_one_mode() -> None:
    plant = ModalPlant([(10.0, 0.0), (23.7, 0.0)], [[0.6, 0.4], [1.0, -1.0]])
    response = plant.response(np.ones(40_000), dt=1e-3)
    deviation = np.abs(response.output - plant.gains.sum(axis=1)[:, np.newaxis])
    assert (deviation.max(axis=1) <= response.output_residual * (1 + 1e-12)).all()
    # Two incommensurate undamped modes come as near to their sum as one waits for.
    np.testing.assert_allclose(deviation.max(axis=1), response.output_residual, rtol=1e-3)
    np.testing.assert_allclose(response.residual_amplitudes, [1.0, 1.0], rtol=1e-11)
    alone = ModalPlant((10.0, 0.1), [3.0]).response(np.ones(5), dt=1e-3)
    assert alone.output_residual == pytest.approx(3.0 * alone.residual_amplitudes[0], rel=1e-15)


def test_default_gains_make_the_output_settle_on_the_command() -> None:
    plant = ModalPlant([(5.0, 0.3), (8.0, 0.3), (11.0, 0.3)])
    assert plant.response(np.full(5000, 0.7), dt=1e-3).output[-1] == pytest.approx(0.7, rel=1e-12)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: ModalPlant((0.0, 0.1)), "not a natural frequency"),
        (lambda: ModalPlant((1.0, 0.1), [1.0, 2.0]), r"gains have shape \(2,\) for 1 mode"),
        (lambda: ModalPlant((1.0, 0.1), 1.0), r"gains have shape \(\)"),
        (lambda: ModalPlant((1.0, 0.1), [math.nan]), "gains hold NaN"),
        (lambda: ModalPlant((1.0, 0.1), ["much"]), "gains hold something that is not a number"),
        (lambda: ModalPlant((1.0, 0.1), drive="force"), "drive is 'force': give 'position' or 'acceleration'"),
        (lambda: ModalPlant((1.0, 0.1)).response([0.0, 1.0], 0.0), "dt is 0 s"),
        (lambda: ModalPlant((1.0, 0.1)).response([0.0, 1.0], "slow"), "dt must be a number"),
        (lambda: ModalPlant((1.0, 0.1)).response([0.0, math.nan], 0.1), "command holds nan at index 1"),
        (lambda: ModalPlant((1.0, 0.1)).response(["a"], 0.1), "command holds something that is not a number"),
        (lambda: ModalPlant((1.0, 0.1)).response([], 0.1), "no samples"),
        (lambda: ModalPlant((1.0, 0.1)).response(np.zeros((2, 3)), 0.1), r"command has shape \(2, 3\)"),
        (lambda: ModalPlant((1.0, 0.1)).response([1.0], 0.1, hold="cubic"), "hold is 'cubic'"),
        (
            lambda: ModalPlant((1.0, 0.1)).response([1.0], 0.1, velocity=[1.0, 2.0]),
            "velocity has 2 value",
        ),
        (lambda: ModalPlant((1.0, 0.1)).step_train([0.0], [0.5, 0.5]), "times has 1 and amplitudes has 2"),
        (lambda: ModalPlant((1.0, 0.1)).impulse_train([], []), "at least one"),
        (lambda: ModalPlant((1.0, 0.1)).impulse_residual([math.inf], [1.0]), "times holds inf"),
    ],
)
def test_wrong_input_is_answered_with_value_and_remedy(make, words: str) -> None:
    with pytest.raises(InputError, match=words):
        make()
