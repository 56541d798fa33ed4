"""What the MACE test article weighs, how stiff it is, how it is controlled, and what its gimbal can do.

Hyde employed a model of others (Padilla's, in DISCOS) and prints its frequencies, not its parameters. Those that he
prints or quotes are constants here; the rest is calibrated (:mod:`preshape.plant.mace.calibration`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from preshape.checks import not_negative, positive
from preshape.errors import InputError

__all__ = [
    "ATTITUDE_UNIT",
    "CALIBRATED",
    "CALIBRATED_GAINS",
    "LENGTH",
    "PAYLOAD",
    "NODE_INERTIA",
    "POUND",
    "SENSOR",
    "GimbalLimits",
    "MaceGains",
    "MaceStructure",
]

POUND = 0.45359237
"""[kg]."""

OUNCE_INCH = 7.0615518e-3
"""[N m]."""

LENGTH = 1.5
"""Of the bus [m] (Hyde 4.3)."""

ATTITUDE_UNIT = 15.6 * POUND
"""[kg] (Hyde A.2)."""

PAYLOAD = 5.0 * POUND
"""[kg] (Hyde A.3.2)."""

SENSOR = 0.1875
"""How far inside the ends of the bus its sensors are [m]: "not placed at the endpoints or midpoint" (figure 5.7)."""

NODE_INERTIA = 2e-4
"""Of an aluminium node about its centre [kg m^2]: half a kilogram, 5 cm across. No frequency depends on it visibly."""


@dataclass(frozen=True, slots=True)
class MaceStructure:
    """A bus of four struts between five nodes; an attitude unit in the middle, a gimbal and a payload on either end.

    Seen from the side: the bus along x, gimbals and payloads above it, the attitude unit below. All in SI units.

    Parameters
    ----------
    bus_density : float
        Struts, connectors and wiring [kg/m].
    bending_stiffness, axial_stiffness : float
        Of a strut, E I [N m^2] and E A [N].
    node_mass : float
        One of the five nodes [kg].
    gyro_mass : float
        The rate gyroscopes on the middle node, opposite of the attitude unit [kg].
    attitude_offset : float
        How far the attitude unit's centre of mass hangs below the bus [m].
    attitude_inertia : float
        Of unit and gyroscopes about their centre of mass [kg m^2].
    gimbal_mass, gimbal_offset, gimbal_inertia : float
        The part of a gimbal that does not turn: [kg], its centre of mass above the bus [m], about it [kg m^2].
    stage_mass : float
        The part of a gimbal that turns with its payload [kg].
    axis_height : float
        The gimbal's axis above the bus [m].
    arm, payload_inertia : float
        What turns, payload and stage: its centre of mass from the axis [m], its inertia about it [kg m^2].

    Raises
    ------
    InputError
        If a value is not finite or not above zero (offsets and extra masses may be zero).
    """

    bus_density: float
    bending_stiffness: float
    axial_stiffness: float
    node_mass: float
    gyro_mass: float
    attitude_offset: float
    attitude_inertia: float
    gimbal_mass: float
    gimbal_offset: float
    gimbal_inertia: float
    stage_mass: float
    axis_height: float
    arm: float
    payload_inertia: float

    def __post_init__(self) -> None:
        may_vanish = {"gyro_mass", "attitude_offset", "gimbal_offset", "stage_mass", "axis_height", "arm"}
        for field in fields(self):
            check = not_negative if field.name in may_vanish else positive
            object.__setattr__(self, field.name, check(field.name, getattr(self, field.name), "(SI)"))

    @property
    def turning_mass(self) -> float:
        """What turns on the gimbal's axis: the payload and the stage that carries it [kg]."""
        return PAYLOAD + self.stage_mass

    @property
    def middle_mass(self) -> float:
        """The attitude unit with the gyroscopes [kg]."""
        return ATTITUDE_UNIT + self.gyro_mass

    @property
    def total_mass(self) -> float:
        """Of the whole article [kg]; Hyde: about 60 lb."""
        ends = 2.0 * (self.gimbal_mass + self.turning_mass)
        return self.middle_mass + ends + 5.0 * self.node_mass + LENGTH * self.bus_density


@dataclass(frozen=True, slots=True)
class MaceGains:
    """Proportional and derivative gains; both loops act on inertial angles, as rate gyroscopes report them.

    The attitude unit answers the bus's angle in the middle with a torque on the bus there; the gimbal's motor answers
    the payload's own angle, and pushes itself off the bus's end.

    Parameters
    ----------
    attitude_stiffness, attitude_damping : float
        [N m/rad], [N m s/rad].
    gimbal_stiffness, gimbal_damping : float
        [N m/rad], [N m s/rad].

    Raises
    ------
    InputError
        If a gain is not finite. Any sign is allowed: what an unstable loop does can be simulated.
    """

    attitude_stiffness: float
    attitude_damping: float
    gimbal_stiffness: float
    gimbal_damping: float

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
                raise InputError(f"{field.name} is {value!r}: give a finite gain in N m/rad or N m s/rad.")
            object.__setattr__(self, field.name, float(value))


@dataclass(frozen=True, slots=True)
class GimbalLimits:
    """What the gimbal's motor can do; Hyde's model leaves it out (5.3.2), his appendix names it (A.3.2).

    A commanded angle is followed with no more than this speed and acceleration, and the motor's torque is cut.

    Parameters
    ----------
    speed : float
        [rad/s].
    acceleration : float
        [rad/s^2].
    torque : float
        [N m]: 40 oz-in in normal operation; 560 oz-in is the stall torque.

    Raises
    ------
    InputError
        If a limit is not above zero.
    """

    speed: float = math.radians(50.0)
    acceleration: float = math.radians(125.0)
    torque: float = 40.0 * OUNCE_INCH

    def __post_init__(self) -> None:
        object.__setattr__(self, "speed", positive("speed", self.speed, "rad/s"))
        object.__setattr__(self, "acceleration", positive("acceleration", self.acceleration, "rad/s^2"))
        object.__setattr__(self, "torque", positive("torque", self.torque, "N m"))


CALIBRATED = MaceStructure(
    bus_density=0.57496,
    bending_stiffness=65.519,
    axial_stiffness=1.3713e6,
    node_mass=0.20874,
    gyro_mass=1.3518,
    attitude_offset=0.19343,
    attitude_inertia=0.13491,
    gimbal_mass=3.4019,
    gimbal_offset=0.034649,
    gimbal_inertia=0.014914,
    stage_mass=2.7215,
    axis_height=0.083911,
    arm=0.23812,
    payload_inertia=0.004,
)
"""What :func:`preshape.plant.mace.calibrate` finds, rounded; `calibration_table` shows how it fits. At a bound of what
is plausible: the gimbal's weight (13.5 lb), its turning part (6 lb), the gyroscopes (3 lb), the payload's inertia."""

CALIBRATED_GAINS = MaceGains(
    attitude_stiffness=7.673, attitude_damping=99.49, gimbal_stiffness=0.20767, gimbal_damping=0.2586
)
"""Found together with :data:`CALIBRATED`. The attitude unit's stiffness hardly shows in any frequency."""
