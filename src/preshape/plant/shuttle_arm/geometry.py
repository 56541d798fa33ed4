"""The arm's links and its payload: where joints are, how they turn, what is how heavy.

Frames at zero angles are all alike: x along the stretched arm, z the shoulder's yaw axis, y to complete. Positive pitch
lifts, positive yaw turns to the left; the elbow folds with negative angles.

Positions are those of the arm's joints in the Orbiter's coordinates as simulators of the Shuttle reproduce them from
NASA's drawings (shoulder pitch at Xo 679.5 in, elbow 930.55, wrist pitch 1208.5, wrist yaw 1226.5, end effector 1282.5;
the shoulder's axes 12 in apart, the elbow's axis 6 in below): 6.38 m and 7.06 m between the pitch axes, 15.3 m from
shoulder to end point, NASA's 50 ft 3 in. The mass is NASA's 905 lb (410 kg). How it is shared among the links, their
centres and radii are our assumptions, with the booms as slender rods.

References
----------
NASA, "Remote Manipulator System", Shuttle reference manual (1988): 50 ft 3 in, 15 in, 905 lb, six joints.
P. K. Nguyen, P. C. Hughes, "Teleoperation: from the Space Shuttle to the Space Station", Progress in Astronautics and
Aeronautics 161 (1994), on the arm and its models.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.checks import not_negative, positive

__all__ = ["ANGLE_LIMITS", "JOINTS", "RATE_LIMITS", "SHUTTLE_LINKS", "Links", "Payload", "cylinder"]

Matrix = NDArray[np.float64]

JOINTS = ("shoulder yaw", "shoulder pitch", "elbow pitch", "wrist pitch", "wrist yaw", "wrist roll")
"""From the shoulder outwards."""

ANGLE_LIMITS = np.radians(
    [[-180.0, 180.0], [-2.0, 145.0], [-161.0, 2.0], [-121.0, 121.0], [-121.0, 121.0], [-447.0, 447.0]]
)
"""Of the joints [rad], shape (joint, 2), rounded."""

RATE_LIMITS = np.radians([2.29, 2.29, 3.21, 4.76, 4.76, 4.76])
"""Of the joints of the unloaded arm [rad/s]; as quoted in operators' literature, assumed here."""

INCH = 0.0254

ANGLES = np.array([[0, 0, 1], [0, -1, 0], [0, -1, 0], [0, -1, 0], [0, 0, 1], [1, 0, 0]], dtype=float)
OFFSETS = INCH * np.array(
    [[0, 0, 0], [0, 0, 12.0], [251.05, 0, -6.0], [277.95, 0, 6.0], [18.0, 0, 0], [28.0, 0, 0]], dtype=float
)


def cylinder(mass: float, radius: float, length: float, axis: int) -> Matrix:
    """Principal moments of a solid cylinder about its centre [kg m^2], shape (3,); `axis` is its own.

    Examples
    --------
    >>> cylinder(12.0, 1.0, 2.0, 0).tolist()
    [6.0, 7.0, 7.0]
    """
    moments = np.full(3, mass * (3.0 * radius**2 + length**2) / 12.0)
    moments[axis] = 0.5 * mass * radius**2
    return moments


@dataclass(frozen=True)
class Payload:
    """A cylinder held by the middle of one end, along the axis of the wrist's roll.

    Parameters
    ----------
    mass : float
        [kg]
    radius, length : float
        [m]
    """

    mass: float = 7000.0 * 0.45359237
    radius: float = 1.5
    length: float = 2.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "mass", not_negative("mass", self.mass, "kg"))
        object.__setattr__(self, "radius", positive("radius", self.radius, "m"))
        object.__setattr__(self, "length", positive("length", self.length, "m"))


@dataclass(frozen=True, eq=False)
class Links:
    """Six rigid links in a row.

    Attributes
    ----------
    axes : ndarray, shape (joint, 3)
        Unit vectors in the link's frame.
    offsets : ndarray, shape (joint, 3)
        Of a joint from the one before, in the frame of the link before [m].
    masses : ndarray, shape (link,)
        [kg]
    centres : ndarray, shape (link, 3)
        Of mass, from the link's joint [m].
    moments : ndarray, shape (link, 3)
        Principal, about the centre of mass along the frame's axes [kg m^2].
    end : ndarray, shape (3,)
        The end point from the last joint [m].
    """

    axes: Matrix
    offsets: Matrix
    masses: Matrix
    centres: Matrix
    moments: Matrix
    end: Matrix

    def carrying(self, payload: Payload) -> Links:
        """The same with a payload on the last link.

        Examples
        --------
        >>> float(SHUTTLE_LINKS.carrying(Payload(1000.0)).masses.sum())
        1410.0
        """
        masses, centres, moments = self.masses.copy(), self.centres.copy(), self.moments.copy()
        place = self.end + np.array([0.5 * payload.length, 0.0, 0.0])
        total = masses[5] + payload.mass
        centre = (masses[5] * centres[5] + payload.mass * place) / total
        parts = ((masses[5], centres[5]), (payload.mass, place))
        moments[5] = moments[5] + cylinder(payload.mass, payload.radius, payload.length, 0)
        for mass, at in parts:
            # Both centres lie on the roll axis, so that the axes stay principal.
            moments[5] += mass * np.sum((at - centre) ** 2) * np.array([0.0, 1.0, 1.0])
        masses[5], centres[5] = total, centre
        return Links(self.axes, self.offsets, masses, centres, moments, self.end)


def _shuttle_links() -> Links:
    radius = 7.5 * INCH
    masses = np.array([95.0, 140.0, 85.0, 8.0, 46.0, 36.0])
    centres = np.array([[0, 0, 0.15], [3.19, 0, -0.08], [3.53, 0, 0.08], [0.23, 0, 0], [0.35, 0, 0], [0.36, 0, 0]])
    moments = np.array(
        [
            cylinder(95.0, radius, 0.30, 2),
            cylinder(140.0, radius, 251.05 * INCH, 0),
            cylinder(85.0, radius, 277.95 * INCH, 0),
            cylinder(8.0, radius, 18.0 * INCH, 0),
            cylinder(46.0, radius, 28.0 * INCH, 0),
            cylinder(36.0, radius, 28.0 * INCH, 0),
        ]
    )
    return Links(ANGLES, OFFSETS, masses, centres, moments, INCH * np.array([28.0, 0.0, 0.0]))


SHUTTLE_LINKS = _shuttle_links()
"""The unloaded arm's."""
