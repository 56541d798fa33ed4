"""Partial-sum shapers: impulses 1, -2, 2, ...: the shaped step jumps between full forward and full reverse.

PS-ZV is the shortest shaper with partial sums in [-1, 1]: what an actuator can do that is as strong in reverse.
"""

from __future__ import annotations

from preshape.design.fixed_amplitudes import zero_vibration_times
from preshape.design.negative_impulses import convolve_negative, timed
from preshape.mode import Mode, ModesLike
from preshape.shaper import Shaper

__all__ = ["ps_zv", "ps_zvd"]

THREE, FIVE = (1.0, -2.0, 2.0), (1.0, -2.0, 2.0, -2.0, 2.0)

UNDAMPED_ZV = (0.209785, 0.290215)
"""Where Newton's method starts: acos(1/4) / 2 pi, and as much before half a period."""

UNDAMPED_ZVD = (0.152406, 0.277396, 0.631311, 0.678948)


def ps_zv(modes: ModesLike) -> Shaper:
    """Partial-sum zero vibration: impulses 1, -2, 2, 0.290 periods long (z = 0), exact for any damping.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-]. For several modes the shapers are convolved; only a single one has the
        partial sums 1, -1, 1: ``design.settings["lowest_partial_sum"]`` and ``["highest_partial_sum"]`` say how far the
        shaped step really goes.

    Returns
    -------
    Shaper
        ``design.settings["high_frequency_gain"]`` is the warning value: by how much it excites, at most, what lies in
        the decade above the highest mode (up to 5).

    Raises
    ------
    InputError
        If a mode is not one, or at damping above 0.979, where the last two impulses are one to rounding.

    Examples
    --------
    >>> shaper = ps_zv((1.0, 0.0))
    >>> shaper.times.round(6).tolist(), shaper.amplitudes.tolist()
    ([0.0, 0.209785, 0.290215], [1.0, -2.0, 2.0])
    """

    def one(mode: Mode) -> Shaper:
        followed = zero_vibration_times(THREE, UNDAMPED_ZV, mode.damping)
        return timed(mode, THREE, followed, "PS-ZV shaper", "use zv")

    return convolve_negative(modes, "ps_zv", one)


def ps_zvd(modes: ModesLike) -> Shaper:
    """Partial-sum zero vibration and derivative: impulses 1, -2, 2, -2, 2, 0.679 periods long (z = 0).

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        As for :func:`ps_zv`; the warning value is up to 9.

    Raises
    ------
    InputError
        If a mode is not one, or at damping above 0.930, where the last two impulses are one to rounding.

    Examples
    --------
    >>> ps_zvd((1.0, 0.1)).times.round(5).tolist()
    [0.0, 0.17744, 0.28918, 0.66772, 0.70136]
    """

    def one(mode: Mode) -> Shaper:
        followed = zero_vibration_times(FIVE, UNDAMPED_ZVD, mode.damping)
        return timed(mode, FIVE, followed, "PS-ZVD shaper", "use zvd")

    return convolve_negative(modes, "ps_zvd", one)
