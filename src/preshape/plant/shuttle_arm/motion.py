"""The arm's equations followed in time, for any number of runs at once.

Leapfrog: angles at whole steps, rates between them. It keeps the energy of free motion, needs the forces once a step,
and what acts on a motor's own rate (servo, viscous friction) is taken implicitly. Dry friction is the impulse that
stops the motor, or as much of that as friction can give: a motor that sticks does not creep. The links' mass matrix and
centripetal torques vary with the pose, slowly, and are renewed every few steps for the middle of these.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from preshape.plant.shuttle_arm.inertia import pose_of
from preshape.plant.shuttle_arm.joints import JointHardware
from preshape.plant.shuttle_arm.reading import Reading

if TYPE_CHECKING:
    from preshape.plant.shuttle_arm.arm import ShuttleArm

__all__ = ["RENEWED", "Record", "follow"]

Matrix = NDArray[np.float64]

RENEWED = 0.04
"""The pose's mass matrix serves as long as this [s]: joints turn by less than 0.2 deg in it."""

FASTEST = 10.0
"""A joint that turns faster than this [rad/s] has run away: a hundred times the fastest it can be commanded."""

REPORTS = 50
"""How often progress is told."""


@dataclass(frozen=True, eq=False)
class Record:
    """The samples so far, first axis; shape (sample, run, joint), or (sample, run) for energies.

    Attributes
    ----------
    links, motors : ndarray
        Angles [rad].
    energy : mapping of str to ndarray
        [J]; empty unless asked for.
    failed : tuple of int, float, or None
        Which run ran away, and when [s].
    """

    links: Matrix
    motors: Matrix
    energy: dict[str, Matrix]
    failed: tuple[int, float] | None


@np.errstate(over="ignore", invalid="ignore")
def follow(
    arm: ShuttleArm,
    angles: Matrix,
    reading: Reading,
    samples: int,
    ratio: int,
    step: float,
    energy: bool,
    progress: Callable[[float], object] | None,
) -> Record:
    """From rest at `angles`, shape (run, joint) [rad], under what the joints read.

    Parameters
    ----------
    arm : ShuttleArm
        Whose links, joints and servo; its own pose is not used.
    angles : ndarray, shape (run, joint)
        [rad]
    reading : Reading
        What the joints go by at every step.
    samples, ratio : int
        Of the result, and steps between them.
    step : float
        [s]
    energy : bool
        Whether to account for the energy.
    progress : function or None
        Called with the part done, 0 to 1.
    """
    joints = arm.joints
    servo = arm.servo
    angle_gain, rate_gain = (np.zeros(6), np.zeros(6)) if servo is None else servo.gains(joints.inertia)
    windup = joints.torque_limit / angle_gain if servo is not None and joints.has("saturation") else None
    damper = joints.relaxation * joints.stiffness
    q, motor = angles.copy(), angles.copy()
    wanted = angles.copy()
    v, w, acceleration = np.zeros_like(q), np.zeros_like(q), np.zeros_like(q)
    before = np.zeros_like(q)
    renewal = max(1, round(RENEWED / step))
    recorded_links = np.empty((samples, *q.shape))
    recorded_motors = np.empty_like(recorded_links)
    account = _Account(arm, samples, len(angles)) if energy else None
    total = (samples - 1) * ratio

    def record(kept: int, failed: tuple[int, float] | None) -> Record:
        energies = {} if account is None else {name: values[:kept] for name, values in account.energies.items()}
        return Record(recorded_links[:kept], recorded_motors[:kept], energies, failed)

    told = max(1, total // REPORTS)
    inverse: Matrix = np.zeros(0)
    centripetal: Matrix = np.zeros(0)
    for n in range(total + 1):
        if n % renewal == 0:
            run = _runaway(v, w)
            if run is not None:
                # Up to the last time that all was well.
                return record(max(n - renewal, 0) // ratio + 1, (run, n * step))
            pose = pose_of(arm.links, q + 0.5 * renewal * step * v)
            inverse, centripetal = np.asarray(np.linalg.inv(pose.mass_matrix()), dtype=float), pose.centripetal(v)
            if progress is not None and n // told != (n - renewal) // told:
                progress(n / max(total, 1))
        # At time 0 rates are known at the same moment as angles: half a kick leads to the middle of the step.
        kick = 0.5 * step if n == 0 else step
        command = reading(n)
        # A kick goes from the middle of a step to that of the next, and a command changes between the two: what is read
        # now acts in the second half only. Else all that is commanded later than at 0 would act half a step early.
        acting = command if n == 0 else 0.5 * (before + command)
        before = command
        twist = motor - q
        stretch = joints.stretch(twist)
        elastic = joints.torque(stretch)
        damping = damper * (w - v)
        if joints.has("freeplay"):
            damping = damping * (stretch != 0.0)
        gear = elastic + damping
        acceleration = (inverse @ (gear - centripetal)[:, :, np.newaxis])[:, :, 0]
        v_next = v + kick * acceleration
        if servo is None:
            pull, hold = acting, np.zeros(6)
        else:
            pull, hold = rate_gain * acting + angle_gain * (wanted - motor), rate_gain
        w_next, torque, friction = _turned(joints, w, pull, hold, gear, kick)
        if n % ratio == 0:
            recorded_links[n // ratio], recorded_motors[n // ratio] = q, motor
        if account is not None:
            account.kick(n, ratio, kick, (v, v_next), (w, w_next), (damping, torque, friction), (q, stretch))
        v, w = v_next, w_next
        q = q + step * v
        motor = motor + step * w
        if servo is not None:
            wanted = wanted + step * command
            if windup is not None:
                wanted = motor + np.clip(wanted - motor, -windup, windup)
    run = _runaway(v, w)
    return record(
        samples if run is None else (total - total % renewal) // ratio + 1, None if run is None else (run, total * step)
    )


def _runaway(v: Matrix, w: Matrix) -> int | None:
    """The first run with a joint that turns too fast, or not by a number."""
    slow = (np.abs(v) < FASTEST).all(axis=1) & (np.abs(w) < FASTEST).all(axis=1)
    return None if slow.all() else int(np.argmin(slow))


def _turned(
    joints: JointHardware, rates: Matrix, pull: Matrix, hold: Matrix, gear: Matrix, kick: float
) -> tuple[Matrix, Matrix, Matrix]:
    """The motors' rates after a kick, the torque of each, and what dry friction took of it, shape (run, joint).

    The torque is `pull` less `hold` times the mean rate of the kick, as far as the motor can.
    """
    after, friction = _rubbed(joints, rates, pull, hold + joints.viscous, gear, kick)
    torque = pull - 0.5 * hold * (rates + after)
    if not joints.has("saturation"):
        return after, torque, friction
    most = np.clip(torque, -joints.torque_limit, joints.torque_limit)
    limited = most != torque
    if limited.any():
        after_most, friction_most = _rubbed(joints, rates, most, joints.viscous, gear, kick)
        after, friction = np.where(limited, after_most, after), np.where(limited, friction_most, friction)
    return after, most, friction


def _rubbed(
    joints: JointHardware, rates: Matrix, pull: Matrix, viscous: Matrix, gear: Matrix, kick: float
) -> tuple[Matrix, Matrix]:
    """The same for a given pull against viscous and dry friction."""
    inertia = joints.inertia + 0.5 * kick * viscous
    after = (joints.inertia * rates + kick * (pull - gear - 0.5 * viscous * rates)) / inertia
    if not joints.has("friction"):
        return after, np.zeros_like(after)
    most = kick * np.where(rates == 0.0, joints.sticking, joints.coulomb) / inertia
    left = after - np.clip(after, -most, most)
    return left, (after - left) * inertia / kick


class _Account:
    """Where the energy is, and where it came from and went, sums over the joints."""

    def __init__(self, arm: ShuttleArm, samples: int, runs: int) -> None:
        self._arm = arm
        self.energies = {name: np.zeros((samples, runs)) for name in ("kinetic", "strain", "work", "dissipated")}
        self._work, self._lost = np.zeros(runs), np.zeros(runs)

    def kick(
        self,
        n: int,
        ratio: int,
        kick: float,
        links: tuple[Matrix, Matrix],
        motors: tuple[Matrix, Matrix],
        torques: tuple[Matrix, Matrix, Matrix],
        place: tuple[Matrix, Matrix],
    ) -> None:
        """Rates before and after a kick; torques of gear damping, motor and friction; angles and the gears' stretch."""
        joints = self._arm.joints
        (v, v_next), (w, w_next), (damping, torque, friction) = links, motors, torques
        turning, motor = 0.5 * (w + w_next - v - v_next), 0.5 * (w + w_next)
        work = kick * np.sum(torque * motor, axis=1)
        lost = kick * np.sum(damping * turning + friction * motor + joints.viscous * motor**2, axis=1)
        if n % ratio == 0:
            # The kick at a step reaches as far before it as after it; the first begins there.
            part = 0.0 if n == 0 else 0.5
            energies, row, (q, stretch) = self.energies, n // ratio, place
            mass = pose_of(self._arm.links, q).mass_matrix()
            moving = np.einsum("ri,rij,rj->r", v, mass, v_next) + np.sum(joints.inertia * w * w_next, axis=1)
            energies["kinetic"][row] = 0.5 * moving
            energies["strain"][row] = np.sum(joints.energy(stretch), axis=1)
            energies["work"][row] = self._work + part * work
            energies["dissipated"][row] = self._lost + part * lost
        self._work += work
        self._lost += lost
