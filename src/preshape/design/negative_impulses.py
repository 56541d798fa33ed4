"""What every shaper with negative impulses says about itself: its warning value and how far its step response goes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from preshape.design.each_mode import convolve_each
from preshape.design.fixed_amplitudes import Followed
from preshape.errors import InputError
from preshape.mode import Mode, Modes, ModesLike
from preshape.shaper import Shaper
from preshape.vibration import high_frequency_gain
from preshape.vibration.high_frequency import DECADE

__all__ = ["convolve_negative", "timed", "warned"]


def convolve_negative(
    modes: ModesLike, family: str, one: Callable[[Mode], Shaper], settings: Mapping[str, Any] | None = None
) -> Shaper:
    """One shaper a mode, convolved, with three more settings recorded.

    ``high_frequency_gain`` is the warning value: the largest gain [-] in the decade above the highest mode, or the
    bound sum |a_i| where the modes are too far apart for that decade to be searched (it must not say too little);
    ``lowest_partial_sum`` and ``highest_partial_sum`` [-] are the extremes of the shaped unit step.
    """
    return warned(convolve_each(modes, family, one, settings), max(mode.frequency for mode in Modes(modes)))


def warned(shaper: Shaper, highest: float) -> Shaper:
    """The shaper with the three settings recorded; `highest` is the highest frequency it was designed for [Hz]."""
    sums = np.cumsum(shaper.amplitudes)
    gain = high_frequency_gain(shaper, highest)
    warnings = {
        "high_frequency_gain": gain.value if gain.high >= DECADE * highest else gain.bound,
        "lowest_partial_sum": float(sums.min()),
        "highest_partial_sum": float(sums.max()),
    }
    design = replace(shaper.design, settings={**shaper.design.settings, **warnings})
    return shaper.with_design(design)


def timed(mode: Mode, amplitudes: tuple[float, ...], followed: Followed, what: str, remedy: str) -> Shaper:
    """The shaper for one mode from times in damped periods; InputError where following them ended before."""
    if followed.times is None:
        raise InputError(
            f"no {what} exists at damping {mode.damping:g}: {followed.end} near damping {followed.reached:.4g}; "
            f"{remedy}."
        )
    return Shaper(followed.times * mode.damped_period, amplitudes)
