"""SNA-ZV: a negative impulse as large as one allows, between ZV (none) and UM-ZV (1) and beyond.

The larger it is, the shorter the shaper and the more it excites above the mode, 1 + 2 b at most.
"""

from __future__ import annotations

import math
from numbers import Real

from preshape.design.fixed_amplitudes import zero_vibration_times
from preshape.design.negative_impulses import convolve_negative, timed
from preshape.errors import InputError
from preshape.mode import Mode, ModesLike
from preshape.shaper import Shaper

__all__ = ["sna_zv"]

LARGEST_AMPLITUDE = 100.0
"""A negative impulse of that size excites 201 times what the command does, and rounding shows in the zero."""


def sna_zv(modes: ModesLike, negative_amplitude: float) -> Shaper:
    """Zero vibration with a specified negative amplitude: impulses (1 + b)/2, -b, (1 + b)/2.

    Undamped, at 0, x, 2 x of a period, cos(2 pi x) = b / (1 + b); with damping the times are solved for and the
    amplitudes stay what they are.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-]. For several modes the shapers are convolved; only a single one has the
        partial sums (1 + b)/2, (1 - b)/2, 1: ``design.settings["lowest_partial_sum"]`` and
        ``["highest_partial_sum"]`` say how far the shaped step really goes.
    negative_amplitude : float
        b [-], as a positive number, from above 0 to 100; 1 gives UM-ZV.

    Returns
    -------
    Shaper
        ``design.settings["high_frequency_gain"]`` is the warning value: by how much it excites, at most, what lies in
        the decade above the highest mode (up to 1 + 2 b).

    Raises
    ------
    InputError
        If a mode is not one or b is out of range; or if b < 1 is too small for the damping: the last two impulses merge
        where K, the decay over half a damped period, is (1 - b)/(1 + b), and what is left is ZV
        (damping 0.064, 0.160, 0.330, 0.527, 0.684 for b = 0.1, 0.25, 0.5, 0.75, 0.9). With b > 1 there is no such end.

    Examples
    --------
    >>> shaper = sna_zv((1.0, 0.1), negative_amplitude=0.5)
    >>> shaper.times.round(5).tolist(), shaper.amplitudes.tolist()
    ([0.0, 0.25495, 0.39772], [0.75, -0.5, 0.75])
    """
    b = _amplitude_of(negative_amplitude)
    amplitudes = ((1.0 + b) / 2.0, -b, (1.0 + b) / 2.0)
    step = math.acos(b / (1.0 + b)) / (2.0 * math.pi)

    def one(mode: Mode) -> Shaper:
        followed = zero_vibration_times(amplitudes, (step, 2.0 * step), mode.damping)
        kept = mode.decay_per_half_period
        remedy = f"use zv, or a negative amplitude above {(1.0 - kept) / (1.0 + kept):.4g}"
        return timed(mode, amplitudes, followed, f"SNA-ZV shaper with negative amplitude {b:g}", remedy)

    return convolve_negative(modes, "sna_zv", one, {"negative_amplitude": b})


def _amplitude_of(value: object) -> float:
    number = math.nan if isinstance(value, bool) or not isinstance(value, Real) else float(value)
    if not 0.0 < number <= LARGEST_AMPLITUDE:
        raise InputError(
            f"negative_amplitude is {value!r}: give a number above 0 and up to {LARGEST_AMPLITUDE:g}, such as 0.5 for "
            "the amplitudes 0.75, -0.5, 0.75."
        )
    return number
