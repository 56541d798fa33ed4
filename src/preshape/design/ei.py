"""EI and k-hump EI: vibration is let rise to a tolerance beside the mode, which widens the band it stays below.

Undamped, V over frequency is a Chebyshev polynomial: n = k + 1 half-period steps, V(x) = tol |T_n(x0 cos(pi x / 2))|,
x0 = cosh(acosh(1/tol) / n), so k humps of equal height between n zeros. With damping the same conditions, every hump
exactly at the tolerance and a zero on both sides of each, are solved by Newton's method (hump_equations.py).
"""

from __future__ import annotations

from preshape.checks import tolerance_of, whole_number
from preshape.design.each_mode import convolve_each
from preshape.design.hump_equations import equal_humps
from preshape.mode import Mode, ModesLike
from preshape.shaper import Shaper

__all__ = ["ei", "k_hump_ei", "three_hump_ei", "two_hump_ei"]

MOST_HUMPS = 8


def ei(modes: ModesLike, tolerance: float = 0.05) -> Shaper:
    """Extra insensitive: three impulses a mode; V equals `tolerance` at the mode, zero on both sides of it.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-]; for several modes the shapers are convolved.
    tolerance : float
        Height of the hump, as a fraction of the unshaped vibration, between 0 and 1.

    Raises
    ------
    InputError
        If the tolerance is out of range, or no such shaper exists because the damping is too high for it.

    Examples
    --------
    >>> ei((10.0, 0.0), tolerance=0.05).amplitudes.round(4).tolist()
    [0.2625, 0.475, 0.2625]
    """
    return _family(modes, "ei", 1, tolerance)


def two_hump_ei(modes: ModesLike, tolerance: float = 0.05) -> Shaper:
    """Two-hump EI: four impulses a mode, zero at the mode, a hump on each side; see :func:`ei`."""
    return _family(modes, "two_hump_ei", 2, tolerance)


def three_hump_ei(modes: ModesLike, tolerance: float = 0.05) -> Shaper:
    """Three-hump EI: five impulses a mode; see :func:`ei`."""
    return _family(modes, "three_hump_ei", 3, tolerance)


def k_hump_ei(modes: ModesLike, humps: int, tolerance: float = 0.05) -> Shaper:
    """EI with any number of humps (1 to 8): humps + 2 impulses a mode; see :func:`ei`."""
    return _family(modes, "k_hump_ei", whole_number("humps", humps, 1, MOST_HUMPS), tolerance)


def _family(modes: ModesLike, family: str, humps: int, tolerance: float) -> Shaper:
    height = tolerance_of(tolerance)

    def one(mode: Mode) -> Shaper:
        times, amplitudes = equal_humps(humps, height, mode.damping)
        return Shaper(times / mode.frequency, amplitudes)

    return convolve_each(modes, family, one, {"humps": humps, "tolerance": height})
