"""What sits between a command and a link: servo, motor, gearbox; and which of its imperfections are on.

Torque limits (772, 528, 231 ft lb; the first is 15 lb at the end of 50 ft) and gear ratios (1842, 1260, 739 to 1) are
the Shuttle arm's as commonly quoted; we have no primary source. Rotor inertia, gaps, friction, resolution and the
servo's bandwidth are assumptions of ours: plausible, not measured; change them with dataclasses.replace. Stiffnesses
come from :mod:`preshape.plant.shuttle_arm.calibration`.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, fields, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import not_negative, positive
from preshape.errors import InputError

__all__ = ["IMPERFECTIONS", "JointHardware", "Servo"]

Matrix = NDArray[np.float64]

IMPERFECTIONS = ("stiffening", "freeplay", "friction", "saturation", "digital")
"""What can be switched on alone: gears that stiffen with their twist; their gap; Coulomb friction with stiction; the
motors' torque limit; commands read by each joint at its own moments, in steps."""

FOOT_POUND = 0.3048 * 0.45359237 * 9.80665

RATIOS = np.array([1842.0, 1842.0, 1260.0, 739.0, 739.0, 739.0])

ROTOR = 2.5e-4
"""Inertia of a motor [kg m^2], assumed."""

SIX = 6


def _row(name: str, values: ArrayLike, *, zero: bool) -> Matrix:
    """Six finite numbers, above zero or not below it."""
    try:
        row = np.broadcast_to(np.asarray(values, dtype=float), (SIX,)).copy()
    except (TypeError, ValueError):
        raise InputError(f"{name} is {values!r}: give a number, or one for each of the six joints.") from None
    if not (np.isfinite(row).all() and (row >= 0.0).all() and (zero or (row > 0.0).all())):
        raise InputError(f"{name} is {row.tolist()}: give finite numbers {'of 0 or more' if zero else 'above 0'}.")
    row.setflags(write=False)
    return row


@dataclass(frozen=True)
class Servo:
    """A motor's loop: rate, and the integral of rate, both against the command.

    Parameters
    ----------
    bandwidth : float
        Natural frequency of the loop with the motor alone [Hz].
    damping : float
        Ratio of that [-]; below 0 the loop is unstable.
    """

    bandwidth: float = 10.0
    damping: float = 0.7

    def __post_init__(self) -> None:
        object.__setattr__(self, "bandwidth", positive("bandwidth", self.bandwidth, "Hz"))
        if isinstance(self.damping, bool) or not np.isfinite(self.damping):
            raise InputError(f"the servo's damping is {self.damping!r}: give a finite ratio.")

    def gains(self, inertias: Matrix) -> tuple[Matrix, Matrix]:
        """Of the angle [N m/rad] and of the rate [N m s/rad], for motors of these inertias [kg m^2]."""
        omega = 2.0 * np.pi * self.bandwidth
        return omega**2 * inertias, 2.0 * self.damping * omega * inertias


@dataclass(frozen=True, eq=False)
class JointHardware:
    """Six motors and gearboxes, everything as seen from the output of the gear.

    Parameters
    ----------
    stiffness : array_like
        Of the gears, small twists beyond the gap [N m/rad]. This and all others: one number, or six.
    inertia : array_like, optional
        Of the motors [kg m^2].
    relaxation : float
        Damping of a gear over its stiffness [s], while its teeth touch.
    growth : float
        How much stiffer, relatively, a gear is at the twist stiffness takes for the torque limit [-].
    gap : array_like
        Half the freeplay [rad].
    coulomb, sticking, viscous : array_like
        Friction of the motors: moving [N m], breaking away [N m], proportional [N m s/rad]; the latter is always on.
    torque_limit : array_like
        [N m]
    rate_step : float
        Of a command as a joint reads it [rad/s].
    reading : float
        Between two readings of a joint [s].
    imperfections : collection of str
        Which of :data:`IMPERFECTIONS` are on.

    Examples
    --------
    >>> joints = JointHardware(1e6).only("freeplay")
    >>> sorted(joints.imperfections), sorted(joints.only().imperfections)
    (['freeplay'], [])
    """

    stiffness: Matrix
    inertia: Matrix = field(default_factory=lambda: ROTOR * RATIOS**2)
    relaxation: float = 0.001
    growth: float = 0.5
    gap: Matrix = field(default_factory=lambda: np.array([1e-4, 1e-4, 1e-4, 2e-4, 2e-4, 2e-4]))
    coulomb: Matrix = field(default_factory=lambda: 0.05 * FOOT_POUND * np.array([772, 772, 528, 231, 231, 231.0]))
    sticking: Matrix = field(default_factory=lambda: 0.065 * FOOT_POUND * np.array([772, 772, 528, 231, 231, 231.0]))
    viscous: Matrix = field(default_factory=lambda: 0.1 * ROTOR * RATIOS**2)
    torque_limit: Matrix = field(default_factory=lambda: FOOT_POUND * np.array([772, 772, 528, 231, 231, 231.0]))
    rate_step: float = np.radians(0.02)
    reading: float = 0.08
    imperfections: frozenset[str] = frozenset(IMPERFECTIONS)

    def __post_init__(self) -> None:
        for name in ("stiffness", "inertia", "torque_limit"):
            object.__setattr__(self, name, _row(name, getattr(self, name), zero=False))
        for name in ("gap", "coulomb", "sticking", "viscous"):
            object.__setattr__(self, name, _row(name, getattr(self, name), zero=True))
        if (self.sticking < self.coulomb).any():
            raise InputError("sticking friction is below that of motion: give as much, or more.")
        for name, unit in (("relaxation", "s"), ("growth", "relatively"), ("rate_step", "rad/s")):
            object.__setattr__(self, name, not_negative(name, getattr(self, name), unit))
        object.__setattr__(self, "reading", positive("reading", self.reading, "s"))
        object.__setattr__(self, "imperfections", _known(self.imperfections))

    def only(self, *imperfections: str) -> JointHardware:
        """The same joints with these imperfections alone; with none they are linear."""
        return replace(self, imperfections=frozenset(imperfections))

    def has(self, imperfection: str) -> bool:
        """Whether this one is on."""
        return imperfection in self.imperfections

    def stretch(self, twist: Matrix) -> Matrix:
        """What is left of a twist [rad] beyond the gap [rad], shape (..., joint)."""
        return twist - np.clip(twist, -self.gap, self.gap) if self.has("freeplay") else twist

    def torque(self, stretch: Matrix) -> Matrix:
        """Of the gears [N m], elastic part."""
        linear = self.stiffness * stretch
        return linear * (1.0 + self._hardening * stretch**2) if self.has("stiffening") else linear

    def energy(self, stretch: Matrix) -> Matrix:
        """Stored in the gears [J]."""
        squared = stretch**2
        linear = 0.5 * self.stiffness * squared
        return linear * (1.0 + 0.5 * self._hardening * squared) if self.has("stiffening") else linear

    @property
    def _hardening(self) -> Matrix:
        """h of k e (1 + h e^2), whose slope is k (1 + 3 h e^2) [1/rad^2]."""
        return self.growth / 3.0 * (self.stiffness / self.torque_limit) ** 2

    def __repr__(self) -> str:
        return f"<JointHardware: {', '.join(sorted(self.imperfections)) or 'linear'}>"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, JointHardware):
            return NotImplemented
        return all(np.array_equal(getattr(self, f.name), getattr(other, f.name)) for f in fields(self))

    def __hash__(self) -> int:
        return hash((self.stiffness.tobytes(), self.imperfections))


def _known(imperfections: Iterable[str]) -> frozenset[str]:
    given = frozenset(imperfections)
    for name in given:
        if name not in IMPERFECTIONS:
            raise InputError(f"there is no imperfection {name!r}: name some of {', '.join(IMPERFECTIONS)}, or none.")
    return given
