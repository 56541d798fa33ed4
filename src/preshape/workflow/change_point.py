"""When a known motion begins, from what is off it before: a probability for each sample, by Bayes' rule.

Before the change the record is off by something unknown: a jump that drifts, or something that starts from zero, as the
acceleration of a move with limited jerk does. Each is a Gaussian process of the size of the motion, so that the odds of
a change at a sample are those of what is seen on both sides of it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["change_point"]

JUMPS = (1.0, 0.1)
"""Sizes of the jump, as parts of the motion."""

DRIFT = 0.02
"""Of what is off, over a sample, as a part of its size."""

_Array = NDArray[np.float64]


def change_point(off: _Array, covariances: _Array, sizes: _Array) -> tuple[float, float]:
    """Mean and standard deviation of the sample from which on the record is only noise.

    Parameters
    ----------
    off : ndarray, shape (channel, sample)
        How far the record is off.
    covariances : ndarray, shape (channel, sample, sample)
        Of the noise.
    sizes : ndarray, shape (channel,)
        Of what it may be off by.
    """
    samples = off.shape[-1]
    places = np.arange(1, samples + 1)
    logs = np.full((places.size, 2 * len(JUMPS)), -np.inf)
    for row, place in enumerate(places):
        ago = (place - np.arange(samples))[:place].astype(float)
        nearer = np.minimum.outer(ago, ago)
        for column, part in enumerate(JUMPS):
            jump = 1.0 + DRIFT * nearer
            # A jerk that drifts, integrated: exact for a ramp that ends here.
            ramp = (np.outer(ago, ago) + DRIFT * nearer**2 * (3.0 * np.maximum.outer(ago, ago) - nearer) / 6.0) / 100.0
            logs[row, 2 * column] = _log_likelihood(off, covariances, place, part * sizes, jump)
            logs[row, 2 * column + 1] = _log_likelihood(off, covariances, place, part * sizes, ramp)
    weights = np.exp(logs - logs.max()).sum(axis=1)
    weights /= weights.sum()
    # The change is somewhere between the last sample that is off and the next one.
    mean = float(weights @ places) - 0.5
    return mean, float(np.sqrt(weights @ (places - 0.5 - mean) ** 2 + 1.0 / 12.0))


def _log_likelihood(off: _Array, covariances: _Array, place: int, sizes: _Array, shape: _Array) -> float:
    total = 0.0
    for row, covariance, size in zip(off, covariances, sizes, strict=True):
        whole = covariance.copy()
        whole[:place, :place] += size**2 * shape
        factor = np.linalg.cholesky(whole)
        white = np.linalg.solve(factor, row)
        total -= 0.5 * float(white @ white) + float(np.sum(np.log(np.diagonal(factor))))
    return total
