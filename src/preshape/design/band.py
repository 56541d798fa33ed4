"""The EI shaper that covers a band of frequencies: as many humps as the band needs, tuned to its lower edge."""

from __future__ import annotations

import math
from dataclasses import replace

from preshape.design.ei import MOST_HUMPS, k_hump_ei
from preshape.errors import InputError
from preshape.shaper import Shaper
from preshape.vibration import insensitivity

__all__ = ["ei_for_band"]


def ei_for_band(low: float, high: float, tolerance: float = 0.05, damping: float = 0.0) -> Shaper:
    """The shortest k-hump EI shaper with V <= `tolerance` for every natural frequency from `low` to `high`.

    Parameters
    ----------
    low, high : float
        The band [Hz], 0 < low < high.
    tolerance : float
        V allowed in it [-], between 0 and 1.
    damping : float
        Damping ratio [-] at which it holds.

    Raises
    ------
    InputError
        If the band is empty, or wider than eight humps can cover.

    Examples
    --------
    >>> shaper = ei_for_band(8.0, 12.0)
    >>> len(shaper), round(shaper.duration, 4)
    (4, 0.1196)
    """
    if not (math.isfinite(low) and math.isfinite(high) and 0.0 < low < high):
        raise InputError(
            f"the band {low:g} to {high:g} Hz is empty: give two frequencies above 0, the lower one first."
        )
    for humps in range(1, MOST_HUMPS + 1):
        unit = insensitivity(k_hump_ei((1.0, damping), humps, tolerance), (1.0, damping), tolerance)
        if unit.high / unit.low >= high / low:
            shaper = k_hump_ei((low / unit.low, damping), humps, tolerance)
            settings = {**shaper.design.settings, "band": [low, high]}
            return shaper.with_design(replace(shaper.design, settings=settings))
    raise InputError(
        f"no EI shaper with up to {MOST_HUMPS} humps keeps V at or below {tolerance:g} from {low:g} to {high:g} Hz: "
        "narrow the band, or raise the tolerance."
    )
