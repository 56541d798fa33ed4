"""MACE linearised about a payload angle: matrices from Bernoulli-Euler elements, and the poles of the loop.

Small motions of the bus (along it, across it, and its slope at every node) and of the right payload's angle. This is
written out by hand, from the elements of :mod:`preshape.plant.beam_assembly`: it calibrates the model, gives its
modes, and is checked against the multibody model, of which it knows nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.plant.beam_assembly import cubics, element_mass
from preshape.plant.mace.structure import LENGTH, NODE_INERTIA, SENSOR, MaceGains, MaceStructure

__all__ = ["Linearised", "bending_damping", "fundamental_swing", "lumps", "oscillations", "sensor_weights"]

RIGID = 0.05
"""Frequencies below this [Hz] are the rigid motions, which rounding puts a little off zero."""

Matrix = NDArray[np.float64]


@dataclass(frozen=True)
class Lump:
    """A rigid body on a node: its node, mass [kg], centre of mass above the bus [m], inertia about it [kg m^2]."""

    node: int
    mass: float
    height: float
    inertia: float


def lumps(structure: MaceStructure, elements: int) -> list[Lump]:
    """The rigid bodies on the bus of so many elements a strut, the clamped left payload among them."""
    s, last = structure, 4 * elements
    nodes = [Lump(k * elements, s.node_mass, 0.0, NODE_INERTIA) for k in range(5)]
    gimbals = [Lump(node, s.gimbal_mass, s.gimbal_offset, s.gimbal_inertia) for node in (0, last)]
    return [
        *nodes,
        *gimbals,
        Lump(2 * elements, s.middle_mass, -s.attitude_offset, s.attitude_inertia),
        Lump(0, s.turning_mass, s.axis_height + s.arm, s.payload_inertia),
    ]


class Linearised:
    """Mass, stiffness and damping about a payload angle.

    Parameters
    ----------
    structure : MaceStructure
    angle : float
        Of the right payload [rad]: 0 vertical, positive inboard.
    elements : int
        A strut.
    gains : MaceGains, optional
        Closes both loops.
    damping : float
        Ratio [-] of the bending modes with the payloads vertical and the loops open.

    Attributes
    ----------
    mass, stiffness, damping : ndarray, shape (coordinate, coordinate)
        Three coordinates a node (along, across, slope), then the payload's angle.
    """

    def __init__(
        self,
        structure: MaceStructure,
        angle: float = 0.0,
        *,
        elements: int = 2,
        gains: MaceGains | None = None,
        damping: float = 0.0,
    ) -> None:
        s, last = structure, 4 * elements
        size = 3 * (last + 1) + 1
        self.payload = size - 1
        self.middle = _slope(2 * elements)
        self.end = _slope(last)
        mass, stiffness = np.zeros((size, size)), np.zeros((size, size))
        for k in range(last):
            _add_element(mass, stiffness, s, k, LENGTH / last)
        for lump in lumps(s, elements):
            along, across, slope = (_unit(size, 3 * lump.node + i) for i in range(3))
            along -= lump.height * slope
            mass += lump.mass * (np.outer(along, along) + np.outer(across, across))
            mass += lump.inertia * np.outer(slope, slope)
        turn = _unit(size, self.payload)
        along = _unit(size, 3 * last) - s.axis_height * _unit(size, self.end) - s.arm * np.cos(angle) * turn
        across = _unit(size, 3 * last + 1) - s.arm * np.sin(angle) * turn
        mass += s.turning_mass * (np.outer(along, along) + np.outer(across, across))
        mass += s.payload_inertia * np.outer(turn, turn)

        damper = np.zeros((size, size))
        if damping > 0.0:
            bending = [3 * k + i for k in range(last + 1) for i in (1, 2)]
            damper[np.ix_(bending, bending)] = bending_damping(s, elements, damping)
        if gains is not None:
            stiffness[self.middle, self.middle] += gains.attitude_stiffness
            damper[self.middle, self.middle] += gains.attitude_damping
            for row, sign in ((self.payload, 1.0), (self.end, -1.0)):
                stiffness[row, self.payload] += sign * gains.gimbal_stiffness
                damper[row, self.payload] += sign * gains.gimbal_damping
        self.mass, self.stiffness, self.damping = mass, stiffness, damper

    def poles(self) -> NDArray[np.complex128]:
        """All poles [1/s], the slowest first."""
        found = np.linalg.eigvals(self.state()).astype(complex)
        return found[np.argsort(np.abs(found), kind="stable")]

    def state(self) -> Matrix:
        """State matrix of coordinates and rates."""
        size = len(self.mass)
        state = np.zeros((2 * size, 2 * size))
        state[:size, size:] = np.eye(size)
        state[size:, :size] = -np.linalg.solve(self.mass, self.stiffness)
        state[size:, size:] = -np.linalg.solve(self.mass, self.damping)
        return state

    def undamped(self) -> Matrix:
        """Natural frequencies without dampers and loops [Hz], the four rigid motions left out."""
        from scipy.linalg import eigh

        squared = eigh(self.stiffness, self.mass, eigvals_only=True)
        return np.asarray(np.sqrt(np.abs(squared[4:])) / (2.0 * np.pi))


def oscillations(poles: NDArray[np.complex128]) -> tuple[Matrix, Matrix]:
    """Natural frequencies [Hz] and damping ratios [-] of the poles that oscillate, in rising order.

    Examples
    --------
    >>> oscillations(np.array([-1.0 + 0j, -0.1 + 6j, -0.1 - 6j]))[0].round(3)
    array([0.955])
    """
    above = poles[poles.imag > 1e-6 * np.maximum(np.abs(poles), 1.0)]
    frequencies, dampings = np.abs(above) / (2.0 * np.pi), -above.real / np.abs(above)
    keep = frequencies > RIGID
    order = np.argsort(frequencies[keep], kind="stable")
    return frequencies[keep][order], dampings[keep][order]


def fundamental_swing(model: Linearised, elements: int, torque: float, above: float) -> float:
    """Peak to peak [m] of the left sensor in the first mode `above` a frequency [Hz], after a step of gimbal torque.

    The sensor looks across the bus, relative to its middle and the slope there.
    """
    size, middle = len(model.mass), 2 * elements
    force = np.zeros(size)
    force[model.payload], force[model.end] = torque, -torque
    drive = np.concatenate([np.zeros(size), np.linalg.solve(model.mass, force)])
    sensor = np.zeros(2 * size)
    element, weights = sensor_weights(elements)
    for k, weight in zip((1, 2, 4, 5), weights, strict=True):
        sensor[3 * element + k] = weight
    sensor[[3 * middle + 1, 3 * middle + 2]] += -1.0, 0.5 * LENGTH - SENSOR
    poles, modes = np.linalg.eig(model.state())
    shares = (sensor @ modes) * np.linalg.solve(modes, drive.astype(complex)) / poles
    seen = np.flatnonzero((poles.imag > 2.0 * np.pi * above) & (-poles.real < 0.15 * np.abs(poles)))
    first = seen[np.argmin(np.abs(poles[seen]))]
    return float(4.0 * np.abs(shares[first]))


def sensor_weights(elements: int) -> tuple[int, Matrix]:
    """The element the left sensor is on, and how the coordinates across and slope of its two nodes make its motion."""
    element, displacement, _ = cubics(np.linspace(0.0, LENGTH, 4 * elements + 1), SENSOR)
    return element, displacement


def bending_damping(structure: MaceStructure, elements: int, ratio: float) -> Matrix:
    """Damping of the bus's bending, the same ratio in every mode with the payloads vertical and the loops open.

    M P diag(2 z w) P' M with the modes P of the bus, free along its axis, on the coordinates across and slope of every
    node. It resists no rigid motion of the bus, of any size: on those two coordinates of the beam elements (the
    position across and the slope's component across) a rigid rotation moves like a small one.
    """
    from scipy.linalg import eigh

    model = Linearised(structure, elements=elements)
    size = len(model.mass)
    nodes = 4 * elements + 1
    bending = [3 * k + i for k in range(nodes) for i in (1, 2)]
    # The struts hardly stretch: along its axis the bus is one coordinate, free as the payload's angle is.
    along = np.zeros(size)
    along[[3 * k for k in range(nodes)]] = 1.0
    free = np.column_stack([along, _unit(size, model.payload)])
    coupled = model.mass[bending] @ free
    mass = model.mass[np.ix_(bending, bending)] - coupled @ np.linalg.solve(free.T @ model.mass @ free, coupled.T)
    squared, modes = eigh(model.stiffness[np.ix_(bending, bending)], mass)
    rates = np.sqrt(np.maximum(squared, 0.0))
    rates[:2] = 0.0
    weighted = mass @ modes
    return np.asarray(weighted @ np.diag(2.0 * ratio * rates) @ weighted.T)


def _slope(node: int) -> int:
    return 3 * node + 2


def _unit(size: int, k: int) -> Matrix:
    row = np.zeros(size)
    row[k] = 1.0
    return row


def _add_element(mass: Matrix, stiffness: Matrix, s: MaceStructure, k: int, length: float) -> None:
    """One Bernoulli-Euler element between nodes k and k + 1, with its bar along the axis."""
    a = length
    bending = [3 * k + 1, 3 * k + 2, 3 * k + 4, 3 * k + 5]
    axial = [3 * k, 3 * k + 3]
    stiffness[np.ix_(bending, bending)] += (s.bending_stiffness / a**3) * _matrix(
        [12, 6 * a, -12, 6 * a],
        [6 * a, 4 * a * a, -6 * a, 2 * a * a],
        [-12, -6 * a, 12, -6 * a],
        [6 * a, 2 * a * a, -6 * a, 4 * a * a],
    )
    mass[np.ix_(bending, bending)] += element_mass(a, s.bus_density)
    stiffness[np.ix_(axial, axial)] += (s.axial_stiffness / a) * _matrix([1, -1], [-1, 1])
    mass[np.ix_(axial, axial)] += (s.bus_density * a / 6.0) * _matrix([2, 1], [1, 2])


def _matrix(*rows: Sequence[float]) -> Matrix:
    return np.array(rows, dtype=float)
