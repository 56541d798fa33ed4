"""Deflection-limited shapers: limits kept exactly during a given command, and no slot of the grid wasted."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from preshape import design
from preshape.plant import FloatingOscillator, ModalPlant, PositionedMass
from preshape.profile import Profile

ARM = PositionedMass((1.0, 0.1))
CORNERS = np.array([0.0, 1.5, 3.5, 5.0])
SPEEDS = np.array([1.0, -1.0, -1.0, 1.0]) * 2.0 / 1.5
ROBERTSON = Profile.steps(CORNERS, SPEEDS, order=1)


def response(mode: tuple[float, float], t: np.ndarray) -> np.ndarray:
    """The deflection under Robertson's unshaped move, by its formula: a damped sine for every step of speed."""
    w, z = 2.0 * np.pi * mode[0], mode[1]
    turn = w * np.sqrt(1.0 - z**2)
    since = np.maximum(t[..., None] - CORNERS, 0.0)
    return np.asarray((np.exp(-z * w * since) * np.sin(turn * since) / turn) @ SPEEDS)


def possible(mode: tuple[float, float], limit: float, dt: float, slots: int) -> bool:
    """Whether positive impulses on so many slots keep the limit at fine samples and leave nothing; by HiGHS."""
    impulses = np.arange(slots + 1) * dt
    times = np.arange(0.0, CORNERS[-1] + impulses[-1], dt / 8.0)
    shaped = response(mode, times[:, None] - impulses)
    w, z = 2.0 * np.pi * mode[0], mode[1]
    wave = np.exp((z + 1j * np.sqrt(1.0 - z**2)) * w * (impulses - impulses[-1]))
    answer = linprog(
        np.zeros(slots + 1),
        A_ub=np.concatenate([shaped, -shaped]),
        b_ub=np.full(2 * times.size, limit),
        A_eq=np.array([np.ones(slots + 1), wave.real, wave.imag]),
        b_eq=[1.0, 0.0, 0.0],
        bounds=(0.0, 1.0),
    )
    return bool(answer.status == 0)


@pytest.mark.parametrize("ratio", [0.2, 0.3, 0.4])
def test_robertsons_move_keeps_its_limit_in_the_fewest_slots(ratio: float) -> None:
    dt, limit = 0.02, ratio * ARM.ramp_deflection(2.0 / 1.5)
    shaper = design.deflection_limited(ARM, ROBERTSON, limit, dt=dt)
    motion = ARM.motion(ROBERTSON.shaped(shaper))
    assert motion.peak("deflection").value <= limit * (1.0 + 1e-9)
    assert motion.residual("deflection") < 1e-10
    assert (shaper.amplitudes > 0.0).all() and shaper.amplitudes.sum() == pytest.approx(1.0, abs=1e-12)
    np.testing.assert_allclose(shaper.times / dt, np.rint(shaper.times / dt), atol=1e-9)
    slots = round(shaper.duration / dt)
    assert shaper.design.status == "optimal"
    assert possible((1.0, 0.1), limit, dt, slots) and not possible((1.0, 0.1), limit, dt, slots - 1)


def test_it_knows_the_command_where_sd_zv_does_not() -> None:
    """A shaper longer than the move's parts mixes what starting and braking do: the ratio alone does not limit that."""
    dt, limit = 0.04, 0.05 * ARM.ramp_deflection(2.0 / 1.5)
    blind = design.sd_zv((1.0, 0.1), 0.05, dt=dt)
    assert ARM.motion(ROBERTSON.shaped(blind)).peak("deflection").value > 1.2 * limit
    shaper = design.deflection_limited(ARM, ROBERTSON, limit, dt=dt)
    assert ARM.motion(ROBERTSON.shaped(shaper)).peak("deflection").value <= limit * (1.0 + 1e-9)
    assert shaper.duration > blind.duration


def test_a_gentle_command_needs_less_than_a_step_of_speed() -> None:
    dt, smooth = 0.02, Profile.steps([0.0, 1.0, 2.0], [0.3, -0.6, 0.3], order=2)
    limit = 0.5 * ARM.motion(smooth).peak("deflection").value
    shaper = design.deflection_limited(ARM, smooth, limit, dt=dt)
    assert ARM.motion(smooth.shaped(shaper)).peak("deflection").value <= limit * (1.0 + 1e-9)
    ratio = limit / ARM.ramp_deflection(0.3)  # what SD-ZV would be asked for: the same as for a step to full speed
    assert shaper.duration < design.sd_zv((1.0, 0.1), min(ratio, 0.5), dt=dt).duration + 1e-9


def test_several_modes_and_outputs_keep_all_limits() -> None:
    plant = ModalPlant([(1.0, 0.02), (2.7, 0.0)], [[1.0, 0.0], [0.4, -1.0]], drive="acceleration")
    push = Profile.steps([0.0, 1.1, 2.2], [1.0, -2.0, 1.0], order=0)
    unshaped = plant.motion(push)
    limits = {name: 0.45 * unshaped.peak(name).value for name in ("output 1", "output 2")}
    shaper = design.deflection_limited(plant, push, limits, dt=0.02)
    motion = plant.motion(push.shaped(shaper))
    for name, limit in limits.items():
        assert motion.peak(name).value <= limit * (1.0 + 1e-9)
        assert shaper.design.settings["deflection_reached"][name] == motion.peak(name).value
    assert motion.residual_amplitudes.max() < 1e-10
    assert shaper.duration >= shaper.design.settings["duration_without_limits"]


def test_a_force_on_a_free_body_still_brings_it_to_the_target() -> None:
    plant = FloatingOscillator(1.0, 1.0, 1.0)
    half = np.sqrt(20.0)
    force = Profile.steps([0.0, half, 2.0 * half], [1.0, -2.0, 1.0])
    shaper = design.deflection_limited(plant, force, 0.55, dt=0.05)
    motion = plant.motion(force.shaped(shaper))
    assert motion.peak("deflection").value <= 0.55 * (1.0 + 1e-9)
    assert float(motion("second_position", motion.end_time + 3.0)) == pytest.approx(10.0, abs=1e-8)
    assert float(force.shaped(shaper)(np.linspace(0.0, 12.0, 1201)).max()) <= 1.0 + 1e-12


@settings(max_examples=8)
@given(st.floats(0.0, 0.2), st.floats(0.25, 0.9), st.floats(0.3, 3.0))
def test_limits_are_exact_for_any_plant_and_move(damping: float, part: float, length: float) -> None:
    plant = PositionedMass((1.0, damping))
    move = Profile.steps([0.0, length], [1.0, -1.0], order=1)
    limit = part * plant.motion(move).peak("deflection").value
    shaper = design.deflection_limited(plant, move, limit, dt=0.05)
    motion = plant.motion(move.shaped(shaper))
    assert motion.peak("deflection").value <= limit * (1.0 + 1e-9) and motion.residual("deflection") < 1e-9
    assert shaper.design.settings["nothing_shorter_than"] <= shaper.duration + 1e-12


def test_limits_that_cost_nothing_change_nothing() -> None:
    shaper = design.deflection_limited(ARM, ROBERTSON, 10.0, dt=0.02)
    assert shaper.design.settings["duration_without_limits"] == shaper.duration
    assert shaper.design.status == "optimal" and ARM.motion(ROBERTSON.shaped(shaper)).residual("deflection") < 1e-12


def test_impulses_of_both_signs_are_shorter() -> None:
    limit = 0.4 * ARM.ramp_deflection(2.0 / 1.5)
    positive = design.deflection_limited(ARM, ROBERTSON, limit, dt=0.02)
    signed = design.deflection_limited(ARM, ROBERTSON, limit, dt=0.02, positive_only=False)
    assert signed.duration < positive.duration and np.abs(signed.amplitudes).max() <= 1.0 + 1e-12
    assert ARM.motion(ROBERTSON.shaped(signed)).peak("deflection").value <= limit * (1.0 + 1e-9)


def test_bad_input_says_what_to_do() -> None:
    with pytest.raises(ValueError, match="the limit of deflection .* above 0"):
        design.deflection_limited(ARM, ROBERTSON, -0.1, dt=0.02)
    with pytest.raises(ValueError, match="this motion has deflection, position"):
        design.deflection_limited(ARM, ROBERTSON, {"strain": 0.1}, dt=0.02)
    with pytest.raises(ValueError, match="give a Profile"):
        design.deflection_limited(ARM, [0.0, 1.0], 0.1, dt=0.02)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="grows for ever"):
        design.deflection_limited(
            FloatingOscillator(1.0, 1.0, 1.0), Profile.steps([0.0], [1.0]), {"centre": 1.0}, dt=0.1
        )
    with pytest.raises(ValueError, match="looks of .* leave out the fastest modes"):
        design.deflection_limited(ARM, Profile.steps([0.0, 9e5], [1.0, -1.0], order=1), 0.1, dt=0.02)
    with pytest.raises(ValueError, match="no shaper keeps the limits, deflection of 1e-06"):
        design.deflection_limited(ARM, Profile.steps([0.0], [1.0]), 1e-6, dt=0.45)
