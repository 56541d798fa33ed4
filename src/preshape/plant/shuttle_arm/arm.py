"""ShuttleArm: the six-joint arm as a plant, with modes in any pose and simulation of commands, one or hundreds."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.plant.diverged import Diverged
from preshape.plant.sampled_command import command_rows, steps_of
from preshape.plant.shuttle_arm.asked import LARGEST_STEP, six_angles, unstable
from preshape.plant.shuttle_arm.calibration import CALIBRATED_JOINTS
from preshape.plant.shuttle_arm.geometry import JOINTS, SHUTTLE_LINKS, Links, Payload
from preshape.plant.shuttle_arm.inertia import end_points
from preshape.plant.shuttle_arm.joints import JointHardware, Servo
from preshape.plant.shuttle_arm.linear import end_point_steps, oscillations, state_matrix
from preshape.plant.shuttle_arm.motion import Record, follow
from preshape.plant.shuttle_arm.reading import Reading
from preshape.plant.simulation import Simulation

__all__ = ["ShuttleArm"]

Matrix = NDArray[np.float64]

STABLE = 1.8
"""Leapfrog follows what vibrates with w while w times the step is below 2; this leaves room for gears that stiffen."""

UNSTABLE = 1e-3
"""A pole that grows faster than this [1/s] makes the loop unstable; rounding of rigid motions stays below."""


@dataclass(frozen=True)
class ShuttleArm:
    """The Shuttle's Remote Manipulator System in orbit: six links on elastic joints, the Orbiter at rest.

    With a servo the inputs are the joints' rates, as the operator commands them; without one, the motors' torques.

    Parameters
    ----------
    pose : array_like, shape (joint,)
        Where it starts [rad]: shoulder yaw and pitch, elbow, wrist pitch, yaw, roll.
    payload : Payload, optional
        What it holds.
    joints : JointHardware
        Gears, motors, and which imperfections are on.
    servo : Servo, optional
        None for free motors.
    empty : Links
        Geometry and masses, without payload.

    Raises
    ------
    InputError
        If a value is out of its range.

    Examples
    --------
    The frequencies that Hyde gives for a 7,000 lb satellite, in the pose they were fitted in:

    >>> from preshape.plant.shuttle_arm import CALIBRATION_POSE
    >>> [round(mode.frequency, 3) for mode in ShuttleArm(CALIBRATION_POSE, Payload()).modes()][:4]
    [0.2, 0.26, 0.45, 0.59]

    References
    ----------
    Singer & Seering, section 2.6. Hyde, section 3.2.3. Geometry: see :mod:`preshape.plant.shuttle_arm.geometry`.
    """

    pose: tuple[float, ...] = (0.0,) * 6
    payload: Payload | None = None
    joints: JointHardware = field(default=CALIBRATED_JOINTS)
    servo: Servo | None = Servo()
    empty: Links = field(default=SHUTTLE_LINKS, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "pose", tuple(six_angles(self.pose).tolist()))

    @property
    def links(self) -> Links:
        """With the payload on the last."""
        return self.empty if self.payload is None else self.empty.carrying(self.payload)

    @property
    def inputs(self) -> Mapping[str, str]:
        """Unit of each input, by name."""
        kind, unit = ("rate", "rad/s") if self.servo is not None else ("torque", "N m")
        return {f"{joint} {kind}": unit for joint in JOINTS}

    @property
    def outputs(self) -> Mapping[str, str]:
        """Unit of each output, by name."""
        ends = {f"end point {axis}": "m" for axis in "xyz"}
        return {
            **ends,
            **{f"{joint} angle": "rad" for joint in JOINTS},
            **{f"{joint} motor": "rad" for joint in JOINTS},
        }

    def modes(self, configuration: ArrayLike | None = None) -> Modes:
        """What vibrates in a pose: small motion with gears in touch, motors held by their servos.

        Parameters
        ----------
        configuration : array_like, shape (joint,), optional
            The pose [rad]; where the arm starts unless given.

        Returns
        -------
        Modes
            Rising; what is damped by more than 20 % is left out.

        Raises
        ------
        InputError
            If the servo is unstable.
        """
        angles = np.array(self.pose) if configuration is None else six_angles(configuration)
        matrix = state_matrix(self.links, self.joints, self.servo, angles)
        growth = float(np.linalg.eigvals(matrix).real.max())
        if self.servo is not None and growth > UNSTABLE:
            raise InputError(f"{unstable(growth)}: it has no modes. Give a servo with damping above 0.")
        frequencies, dampings = oscillations(matrix)
        return Modes(list(zip(frequencies.tolist(), dampings.tolist(), strict=True)))

    def end_point_steps(self, rates: ArrayLike, configuration: ArrayLike | None = None) -> Matrix:
        """How far the end point swings in each of the modes when the commanded rates step.

        Parameters
        ----------
        rates : array_like, shape (joint,)
            The step [rad/s].
        configuration : array_like, shape (joint,), optional
            The pose [rad]; where the arm starts unless given.

        Returns
        -------
        ndarray, shape (mode,)
            Amplitudes of the linearised arm [m], in the order of :meth:`modes`.

        Raises
        ------
        InputError
            If there is no servo to follow rates.

        Examples
        --------
        Shoulder yaw excites what swings sideways, the second mode of the stretched arm, and nothing else:

        >>> ShuttleArm().end_point_steps([0.01, 0, 0, 0, 0, 0])[:3].round(4).tolist()
        [0.0, 0.0235, 0.0]
        """
        if self.servo is None:
            raise InputError("without a servo the joints follow no rates: give the arm a servo.")
        angles = np.array(self.pose) if configuration is None else six_angles(configuration)
        return end_point_steps(self.links, self.joints, self.servo, angles, six_angles(rates))

    def end_point(self, configuration: ArrayLike | None = None) -> Matrix:
        """Of the arm in a pose [rad], from the shoulder's yaw joint, shape (3,) [m].

        Examples
        --------
        >>> ShuttleArm().end_point().round(2).tolist()
        [15.32, 0.0, 0.3]
        """
        angles = np.array(self.pose) if configuration is None else six_angles(configuration)
        return np.asarray(end_points(self.links, angles[np.newaxis])[0])

    def simulate(
        self,
        command: ArrayLike,
        dt: float,
        *,
        step: float | None = None,
        energy: bool = False,
        seed: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> Simulation:
        """What the arm does under a held, sampled command, from rest in its pose.

        Parameters
        ----------
        command : array_like, shape (joint, sample)
            Rates [rad/s], or torques [N m] without a servo.
        dt : float
            Sample interval [s].
        step : float, optional
            The simulation's [s], of which `dt` must be a whole number; the longest up to 2.5 ms unless given.
        energy : bool
            Whether to account for the energy.
        seed : int
            Of the moments at which digital joints read.
        progress : function, optional
            Called with the part done, 0 to 1.

        Raises
        ------
        InputError
            If the command is not finite numbers, or `dt` and `step` do not fit.
        Diverged
            If a joint runs away; what was computed is in `partial`.

        Examples
        --------
        Shoulder yaw at 0.01 rad/s for five seconds, on linear joints:

        >>> import numpy as np
        >>> from preshape.plant.shuttle_arm import CALIBRATED_JOINTS
        >>> command = np.zeros((6, 1500))
        >>> command[0, :250] = 0.01
        >>> done = ShuttleArm(joints=CALIBRATED_JOINTS.only()).simulate(command, 0.02)
        >>> round(float(done.outputs["shoulder yaw angle"][-1]), 3)
        0.05
        """
        rows = command_rows(command, self.inputs)
        return self.simulate_all([self.pose], [rows], dt, step=step, energy=energy, seed=seed, progress=progress)[0]

    def simulate_all(
        self,
        poses: ArrayLike,
        commands: Sequence[ArrayLike],
        dt: float,
        *,
        step: float | None = None,
        energy: bool = False,
        seed: int = 0,
        progress: Callable[[float], object] | None = None,
    ) -> list[Simulation]:
        """The same for many starting poses and commands at once; a hundred take hardly longer than ten.

        Parameters
        ----------
        poses : array_like, shape (run, joint)
            [rad]
        commands : sequence of array_like, each of shape (joint, sample)
            One for each pose, all of one length.
        dt, step, energy, seed, progress
            As of :meth:`simulate`.

        Raises
        ------
        InputError
            If poses and commands are not as many, or as of :meth:`simulate`.
        Diverged
            If a joint runs away in one of the runs; `partial` is that run's.
        """
        starts = np.array([six_angles(pose) for pose in np.asarray(poses, dtype=float)]).reshape(-1, 6)
        rows = [command_rows(command, self.inputs) for command in commands]
        if len(rows) != len(starts) or not rows or len({row.shape for row in rows}) != 1:
            raise InputError(
                f"there are {len(starts)} pose(s) and {len(rows)} command(s): give as many of each, at least one, and "
                "commands of one length."
            )
        dt = positive("dt", dt, "s")
        ratio, fine = steps_of(dt, step, LARGEST_STEP)
        self._check_step(starts, fine)
        joints = None if self.servo is None else self.joints
        reading = Reading(np.array(rows), ratio, fine, joints, seed)
        record = follow(self, starts, reading, rows[0].shape[1], ratio, fine, energy, progress)
        if progress is not None:
            progress(1.0)
        if record.failed is not None:
            run, time = record.failed
            raise Diverged(self._reason(starts[run], fine), time, self._simulation(record, run, rows[run], dt))
        return [self._simulation(record, run, row, dt) for run, row in enumerate(rows)]

    def _simulation(self, record: Record, run: int, rows: Matrix, dt: float) -> Simulation:
        links, motors = record.links[:, run], record.motors[:, run]
        ends = end_points(self.links, links)
        outputs = dict(zip(self.outputs, np.hstack([ends, links, motors]).T, strict=True))
        energy = {name: values[:, run] for name, values in record.energy.items()} or None
        done = len(links)
        return Simulation(dt * np.arange(done, dtype=float), rows[:, :done], outputs, self.outputs, energy)

    def _check_step(self, poses: Matrix, step: float) -> None:
        # The fastest is the wrist on its gears, in any pose much alike, so that a few will do; or a motor on its servo.
        some = poses[:: max(1, len(poses) // 8)]
        matrices = np.array([state_matrix(self.links, self.joints, None, pose) for pose in some])
        fastest = float(np.abs(np.linalg.eigvals(matrices).imag).max())
        if self.servo is not None:
            held = self.servo.gains(self.joints.inertia)[0] + self.joints.stiffness
            fastest = max(fastest, float(np.sqrt(held / self.joints.inertia).max()))
        if fastest * step > STABLE:
            raise InputError(
                f"the simulation's step {step:g} s is too long for joints that vibrate at "
                f"{fastest / (2.0 * math.pi):.3g} Hz: give one below {STABLE / fastest:.2g} s."
            )

    def _reason(self, pose: Matrix, step: float) -> str:
        growth = float(np.linalg.eigvals(state_matrix(self.links, self.joints, self.servo, pose)).real.max())
        if self.servo is not None and growth > UNSTABLE:
            return f"{unstable(growth)}: give a servo with damping above 0."
        return f"a joint turns faster than 10 rad/s. Give a smaller command, or a shorter step than {step:g} s."
