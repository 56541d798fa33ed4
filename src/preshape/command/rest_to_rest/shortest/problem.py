"""Problem: a rest-to-rest move in the units in which its mathematics is simplest, as all solvers of this folder see it.

The force is v in [-1, 1] (of the largest force), the rigid body obeys X'' = v with a target in s^2, and mode j obeys
  x_j'' + 2 z w x_j' + w^2 x_j = w^2 v,
so that x_j is its deflection in static deflections under the largest force.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.engine.edges import Edge

__all__ = ["Problem", "kappa"]

HOLDABLE = 1e-12
"""A limit of the static deflection itself, to rounding, is held by the largest force."""


@dataclass(frozen=True, eq=False)
class Problem:
    """A move, its modes and its limits.

    Parameters
    ----------
    target : float
        Distance times mass over the largest force [s^2], above zero.
    rates : ndarray of complex, shape (mode,)
        s = z w + i w sqrt(1 - z^2) of every mode [1/s].
    rows : ndarray, shape (output, mode)
        Each output's deflection in units of its limit, for deflections in static ones [-]: \\|rows x\\| <= 1.
    edges : tuple of Edge
        Where residual vibration is limited beside the modes, and how much.
    """

    target: float
    rates: NDArray[np.complex128]
    rows: NDArray[np.float64]
    edges: tuple[Edge, ...] = ()

    @property
    def unit(self) -> float:
        """The square root of the target [s]: half of what a rigid body would take."""
        return math.sqrt(self.target)

    @property
    def fastest(self) -> float:
        """Largest frequency of all modes and edges [rad/s]."""
        return max(float(np.abs(self.rates).max()), *(2.0 * math.pi * edge.high for edge in self.edges), 0.0)

    @property
    def tracked(self) -> list[int]:
        """Modes that limited outputs show: those whose motion a programme must follow."""
        return [int(mode) for mode in np.flatnonzero((self.rows != 0.0).any(axis=0))]

    def rounding(self, duration: float) -> float:
        """What rounding of times near `duration` [s] leaves of outputs, in units of their limits [-]."""
        steepest = (np.abs(self.rows) * np.abs(self.rates)).sum(axis=1).max(initial=0.0)
        return float(np.finfo(float).eps * duration * steepest)

    def held_mode(self, row: int) -> int | None:
        """The one mode that an output shows, if a constant force can hold it on its limit; else None."""
        modes = np.flatnonzero(self.rows[row])
        if modes.size != 1 or abs(self.rows[row, modes[0]]) < 1.0 - HOLDABLE:
            return None
        return int(modes[0])

    def held_level(self, row: int, mode: int, sign: float) -> float:
        """The force that holds an output on its limit, 1 or -1 [-]."""
        level = sign / float(self.rows[row, mode])
        return level if abs(level) < 1.0 - HOLDABLE else math.copysign(1.0, level)


def kappa(rates: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """1 + i z / sqrt(1 - z^2), shape (mode,): a unit step of force makes the deflection 1 - Re(kappa exp(-s t))."""
    return np.asarray(1.0 + 1j * rates.real / rates.imag, dtype=complex)
