"""The torques on MACE, step by step: the command held, the gimbal's loop, its limits, and when to stop."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from preshape.plant.mace.limits import LimitedFollower
from preshape.plant.mace.structure import LENGTH

if TYPE_CHECKING:
    from preshape.plant.mace.mace import Mace

__all__ = ["Control"]

BENT = 0.1 * LENGTH
"""An end of the bus that is this far from its middle's height [m] has left what struts can do."""

FASTEST = 100.0
"""A payload that turns faster than this [rad/s] is out of control: 16 turns a second."""

REPORTS = 50
"""How often a simulation tells its progress."""

Matrix = NDArray[np.float64]


class Control:
    """Gives the torques at the end of every step, and remembers them.

    The trapezoidal rule runs straight from one step's torque to the next, so where a held command jumps it is given
    half way: the impulse is then that of the held command. The gimbal's loop acts on angle and rate predicted to the
    end of the step from the present acceleration, which is of the order of the rule itself.
    """

    def __init__(
        self, plant: Mace, rows: Matrix, ratio: int, step: float, progress: Callable[[float], object] | None
    ) -> None:
        self._plant, self._ratio, self._step, self._progress = plant, ratio, step, progress
        self._rows = rows
        self._steps = (rows.shape[1] - 1) * ratio
        self._follower = None if plant.limits is None else LimitedFollower(plant.limits, plant.angle, step)
        self._ends = (1, 4 * 4 * plant.elements + 1, 4 * 2 * plant.elements + 1)
        self._gimbal: list[float] = []
        self._attitude: list[float] = []
        self._angles = self._commanded_angles()
        self.reason = ""

    def __call__(self, k: int, q: Matrix, v: Matrix, a: Matrix) -> tuple[float, float] | None:
        """Torques at step k + 1 (see :meth:`MaceBody.run`), or None when the motion has run away."""
        if k >= 0 and self._runs_away(q, v):
            return None
        if self._progress is not None and k > 0 and k % max(self._steps // REPORTS, 1) == 0:
            self._progress(k / self._steps)
        gimbal, attitude = self._held(-2, k), self._held(-1, k)
        plant, h = self._plant, self._step
        if plant.gains is not None:
            ahead = 0.0 if k < 0 else h
            angle = plant.angle + q[-1] + ahead * v[-1] + 0.5 * ahead**2 * a[-1]
            rate = v[-1] + ahead * a[-1]
            wanted = self._angles[k + 1]
            gimbal += plant.gains.gimbal_stiffness * (wanted - angle) - plant.gains.gimbal_damping * rate
        if plant.limits is not None:
            gimbal = min(max(gimbal, -plant.limits.torque), plant.limits.torque)
        self._gimbal.append(float(gimbal))
        self._attitude.append(float(attitude))
        return self._gimbal[-1], self._attitude[-1]

    def applied(self, positions: Matrix, velocities: Matrix) -> tuple[Matrix, Matrix]:
        """Torques of gimbal and attitude unit at the recorded times, control included [N m], shape (time,)."""
        count = len(positions)
        gimbal, attitude = np.array(self._gimbal[:count]), np.array(self._attitude[:count])
        gains = self._plant.gains
        if gains is not None:
            bus = 4 * (4 * self._plant.elements + 1) + 3 * 2 + 2
            attitude = attitude - gains.attitude_stiffness * positions[:, bus]
            attitude = attitude - gains.attitude_damping * velocities[:, bus]
        return gimbal, attitude

    def _held(self, row: int, k: int) -> float:
        """The command of a torque at step k + 1, half way where it jumps; all of it at time 0."""
        values, last = self._rows[row], self._rows.shape[1] - 1
        after = values[min((k + 1) // self._ratio, last)]
        before = after if k < 0 else values[min(k // self._ratio, last)]
        return float(0.5 * (before + after))

    def _commanded_angles(self) -> Matrix:
        """The angle to follow at every step [rad]."""
        if self._plant.gains is None:
            return np.zeros(0)
        held = np.repeat(self._rows[0], self._ratio)[: self._steps + 2]
        held = np.append(held, np.full(max(0, self._steps + 2 - len(held)), self._rows[0, -1]))
        if self._follower is not None:
            return np.array([self._plant.angle] + [self._follower.towards(float(c)) for c in held[:-1]])
        return np.concatenate([held[:1], 0.5 * (held[:-1] + held[1:])])

    def _runs_away(self, q: Matrix, v: Matrix) -> bool:
        left, right, middle = (float(q[i]) for i in self._ends)
        turned = self._plant.elements * 16 + 4 + 3 * 2 + 2
        lean = float(np.sin(q[turned]))
        bent = max(abs(left - middle + 0.5 * LENGTH * lean), abs(right - middle - 0.5 * LENGTH * lean))
        if not (np.isfinite(q).all() and np.isfinite(v).all()):
            self.reason = "the motion is not finite"
        elif bent > BENT:
            self.reason = f"an end of the bus is {100.0 * bent:.0f} cm off the line of its middle"
        elif abs(v[-1]) > FASTEST:
            self.reason = f"the payload turns at {abs(v[-1]):.0f} rad/s"
        return bool(self.reason)
