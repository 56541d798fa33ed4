"""Finite elements of a Bernoulli-Euler beam: Hermite's cubics, a displacement and a slope at each node.

Coordinates: displacement and slope of the first node, of the second, ..., then the angle of each hinged payload.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from preshape.plant.beam_parts import HingedPayload, Lump

__all__ = ["cubics", "element_mass", "mass_matrix", "rigid_motions", "strain_matrix", "supported"]

Vector = NDArray[np.float64]


def element_mass(length: float, density: float) -> Vector:
    """The consistent mass of an element, shape (4, 4), of displacement and slope at its first node, then its second.

    Parameters
    ----------
    length : float
        [m].
    density : float
        Mass per length [kg/m].

    Examples
    --------
    >>> unit = element_mass(2.0, 3.0)
    >>> float(np.array([1.0, 0.0, 1.0, 0.0]) @ unit @ [1.0, 0.0, 1.0, 0.0])
    6.0
    """
    h, hh = length, length * length
    rows = [[156.0, 22 * h, 54.0, -13 * h], [22 * h, 4 * hh, 13 * h, -3 * hh]]
    rows += [[54.0, 13 * h, 156.0, -22 * h], [-13 * h, -3 * hh, -22 * h, 4 * hh]]
    return density * length / 420.0 * np.array(rows)


def mass_matrix(nodes: Vector, densities: Vector, lumps: Sequence[Lump], payloads: Sequence[HingedPayload]) -> Vector:
    """M of the beam and of all it carries, shape (coordinate, coordinate); `densities` [kg/m], one an element."""
    base = 2 * nodes.size
    total = np.zeros((base + len(payloads),) * 2)
    for k, (h, density) in enumerate(zip(np.diff(nodes), densities, strict=True)):
        total[2 * k : 2 * k + 4, 2 * k : 2 * k + 4] += element_mass(h, density)
    for lump in lumps:
        at = 2 * _node(nodes, lump.position)
        total[at, at] += lump.mass
        total[at + 1, at + 1] += lump.inertia
    for k, payload in enumerate(payloads):
        both = [2 * _node(nodes, payload.position), base + k]
        # Its centre of mass moves across the beam by the hinge's displacement plus `along` times its angle.
        centre = np.array([1.0, payload.along])
        total[np.ix_(both, both)] += payload.mass * np.outer(centre, centre)
        total[base + k, base + k] += payload.own_inertia
    return total


def strain_matrix(nodes: Vector, stiffnesses: Vector, payloads: Sequence[HingedPayload]) -> Vector:
    """S with S' S the stiffness matrix, shape (strain, coordinate); `stiffnesses` E I [N m^2], one an element.

    A cubic's curvature is linear in an element: its mean and its slope are two independent strains. A hinge's spring
    adds one.
    """
    base = 2 * nodes.size
    rows = []
    for k, (h, stiffness) in enumerate(zip(np.diff(nodes), stiffnesses, strict=True)):
        mean, slope = np.zeros((2, base + len(payloads)))
        mean[[2 * k + 1, 2 * k + 3]] = -1.0, 1.0
        slope[2 * k : 2 * k + 4] = 1.0, 0.5 * h, -1.0, 0.5 * h
        rows += [np.sqrt(stiffness / h) * mean, np.sqrt(12.0 * stiffness / h**3) * slope]
    for k, payload in enumerate(payloads):
        if payload.stiffness > 0.0:
            spring = np.zeros(base + len(payloads))
            spring[[2 * _node(nodes, payload.position) + 1, base + k]] = -1.0, 1.0
            rows.append(np.sqrt(payload.stiffness) * spring)
    return np.array(rows)


def supported(nodes: Vector, supports: Mapping[float, str], payloads: int) -> NDArray[np.bool_]:
    """Which coordinates a support holds, shape (coordinate,)."""
    held = np.zeros(2 * nodes.size + payloads, dtype=bool)
    for position, kind in supports.items():
        at = 2 * _node(nodes, position)
        held[at] = True
        held[at + 1] |= kind == "clamped"
    return held


def rigid_motions(nodes: Vector, supports: Mapping[float, str], payloads: Sequence[HingedPayload]) -> Vector:
    """The motions that strain nothing and that the supports allow, exactly, shape (coordinate, rigid motion)."""
    base = 2 * nodes.size
    count = base + len(payloads)
    found = []
    if not supports:
        translation = np.zeros(count)
        translation[0:base:2] = 1.0
        found.append(translation)
    if not supports or (len(supports) == 1 and "pinned" in supports.values()):
        pivot = nodes[_node(nodes, next(iter(supports)))] if supports else 0.5 * nodes[-1]
        rotation = np.ones(count)
        rotation[0:base:2] = nodes - pivot
        found.append(rotation)
    for k, payload in enumerate(payloads):
        if payload.stiffness == 0.0:
            found.append(np.eye(count)[base + k])
    return np.array(found).T if found else np.zeros((count, 0))


def cubics(nodes: Vector, position: float) -> tuple[int, Vector, Vector]:
    """Where a position lies: its element, and what displacement and slope there are of the element's coordinates."""
    k = int(np.clip(np.searchsorted(nodes, position, side="right") - 1, 0, nodes.size - 2))
    h = float(nodes[k + 1] - nodes[k])
    u = (position - float(nodes[k])) / h
    displacement = np.array(
        [1.0 - u * u * (3.0 - 2.0 * u), h * u * (1.0 - u) ** 2, u * u * (3.0 - 2.0 * u), h * u * u * (u - 1.0)]
    )
    slope = np.array(
        [-6.0 * u * (1.0 - u) / h, (1.0 - u) * (1.0 - 3.0 * u), 6.0 * u * (1.0 - u) / h, u * (3.0 * u - 2.0)]
    )
    return k, displacement, slope


def _node(nodes: Vector, position: float) -> int:
    """The node at a position; Beam has made sure that there is one."""
    return int(np.argmin(np.abs(nodes - position)))
