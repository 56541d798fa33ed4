"""Beam: a planar Bernoulli-Euler beam in finite elements, with lumps and hinged payloads, and the plant it makes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive, whole_number
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.plant.beam_assembly import cubics, mass_matrix, rigid_motions, strain_matrix, supported
from preshape.plant.beam_parts import BeamCoordinate, HingedPayload, Lump
from preshape.plant.checks import finite_row
from preshape.plant.exact import Output
from preshape.plant.flexible_structure import FlexibleStructure
from preshape.plant.reduction import StructureModes, reduced

__all__ = ["Beam", "Support"]

Support: TypeAlias = Literal["pinned", "clamped"]

MOST_ELEMENTS = 2000
"""A modal reduction takes time as the cube: minutes beyond."""

NEAR_A_NODE = 1e-9
"""Of the beam's length: a position as near to a node is that node."""


@dataclass(frozen=True, eq=False)
class Beam:
    """A beam that bends in a plane, from 0 to `length`, in elements of equal length.

    Small deflections, no shear, no rotary inertia of the beam itself, no damping; it does not move along itself.

    Parameters
    ----------
    length : float
        [m].
    elements : int
        How many, 1 to 2000. Frequencies come out too high by (length of an element / wavelength)^4.
    bending_stiffness : float or array_like, shape (element,)
        E I [N m^2].
    mass_per_length : float or array_like, shape (element,)
        [kg/m].
    supports : mapping of float to {"pinned", "clamped"}
        What holds it, by position [m]; free unless given.
    lumps : sequence of Lump
        Rigid things fixed to it.
    payloads : sequence of HingedPayload
        Rigid things hinged to it.

    Raises
    ------
    InputError
        If a value is out of range, or a support, lump or hinge is not at a node.

    References
    ----------
    Meirovitch, Fundamentals of Vibrations (2001), sections 8.3 (exact frequencies) and 10.4 (Hermite elements).

    Examples
    --------
    A cantilever: its lowest frequency is 1.8751^2 / (2 pi) times sqrt(E I / (m L^4)).

    >>> beam = Beam(1.0, 8, bending_stiffness=1.0, mass_per_length=1.0, supports={0.0: "clamped"})
    >>> round(float(beam.modes.frequencies[0]), 4)
    0.5596
    """

    length: float
    elements: int
    bending_stiffness: ArrayLike
    mass_per_length: ArrayLike
    supports: Mapping[float, Support] = field(default_factory=dict)
    lumps: Sequence[Lump] = ()
    payloads: Sequence[HingedPayload] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "length", positive("length", self.length, "m"))
        object.__setattr__(self, "elements", whole_number("elements", self.elements, 1, MOST_ELEMENTS))
        for name, unit in (("bending_stiffness", "N m^2"), ("mass_per_length", "kg/m")):
            values = self._one_an_element(name, unit)
            values.setflags(write=False)
            object.__setattr__(self, name, values)
        for name in ("lumps", "payloads"):
            object.__setattr__(self, name, tuple(getattr(self, name)))
        object.__setattr__(self, "supports", MappingProxyType(dict(self.supports)))
        for position, kind in self.supports.items():
            if kind not in ("pinned", "clamped"):
                raise InputError(f"the support at {position:g} m is {kind!r}: give 'pinned' or 'clamped'.")
            self._check_node("support", position)
        for lump in self.lumps:
            self._check_node("lump", lump.position)
        for payload in self.payloads:
            self._check_node("hinge", payload.position)
        if self._held.all():
            raise InputError("the supports hold every node: give more elements, or leave a support out.")

    @property
    def nodes(self) -> NDArray[np.float64]:
        """Positions of the nodes [m], shape (elements + 1,)."""
        return np.linspace(0.0, self.length, self.elements + 1)

    @cached_property
    def mass_matrix(self) -> NDArray[np.float64]:
        """Of all coordinates, held ones included: displacement and slope of each node, angle of each payload."""
        return mass_matrix(self.nodes, np.asarray(self.mass_per_length), self.lumps, self.payloads)

    @property
    def stiffness_matrix(self) -> NDArray[np.float64]:
        """Of all coordinates, held ones included. The modes do not come from it: see `preshape.plant.reduction`."""
        return self._strain.T @ self._strain

    @cached_property
    def modes(self) -> StructureModes:
        """All modes, rigid ones apart; coordinates that are held are 0 in every shape."""
        free = ~self._held
        rigid = rigid_motions(self.nodes, self.supports, self.payloads)[free]
        found = reduced(self.mass_matrix[np.ix_(free, free)], self._strain[:, free], rigid)
        shapes, rigid_shapes = (np.zeros((free.size, part.shape[1])) for part in (found.shapes, found.rigid_shapes))
        shapes[free], rigid_shapes[free] = found.shapes, found.rigid_shapes
        return StructureModes(found.frequencies, shapes, rigid_shapes)

    def displacement(self, position: float) -> BeamCoordinate:
        """The displacement across the beam at a position [m], anywhere on it; as a load, a force there [N]."""
        element, across, _ = cubics(self.nodes, self._inside(position))
        return self._coordinate({2 * element + k: float(value) for k, value in enumerate(across)}, "m", "N")

    def slope(self, position: float) -> BeamCoordinate:
        """The beam's angle at a position [rad], anywhere on it; as a load, a torque there [N m]."""
        element, _, slope = cubics(self.nodes, self._inside(position))
        return self._coordinate({2 * element + k: float(value) for k, value in enumerate(slope)}, "rad", "N m")

    def payload_angle(self, payload: int = 0) -> BeamCoordinate:
        """The angle of a hinged payload in space [rad], counted from 0; as a load, a torque from outside [N m]."""
        return self._coordinate({2 * (self.elements + 1) + self._payload(payload): 1.0}, "rad", "N m")

    def hinge_angle(self, payload: int = 0) -> BeamCoordinate:
        """The angle from beam to payload [rad]; as a load, a motor between them: reversed on the beam [N m]."""
        return self.payload_angle(payload) - self.slope(self.payloads[self._payload(payload)].position)

    def centre_of_mass(self) -> BeamCoordinate:
        """The mean displacement of all mass [m]; as a load, a force that bends nothing [N]."""
        translation = np.zeros(self._held.size)
        translation[: 2 * (self.elements + 1) : 2] = 1.0
        moved = self.mass_matrix @ translation
        return BeamCoordinate(moved / (translation @ moved), "m", "N")

    def plant(
        self,
        load: BeamCoordinate,
        outputs: Mapping[str, BeamCoordinate],
        *,
        damping: float | Sequence[float] = 0.0,
        count: int | None = None,
        name: str = "load",
    ) -> FlexibleStructure:
        """The beam under one force or torque, as modes.

        Parameters
        ----------
        load : BeamCoordinate
            What the command acts on: a force on a displacement, a torque on an angle.
        outputs : mapping of str to BeamCoordinate
            What is looked at, by name.
        damping : float or sequence of float, one a mode
            Damping ratios [-].
        count : int, optional
            How many flexible modes, from the slowest; all unless given. The fastest third of them are the mesh's more
            than the beam's, but all together are its exact static deflection.
        name : str
            What the command is called.

        Returns
        -------
        FlexibleStructure
            With `motion` (exact, of a Profile), `simulate` (samples), `retuned`.

        Raises
        ------
        InputError
            If a coordinate is of another beam, or the damping ratios do not fit the modes.

        Examples
        --------
        >>> beam = Beam(1.0, 4, 1.0, 1.0, supports={0.0: "clamped"})
        >>> tip = beam.displacement(1.0)
        >>> round(float(beam.plant(tip, {"tip": tip}).static_deflections("tip").sum()), 12)
        0.333333333333
        """
        found = self.modes
        kept = whole_number("count", found.frequencies.size if count is None else count, 1, found.frequencies.size)
        shapes = found.shapes[:, :kept]
        ratios = [damping] * kept if isinstance(damping, int | float) else list(damping)
        if len(ratios) != kept:
            raise InputError(f"{len(ratios)} damping ratios for {kept} modes: give one number, or one a mode.")
        if any(part.row.size != self._held.size for part in (load, *outputs.values())):
            raise InputError("a coordinate is of another beam: take load and outputs from this one.")
        pushed = found.rigid_shapes.T @ load.row
        looks = {
            seen: Output(
                tuple((at.row @ shapes).tolist()), rigid=float((at.row @ found.rigid_shapes) @ pushed), unit=at.unit
            )
            for seen, at in outputs.items()
        }
        modes = [Mode(float(f), z) for f, z in zip(found.frequencies[:kept], ratios, strict=True)]
        return FlexibleStructure(modes, shapes.T @ load.row, looks, input=name, unit=load.load_unit)

    @cached_property
    def _strain(self) -> NDArray[np.float64]:
        return strain_matrix(self.nodes, np.asarray(self.bending_stiffness), self.payloads)

    @property
    def _held(self) -> NDArray[np.bool_]:
        return supported(self.nodes, self.supports, len(self.payloads))

    def _coordinate(self, weights: Mapping[int, float], unit: str, load_unit: str) -> BeamCoordinate:
        row = np.zeros(self._held.size)
        row[list(weights)] = list(weights.values())
        row.setflags(write=False)
        return BeamCoordinate(row, unit, load_unit)

    def _payload(self, number: int) -> int:
        if not self.payloads:
            raise InputError("this beam has no hinged payload: give it one, HingedPayload(position, mass, ...).")
        return whole_number("payload", number, 0, len(self.payloads) - 1)

    def _inside(self, position: float) -> float:
        at = float(finite_row("position", position)[0])
        if not -NEAR_A_NODE * self.length <= at <= (1.0 + NEAR_A_NODE) * self.length:
            raise InputError(f"position {at:g} m is not on the beam: give 0 to {self.length:g} m.")
        return at

    def _check_node(self, what: str, position: float) -> None:
        nearest = self.nodes[int(np.argmin(np.abs(self.nodes - self._inside(position))))]
        if abs(nearest - position) > NEAR_A_NODE * self.length:
            raise InputError(
                f"the {what} at {position:g} m is not at a node, the nearest is at {nearest:g} m: "
                f"move it, or give another number of elements than {self.elements}."
            )

    def _one_an_element(self, name: str, unit: str) -> NDArray[np.float64]:
        values = finite_row(name, getattr(self, name))
        if values.size == 1:
            values = np.full(self.elements, values[0])
        if values.size != self.elements:
            raise InputError(
                f"{name} has {values.size} values for {self.elements} elements: give one, or one for each."
            )
        if not (values > 0.0).all():
            raise InputError(f"{name} is {values.min():g} {unit}: give values above 0 {unit}.")
        return values
