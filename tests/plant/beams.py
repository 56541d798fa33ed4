"""Beams to test with, and exact frequencies from the differential equation: no finite elements in these."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import brentq

from preshape.plant import Beam, HingedPayload, Lump

EQUATIONS: dict[str, tuple[Callable[[float], float], float]] = {
    # Characteristic equations divided by cosh, and where the k-th root is near: (k + shift) pi.
    "free-free": (lambda b: math.cos(b) - 1.0 / math.cosh(b), 0.5),
    "clamped-clamped": (lambda b: math.cos(b) - 1.0 / math.cosh(b), 0.5),
    "clamped-free": (lambda b: math.cos(b) + 1.0 / math.cosh(b), -0.5),
    "pinned-free": (lambda b: math.sin(b) - math.cos(b) * math.tanh(b), 0.25),
    "clamped-pinned": (lambda b: math.sin(b) - math.cos(b) * math.tanh(b), 0.25),
    "pinned-pinned": (math.sin, 0.0),
}

SUPPORTS = {
    "free-free": {},
    "clamped-free": {0.0: "clamped"},
    "pinned-free": {0.0: "pinned"},
    "pinned-pinned": {0.0: "pinned", 1.0: "pinned"},
    "clamped-pinned": {0.0: "clamped", 1.0: "pinned"},
    "clamped-clamped": {0.0: "clamped", 1.0: "clamped"},
}


def unit_beam(kind: str, elements: int) -> Beam:
    return Beam(1.0, elements, 1.0, 1.0, supports=SUPPORTS[kind])


def carrying(elements: int = 6, **held: str) -> Beam:
    """A beam with everything on it, uneven."""
    return Beam(
        1.2,
        elements,
        np.linspace(30.0, 50.0, elements),
        np.linspace(0.5, 0.3, elements),
        supports={{"left": 0.0, "middle": 0.6}[where]: kind for where, kind in held.items()},
        lumps=[Lump(0.6, 1.5, 0.02), Lump(0.0, 0.4)],
        payloads=[HingedPayload(1.2, 2.0, 0.05, along=0.1, stiffness=9.0), HingedPayload(0.0, 1.0, across=0.2)],
    )


def frequency(kind: str, mode: int) -> float:
    """Of mode 1, 2, ... of a uniform beam with E I = m = L = 1 [Hz]."""
    equation, shift = EQUATIONS[kind]
    near = (mode + shift) * math.pi
    return brentq(equation, near - 0.4, near + 0.4, xtol=1e-14, rtol=1e-15) ** 2 / (2.0 * math.pi)


def payload_beam_frequency(
    near: float, length: float, stiffness: float, density: float, payload: tuple[float, float, float, float]
) -> float:
    """Of a free beam with the same payload hinged at either end, its centre of mass outboard [Hz].

    `payload`: mass, inertia, distance of its centre of mass from the hinge, spring. Four constants of the beam's
    general solution and the two angles make a determinant that vanishes at a natural frequency.
    """
    mass, inertia, outboard, spring = payload

    def determinant(f: float) -> float:
        w2 = (2.0 * math.pi * f) ** 2
        b = (density * w2 / stiffness) ** 0.25
        rows = np.zeros((6, 6))
        for end, (x, side, c) in enumerate(((0.0, -1.0, -outboard), (length, 1.0, outboard))):
            v0, v1, v2, v3 = (_solution(b, x, length, order) for order in range(4))
            angle = np.zeros(6)
            angle[4 + end] = 1.0
            # What bends the beam is the spring, what shears it the inertia of the payload; the third: its rotation.
            rows[3 * end] = side * stiffness * v2 - spring * (angle - v1)
            rows[3 * end + 1] = -side * stiffness * v3 - w2 * mass * (v0 + c * angle)
            rows[3 * end + 2] = spring * (angle - v1) - w2 * (mass * c * v0 + (inertia + mass * c * c) * angle)
        rows /= np.abs(rows).max(axis=1, keepdims=True)
        return float(np.linalg.det(rows))

    return float(brentq(determinant, 0.995 * near, 1.005 * near, xtol=1e-13, rtol=1e-13))


def _solution(b: float, x: float, length: float, order: int) -> NDArray[np.float64]:
    """Derivative of sin, cos, exp(b (x - L)) and exp(-b x), by their constants; the last two are the angles."""
    phase = b * x + 0.5 * math.pi * order
    return b**order * np.array(
        [math.sin(phase), math.cos(phase), math.exp(b * (x - length)), (-1.0) ** order * math.exp(-b * x), 0.0, 0.0]
    )
