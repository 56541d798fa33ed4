"""One convex programme over the amplitudes of impulses at given leads, solved by Clarabel (interior point, cones).

`Programme` gathers the rows of any constraints; `solve` finds amplitudes that meet them with the least excess, or with
the least sum of squares of some rows (flatness).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import Basis
from preshape.engine.constraints import Constraint, ZeroVibration
from preshape.mode import Modes

__all__ = ["Programme", "Solution", "gather", "solve"]

PRECISION = 1e-9
"""Relative precision asked of the solver; feasibility and gap come out better on these small problems."""

TIME_LIMIT = 60.0
"""No single programme takes longer [s]; this many seconds mean that the problem is far too large."""


@dataclass(frozen=True)
class Programme:
    """Rows over the amplitudes at `leads`.

    Parameters
    ----------
    leads : ndarray, shape (impulse,)
        Times before the last impulse [s].
    basis : Basis or None
        Orthonormal functions whose sums vanish (zero vibration).
    equalities : ndarray, shape (row, impulse)
        Those functions at the leads.
    cones, radii, inequalities, limits, low, high
        As in :class:`preshape.engine.constraints.Rows`, of all constraints together.
    """

    leads: NDArray[np.float64]
    basis: Basis | None
    equalities: NDArray[np.float64]
    cones: NDArray[np.complex128]
    radii: NDArray[np.float64]
    inequalities: NDArray[np.float64]
    limits: NDArray[np.float64]
    low: float
    high: float


@dataclass(frozen=True)
class Solution:
    """What the solver found.

    Parameters
    ----------
    amplitudes : ndarray, shape (impulse,)
        [-], summing to 1.
    excess : float
        By how much cones and inequalities are exceeded at least [-]; below zero there is room. inf: the equalities
        cannot be met at all.
    solved : bool
        Whether the solver reached its precision.
    waves : ndarray of complex, shape (cone,)
        Multipliers lambda of the cones [-], scaled with the others to sum 1 of magnitudes.
    multipliers : ndarray, shape (row,)
        Multipliers c of the equalities, in the same scale.
    """

    amplitudes: NDArray[np.float64]
    excess: float
    solved: bool
    waves: NDArray[np.complex128]
    multipliers: NDArray[np.float64]


def gather(constraints: Sequence[Constraint], leads: NDArray[np.float64], basis: Basis | None = None) -> Programme:
    """The programme of all `constraints` for impulses at `leads` [s]; `basis` if its functions are known."""
    zeros = [one for one in constraints if isinstance(one, ZeroVibration)]
    if basis is None and zeros:
        orders = tuple(one.order for one in zeros)
        basis = Basis(Modes([one.mode for one in zeros]), orders, float(leads.max()))
    rows = [one.rows(leads) for one in constraints]
    count = leads.size
    return Programme(
        leads=leads,
        basis=basis,
        equalities=np.zeros((0, count)) if basis is None else basis(leads),
        cones=np.concatenate([np.zeros((0, count), dtype=complex), *(r.cones for r in rows if r.radii.size)]),
        radii=np.concatenate([r.radii for r in rows]),
        inequalities=np.concatenate([np.zeros((0, count)), *(r.inequalities for r in rows if r.limits.size)]),
        limits=np.concatenate([r.limits for r in rows]),
        low=max(r.low for r in rows),
        high=min(r.high for r in rows),
    )


def solve(
    programme: Programme, *, flatten: NDArray[np.float64] | None = None, cost: NDArray[np.float64] | None = None
) -> Solution:
    """Amplitudes of sum 1 that meet the programme.

    Parameters
    ----------
    programme : Programme
        With linear rows only; integers are engine/fewest.py's.
    flatten : ndarray, shape (row, impulse), optional
        Rows whose sum of squares is minimised with all constraints hard. Without it and `cost` the largest excess over
        cones and inequalities is minimised (an elastic programme, which always has a solution when the equalities do).
    cost : ndarray, shape (impulse,), optional
        Linear cost, minimised with all constraints hard.
    """
    import clarabel
    from scipy import sparse

    count = programme.leads.size
    elastic = flatten is None and cost is None and programme.limits.size + programme.radii.size > 0
    size = count + 1
    quadratic = np.zeros((size, size))
    if flatten is not None:
        quadratic[:count, :count] = 2.0 * flatten.T @ flatten
    linear = np.zeros(size)
    linear[count] = 1.0 if elastic else 0.0
    if cost is not None:
        linear[:count] = cost
    rows, sides, cones = _conic_form(programme, elastic)
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.time_limit = TIME_LIMIT
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = PRECISION
    settings.direct_solve_method = "qdldl"
    answer = clarabel.DefaultSolver(
        sparse.csc_matrix(np.triu(quadratic)), linear, sparse.csc_matrix(rows), sides, cones, settings
    ).solve()
    status = str(answer.status)
    solved = status in ("Solved", "AlmostSolved")
    x, dual = np.array(answer.x), np.array(answer.z)
    amplitudes = x[:count]
    excess = float(x[count]) if elastic else 0.0
    if not solved and "Infeasible" in status:
        excess = math.inf
    m, k = programme.equalities.shape[0], programme.radii.size
    tail = dual[dual.size - 3 * k :].reshape(k, 3)
    return Solution(amplitudes, excess, solved, -(tail[:, 1] + 1j * tail[:, 2]), dual[:m])


def _conic_form(programme: Programme, elastic: bool) -> tuple[NDArray[np.float64], NDArray[np.float64], list[object]]:
    """A, b and the cones of A x + s = b, x = (amplitudes, excess)."""
    import clarabel

    count, m = programme.leads.size, programme.equalities.shape[0]
    extra = -1.0 if elastic else 0.0
    equal = np.zeros((m + 1 + (0 if elastic else 1), count + 1))
    equal[:m, :count], equal[m, :count] = programme.equalities, 1.0
    if not elastic:
        equal[m + 1, count] = 1.0
    right = np.zeros(equal.shape[0])
    right[m] = 1.0
    below, limits = [], []
    if programme.limits.size:
        below.append(np.column_stack([programme.inequalities, np.full(programme.limits.size, extra)]))
        limits.append(programme.limits)
    identity = np.eye(count, count + 1)
    if math.isfinite(programme.high):
        below.append(identity)
        limits.append(np.full(count, programme.high))
    if math.isfinite(programme.low):
        below.append(-identity)
        limits.append(np.full(count, -programme.low))
    k = programme.radii.size
    cone = np.zeros((k, 3, count + 1))
    cone[:, 0, count] = extra
    cone[:, 1, :count], cone[:, 2, :count] = -programme.cones.real, -programme.cones.imag
    radius = np.zeros((k, 3))
    radius[:, 0] = programme.radii
    kinds: list[object] = [clarabel.ZeroConeT(equal.shape[0])]
    if below:
        kinds.append(clarabel.NonnegativeConeT(sum(part.shape[0] for part in below)))
    kinds += [clarabel.SecondOrderConeT(3)] * k
    rows = np.concatenate([equal, *below, cone.reshape(3 * k, count + 1)])
    return rows, np.concatenate([right, *limits, radius.ravel()]), kinds
