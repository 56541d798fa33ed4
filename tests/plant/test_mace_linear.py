"""The linear MACE model: its printed frequencies, what a slew leaves, and a witness that knows nothing of modes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.linalg import expm

from preshape import Modes, Shaper, design
from preshape.errors import InputError
from preshape.plant import (
    linear_mace,
    linear_mace_beam,
    linear_mace_torque,
    peak_to_peak,
    torque_pulses,
)
from preshape.profile import Profile

PRINTED = [9.8, 31.7, 66.2, 114.1, 175.9]
MODES = linear_mace().modes()
PULSES = torque_pulses(linear_mace_torque())


def undriven_energy(command: Profile) -> tuple[float, float]:
    """Strain energy and kinetic energy of bending after a command made of steps, by the finite elements themselves.

    The state (displacements, rates) of the unreduced matrices is carried from step to step by the matrix exponential,
    the held torque as a state of its own: no mode, no phasor, no closed form.
    """
    beam = linear_mace_beam()
    mass, stiffness, load = beam.mass_matrix, beam.stiffness_matrix, beam.hinge_angle().row
    n = mass.shape[0]
    system = np.zeros((2 * n + 1, 2 * n + 1))
    system[:n, n : 2 * n] = np.eye(n)
    system[n : 2 * n, :n] = -np.linalg.solve(mass, stiffness)
    system[n : 2 * n, 2 * n] = np.linalg.solve(mass, load)
    state = np.zeros(2 * n + 1)
    for gap, jump in zip(np.diff(command.times, append=command.end_time), command.jumps, strict=True):
        state[2 * n] += jump
        turns = max(1, math.ceil(gap / 1e-4))  # about a radian of the fastest mode: expm is good to the last digit
        state = np.linalg.matrix_power(expm(system * (gap / turns)), turns) @ state
    x, v = state[:n], state[n : 2 * n]
    rigid = beam.modes.rigid_shapes
    x, v = (part - rigid @ (rigid.T @ mass @ part) for part in (x, v))
    return 0.5 * float(x @ stiffness @ x), 0.5 * float(v @ mass @ v)


def test_frequencies_are_hyde_s_and_twelve_modes_bend() -> None:
    found = np.array([mode.frequency for mode in MODES])
    np.testing.assert_allclose(found[:5], PRINTED, rtol=2e-3)
    assert found.size == 12 and linear_mace_beam().modes.rigid_shapes.shape[1] == 3
    assert all(mode.damping == 0.0 for mode in MODES)


def test_they_do_not_depend_on_what_hyde_leaves_open(monkeypatch: pytest.MonkeyPatch) -> None:
    # Only two ratios are identified: the scale of mass and the payload's arm change no frequency.
    expected = [mode.frequency for mode in MODES]
    for name, value in (("BUS_MASS", 3.0), ("ARM", 0.4)):
        monkeypatch.setattr(f"preshape.plant.mace_linear.{name}", value)
        np.testing.assert_allclose([mode.frequency for mode in linear_mace().modes()], expected, rtol=1e-12)


def test_the_unshaped_slew_leaves_1_2_millimetres() -> None:
    motion = linear_mace().motion(PULSES)
    assert peak_to_peak(motion, "left") == pytest.approx(1.2e-3, rel=1e-12)
    times = np.linspace(1.0, 2.0, 200_001)
    assert np.ptp(motion("left", times)) == pytest.approx(1.2e-3, rel=1e-4)
    assert linear_mace_torque(2.4e-3) == pytest.approx(2.0 * linear_mace_torque(), rel=1e-12)
    # It turns payload and bus against each other, about a centre of mass that stays, and then they stop.
    payload, bus = (motion(name, times) for name in ("payload", "bus"))
    assert payload.mean() > 0.0 > bus.mean()
    assert np.ptp(payload) < 1e-12
    assert np.abs(motion("centre", np.linspace(0.0, 2.0, 101))).max() < 1e-15


def test_the_payload_turns_as_its_inertia_says() -> None:
    torque, width, delay, inertia = 0.2, 0.3, 0.5, 11.305 * 0.8 * 0.15**2
    motion = linear_mace().motion(torque_pulses(torque, width, delay))
    assert float(motion("payload", 3.0)) == pytest.approx(torque * width * delay / inertia, rel=1e-12)


@pytest.mark.parametrize("count", [3, 4, 5, 12])
def test_shapers_for_more_modes_than_hyde_s_three(count: int) -> None:
    plant = linear_mace()
    shaper = design.direct(MODES[:count])
    assert shaper.design.status == "optimal"
    assert shaper.duration < 0.82 * sum(1.0 / mode.frequency for mode in MODES[:count])  # convolved
    plain, motion = plant.motion(PULSES), plant.motion(PULSES.shaped(shaper))
    left = motion.residual_amplitudes / plain.residual_amplitudes
    assert left[:count].max() < 1e-9
    assert peak_to_peak(motion, "left") < 0.006 * peak_to_peak(plain, "left")
    if count == 12:
        assert peak_to_peak(motion, "left") < 1e-9 * peak_to_peak(plain, "left")
        assert motion.settling_time("left", 1e-12) <= motion.end_time + 1e-12


def test_the_finite_elements_themselves_agree() -> None:
    plant = linear_mace()
    for shaper in (Shaper([0.0], [1.0]), design.direct(MODES[:3]), design.direct(MODES)):
        command = PULSES.shaped(shaper)
        motion = plant.motion(command)
        omega = np.array([mode.omega for mode in MODES])
        expected = 0.5 * float(np.sum((omega * motion.residual_amplitudes) ** 2))
        unshaped = 0.5 * float(np.sum((omega * plant.motion(PULSES).residual_amplitudes) ** 2))
        assert sum(undriven_energy(command)) == pytest.approx(expected, rel=1e-6, abs=1e-16 * unshaped)


def test_twelve_modes_cost_hardly_more_than_three() -> None:
    three, twelve = design.direct(MODES[:3]).duration, design.direct(MODES).duration
    assert three == pytest.approx(0.119052, abs=1e-6)
    assert twelve == pytest.approx(0.120495, abs=1e-6)


def test_a_finer_mesh_changes_the_slow_modes_little_and_the_fast_ones_much() -> None:
    fine = np.array([mode.frequency for mode in linear_mace(elements=24, count=12).modes()])
    coarse = np.array([mode.frequency for mode in MODES])
    assert (coarse > fine).all()
    assert coarse[0] / fine[0] < 1.0002 and coarse[11] / fine[11] > 1.4


def test_samples_of_the_slew() -> None:
    plant, dt = linear_mace(damping=0.002), 1e-4
    command = PULSES.shaped(design.direct(Modes(MODES[:3])))
    gridded = Profile.steps(dt * np.round(command.times / dt), command.jumps)
    # A touch late, so that rounding leaves no sample before its own step.
    found = plant.simulate(gridded(dt * np.arange(13_000) + 1e-9), dt)
    motion = plant.motion(gridded)
    for name in plant.outputs:
        exact = motion(name, found.times)
        np.testing.assert_allclose(found.outputs[name], exact, rtol=0, atol=1e-11 * max(np.abs(exact).max(), 1e-3))


def vibration(times: NDArray[np.float64]) -> NDArray[np.float64]:
    return linear_mace().motion(PULSES)("left", times)


def test_it_never_settles_unshaped() -> None:
    # No damping: the same range a minute later.
    assert np.ptp(vibration(np.linspace(60.0, 61.0, 50_001))) == pytest.approx(1.2e-3, rel=0.02)


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: torque_pulses(1.0, 0.0), "width is 0 s"),
        (lambda: torque_pulses(1.0, 0.5, 0.4), "delay beyond the width is -0.1 s"),
        (lambda: linear_mace_torque(-1.0), "residual is -1 m"),
        (lambda: linear_mace(damping=1.0), "damping ratio 1 is outside"),
        (lambda: linear_mace(count=13), "count is 13: give a whole number from 1 to 12"),
        (lambda: peak_to_peak(linear_mace().motion(PULSES), "left", span=0.0), "span is 0 s"),
        (lambda: peak_to_peak(linear_mace().motion(PULSES), "top"), "output is 'top'"),
    ],
)
def test_wrong_input_is_answered_with_value_and_remedy(make, words: str) -> None:
    with pytest.raises(InputError, match=words):
        make()
