"""Two solvers of one programme: least cost x with A x + s = b, s zero, then not negative, then in cones of 3 rows."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["by_interior_points", "by_vertices"]

PRECISION = 1e-9
"""Relative precision asked of the interior-point solver; with less it gives up on long moves."""

TIME_LIMIT = 60.0
"""No single programme takes longer [s]; the largest that are posed take about one."""

Solved = tuple[bool, NDArray[np.float64], NDArray[np.float64]]


def by_interior_points(
    matrix: Any, sides: NDArray[np.float64], cost: NDArray[np.float64], equalities: int, inequalities: int
) -> Solved:
    """By Clarabel: whether it is solved, x, and the multipliers of all rows."""
    import clarabel
    from scipy import sparse

    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.time_limit = TIME_LIMIT
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = PRECISION
    settings.direct_solve_method = "qdldl"
    # programme.py scales by what things mean; rescaled, programmes with limits of 1 % of the static fail or take longer
    settings.equilibrate_enable = False
    cones = [clarabel.ZeroConeT(equalities), clarabel.NonnegativeConeT(inequalities)]
    cones += [clarabel.SecondOrderConeT(3)] * ((sides.size - equalities - inequalities) // 3)
    quadratic = sparse.csc_matrix((cost.size, cost.size))
    answer = clarabel.DefaultSolver(quadratic, cost, sparse.csc_matrix(matrix), sides, cones, settings).solve()
    return str(answer.status) in ("Solved", "AlmostSolved"), np.array(answer.x), np.array(answer.z)


def by_vertices(
    matrix: Any, sides: NDArray[np.float64], cost: NDArray[np.float64], equalities: int, inequalities: int
) -> Solved:
    """By HiGHS' interior points, which end in a vertex: every level is at a bound, or a limit decides it. No cones."""
    from scipy.optimize import linprog

    rows = matrix.tocsr()
    answer = linprog(
        cost,
        A_ub=rows[equalities:],
        b_ub=sides[equalities:],
        A_eq=rows[:equalities],
        b_eq=sides[:equalities],
        bounds=(None, None),
        method="highs-ipm",
        options={"time_limit": TIME_LIMIT},
    )
    if answer.x is None:
        return False, np.zeros(cost.size), np.zeros(sides.size)
    return answer.status == 0, answer.x, -np.concatenate([answer.eqlin.marginals, answer.ineqlin.marginals])
