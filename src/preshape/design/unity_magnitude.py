"""Unity-magnitude shapers: impulses 1, -1, 1, ...: the shaped step is on or off, as thrusters and relays are.

UM-ZV is the shortest shaper with partial sums in [0, 1], a third of a period long where ZV takes half of one. What it
saves is paid above the mode: there it excites up to three times, UM-ZVD and UM-EI up to five times, what the command
does.
"""

from __future__ import annotations

from preshape.checks import tolerance_of
from preshape.design.fixed_amplitudes import hump_times, zero_vibration_times
from preshape.design.negative_impulses import convolve_negative, timed
from preshape.errors import InputError
from preshape.mode import Mode, ModesLike
from preshape.shaper import Shaper

__all__ = ["um_ei", "um_zv", "um_zvd"]

THREE, FIVE = (1.0, -1.0, 1.0), (1.0, -1.0, 1.0, -1.0, 1.0)

UNDAMPED_ZV = (1.0 / 6.0, 1.0 / 3.0)
"""Exact: three unit vectors 60 degrees apart, the middle one negative, close."""

UNDAMPED_ZVD = (0.089513, 0.366234, 0.642955, 0.732468)
"""Where Newton's method starts: (y - x, y, y + x, 2 y) / 2 pi with 1 - 2 cos x + 2 cos y = 0, x sin x = y sin y."""

LOWEST_TOLERANCE = 1e-6
"""The zeros of UM-EI are about sqrt(tolerance) from the mode; nearer ones rounding does not tell from UM-ZVD's."""


def um_zv(modes: ModesLike) -> Shaper:
    """Unity-magnitude zero vibration: impulses 1, -1, 1 at 0, 1/6, 1/3 of a period (z = 0), exact for any damping.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-]. For several modes the shapers are convolved; only a single one has the
        partial sums 1, 0, 1: ``design.settings["lowest_partial_sum"]`` and ``["highest_partial_sum"]`` say how far the
        shaped step really goes.

    Returns
    -------
    Shaper
        ``design.settings["high_frequency_gain"]`` is the warning value: by how much it excites, at most, what lies in
        the decade above the highest mode (3.0 at three times the frequency of a single undamped mode).

    Raises
    ------
    InputError
        If a mode is not one, or at damping above 0.981: the solution exists at every damping, but its last two
        impulses come closer as exp(-pi z / sqrt(1 - z^2)), and from there on they are one to rounding.

    References
    ----------
    Singhose, Seering & Singer (1996) publish fits in damping that leave some 0.05 %; here the equations
    sum a_i exp(r t_i) = 0 themselves are solved, to rounding.

    Examples
    --------
    >>> shaper = um_zv((1.0, 0.1))
    >>> shaper.times.round(5).tolist(), shaper.amplitudes.tolist()
    ([0.0, 0.1968, 0.33572], [1.0, -1.0, 1.0])
    """

    def one(mode: Mode) -> Shaper:
        followed = zero_vibration_times(THREE, UNDAMPED_ZV, mode.damping)
        return timed(mode, THREE, followed, "UM-ZV shaper", "use zv")

    return convolve_negative(modes, "um_zv", one)


def um_zvd(modes: ModesLike) -> Shaper:
    """Unity-magnitude zero vibration and derivative: impulses 1, -1, 1, -1, 1, 0.732 periods long (z = 0).

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        As for :func:`um_zv`; also what convolution does to the partial sums, and the warning value (up to 5).

    Raises
    ------
    InputError
        If a mode is not one, or at damping above 0.935, where the last two impulses are one to rounding.

    Examples
    --------
    >>> um_zvd((1.0, 0.1)).times.round(5).tolist()
    [0.0, 0.12031, 0.35983, 0.67456, 0.73853]
    """

    def one(mode: Mode) -> Shaper:
        followed = zero_vibration_times(FIVE, UNDAMPED_ZVD, mode.damping)
        return timed(mode, FIVE, followed, "UM-ZVD shaper", "use zvd")

    return convolve_negative(modes, "um_zvd", one)


def um_ei(modes: ModesLike, tolerance: float = 0.05) -> Shaper:
    """Unity-magnitude extra insensitive: impulses 1, -1, 1, -1, 1; V equals `tolerance` at the mode, with zero slope.

    Six equations for six unknowns, at any damping: V is zero at two frequencies, one on each side of the mode, and at
    the mode it equals the tolerance and has no slope; unknown are four times and the two zeros.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        As for :func:`um_zv`. Convolved with those of other modes, which may amplify at this one, the hump can come out
        higher than the tolerance: ``design.residual`` says how high.
    tolerance : float
        Height of the hump, as a fraction of the unshaped vibration, from 1e-6 to below 1.

    Raises
    ------
    InputError
        If a mode is not one, the tolerance is out of range, or the damping is above that at which the shaper is as long
        as a damped period (0.851, 0.767, 0.703, 0.621, 0.478 for tolerances of 1.25, 5, 10, 20, 50 %): beyond, the
        solution goes on to ever longer shapers in which the mode decays by itself.

    Examples
    --------
    >>> um_ei((1.0, 0.0)).times.round(6).tolist()
    [0.0, 0.094076, 0.368366, 0.642656, 0.736732]
    """
    height = tolerance_of(tolerance)
    if height < LOWEST_TOLERANCE:
        raise InputError(f"tolerance {height:g} is below {LOWEST_TOLERANCE:g}, which is no hump any more: use um_zvd.")

    def one(mode: Mode) -> Shaper:
        followed = hump_times(FIVE, height, mode.damping)
        what = f"UM-EI shaper with tolerance {height:g}"
        return timed(mode, FIVE, followed, what, "use a smaller tolerance, or zvd")

    return convolve_negative(modes, "um_ei", one, {"tolerance": height})
