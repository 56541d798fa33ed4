"""The Shuttle arm against other mechanics: energy of its bodies, Lagrange's equations, modal motion, energy balance."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.linalg import eigh, expm
from scipy.spatial.transform import Rotation

from preshape.plant import SimulatedPlant
from preshape.plant.shuttle_arm import (
    ANGLE_LIMITS,
    CALIBRATED_JOINTS,
    CALIBRATION_POSE,
    HYDE_FREQUENCIES,
    IMPERFECTIONS,
    RATE_LIMITS,
    SHUTTLE_LINKS,
    STIFFNESSES,
    Payload,
    Servo,
    ShuttleArm,
    calibrate,
    calibration_table,
    end_points,
)
from preshape.plant.shuttle_arm.inertia import pose_of
from preshape.plant.shuttle_arm.linear import state_matrix

LOADED = SHUTTLE_LINKS.carrying(Payload())
LINEAR = CALIBRATED_JOINTS.only()


def bodies(links, angles):
    """Centres [m] and turns of the six links, by chained rotations of SciPy."""
    place, turn, found = np.zeros(3), Rotation.identity(), []
    for axis, offset, centre, angle in zip(links.axes, links.offsets, links.centres, angles, strict=True):
        place = place + turn.apply(offset)
        turn = turn * Rotation.from_rotvec(axis * angle)
        found.append((place + turn.apply(centre), turn))
    return found


def kinetic_energy(links, angles, rates, change=1e-5):
    """Half m v^2 + half w.I.w of the six bodies, their motion by central differences of where they are."""
    after, before = bodies(links, angles + change * rates), bodies(links, angles - change * rates)
    energy = 0.0
    for k, ((to, turned), (back, unturned)) in enumerate(zip(after, before, strict=True)):
        speed = (to - back) / (2.0 * change)
        # Turn rate in the body's own axes, where the moments are principal.
        spin = (unturned.inv() * turned).as_rotvec() / (2.0 * change)
        energy += 0.5 * links.masses[k] * speed @ speed + 0.5 * spin @ (links.moments[k] * spin)
    return energy


@pytest.fixture(scope="module")
def random_poses():
    return np.random.default_rng(5).uniform(ANGLE_LIMITS[:, 0], ANGLE_LIMITS[:, 1], (6, 6))


@pytest.mark.parametrize("links", [SHUTTLE_LINKS, LOADED], ids=["empty", "loaded"])
def test_mass_matrix_gives_the_kinetic_energy_of_the_bodies(links, random_poses):
    masses = pose_of(links, random_poses).mass_matrix()
    assert np.array_equal(masses, np.swapaxes(masses, 1, 2))
    assert np.linalg.eigvalsh(masses).min() > 0.1
    rng = np.random.default_rng(1)
    for angles, mass in zip(random_poses, masses, strict=True):
        rates = rng.normal(size=6)
        assert 0.5 * rates @ mass @ rates == pytest.approx(kinetic_energy(links, angles, rates), rel=1e-8)


def test_centripetal_torques_are_those_of_lagranges_equations(random_poses):
    rng = np.random.default_rng(2)
    change = 1e-5
    for angles in random_poses:
        rates = rng.normal(size=6)

        def mass(at):
            return pose_of(LOADED, at[np.newaxis]).mass_matrix()[0]

        slopes = np.array([(mass(angles + e) - mass(angles - e)) / (2.0 * change) for e in change * np.eye(6)])
        expected = np.einsum("kij,k,j->i", slopes, rates, rates) - 0.5 * np.einsum("kij,i,j->k", slopes, rates, rates)
        found = pose_of(LOADED, angles[np.newaxis]).centripetal(rates[np.newaxis])[0]
        assert found == pytest.approx(expected, rel=1e-5, abs=1e-4 * np.abs(expected).max())


def test_end_point_jacobian_and_reach(random_poses):
    change = 1e-6
    jacobians = pose_of(SHUTTLE_LINKS, random_poses).end_jacobian()
    for k, e in enumerate(change * np.eye(6)):
        moved = end_points(SHUTTLE_LINKS, random_poses + e) - end_points(SHUTTLE_LINKS, random_poses - e)
        assert jacobians[:, :, k] == pytest.approx(moved / (2.0 * change), abs=1e-7)
    # NASA: 50 ft 3 in from the shoulder to the end.
    assert ShuttleArm().end_point()[0] == pytest.approx(50.25 * 0.3048, abs=0.01)
    assert SHUTTLE_LINKS.masses.sum() == pytest.approx(905 * 0.45359237, abs=1.0)


def test_payload_moves_the_last_links_centre_and_moments():
    """Against point masses: the payload's cylinder and the hand, summed about their common centre."""
    one, hand = Payload(1000.0, 0.5, 2.0), SHUTTLE_LINKS
    links = hand.carrying(one)
    at = hand.end[0] + 1.0
    centre = (36.0 * hand.centres[5, 0] + 1000.0 * at) / 1036.0
    assert links.centres[5] == pytest.approx([centre, 0.0, 0.0])
    across = 1000.0 * (3 * 0.25 + 4.0) / 12.0 + 1000.0 * (at - centre) ** 2
    across += hand.moments[5, 1] + 36.0 * (hand.centres[5, 0] - centre) ** 2
    assert links.moments[5] == pytest.approx([hand.moments[5, 0] + 125.0, across, across])


def test_hydes_frequencies_and_low_damping():
    rows = calibration_table()
    assert [row.printed for row in rows] == list(HYDE_FREQUENCIES)
    assert max(abs(row.residual) for row in rows) < 1e-5
    assert all(0.004 < row.damping < 0.02 for row in rows), "Hyde: around 0.01"
    assert calibrate() == pytest.approx(STIFFNESSES, rel=1e-5)
    # Motors held: the plain eigenproblem of links on springs.
    stiff = replace(LINEAR, stiffness=LINEAR.stiffness, relaxation=0.0)
    held = Servo(2000.0)
    mass = pose_of(LOADED, np.array([CALIBRATION_POSE])).mass_matrix()[0]
    expected = np.sqrt(eigh(np.diag(stiff.stiffness), mass, eigvals_only=True)) / (2.0 * math.pi)
    found = ShuttleArm(CALIBRATION_POSE, Payload(), stiff, held).modes()
    assert [mode.frequency for mode in found][:6] == pytest.approx(expected, rel=1e-3)


def test_frequencies_depend_on_the_pose():
    arm = ShuttleArm()
    stretched, folded = arm.modes(), arm.modes(np.radians([0.0, 40.0, -130.0, 0.0, 0.0, 0.0]))
    assert stretched[0].frequency == pytest.approx(0.91, abs=0.01)
    assert folded[0].frequency > 1.3 * stretched[0].frequency


def test_small_motion_is_the_linear_one():
    """Without imperfections, against the matrix exponential of the linearised arm."""
    arm = ShuttleArm(CALIBRATION_POSE, Payload(), LINEAR)
    dt, samples = 0.02, 500
    command = np.zeros((6, samples))
    command[:, :100] = 1e-4 * np.array([[1.0], [-0.5], [0.7], [0.3], [0.8], [-0.2]])
    found = arm.simulate(command, dt)
    matrix = np.zeros((36, 36))
    matrix[:24, :24] = state_matrix(arm.links, arm.joints, arm.servo, np.array(arm.pose))
    angle, rate = arm.servo.gains(arm.joints.inertia)
    matrix[18:24, 24:30] = np.diag(angle / arm.joints.inertia)
    matrix[18:24, 30:] = np.diag(rate / arm.joints.inertia)
    matrix[24:30, 30:] = np.eye(6)
    step, state, states = expm(matrix * dt), np.zeros(36), []
    for k in range(samples):
        state[30:] = command[:, k]
        states.append(state[:12])
        state = step @ state
    states = np.array(states)
    names = [f"{joint} angle" for joint in ("shoulder yaw", "shoulder pitch", "elbow pitch", "wrist yaw")]
    for name, k in zip(names, (0, 1, 2, 4), strict=True):
        moved = found.outputs[name] - arm.pose[k]
        assert moved == pytest.approx(states[:, k], abs=2e-3 * np.abs(states[:, k]).max())


def test_end_point_steps_predict_the_swing():
    arm = ShuttleArm(np.radians([10.0, 50.0, -80.0, 20.0, 30.0, 0.0]), None, LINEAR)
    rates = 1e-4 * np.array([1.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    predicted, modes = arm.end_point_steps(rates), arm.modes()
    command = np.repeat(rates[:, np.newaxis], 400, axis=1)
    found = arm.simulate(command, 0.01)
    ends = np.array([found.outputs[f"end point {axis}"] for axis in "xyz"])
    times, kept = found.times, found.times > 0.5
    # Least squares: a drift and each mode's decaying cosine and sine.
    columns = [np.ones(times.size), times]
    for mode in modes[:3]:
        s = np.exp(mode.pole * times)
        columns += [s.real, s.imag]
    basis = np.array(columns).T[kept]
    fit = np.linalg.lstsq(basis, ends[:, kept].T, rcond=None)[0]
    for k in range(2):
        swing = fit[2 + 2 * k] - 1j * fit[3 + 2 * k]
        largest = max(np.linalg.norm((swing * np.exp(1j * phase)).real) for phase in np.linspace(0.0, math.pi, 181))
        assert largest == pytest.approx(predicted[k], rel=0.03)


@pytest.mark.parametrize("imperfections", [(), *((name,) for name in IMPERFECTIONS[:4]), IMPERFECTIONS], ids=str)
@pytest.mark.parametrize("payload", [None, Payload()], ids=["empty", "loaded"])
def test_energy_balances_with_controllers_off(imperfections, payload):
    """Torque pulses, then free motion: what the motors gave is in the links and gears, or was rubbed away, to 0.1 %."""
    arm = ShuttleArm(CALIBRATION_POSE, payload, CALIBRATED_JOINTS.only(*imperfections), servo=None)
    torques = np.zeros((6, 400))
    torques[:, :40] = (
        0.3 * arm.joints.torque_limit[:, np.newaxis] * np.array([[1.0], [0.8], [-1.0], [1.0], [0.7], [-1.0]])
    )
    found = arm.simulate(torques, 0.02, energy=True)
    energy = found.energy
    kept = energy["kinetic"] + energy["strain"]
    off = kept + energy["dissipated"] - energy["work"]
    assert np.abs(off).max() < 1e-3 * energy["work"].max()
    # Passive in free motion: nothing is made, and what dissipates does so for good.
    assert np.diff(energy["dissipated"]).min() >= -1e-12
    assert np.diff(kept[41:]).max() < 1e-3 * kept[41]
    assert np.ptp(energy["work"][41:]) == 0.0


def test_energy_balances_under_control():
    arm = ShuttleArm(CALIBRATION_POSE, None)
    command = np.zeros((6, 300))
    command[:, :200] = 0.5 * RATE_LIMITS[:, np.newaxis]
    energy = arm.simulate(command, 0.02, energy=True).energy
    off = energy["kinetic"] + energy["strain"] + energy["dissipated"] - energy["work"]
    assert np.abs(off).max() < 1e-3 * energy["work"].max()


def test_is_a_plant_with_named_outputs():
    arm = ShuttleArm()
    assert isinstance(arm, SimulatedPlant)
    done = arm.simulate(np.zeros((6, 5)), 0.02)
    assert set(done.outputs) == set(done.units) == set(arm.outputs)
    assert len(arm.outputs) == 15
    assert all(np.ptp(values) == 0.0 for values in done.outputs.values())
