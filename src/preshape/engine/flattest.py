"""Positive amplitudes that meet equations exactly and make a sum of squares least (Hyde 3.2, "second derivative").

A quadratic programme, solved by non-negative least squares alone: the equations are weighted heavily, and what they
still miss is added to what is asked of them (the method of multipliers). Two or three rounds bring the miss down to
rounding. Non-negative least squares leaves no more impulses than there are rows, exact zeros elsewhere, and takes
milliseconds for thousands of slots; an interior-point method gives every slot a little.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["flattest"]

WEIGHT = 1e3
"""Weight of the equations against the rows to flatten, both of size one: each round divides the miss by its square."""

MAXIMUM_ROUNDS = 30

EXACT = 1e-15
"""A miss of the equations (rows of size one) that counts as none."""


def flattest(rows: NDArray[np.float64], flatten: NDArray[np.float64]) -> NDArray[np.float64]:
    """Amplitudes a >= 0 of sum 1 with rows a = 0 and least |flatten a|.

    The equations must have a solution; how well they are met is for the caller to measure.

    Parameters
    ----------
    rows : ndarray, shape (row, impulse)
        Orthonormal constraint functions at the impulses.
    flatten : ndarray, shape (row, impulse)
        What is to be flattened, of about size one.
    """
    from scipy.optimize import nnls

    count = rows.shape[1]
    equations = np.vstack([rows, np.ones(count)])
    wanted = np.zeros(equations.shape[0])
    wanted[-1] = 1.0
    matrix = np.vstack([WEIGHT * equations, flatten])
    asked, zeros = wanted.copy(), np.zeros(flatten.shape[0])
    best, least = np.zeros(count), np.inf
    for _ in range(MAXIMUM_ROUNDS):
        amplitudes, _ = nnls(matrix, np.concatenate([WEIGHT * asked, zeros]), maxiter=50 * count + 1000)
        missed = wanted - equations @ amplitudes
        miss = float(np.linalg.norm(missed))
        if miss >= least:
            break
        best, least = amplitudes, miss
        if miss <= EXACT:
            break
        asked = asked + missed
    result: NDArray[np.float64] = best / best.sum()
    return result
