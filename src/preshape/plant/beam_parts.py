"""What a beam carries: lumps that are fixed to it and payloads hinged to it; and what is done to it or seen of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.checks import not_negative
from preshape.errors import InputError
from preshape.plant.checks import finite_row

__all__ = ["BeamCoordinate", "HingedPayload", "Lump"]


@dataclass(frozen=True)
class Lump:
    """A rigid thing fixed to a beam, its centre of mass on the beam.

    Parameters
    ----------
    position : float
        Where [m], at a node of the beam.
    mass : float
        [kg].
    inertia : float
        About its own centre of mass, for rotation in the plane [kg m^2].
    """

    position: float
    mass: float = 0.0
    inertia: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "mass", not_negative("mass", self.mass, "kg"))
        object.__setattr__(self, "inertia", not_negative("inertia", self.inertia, "kg m^2"))


@dataclass(frozen=True)
class HingedPayload:
    """A rigid thing that turns on a hinge of a beam, in the beam's plane, with an angle of its own.

    Its angle is counted from where it points at rest, in space, not from the beam. The beam does not move along itself,
    so `across` adds to the payload's inertia only, and `along` couples its angle to the beam's deflection.

    Parameters
    ----------
    position : float
        Of the hinge [m], at a node of the beam.
    mass : float
        [kg].
    inertia : float
        About its own centre of mass [kg m^2].
    along, across : float
        Of the centre of mass from the hinge, along the beam and across it [m].
    stiffness : float
        Of a spring between payload and beam [N m/rad], such as the proportional gain of a gimbal; 0: free to turn.
    """

    position: float
    mass: float
    inertia: float = 0.0
    along: float = 0.0
    across: float = 0.0
    stiffness: float = 0.0

    def __post_init__(self) -> None:
        for name, unit in (("mass", "kg"), ("inertia", "kg m^2"), ("stiffness", "N m/rad")):
            object.__setattr__(self, name, not_negative(name, getattr(self, name), unit))
        along, across = finite_row("along and across", [self.along, self.across])
        object.__setattr__(self, "along", float(along))
        object.__setattr__(self, "across", float(across))
        if not self.own_inertia > 0.0:
            raise InputError(
                "a hinged payload has no inertia of its own: give inertia, or a mass with an offset across; "
                "for a mass that does not turn take a Lump."
            )

    @property
    def own_inertia(self) -> float:
        """What resists its turning while its hinge follows the motion of its centre of mass [kg m^2]."""
        return self.inertia + self.mass * self.across**2


@dataclass(frozen=True, eq=False)
class BeamCoordinate:
    """A displacement or an angle of a beam: what can be looked at, and what a force or a torque can act on.

    Parameters
    ----------
    row : ndarray, shape (coordinate,)
        Its weights of the beam's coordinates; and, as a load, what a unit of it puts on each.
    unit, load_unit : str
        "m" and "N", or "rad" and "N m".
    """

    row: NDArray[np.float64]
    unit: str
    load_unit: str

    def __sub__(self, other: BeamCoordinate) -> BeamCoordinate:
        """The difference of two, such as the angle between payload and beam; as a load, one and the other reversed."""
        if not isinstance(other, BeamCoordinate):
            return NotImplemented
        if other.unit != self.unit or other.row.shape != self.row.shape:
            raise InputError(
                f"a coordinate in {self.unit} and one in {other.unit} have no difference: subtract two displacements "
                "or two angles of one beam."
            )
        return BeamCoordinate(self.row - other.row, self.unit, self.load_unit)
