"""The non-linear MACE model: against its linearisation, a floating frame of our own, energy and momentum; bad input."""

import math
from dataclasses import replace

import numpy as np
import pytest
from tests.plant.mace_floating_frame import ELEMENTS, FloatingFrame

from preshape.errors import InputError
from preshape.plant.diverged import Diverged
from preshape.plant.mace import CALIBRATED, CALIBRATED_GAINS, GimbalLimits, Mace, MaceGains
from preshape.plant.mace.linear import Linearised, lumps
from preshape.plant.protocol import SimulatedPlant

pytest.importorskip("exudyn", exc_type=ImportError)

from preshape.plant.mace.multibody import MaceBody  # noqa: E402

DT = 1e-3
LIMIT = math.radians(60.0)


def pulses(t: float, torque: float = 0.3) -> float:
    """A pair of opposite smooth pulses: about 20 deg, and at rest again."""
    return torque * math.sin(math.pi * t / 0.8) ** 2 * math.copysign(1.0, 0.8 - t) if t < 1.6 else 0.0


def sampled(duration: float, torque: float = 0.3) -> np.ndarray:
    return np.array([pulses(k * DT + 0.5 * DT, torque) for k in range(round(duration / DT) + 1)])


def swing(simulation, start: float, output: str = "left sensor") -> float:
    """Peak to peak from a time on."""
    return float(np.ptp(simulation.outputs[output][simulation.times >= start]))


@pytest.mark.parametrize("angle", [0.0, 0.7, LIMIT, -LIMIT])
def test_exudyn_linearised_has_the_frequencies_of_the_matrices_written_by_hand(angle: float) -> None:
    body = MaceBody(CALIBRATED, angle, elements=2, damping=0.0, gains=None)
    found = body.natural_frequencies()
    assert found[:4].max() < 1e-3
    np.testing.assert_allclose(found[4:10], Linearised(CALIBRATED, angle).undamped()[:6], rtol=1e-4)


def test_a_small_slew_is_that_of_the_linear_model() -> None:
    from scipy.signal import StateSpace, lsim

    command = sampled(2.0, 1e-4)
    model = Linearised(CALIBRATED, LIMIT, damping=0.01)
    size = len(model.mass)
    force = np.zeros(size)
    force[model.payload], force[model.end] = 1.0, -1.0
    sensor = np.zeros(2 * size)
    sensor[[4, 13, 14]] = 1.0, -1.0, 0.5625
    drive = np.concatenate([np.zeros(size), np.linalg.solve(model.mass, force)])[:, np.newaxis]
    # In modal coordinates slower than 200 Hz: lsim's exponential of all of them loses digits.
    times = DT * np.arange(len(command))
    linear = lsim(StateSpace(model.state(), drive, sensor[np.newaxis], [[0.0]]), command, times, interp=False)[1]
    found = Mace(angle=LIMIT).simulate(command, DT).outputs["left sensor"]
    np.testing.assert_allclose(found, linear, atol=3e-3 * np.abs(linear).max())


@pytest.mark.parametrize("damping", [0.0, 0.01])
def test_energy_balances_with_the_controllers_off(damping: float) -> None:
    energy = Mace(damping=damping).simulate(sampled(4.0, 0.6), DT, energy=True).energy
    assert energy is not None
    missing = energy["kinetic"] + energy["strain"] + energy["dissipated"] - energy["work"]
    assert np.abs(missing).max() < 1e-3 * energy["work"].max()
    assert energy["strain"].max() > 0.02 * energy["work"].max()


def test_energy_balances_with_a_step_of_torque_and_a_turning_bus() -> None:
    torques = np.zeros((2, 3001))
    torques[0, :400], torques[1, :1500] = 0.3, 2.0
    simulation = Mace(damping=0.01).simulate(torques, DT, energy=True)
    energy = simulation.energy
    assert energy is not None and simulation.outputs["bus angle"][-1] > 0.3
    missing = energy["kinetic"] + energy["strain"] + energy["dissipated"] - energy["work"]
    assert np.abs(missing).max() < 1e-3 * energy["work"].max()


def test_nothing_outside_pushes_it_so_its_angular_momentum_stays_zero() -> None:
    body = MaceBody(CALIBRATED, 0.4, elements=2, damping=0.01, gains=None)
    step = 5e-4
    positions, velocities, failure = body.run(step, 2000, lambda k, q, v, a: (pulses((k + 1) * step), 0.0))
    assert failure == ""
    starts = [*range(36, 51, 3), 51]
    heights = [0.0, 0.0, 0.0, 0.0, 0.0]
    masses, inertias, places = [], [], []
    for node in range(5):
        own = [lump for lump in lumps(CALIBRATED, 2) if lump.node == 2 * node]
        total = sum(lump.mass for lump in own)
        heights[node] = sum(lump.mass * lump.height for lump in own) / total
        masses.append(total)
        inertias.append(sum(lump.inertia + lump.mass * (lump.height - heights[node]) ** 2 for lump in own))
        places.append((-0.75 + 0.375 * node, heights[node]))
    masses.append(CALIBRATED.turning_mass)
    inertias.append(CALIBRATED.payload_inertia)
    places.append((0.75 - CALIBRATED.arm * math.sin(0.4), CALIBRATED.axis_height + CALIBRATED.arm * math.cos(0.4)))
    spin = np.zeros(len(positions))
    parts = np.zeros(len(positions))
    for start, m, inertia, (x, y) in zip(starts, masses, inertias, places, strict=True):
        at, rate = positions[:, start : start + 3], velocities[:, start : start + 3]
        each = m * ((x + at[:, 0]) * rate[:, 1] - (y + at[:, 1]) * rate[:, 0]) + inertia * rate[:, 2]
        spin += each
        parts += np.abs(each)
    # The struts' own mass, 3 % of the whole, is not in the sum.
    assert np.abs(spin).max() < 0.03 * parts.max()


def test_a_slew_agrees_with_a_floating_frame() -> None:
    times = DT * np.arange(2501)
    angle = math.radians(-20.0)
    frame = FloatingFrame(CALIBRATED, None, 0.01)
    q = frame.slew(angle, lambda t: pulses(t), times)
    plant = Mace(angle=angle).simulate(sampled(2.5), DT)
    np.testing.assert_allclose(plant.outputs["payload angle"], q[-1], atol=1e-3 * np.ptp(q[-1]))
    expected = frame.off_line(ELEMENTS // 2, q)
    np.testing.assert_allclose(plant.outputs["left sensor"], expected, atol=1e-2 * np.abs(expected).max())


def test_a_closed_loop_slew_of_120_deg_agrees_with_a_floating_frame() -> None:
    times = DT * np.arange(3001)
    frame = FloatingFrame(CALIBRATED, CALIBRATED_GAINS, 0.01)

    def command(t: float) -> float:  # as smooth as it needs to be for a bus of four shapes
        return -LIMIT * math.cos(math.pi * min(t, 1.0))

    q = frame.slew(-LIMIT, command, times)
    plant = Mace(CALIBRATED_GAINS, angle=-LIMIT).simulate([command(t + 0.5 * DT) for t in times], DT)
    np.testing.assert_allclose(plant.outputs["payload angle"], q[-1], atol=1e-3 * np.ptp(q[-1]))
    expected = frame.off_line(ELEMENTS // 2, q)
    np.testing.assert_allclose(plant.outputs["left sensor"], expected, atol=1e-2 * np.abs(expected).max())


def test_the_payload_overshoots_when_hyde_says() -> None:
    simulation = Mace(CALIBRATED_GAINS, angle=math.radians(-20.0)).simulate(np.full(6001, math.radians(20.0)), DT)
    peak = simulation.times[int(np.argmax(simulation.outputs["payload angle"]))]
    assert peak == pytest.approx(4.2, abs=0.1)


def test_half_the_step_changes_the_residual_by_less_than_a_percent() -> None:
    plant = Mace(CALIBRATED_GAINS, angle=-LIMIT)
    command = np.full(7001, LIMIT)
    one, half = (swing(plant.simulate(command, DT, step=step), 5.0) for step in (DT, 0.5 * DT))
    assert half == pytest.approx(one, rel=1e-2)


def test_limits_are_kept() -> None:
    limits = GimbalLimits()
    plant = Mace(CALIBRATED_GAINS, angle=-1.0, limits=limits)
    limited = plant.simulate(np.full(4001, 1.0), DT).outputs
    free = replace(plant, limits=None).simulate(np.full(4001, 1.0), DT).outputs
    assert np.abs(free["gimbal torque"]).max() > limits.torque
    assert np.abs(limited["gimbal torque"]).max() <= limits.torque * (1.0 + 1e-12)
    assert np.ptp(limited["left end"]) < np.ptp(free["left end"])


def test_unstable_gains_end_with_the_time_and_what_was_computed() -> None:
    with pytest.raises(Diverged, match=r"diverged at .* s: .*loop is unstable, motion grows by e every") as stopped:
        Mace(MaceGains(75.0, 100.0, -5.0, -1.0)).simulate(np.full(10001, 0.1), DT)
    partial = stopped.value.partial
    assert 0.1 < stopped.value.time < 9.0
    assert partial.times[-1] == pytest.approx(stopped.value.time, abs=DT)
    assert partial.command.shape == (3, len(partial.times)) and np.isfinite(partial.outputs["left end"]).all()


def test_a_torque_that_no_bus_can_bear_says_to_command_less() -> None:
    with pytest.raises(Diverged, match="Give a smaller command, or a shorter step than 0.001 s") as stopped:
        Mace().simulate(np.full(2001, 50.0), DT)
    assert len(stopped.value.partial.times) > 5


def test_a_sample_time_that_does_not_fit_is_refused() -> None:
    with pytest.raises(InputError, match=r"sample time 0.0015 s is 1.5 simulation steps of 0.001 s"):
        Mace().simulate(np.zeros(10), 0.0015, step=DT)
    with pytest.raises(InputError, match="dt is 0 s"):
        Mace().simulate(np.zeros(10), 0.0)


def test_samples_coarser_than_the_step_see_the_same_motion() -> None:
    fine = Mace(CALIBRATED_GAINS).simulate(np.full(1001, 0.5), DT)
    coarse = Mace(CALIBRATED_GAINS).simulate(np.full(201, 0.5), 5.0 * DT)
    np.testing.assert_allclose(coarse.outputs["left end"], fine.outputs["left end"][::5], rtol=0, atol=1e-12)


@pytest.mark.parametrize("samples", [1, 2])
def test_few_samples_are_enough(samples: int) -> None:
    simulation = Mace().simulate(np.zeros(samples), DT)
    assert simulation.times.shape == simulation.outputs["left end"].shape == (samples,)
    assert np.abs(simulation.outputs["left end"]).max() < 1e-15


def test_it_is_a_plant_as_the_protocol_says() -> None:
    plant = Mace(CALIBRATED_GAINS)
    assert isinstance(plant, SimulatedPlant)
    simulation = plant.simulate(np.zeros((3, 4)), DT)
    assert list(simulation.outputs) == list(plant.outputs) == list(simulation.units)


def test_commands_of_the_wrong_shape_are_refused() -> None:
    with pytest.raises(InputError, match="gimbal torque, attitude torque"):
        Mace().simulate(np.zeros((3, 5)), DT)
    with pytest.raises(InputError, match="NaN"):
        Mace().simulate([0.0, math.nan], DT)


def test_progress_is_told_and_its_exceptions_come_through() -> None:
    parts: list[float] = []
    Mace().simulate(np.zeros(201), DT, progress=parts.append)
    assert parts == sorted(parts) and len(parts) > 10 and 0.0 < parts[0] < parts[-1] <= 1.0

    def refuse(part: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        Mace().simulate(np.zeros(201), DT, progress=refuse)


def test_nothing_is_printed(capfd: pytest.CaptureFixture[str]) -> None:
    Mace().simulate(np.zeros(11), DT)
    with pytest.raises(Diverged):
        Mace().simulate(np.full(2001, 50.0), DT)
    captured = capfd.readouterr()
    assert captured.out == captured.err == ""
