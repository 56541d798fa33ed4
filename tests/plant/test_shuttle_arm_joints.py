"""The arm's imperfections one by one, wrong input, and its motion against Exudyn's kinematic tree."""

from __future__ import annotations

import math
import pickle
import warnings
from dataclasses import replace

import numpy as np
import pytest

from preshape.errors import InputError
from preshape.plant import Diverged
from preshape.plant.shuttle_arm import (
    CALIBRATED_JOINTS,
    IMPERFECTIONS,
    RATE_LIMITS,
    SHUTTLE_LINKS,
    JointHardware,
    Payload,
    Servo,
    ShuttleArm,
    calibrate,
)

POSE = np.radians([20.0, 60.0, -90.0, -40.0, 10.0, 0.0])
LINEAR = CALIBRATED_JOINTS.only()


def pulse(rates, samples=500, dt=0.02, length=4.0):
    """Of six rates, shape (joint, sample)."""
    command = np.zeros((6, samples))
    command[:, : round(length / dt)] = np.asarray(rates)[:, np.newaxis]
    return command


def torque(joint, size, samples=500):
    """Held on one motor."""
    command = np.zeros((6, samples))
    command[joint] = size
    return command


def end_of(done):
    """The end point [m], shape (axis, sample)."""
    return np.array([done.outputs[f"end point {axis}"] for axis in "xyz"])


def residual(done, start=205, samples=150):
    """Largest distance of the end point from its mean [m]."""
    window = end_of(done)[:, start : start + samples]
    return float(np.linalg.norm(window - window.mean(axis=1, keepdims=True), axis=0).max())


def test_a_stuck_motor_does_not_creep_and_breaks_away_at_its_limit():
    arm = ShuttleArm(POSE, None, CALIBRATED_JOINTS.only("friction"), servo=None)
    below = arm.simulate(torque(0, 0.99 * arm.joints.sticking[0], 1000), 0.02).outputs["shoulder yaw motor"]
    assert np.ptp(below) == 0.0
    above = arm.simulate(torque(0, 1.01 * arm.joints.sticking[0]), 0.02).outputs["shoulder yaw motor"]
    assert above[-1] - above[0] > 1e-3


def test_dry_friction_takes_its_share_of_the_torque():
    """A free motor on a gear that holds nothing: J w' = T - F, exactly."""
    loose = replace(CALIBRATED_JOINTS.only("friction"), stiffness=1e-6, viscous=0.0)
    arm = ShuttleArm(POSE, None, loose, servo=None)
    size = 3.0 * loose.coulomb[0]
    angle = arm.simulate(torque(0, size, 101), 0.02).outputs["shoulder yaw motor"] - POSE[0]
    expected = 0.5 * (size - loose.coulomb[0]) / loose.inertia[0] * 2.0**2
    # The first kick breaks away from rest with the sticking friction.
    assert angle[-1] == pytest.approx(expected, rel=2e-3)


def test_a_constant_torque_is_followed_exactly_from_the_first_step():
    """A free motor on a gear that holds nothing: the angle is T t^2 / 2 J, without an error of the step."""
    loose = replace(LINEAR, stiffness=1e-9, viscous=0.0)
    done = ShuttleArm(POSE, None, loose, servo=None).simulate(torque(0, 20.0, 101), 0.02)
    expected = 0.5 * 20.0 / loose.inertia[0] * done.times**2
    assert done.outputs["shoulder yaw motor"] - POSE[0] == pytest.approx(expected, abs=1e-9)


def test_a_torque_that_begins_later_moves_as_much_later():
    """The same motor: T (t - t0)^2 / 2 J from t0 on, then straight on at T (t1 - t0) / J, however the step lies."""
    loose = replace(LINEAR, stiffness=1e-9, viscous=0.0)
    command = torque(0, 20.0, 101)
    command[0, :30] = command[0, 61:] = 0.0
    done = ShuttleArm(POSE, None, loose, servo=None).simulate(command, 0.02)
    pushed = np.clip(done.times - 0.6, 0.0, 0.62)
    expected = 20.0 / loose.inertia[0] * (0.5 * pushed**2 + pushed * np.clip(done.times - 1.22, 0.0, None))
    assert done.outputs["shoulder yaw motor"] - POSE[0] == pytest.approx(expected, abs=1e-9)


def test_within_the_gap_nothing_couples():
    joints = replace(CALIBRATED_JOINTS.only("freeplay"), gap=0.01)
    arm = ShuttleArm(POSE, None, joints, servo=None)
    push = torque(0, 0.0, 200)
    push[0, :5] = 50.0
    done = arm.simulate(push, 0.02)
    motor, link = done.outputs["shoulder yaw motor"], done.outputs["shoulder yaw angle"]
    apart = np.cumsum(motor - POSE[0] >= 0.0099) == 0
    assert 20 < apart.sum() < 150
    assert np.ptp(link[apart]) < 1e-12
    assert np.ptp(link) > 1e-4, "once the gap is used up the link is taken along"


def test_gears_stiffen_by_the_growth_at_the_torque_limit():
    joints = CALIBRATED_JOINTS.only("stiffening")
    at, change = joints.torque_limit / joints.stiffness, 1e-9
    slope = (joints.torque(at + change) - joints.torque(at - change)) / (2.0 * change)
    assert slope == pytest.approx(joints.stiffness * (1.0 + joints.growth), rel=1e-6)
    work = (joints.energy(at + change) - joints.energy(at - change)) / (2.0 * change)
    assert work == pytest.approx(joints.torque(at), rel=1e-6)


def test_saturated_motors_accelerate_no_faster_than_their_torque_allows():
    arm = ShuttleArm(POSE, None, CALIBRATED_JOINTS.only("saturation"))
    fast = arm.simulate(pulse(20.0 * RATE_LIMITS * [1, 0, 0, 0, 0, 0], 50, 0.01, 0.3), 0.01, energy=True)
    moved = fast.outputs["shoulder yaw motor"]
    power = np.diff(fast.energy["work"])
    assert power.max() <= arm.joints.torque_limit[0] * np.abs(np.diff(moved)).max() * 1.05
    free = ShuttleArm(POSE, None, LINEAR).simulate(pulse(20.0 * RATE_LIMITS * [1, 0, 0, 0, 0, 0], 50, 0.01, 0.3), 0.01)
    assert free.outputs["shoulder yaw motor"][10] > 2.0 * (moved[10] - POSE[0]) + POSE[0]


def test_digital_joints_read_late_and_in_steps():
    joints = CALIBRATED_JOINTS.only("digital")
    arm = ShuttleArm(POSE, None, joints)
    rate = 10.4 * joints.rate_step
    done = arm.simulate(pulse(np.full(6, rate), 400), 0.02, seed=4)
    moved = done.outputs["shoulder yaw motor"][-1] - POSE[0]
    assert moved == pytest.approx(4.0 * 10.0 * joints.rate_step, rel=3e-3), "rounded to ten steps"
    other = arm.simulate(pulse(np.full(6, rate), 400), 0.02, seed=5)
    assert not np.array_equal(end_of(other), end_of(done)), "other moments of reading"
    assert np.array_equal(end_of(arm.simulate(pulse(np.full(6, rate), 400), 0.02, seed=4)), end_of(done))


@pytest.mark.parametrize("imperfections", [(), IMPERFECTIONS], ids=["linear", "all"])
@pytest.mark.parametrize("level", [0.3, 0.8])
def test_half_the_step_changes_the_residual_by_less_than_one_percent(imperfections, level):
    arm = ShuttleArm(POSE, None, CALIBRATED_JOINTS.only(*imperfections))
    command = pulse(level * RATE_LIMITS * [1.0, 1.0, 0.5, 0.0, 0.0, 0.0], 360)
    whole, half = arm.simulate(command, 0.02), arm.simulate(command, 0.02, step=0.00125)
    assert residual(half) == pytest.approx(residual(whole), rel=0.01)


def test_many_runs_are_the_single_ones():
    poses = np.array([POSE, np.zeros(6), np.radians([-40.0, 100.0, -120.0, 30.0, -20.0, 100.0])])
    commands = [pulse(level * RATE_LIMITS, 60, length=0.5) for level in (0.2, -0.4, 0.7)]
    hardware = CALIBRATED_JOINTS.only("stiffening", "freeplay", "friction", "saturation")
    for pose, command, found in zip(
        poses, commands, ShuttleArm(joints=hardware).simulate_all(poses, commands, 0.02), strict=True
    ):
        alone = ShuttleArm(pose, None, hardware).simulate(command, 0.02)
        assert end_of(found) == pytest.approx(end_of(alone), abs=1e-12)


def test_unstable_servo_is_named_and_keeps_what_was_computed():
    arm = ShuttleArm(POSE, None, LINEAR, Servo(10.0, -0.05))
    with pytest.raises(InputError, match=r"unstable, motion grows by e every .* s: it has no modes"):
        arm.modes()
    with pytest.raises(Diverged, match=r"diverged at [\d.]+ s: .*unstable.*damping above 0") as told:
        arm.simulate(pulse(0.3 * RATE_LIMITS), 0.02)
    partial = told.value.partial
    assert 0 < partial.times.size < 500
    assert partial.times[-1] < told.value.time
    assert all(values.shape == partial.times.shape and np.isfinite(values).all() for values in partial.outputs.values())
    with pytest.raises(Diverged, match=r"diverged at 0\.\d+ s"):
        ShuttleArm(POSE, None, LINEAR, Servo(10.0, -300.0)).simulate(pulse(RATE_LIMITS, 20, length=0.1), 0.02)
    assert pickle.loads(pickle.dumps(told.value)).time == told.value.time


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda: ShuttleArm().simulate(pulse(RATE_LIMITS), 0.02, step=0.003), "6.66667 simulation steps of 0.003 s"),
        (lambda: ShuttleArm().simulate(pulse(RATE_LIMITS), 0.02, step=0.01), "too long for joints that vibrate at"),
        (lambda: ShuttleArm(servo=Servo(200.0)).simulate(pulse(RATE_LIMITS), 0.02), "vibrate at 20. Hz"),
        (lambda: ShuttleArm().simulate(pulse(RATE_LIMITS), -0.02), "dt is -0.02 s"),
        (lambda: ShuttleArm().simulate(pulse(RATE_LIMITS)[:3], 0.02), "shape"),
        (lambda: ShuttleArm().simulate(np.full((6, 4), math.nan), 0.02), "NaN"),
        (lambda: ShuttleArm((0.0, 1.0)), "six finite angles"),
        (lambda: ShuttleArm((math.inf,) * 6), "six finite angles"),
        (lambda: ShuttleArm().simulate_all([np.zeros(6)], [], 0.02), "1 pose"),
        (lambda: ShuttleArm(servo=None).end_point_steps(RATE_LIMITS), "without a servo"),
        (lambda: JointHardware(-1.0), "above 0"),
        (lambda: JointHardware([1.0, 2.0]), "six joints"),
        (lambda: JointHardware(1e6, sticking=0.0), "below that of motion"),
        (lambda: CALIBRATED_JOINTS.only("rust"), "no imperfection 'rust'"),
        (lambda: Servo(0.0), "bandwidth"),
        (lambda: Payload(-1.0), "mass"),
        (lambda: calibrate((0.2, 0.26, 0.45, 9.0)), "no joint stiffnesses"),
    ],
)
def test_wrong_input_gets_a_sentence(call, sentence):
    with pytest.raises(InputError, match=sentence):
        call()


def test_progress_rises_to_one():
    told = []
    ShuttleArm(POSE).simulate(pulse(0.1 * RATE_LIMITS, 100), 0.02, progress=told.append)
    assert told[-1] == 1.0
    assert len(told) > 10
    assert told == sorted(told)


def test_exudyns_kinematic_tree_moves_alike():
    """The links as somebody else's engine follows them, motors and gears as its springs: to 0.2 mm of a 2 m move."""
    exudyn = pytest.importorskip("exudyn")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = _exudyn(exudyn)
    rates = 0.8 * RATE_LIMITS * [1.0, 1.0, -1.0, 0.5, 1.0, -1.0]
    ours = end_of(ShuttleArm(POSE, None, LINEAR).simulate(pulse(rates, 300), 0.02, step=0.0005))
    assert np.linalg.norm(ours[:, -1] - ours[:, 0]) > 1.0
    assert np.abs(found[:300] - ours.T).max() < 2e-4


def _exudyn(exu):
    """End points every 20 ms, shape (time, axis)."""
    rates = 0.8 * RATE_LIMITS * [1.0, 1.0, -1.0, 0.5, 1.0, -1.0]
    kinds = {2: exu.JointType.RevoluteZ, 1: exu.JointType.RevoluteY, 0: exu.JointType.RevoluteX}
    links, joints = SHUTTLE_LINKS, LINEAR
    angle, rate = Servo().gains(joints.inertia)
    signs = links.axes.sum(axis=1)
    from exudyn.utilities import (
        CoordinateSpringDamper,
        LoadCoordinate,
        MarkerNodeCoordinate,
        NodeGenericODE2,
        ObjectGenericODE2,
        ObjectKinematicTree,
        SensorKinematicTree,
    )

    mbs = exu.SystemContainer().AddSystem()
    start = {"initialCoordinates": [0.0] * 6, "initialCoordinates_t": [0.0] * 6, "numberOfODE2Coordinates": 6}
    tree = mbs.AddNode(NodeGenericODE2(referenceCoordinates=(signs * POSE).tolist(), **start))
    motors = mbs.AddNode(NodeGenericODE2(referenceCoordinates=(signs * POSE).tolist(), **start))
    body = mbs.AddObject(
        ObjectKinematicTree(
            nodeNumber=tree,
            jointTypes=[kinds[int(np.abs(axis).argmax())] for axis in links.axes],
            linkParents=list(range(-1, 5)),
            jointTransformations=exu.Matrix3DList([np.eye(3)] * 6),
            jointOffsets=exu.Vector3DList(list(links.offsets)),
            linkInertiasCOM=exu.Matrix3DList([np.diag(moments) for moments in links.moments]),
            linkCOMs=exu.Vector3DList(list(links.centres)),
            linkMasses=links.masses.tolist(),
            gravity=[0.0, 0.0, 0.0],
        )
    )
    mbs.AddObject(
        ObjectGenericODE2(
            nodeNumbers=[motors],
            massMatrix=np.diag(joints.inertia),
            dampingMatrix=np.diag(rate + joints.viscous),
            stiffnessMatrix=np.diag(angle),
        )
    )
    for k in range(6):
        link = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=tree, coordinate=k))
        motor = mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=motors, coordinate=k))
        spring = {"stiffness": joints.stiffness[k], "damping": joints.relaxation * joints.stiffness[k]}
        mbs.AddObject(CoordinateSpringDamper(markerNumbers=[motor, link], **spring))
        wanted = (signs[k] * rates[k], rate[k], angle[k])

        def pull(_, time, __, wanted=wanted):
            return wanted[0] * (wanted[1] * (time < 4.0) + wanted[2] * min(time, 4.0))

        mbs.AddLoad(LoadCoordinate(markerNumber=motor, load=1.0, loadUserFunction=pull))
    sensor = mbs.AddSensor(
        SensorKinematicTree(
            objectNumber=body,
            linkNumber=5,
            localPosition=links.end.tolist(),
            storeInternal=True,
            outputVariableType=exu.OutputVariableType.Position,
        )
    )
    mbs.Assemble()
    settings = exu.SimulationSettings()
    settings.timeIntegration.numberOfSteps, settings.timeIntegration.endTime = 12000, 6.0
    settings.timeIntegration.newton.relativeTolerance = settings.timeIntegration.newton.absoluteTolerance = 1e-6
    settings.timeIntegration.verboseMode = 0
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = 0.02
    mbs.SolveDynamic(settings)
    return mbs.GetSensorStoredData(sensor)[:, 1:4]
