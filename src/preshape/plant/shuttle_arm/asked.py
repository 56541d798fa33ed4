"""What the arm asks of poses and steps, and the sentences it answers with."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.errors import InputError

__all__ = ["LARGEST_STEP", "six_angles", "steps_of", "unstable"]

Matrix = NDArray[np.float64]

LARGEST_STEP = 2.5e-3
"""The simulation's step unless given [s]: halving it changes the unloaded arm's residual by less than 1 %."""

FITS = 1e-9
"""A sample interval is a whole number of steps to this relative accuracy."""


def six_angles(pose: ArrayLike) -> Matrix:
    """Six finite angles [rad]."""
    try:
        angles = np.array(pose, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"the pose is {pose!r}: give six angles in radians.") from None
    if angles.shape != (6,) or not np.isfinite(angles).all():
        raise InputError(f"the pose is {angles.tolist()}: give six finite angles in radians, shoulder yaw first.")
    return angles


def steps_of(dt: float, step: float | None) -> tuple[int, float]:
    """How many steps a sample takes, and the step [s]."""
    if step is None:
        ratio = math.ceil(dt / LARGEST_STEP * (1.0 - FITS))
        return ratio, dt / ratio
    fine = positive("step", step, "s")
    ratio = round(dt / fine)
    if ratio < 1 or abs(ratio * fine - dt) > FITS * dt:
        raise InputError(
            f"the command's sample time {dt:g} s is {dt / fine:.6g} simulation steps of {fine:g} s: "
            "give a step that it is a whole number of, or none."
        )
    return ratio, dt / ratio


def unstable(growth: float) -> str:
    """What is said of a servo with which motion grows, at this rate [1/s]."""
    return f"with this servo the arm is unstable, motion grows by e every {1.0 / growth:.3g} s"
