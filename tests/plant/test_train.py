"""Impulses and steps at any times, against the matrix exponential and hand-written closed forms."""

import cmath
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.linalg import expm

from preshape.mode import Mode
from preshape.plant import ModalPlant

DAMPINGS = [0.0, 0.01, 0.05, 0.1, 0.2, 0.3]

trains = st.lists(st.tuples(st.floats(0.0, 0.4), st.floats(-2.0, 2.0)), min_size=1, max_size=5)


def zero_vibration_pair(mode: Mode) -> tuple[list[float], list[float]]:
    decay = math.exp(-math.pi * mode.damping / math.sqrt(1 - mode.damping**2))
    return [0.0, math.pi / mode.omega_d], [1 / (1 + decay), decay / (1 + decay)]


@pytest.mark.parametrize("damping", DAMPINGS)
def test_zero_vibration_pair_leaves_nothing(damping: float) -> None:
    mode = Mode(47.3, damping)
    plant = ModalPlant(mode)
    times, amplitudes = zero_vibration_pair(mode)
    assert plant.impulse_residual(times, amplitudes)[0] < 1e-14
    assert plant.step_train(times, amplitudes).residual_amplitudes[0] < 1e-14
    unit = plant.impulse_train([0.0], [1.0]).residual_amplitudes[0]
    assert plant.impulse_train(times, amplitudes).residual_amplitudes[0] < 1e-14 * unit


@pytest.mark.parametrize("damping", DAMPINGS)
def test_what_a_mistuned_pair_leaves_is_robertsons_formula(damping: float) -> None:
    times, amplitudes = zero_vibration_pair(Mode(1.0, damping))
    for frequency in (0.2, 0.7, 0.95, 1.05, 1.8, 40.0):
        mode = Mode(frequency, damping)
        # V = exp(-z w t_n) |sum A_i exp(z w t_i) exp(i w_d t_i)|
        growth = complex(damping * mode.omega, mode.omega_d)
        total = sum(a * cmath.exp(growth * t) for t, a in zip(times, amplitudes, strict=True))
        expected = math.exp(-damping * mode.omega * times[-1]) * abs(total)
        assert ModalPlant(mode).impulse_residual(times, amplitudes)[0] == pytest.approx(expected, abs=1e-13)


@settings(max_examples=40, deadline=None)  # the reference exponentiates a matrix a kick
@given(trains, st.floats(0.0, 0.9))
def test_state_by_state_and_phasor_agree_on_any_train(train: list[tuple[float, float]], damping: float) -> None:
    times, amplitudes = np.array(train).T
    plant = ModalPlant([(10.0, damping), (31.0, 0.02)])
    units = plant.impulse_train([0.0], [1.0]).residual_amplitudes
    left = plant.impulse_train(times, amplitudes).residual_amplitudes / units
    scale = np.abs(amplitudes).sum()
    np.testing.assert_allclose(left, plant.impulse_residual(times, amplitudes), rtol=0, atol=1e-12 * scale)


@settings(max_examples=40, deadline=None)  # the reference exponentiates a matrix a kick
@given(trains, st.floats(0.0, 0.9), st.sampled_from(["position", "acceleration"]))
def test_steps_agree_with_the_matrix_exponential_of_the_driven_system(
    train: list[tuple[float, float]], damping: float, drive: str
) -> None:
    mode = Mode(10.0, damping)
    w = mode.omega
    force = w**2 if drive == "position" else -1.0
    # The state is (x, x', u): the command is a state that only the steps change.
    system = np.array([[0, 1, 0], [-(w**2), -2 * damping * w, force], [0, 0, 0]])
    looks = [0.5, 0.13, 0.0]
    expected = []
    for look in looks:
        state, now = np.zeros(3), 0.0
        for t, a in sorted(train, key=lambda kick: kick[0]):
            if t <= look:
                state = expm(system * (t - now)) @ state + [0, 0, a]
                now = t
        expected.append(expm(system * (look - now)) @ state)
    times, amplitudes = np.array(train).T
    response = ModalPlant(mode, drive=drive).step_train(times, amplitudes, at=looks)
    scale = max(np.abs(amplitudes).sum(), 1e-3) * abs(force) / w**2
    x, v, u = np.array(expected).T
    np.testing.assert_allclose(response.displacement[0], x, rtol=0, atol=1e-12 * scale)
    np.testing.assert_allclose(response.velocity[0], v, rtol=0, atol=1e-12 * scale * w)
    acceleration = force * u - 2 * damping * w * v - w**2 * x
    np.testing.assert_allclose(response.acceleration[0], acceleration, rtol=0, atol=1e-11 * scale * w**2)


def test_steps_on_a_grid_are_the_sampled_response() -> None:
    dt = 2e-3
    levels = np.random.default_rng(7).normal(size=200)
    plant = ModalPlant([(4.0, 0.1), (9.0, 0.0)], [[1.0, 0.0], [0.0, 1.0]])
    sampled = plant.response(levels, dt)
    stairs = plant.step_train(np.arange(200) * dt, np.diff(levels, prepend=0.0), at=sampled.times)
    np.testing.assert_allclose(stairs.output, sampled.output, rtol=0, atol=1e-12)
    np.testing.assert_allclose(stairs.acceleration, sampled.acceleration, rtol=0, atol=1e-8)
    np.testing.assert_allclose(stairs.residual_amplitudes, sampled.residual_amplitudes, rtol=0, atol=1e-12)


def test_impulse_response_is_the_closed_form_and_nothing_comes_before_the_impulse() -> None:
    mode = Mode(20.0, 0.15)
    w, wd = mode.omega, mode.omega_d
    at = np.array([0.3, -1.0, 0.0999, 0.1, 0.101, 30.0])
    response = ModalPlant(mode).impulse_train([0.1], [0.5], at=at)
    t = at - 0.1
    expected = np.where(t < 0, 0.0, 0.5 * w**2 / wd * np.exp(-0.15 * w * np.maximum(t, 0)) * np.sin(wd * t))
    np.testing.assert_allclose(response.output, expected, rtol=0, atol=1e-12 * w)
    assert (response.displacement[:, 1:3] == 0.0).all()
    assert response.residual_time == 0.1


@pytest.mark.parametrize("damping", DAMPINGS)
def test_residual_of_a_step_is_that_of_an_impulse_for_any_shaper(damping: float) -> None:
    # Both excite the same free vibration up to one factor, so a shaper divides both by the same number.
    plant = ModalPlant((3.0, damping))
    times, amplitudes = [0.0, 0.07, 0.25], [0.3, 0.5, 0.2]
    unit = plant.step_train([0.0], [1.0]).residual_amplitudes
    assert unit[0] == pytest.approx(1 / math.sqrt(1 - damping**2), rel=1e-14)
    shaped = plant.step_train(times, amplitudes).residual_amplitudes
    np.testing.assert_allclose(shaped / unit, plant.impulse_residual(times, amplitudes), rtol=1e-12)
