"""What scatters: factors around 1, and modes that are multiplied by them."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from preshape.campaign.machines.machine import Factors
from preshape.mode import Modes

__all__ = ["drawn_factors", "scattered_modes"]

MOST_DAMPING = 0.99
"""What a scattered damping ratio is limited to [-]: at 1 nothing vibrates."""


def drawn_factors(
    random: np.random.Generator, deviations: Mapping[str, float], counts: Mapping[str, int]
) -> dict[str, NDArray[np.float64]]:
    """Log-normal factors: their logarithms have the given standard deviation, each factor is drawn on its own.

    Parameters
    ----------
    random : numpy.random.Generator
        Of the point.
    deviations : mapping of str to float
        Relative standard deviations [-], by what scatters.
    counts : mapping of str to int
        How many factors each has.

    Examples
    --------
    >>> drawn_factors(np.random.default_rng(1), {"frequency": 0.1}, {"frequency": 2})["frequency"].round(4).tolist()
    [1.0352, 1.0856]
    """
    return {name: np.exp(size * random.standard_normal(counts[name])) for name, size in deviations.items()}


def scattered_modes(modes: Modes, factors: Factors) -> Modes:
    """The modes, their frequencies and damping ratios multiplied, each by its own factor."""
    ones = np.ones(len(modes))
    f, z = factors.get("frequency", ones), factors.get("damping", ones)
    return Modes(
        [
            (mode.frequency * float(a), min(mode.damping * float(b), MOST_DAMPING))
            for mode, a, b in zip(modes, f, z, strict=True)
        ]
    )
