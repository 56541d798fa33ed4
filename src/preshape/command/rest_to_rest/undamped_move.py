"""A move of a body with one undamped mode, as the closed forms see it: numbers in the units of their formulas."""

from __future__ import annotations

import math
from dataclasses import dataclass

from preshape.checks import nonzero, positive
from preshape.errors import InputError
from preshape.plant import FlexibleBody, FloatingOscillator

__all__ = ["UndampedMove", "body_of", "undamped_move"]


@dataclass(frozen=True)
class UndampedMove:
    """A move of a body with one undamped mode.

    Parameters
    ----------
    body : FlexibleBody
        What moves.
    distance : float
        [m], with its sign.
    maximum_force : float
        [N].
    omega : float
        Natural frequency w [rad/s].
    acceleration : float
        Of the whole under the maximum force [m/s^2].
    static : float
        Size of the deflection under it, at rest [m].
    """

    body: FlexibleBody
    distance: float
    maximum_force: float
    omega: float
    acceleration: float
    static: float

    @property
    def period(self) -> float:
        """[s]"""
        return 2.0 * math.pi / self.omega

    @property
    def size(self) -> float:
        """How far it is, without the direction [m]."""
        return abs(self.distance)


def body_of(plant: FlexibleBody | FloatingOscillator) -> FlexibleBody:
    """The rigid body with its modes; InputError if it is none."""
    if isinstance(plant, FloatingOscillator):
        return plant.flexible_body
    if not isinstance(plant, FlexibleBody):
        raise InputError(
            f"the plant is {plant!r}: a rest-to-rest command needs a body that is free to move, "
            "plant.FloatingOscillator(first_mass, second_mass, stiffness) or plant.FlexibleBody(mass, modes, gains)."
        )
    return plant


def undamped_move(
    plant: FlexibleBody | FloatingOscillator, distance: float, maximum_force: float, command: str
) -> UndampedMove:
    """Check what the closed form named `command` is given; InputError where a value is out of range."""
    body = body_of(plant)
    distance, force = nonzero("distance", distance, "m"), positive("maximum_force", maximum_force, "N")
    if len(body.modes) > 1:
        raise InputError(
            f"the closed form of the {command} command is for one mode and this plant has {len(body.modes)}; "
            "time_optimal takes any number."
        )
    mode = body.modes[0]
    if mode.damping > 0.0:
        raise InputError(
            f"the closed form of the {command} command is for an undamped mode and this one has a damping ratio of "
            f"{mode.damping:g}: design it for plant.retuned(damping_ratio=0) and look at what is left, or use "
            "time_optimal, which takes any damping."
        )
    return UndampedMove(
        body=body,
        distance=distance,
        maximum_force=force,
        omega=mode.omega,
        acceleration=force / body.mass,
        static=abs(float(body.static_deflections(force)[0])),
    )
