"""What the joints read of a command: held from sample to sample, and, if they are digital, late and in steps.

The arm's computer sends rates to six joint processors that do not share a clock: each looks when its own time comes,
and keeps what it saw, rounded to its resolution, until the next time.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.plant.shuttle_arm.joints import JointHardware

__all__ = ["Reading"]

Matrix = NDArray[np.float64]

ON_TIME = 1e-9
"""A reading that falls on a sample to this part of it sees it."""


class Reading:
    """Commands of shape (run, joint, sample) as the joints know them at every step.

    Parameters
    ----------
    commands : ndarray, shape (run, joint, sample)
        Rates [rad/s].
    ratio : int
        Simulation steps of a sample.
    step : float
        Of the simulation [s].
    joints : JointHardware, optional
        None for commands that are not read by processors, such as torques.
    seed : int
        Of the moments at which the joints first look.

    Examples
    --------
    A joint that looks every 80 ms, first at 20.5 ms, at a command that is sent at 0:

    >>> read = Reading(np.ones((1, 6, 3)), 40, 0.002, JointHardware(1e6), seed=3)
    >>> [float(read(n)[0, 0].round(5)) for n in (0, 3, 4, 39)]
    [0.0, 0.0, 1.00007, 1.00007]
    """

    def __init__(
        self, commands: Matrix, ratio: int, step: float, joints: JointHardware | None = None, seed: int = 0
    ) -> None:
        digital = joints is not None and joints.has("digital")
        self._ratio, self._step, self._last = ratio, step, commands.shape[2] - 1
        self._phases: Matrix | None = None
        if digital:
            assert joints is not None
            self._every = joints.reading
            runs, six = commands.shape[:2]
            self._phases = self._every * np.random.default_rng(seed).random((runs, six))
            if joints.rate_step > 0.0:
                commands = joints.rate_step * np.round(commands / joints.rate_step)
            self._runs, self._joints = np.arange(runs)[:, np.newaxis], np.arange(six)
        self._commands = np.ascontiguousarray(np.moveaxis(commands, 2, 0))

    def __call__(self, n: int) -> Matrix:
        """What each joint of each run goes by at step n [rad/s], shape (run, joint)."""
        if self._phases is None:
            return np.asarray(self._commands[min(n // self._ratio, self._last)])
        looks = np.floor((n * self._step - self._phases) / self._every + ON_TIME)
        samples = np.floor((looks * self._every + self._phases) / (self._ratio * self._step) + ON_TIME)
        known = np.clip(samples, 0, self._last).astype(int)
        return np.where(looks < 0.0, 0.0, self._commands[known, self._runs, self._joints])
