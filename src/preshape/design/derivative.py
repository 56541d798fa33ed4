"""ZV, ZVD, ZVDD, ZVD^k: zero vibration with k vanishing derivatives, impulses half a damped period apart.

Amplitudes are the binomial coefficients times K^i, divided by (1 + K)^n, with K the decay over half a damped period
(Singer & Seering, figures 6 and 9; Hyde 2.2). With z = 0 the insensitivity is (4/pi) asin(tolerance^(1/(k+1))).
"""

from __future__ import annotations

from preshape.checks import whole_number
from preshape.design.each_mode import convolve_each
from preshape.engine import convolved_positive
from preshape.mode import Mode, Modes, ModesLike
from preshape.shaper import Shaper

__all__ = ["zv", "zvd", "zvdd", "zvdk"]

HIGHEST_ORDER = 30


def zv(modes: ModesLike) -> Shaper:
    """Zero vibration: two impulses a mode, half a damped period long.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-]; for several modes the shapers are convolved.

    Raises
    ------
    InputError
        If a mode is not one.

    Examples
    --------
    >>> zv((10.0, 0.0)).times.tolist()
    [0.0, 0.05]
    """
    return convolve_each(modes, "zv", lambda mode: _binomial(mode, 0))


def zvd(modes: ModesLike) -> Shaper:
    """Zero vibration and derivative: three impulses a mode; modes as for :func:`zv`."""
    return convolve_each(modes, "zvd", lambda mode: _binomial(mode, 1))


def zvdd(modes: ModesLike) -> Shaper:
    """Zero vibration and two derivatives: four impulses a mode; modes as for :func:`zv`."""
    return convolve_each(modes, "zvdd", lambda mode: _binomial(mode, 2))


def zvdk(modes: ModesLike, order: int) -> Shaper:
    """Zero vibration and `order` derivatives (0: ZV, 1: ZVD, ...): order + 2 impulses a mode; modes as for :func:`zv`.

    Examples
    --------
    >>> len(zvdk((10.0, 0.05), order=4))
    6
    """
    k = whole_number("order", order, 0, HIGHEST_ORDER)
    return convolve_each(modes, "zvdk", lambda mode: _binomial(mode, k), {"order": k})


def _binomial(mode: Mode, order: int) -> Shaper:
    return convolved_positive(Modes(mode), (order,))
