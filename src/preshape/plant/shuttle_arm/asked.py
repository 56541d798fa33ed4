"""What the arm asks of poses and servos, and the sentences it answers with."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError

__all__ = ["LARGEST_STEP", "six_angles", "unstable"]

Matrix = NDArray[np.float64]

LARGEST_STEP = 2.5e-3
"""The simulation's step unless given [s]: halving it changes the unloaded arm's residual by less than 1 %."""


def six_angles(pose: ArrayLike) -> Matrix:
    """Six finite angles [rad]."""
    try:
        angles = np.array(pose, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"the pose is {pose!r}: give six angles in radians.") from None
    if angles.shape != (6,) or not np.isfinite(angles).all():
        raise InputError(f"the pose is {angles.tolist()}: give six finite angles in radians, shoulder yaw first.")
    return angles


def unstable(growth: float) -> str:
    """What is said of a servo with which motion grows, at this rate [1/s]."""
    return f"with this servo the arm is unstable, motion grows by e every {1.0 / growth:.3g} s"
