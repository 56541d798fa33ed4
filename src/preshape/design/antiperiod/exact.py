"""The exact antiperiod shaper: one impulse more than there are different decay rates, an antiperiod T apart.

With q the delay by T, mode i is a zero of 1 + K_i q if T is an odd number of its half periods and
K_i = exp(-sigma_i T) is what its decay rate sigma_i leaves after T. So prod (1 + K_i q) / (1 + K_i), with one factor a
decay rate, has no residual vibration: N + 1 impulses for N modes with different decay rates, two when all rates are
equal, and never two otherwise, which the paper's sum of all modes conceals.
"""

from __future__ import annotations

import math
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Modes

__all__ = ["different_decays", "exact_impulses"]

EQUAL_DECAY = 1e-13
"""K_i and K_j are one factor when they differ by less: leaving one out costs half of it as residual vibration."""


def different_decays(modes: Modes, spacing: float) -> list[float]:
    """K_i = exp(-sigma_i T) [-] of each different decay rate, T the spacing [s], in rising order."""
    kept: list[float] = []
    for decay in sorted(math.exp(-mode.damping * mode.omega * spacing) for mode in modes):
        if not kept or decay - kept[-1] > EQUAL_DECAY:
            kept.append(decay)
    return kept


def exact_impulses(
    modes: Modes, spacing: float, times_each: int = 1
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times [s] and amplitudes [-]: prod ((1 + K_i q) / (1 + K_i))^n with n = `times_each` (2: zero slope as well)."""
    factors = [np.array([1.0, decay]) / (1.0 + decay) for decay in different_decays(modes, spacing)] * times_each
    amplitudes = reduce(np.convolve, factors)
    return spacing * np.arange(amplitudes.size, dtype=float), amplitudes
