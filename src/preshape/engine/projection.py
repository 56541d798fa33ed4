"""How far positive impulses on [0, T] are from satisfying the constraints: the nearest point, and the proof of it.

The distance is min |sum_i a_i g(t_i)| over positive weights of sum 1. At the minimum r the polynomial p(t) = r.g(t)/|r|
is at least |r| everywhere: no positive measure on [0, T] can make all rows zero while |r| > 0. Its touching points are
the impulses. The mesh is only the start: points where p comes lower are added until the continuum has none.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import Basis

__all__ = ["FEASIBLE", "Projection", "nearest_on", "project"]

FEASIBLE = 1e-10
"""Distances below this (rows orthonormal) count as zero: the constraints can be met."""

GAP = 1e-3
"""The exchange stops when p falls short of its bound by less than this fraction: Newton needs no better start."""

EXCHANGED = 1e-9
"""Precision of exchanged points relative to the duration: p is quadratic there, so its value is good to 1e-17."""

SUPPORT = 1e-9
"""Weights below this are no impulses."""

MAXIMUM_EXCHANGES = 40


@dataclass(frozen=True)
class Projection:
    """The positive measure of sum 1 that comes nearest to the constraints.

    Parameters
    ----------
    times, amplitudes : ndarray, shape (impulse,)
        Its support [s] and weights [-].
    distance : float
        |sum a g| [-]; zero when the constraints can be met.
    multipliers : ndarray, shape (row,)
        The unit vector c of the separating polynomial c.g(t); zeros when the distance is zero.
    separation : float
        Minimum of c.g(t) over the whole interval [-]; above zero it proves that nothing there meets the constraints.
    """

    times: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    distance: float
    multipliers: NDArray[np.float64]
    separation: float = -np.inf

    @property
    def infeasible(self) -> bool:
        """Whether this proves the interval too short."""
        return self.distance > FEASIBLE and self.separation > 0.0


def nearest_on(basis: Basis, times: NDArray[np.float64]) -> Projection:
    """The nearest measure that lives on the given `times` [s] only."""
    from scipy.optimize import nnls

    rows = basis(times)
    matrix = np.vstack([rows, np.ones(times.size)])
    target = np.zeros(basis.size + 1)
    target[-1] = 1.0
    weights, _ = nnls(matrix, target, maxiter=50 * times.size + 1000)
    weights = weights / weights.sum()
    miss = rows @ weights
    distance = float(np.linalg.norm(miss))
    support = weights > SUPPORT
    direction = miss / distance if distance > FEASIBLE else np.zeros(basis.size)
    return Projection(times[support], weights[support], distance, direction)


def project(basis: Basis, times: NDArray[np.float64], gap: float = GAP) -> Projection:
    """The nearest measure on the whole interval [0, basis.duration], starting from a mesh of `times` [s]."""
    nearest = nearest_on(basis, times)
    for _ in range(MAXIMUM_EXCHANGES):
        if nearest.distance <= FEASIBLE:
            break
        minima = basis.minima(nearest.multipliers, basis.duration, EXCHANGED)
        lowest = float((nearest.multipliers @ basis(minima)).min())
        nearest = replace(nearest, separation=lowest)
        if lowest >= nearest.distance * (1.0 - gap):
            break
        nearest = nearest_on(basis, np.unique(np.concatenate([nearest.times, minima])))
    return nearest
