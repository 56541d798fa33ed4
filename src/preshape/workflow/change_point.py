"""When a known motion begins, from what is off it before: a probability for each sample, by Bayes' rule.

Just before the change the record is off by something smooth: by a jump, or by something that starts from zero, as the
acceleration of a move with limited jerk does; farther before by anything of the size of the motion. So the odds of a
change at a sample are those of what is seen on both sides of it.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["change_point"]

NEAR = 12
"""Samples before the change over which what is off is smooth."""

KINDS = 3
"""It begins with a jump, a slope or a curvature."""

SIZES = (1.0, 0.1)
"""Of what is off, as parts of the motion."""

_Array = NDArray[np.float64]


def change_point(off: _Array, noise: _Array, sizes: _Array) -> tuple[float, float]:
    """Mean and standard deviation of the sample from which on the record is only noise.

    Parameters
    ----------
    off, noise : ndarray, shape (channel, sample)
        How far the record is off, and the standard deviation of that.
    sizes : ndarray, shape (channel,)
        Of the motion.
    """
    samples = off.shape[-1]
    places = np.arange(1, samples + 1)
    scaled = off / noise
    free = 0.5 * scaled**2
    logs = np.full((places.size, KINDS * len(SIZES)), -np.inf)
    for column, part in enumerate(SIZES):
        wide = 1.0 + (part * sizes[:, None] / noise) ** 2
        apart = 0.5 * (scaled**2 / wide + np.log(wide))
        for row, place in enumerate(places):
            near = max(place - NEAR, 0)
            known = float(-np.sum(free[:, place:]) - np.sum(apart[:, :near]))
            for kind in range(KINDS):
                size = part * sizes[:, None] / noise[:, near:place]
                logs[row, KINDS * column + kind] = known + _smooth(scaled[:, near:place], size, kind)
    weights = np.exp(logs - logs.max()).sum(axis=1)
    weights /= weights.sum()
    # The change is somewhere between the last sample that is off and the next one.
    mean = float(weights @ places) - 0.5
    return mean, float(np.sqrt(weights @ (places - 0.5 - mean) ** 2 + 1.0 / 12.0))


def _smooth(scaled: _Array, sizes: _Array, least: int) -> float:
    """Log likelihood of three powers plus noise of variance 1, over that of a constant density; powers from `least`."""
    ago = np.arange(scaled.shape[-1], 0, -1) / NEAR
    powers = np.stack([ago**power for power in range(least, least + 3)], axis=-1)
    rows = sizes[:, :, None] * powers * 3.0 ** np.arange(least, least + 3)
    inner = np.eye(powers.shape[-1]) + np.einsum("csi,csj->cij", rows, rows)
    right = np.einsum("csi,cs->ci", rows, scaled)
    solved = np.linalg.solve(inner, right[:, :, None])[:, :, 0]
    return float(0.5 * np.sum(right * solved) - 0.5 * np.sum(scaled**2) - 0.5 * np.sum(np.linalg.slogdet(inner)[1]))
