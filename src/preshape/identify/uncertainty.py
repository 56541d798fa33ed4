"""Confidence intervals from the Jacobian of a least-squares fit."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["NORMAL_95", "covariance"]

NORMAL_95 = 1.96
"""Standard deviations from the middle to either end of a 95 % interval."""

SINGULAR = 1e-14
"""Relative eigenvalue of the normal matrix below which a combination of unknowns is not determined at all."""


def covariance(jacobian: NDArray[np.float64], variance: float) -> NDArray[np.float64]:
    """Covariance of the unknowns for residuals of a given variance.

    What the data do not determine gets a large variance, not the zero that a pseudo-inverse would give it.

    Parameters
    ----------
    jacobian : ndarray, shape (residual, unknown)
        At the solution.
    variance : float
        Of one residual.
    """
    values, vectors = np.linalg.eigh(jacobian.T @ jacobian)
    floor = SINGULAR * max(float(values[-1]), 1.0 / np.finfo(float).max ** 0.25)
    return np.asarray(variance * (vectors / np.maximum(values, floor)) @ vectors.T)
