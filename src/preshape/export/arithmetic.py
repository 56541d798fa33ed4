"""How a controller computes with the taps in its files, and so which impulses it convolves with."""

from __future__ import annotations

import math

import numpy as np

from preshape.export.target import PRECISIONS, Taps
from preshape.shaper import Shaper

__all__ = ["as_coefficients", "as_kernel"]


def as_kernel(taps: Taps) -> Shaper:
    """What y[n] = r + sum over k < last of w[k] (u[n - d[k]] - r) convolves with, r the sample of the last tap.

    Weights are rounded to the width of the controller's numbers. The last one is never used: it is what the others
    leave of 1, so that a constant command comes out to the last bit. Operations are rounded as well; by how much
    depends on the command, not on the shaper, and is no part of this.
    """
    weights = _rounded(taps)
    weights[-1] = 1.0 - math.fsum(weights[:-1])
    return Shaper(taps.delays * np.float64(taps.dt), weights)


def as_coefficients(taps: Taps) -> Shaper:
    """What y[n] = sum of w[k] u[n - d[k]] convolves with: every weight as it stands, in the width of the numbers."""
    return Shaper(taps.delays * np.float64(taps.dt), _rounded(taps))


def _rounded(taps: Taps) -> np.ndarray:
    with np.errstate(over="ignore"):  # infinity is no weight, and Shaper says so
        return taps.weights.astype(PRECISIONS[taps.precision]).astype(np.float64)
