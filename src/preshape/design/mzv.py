"""MZV: three impulses 3/8 of a damped period apart; shorter than ZVD, more robust than ZV.

Amplitudes 1 - 1/sqrt(2), (sqrt(2) - 1) K', (1 - 1/sqrt(2)) K'^2 with K' the decay over 3/8 of a damped period,
normalised: zero vibration at any damping, as the impulses' phasors are 135 degrees apart (known from 3D printers).
"""

from __future__ import annotations

import math

import numpy as np

from preshape.design.each_mode import convolve_each
from preshape.mode import Mode, ModesLike
from preshape.shaper import Shaper

__all__ = ["mzv"]


def mzv(modes: ModesLike) -> Shaper:
    """Modified zero vibration: three impulses a mode, 3/4 of a damped period long.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-]; for several modes the shapers are convolved.

    Examples
    --------
    >>> mzv((10.0, 0.0)).times.round(6).tolist()
    [0.0, 0.0375, 0.075]
    """
    return convolve_each(modes, "mzv", _one)


def _one(mode: Mode) -> Shaper:
    outer, inner = 1.0 - 1.0 / math.sqrt(2.0), math.sqrt(2.0) - 1.0
    decay = mode.decay_per_half_period**0.75
    weights = np.array([outer, inner * decay, outer * decay**2])
    return Shaper(np.arange(3) * 0.375 * mode.damped_period, weights / weights.sum())
