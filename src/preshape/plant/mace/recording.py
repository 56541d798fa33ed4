"""Recorded coordinates of the multibody model as outputs with units, and its energy, term by term."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.plant.beam_assembly import element_mass
from preshape.plant.mace.linear import sensor_weights
from preshape.plant.mace.multibody import lump_heights, node_damping
from preshape.plant.mace.structure import LENGTH, SENSOR, MaceStructure

__all__ = ["OUTPUTS", "Recording"]

OUTPUTS = {
    "payload angle": "rad",
    "bus angle": "rad",
    "left end": "m",
    "left sensor": "m",
    "right sensor": "m",
    "left end height": "m",
    "gimbal torque": "N m",
    "attitude torque": "N m",
}
"""Payload and bus (in its middle) turn against inertial space. Ends and sensors are across the bus, relative to its
middle and the slope there, as "relative, not absolute motion" is (Hyde 5.3.3); the sensors sit 19 cm inside the
ends (figure 5.7). The height is absolute. Torques are those applied, control included."""

Matrix = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Recording:
    """What was recorded at every step.

    Parameters
    ----------
    structure : MaceStructure
    elements : int
        A strut.
    angle : float
        Of the payload at first [rad].
    step : float
        [s].
    positions, velocities : ndarray, shape (time, coordinate)
        Relative to the start, as :class:`MaceBody` orders them.
    gimbal, attitude : ndarray, shape (time,)
        Torques applied [N m].
    """

    structure: MaceStructure
    elements: int
    angle: float
    step: float
    positions: Matrix
    velocities: Matrix
    gimbal: Matrix
    attitude: Matrix

    def outputs(self) -> Mapping[str, Matrix]:
        """By the names of :data:`OUTPUTS`."""
        last, nodes = 4 * self.elements, 4 * self.elements + 1
        across = self.positions[:, : 4 * nodes].reshape(-1, nodes, 4)
        bus = self.positions[:, self._rigid(2) + 2]
        places = np.linspace(-0.5 * LENGTH, 0.5 * LENGTH, nodes)
        x = across[:, :, 0] + places
        y = across[:, :, 1]
        element, weights = sensor_weights(self.elements)
        mirrored = weights * np.array([1.0, -1.0, 1.0, -1.0])
        seen = []
        for node, row, place in ((element, weights, SENSOR), (last - element, mirrored, LENGTH - SENSOR)):
            beside = node + 1 if row is weights else node - 1
            along, up = (across[:, node, i] * row[0] + across[:, node, i + 2] * row[1] for i in (0, 1))
            along += across[:, beside, 0] * row[2] + across[:, beside, 2] * row[3] + place - 0.5 * LENGTH
            up += across[:, beside, 1] * row[2] + across[:, beside, 3] * row[3]
            seen.append((along, up))
        x, y = (np.column_stack([ends, *(pair[i] for pair in seen)]) for i, ends in enumerate((x, y)))
        middle = 2 * self.elements
        normal = np.cos(bus)[:, np.newaxis] * (y - y[:, [middle]]) - np.sin(bus)[:, np.newaxis] * (x - x[:, [middle]])
        return {
            "payload angle": self.angle + self.positions[:, -1],
            "bus angle": bus,
            "left end": normal[:, 0],
            "left sensor": normal[:, -2],
            "right sensor": normal[:, -1],
            "left end height": y[:, 0],
            "gimbal torque": self.gimbal,
            "attitude torque": self.attitude,
        }

    def energy(self, damping: float) -> Mapping[str, Matrix]:
        """Kinetic and strain energy, the torques' work and what the damping has taken [J], each of shape (time,).

        Parameters
        ----------
        damping : float
            Ratio of the bus's bending modes [-].
        """
        turning = self.velocities[:, -1] - self.velocities[:, self._rigid(4) + 2]
        power = self.gimbal * turning + self.attitude * self.velocities[:, self._rigid(2) + 2]
        size = 4 * (4 * self.elements + 1)
        damper = node_damping(self.structure, self.elements, damping)
        rates = self.velocities[:, :size]
        lost = np.einsum("ti,ti->t", rates @ damper, rates)
        return {
            "kinetic": self._kinetic(),
            "strain": self._strain(),
            "work": _integral(power, self.step),
            "dissipated": _integral(lost, self.step),
        }

    def _rigid(self, node: int) -> int:
        """First coordinate of the rigid body on one of the five nodes."""
        return 4 * (4 * self.elements + 1) + 3 * node

    def _kinetic(self) -> Matrix:
        s, count = self.structure, 4 * self.elements
        shape = element_mass(LENGTH / count, s.bus_density)
        total = np.zeros(len(self.velocities))
        for k in range(count):
            for axis in (0, 1):
                rates = self.velocities[:, [4 * k + axis, 4 * k + 2 + axis, 4 * k + 4 + axis, 4 * k + 6 + axis]]
                total += 0.5 * np.einsum("ti,ti->t", rates @ shape, rates)
        bodies = [(mass, inertia) for mass, _, inertia in lump_heights(s, self.elements).values()]
        for k, (mass, inertia) in enumerate([*bodies, (s.turning_mass, s.payload_inertia)]):
            x, y, turn = self.velocities[:, self._rigid(k) : self._rigid(k) + 3].T
            total += 0.5 * (mass * (x * x + y * y) + inertia * turn * turn)
        return total

    def _strain(self) -> Matrix:
        """Of the struts: stretch |r'| - 1 and curvature r' x r'' / |r'|^2 at five Gauss points an element."""
        s, count = self.structure, 4 * self.elements
        a = LENGTH / count
        points, weights = np.polynomial.legendre.leggauss(5)
        u = 0.5 * (1.0 + points)
        first = np.array([-6 * u + 6 * u**2, a * (1 - 4 * u + 3 * u**2), 6 * u - 6 * u**2, a * (3 * u**2 - 2 * u)]) / a
        second = np.array([-6 + 12 * u, a * (6 * u - 4), 6 - 12 * u, a * (6 * u - 2)]) / a**2
        total = np.zeros(len(self.positions))
        for k in range(count):
            x, y = (self.positions[:, [4 * k + i, 4 * k + 2 + i, 4 * k + 4 + i, 4 * k + 6 + i]] for i in (0, 1))
            slope_x, slope_y = 1.0 + x @ first, y @ first
            bend_x, bend_y = x @ second, y @ second
            squared = slope_x**2 + slope_y**2
            stretch = np.sqrt(squared) - 1.0
            curvature = (slope_x * bend_y - slope_y * bend_x) / squared
            density = s.axial_stiffness * stretch**2 + s.bending_stiffness * curvature**2
            total += 0.25 * a * (density @ weights)
        return total


def _integral(rate: Matrix, step: float) -> Matrix:
    """Of values at equal steps by the trapezoidal rule, from the start."""
    return np.concatenate([[0.0], np.cumsum(0.5 * step * (rate[1:] + rate[:-1]))])
