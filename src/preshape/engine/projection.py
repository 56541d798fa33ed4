"""How far positive impulses with leads in [0, T] are from the constraints: the nearest point, and the proof of it.

The distance is min |sum_i a_i g(u_i)| over positive weights of sum 1. At the minimum r the polynomial p(u) = r.g(u)/|r|
is at least |r| everywhere: no positive measure on [0, T] can make all rows zero while |r| > 0. Its touching points are
the impulses. The mesh is only the start: points where p comes lower are added until the continuum has none.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import Basis
from preshape.engine.polynomial import Polynomial

__all__ = ["Projection", "nearest_on", "nearest_on_mesh", "project"]

GAP = 1e-3
"""The exchange stops when p falls short of its bound by less than this fraction: Newton needs no better start."""

MESH_GAP = 1e-6
"""The same for the exchange on a mesh, whose points are all there is."""

EXCHANGED = 1e-9
"""Precision of exchanged points relative to the duration: p is quadratic there, so its value is good to 1e-17."""

SUPPORT = 1e-14
"""Weights below this are no impulses."""

MAXIMUM_EXCHANGES = 40

STALLED = 3
"""So many exchanges in a row that come no nearer: the rest is rounding, and they would go round in circles."""


@dataclass(frozen=True)
class Projection:
    """The positive measure of sum 1 that comes nearest to the constraints.

    Parameters
    ----------
    leads, amplitudes : ndarray, shape (impulse,)
        Its support, times before the end [s], and weights [-].
    distance : float
        |sum a g| [-]; zero when the constraints can be met.
    multipliers : ndarray, shape (row,)
        The unit vector c of the separating polynomial c.g(u); zeros when the distance is zero.
    separation : float
        Minimum of c.g(u) over the whole interval [-]; above zero it proves that nothing there meets the constraints.
    feasible : bool
        Whether the distance is zero within rounding.
    """

    leads: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    distance: float
    multipliers: NDArray[np.float64]
    separation: float = -np.inf
    feasible: bool = False

    @property
    def infeasible(self) -> bool:
        """Whether this proves the interval too short."""
        return not self.feasible and self.separation > 0.0


def nearest_on(basis: Basis, leads: NDArray[np.float64], rows: NDArray[np.float64] | None = None) -> Projection:
    """The nearest measure that lives on the given `leads` [s] only; `rows` is g there, if known."""
    from scipy.optimize import nnls

    matrix = np.empty((basis.size + 1, leads.size))
    matrix[:-1] = basis(leads) if rows is None else rows
    matrix[-1] = 1.0
    target = np.zeros(basis.size + 1)
    target[-1] = 1.0
    weights, _ = nnls(matrix, target, maxiter=50 * leads.size + 1000)
    weights = weights / weights.sum()
    support = weights > SUPPORT
    miss = matrix[:-1, weights > 0.0] @ weights[weights > 0.0]
    distance = float(np.linalg.norm(miss))
    feasible = distance <= basis.zero
    direction = np.zeros(basis.size) if feasible else miss / distance
    return Projection(leads[support], weights[support], distance, direction, feasible=feasible)


def nearest_on_mesh(
    basis: Basis,
    mesh: NDArray[np.float64],
    rows: NDArray[np.float64],
    start: NDArray[np.intp],
    gap: float = MESH_GAP,
) -> tuple[Projection, NDArray[np.intp]]:
    """The nearest measure on a `mesh` of leads [s] with `rows` g there, by exchange from the points `start` (indices).

    Least squares over few points, then the places where the polynomial comes lower than its bound join them, until
    there is none on the mesh: the same answer as :func:`nearest_on`, in a fraction of its time. The fraction
    `gap` of its bound may be missing. Also the indices of the impulses.
    """
    among, before = np.zeros(mesh.size, dtype=bool), np.inf
    among[start] = True
    for _ in range(MAXIMUM_EXCHANGES):
        chosen = np.flatnonzero(among)
        nearest = nearest_on(basis, mesh[chosen], rows[:, chosen])
        if nearest.feasible:
            return nearest, np.searchsorted(mesh, nearest.leads)
        if nearest.distance >= before:
            break  # rounding: the exchange would go round in circles
        before = nearest.distance
        p = nearest.multipliers @ rows
        if p.min() >= nearest.distance * (1.0 - gap):
            return nearest, np.searchsorted(mesh, nearest.leads)
        low = p < nearest.distance
        low[1:] &= p[1:] <= p[:-1]
        low[:-1] &= p[:-1] <= p[1:]
        if not (low & ~among).any():
            return nearest, np.searchsorted(mesh, nearest.leads)
        among = low
        among[np.searchsorted(mesh, nearest.leads)] = True
    nearest = nearest_on(basis, mesh, rows)
    return nearest, np.searchsorted(mesh, nearest.leads)


def project(basis: Basis, leads: NDArray[np.float64], stop: float, gap: float = GAP) -> Projection:
    """The nearest measure on the whole interval [0, stop], starting from a mesh of `leads` [s]."""
    nearest = best = nearest_on(basis, leads)
    closest, stalled = np.inf, 0
    for _ in range(MAXIMUM_EXCHANGES):
        if nearest.feasible:
            return nearest
        minima, values, _ = Polynomial(basis, nearest.multipliers).minima(stop, EXCHANGED)
        nearest = replace(nearest, separation=float(values.min()))
        best = nearest if nearest.separation >= best.separation else best
        stalled = 0 if nearest.distance < closest else stalled + 1
        if nearest.separation >= nearest.distance * (1.0 - gap) or stalled == STALLED:
            break
        closest = min(closest, nearest.distance)
        nearest = nearest_on(basis, np.unique(np.concatenate([nearest.leads, minima])))
    return best
