"""The system of Robertson's section III: a mass under PD control that follows a trapezoid, and its shapers."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from preshape import Mode, Shaper, design
from preshape.papers.robertson.moves import Vector
from preshape.plant import PositionedMass, deflection_sensitivity
from preshape.profile import Profile

__all__ = ["MASS", "RATIOS", "SPEED", "TRAPEZOID", "limit", "over_damping", "over_frequency", "shaper"]

MASS = PositionedMass(Mode(1.0, 0.1))

RATIOS = (0.4, 0.3)
"""Specified deflections [-]."""

RISE, DWELL, HEIGHT = 1.5, 2.0, 2.0
"""Of the trapezoid [s, s, m]."""

SPEED = HEIGHT / RISE

TRAPEZOID = Profile.steps([0.0, RISE, RISE + DWELL, 2.0 * RISE + DWELL], [SPEED, -SPEED, -SPEED, SPEED], order=1)
"""The position command: up 2 units in 1.5 s, 2 s there, back in 1.5 s."""


def shaper(ratio: float) -> Shaper:
    """SD-ZV for this deflection ratio."""
    return design.sd_zv(MASS.mode, ratio)


def limit(ratio: float) -> float:
    """The part `ratio` of the peak deflection that one ramp of the unshaped trapezoid causes [m]."""
    return ratio * MASS.ramp_deflection(SPEED)


def over_frequency(ratio: float, frequency_ratios: ArrayLike) -> Vector:
    """Peak deflection relative to the limit [-], over actual by modelled frequency."""
    found = deflection_sensitivity(
        MASS, TRAPEZOID, shaper(ratio), frequency_ratios=frequency_ratios, limit=limit(ratio)
    )
    return np.asarray(found.relative[0])


def over_damping(ratio: float, damping_ratios: ArrayLike) -> Vector:
    """Peak deflection relative to the limit [-], over the actual damping ratio."""
    found = deflection_sensitivity(MASS, TRAPEZOID, shaper(ratio), damping_ratios=damping_ratios, limit=limit(ratio))
    return np.asarray(found.relative[:, 0])
