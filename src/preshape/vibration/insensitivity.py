"""Insensitivity: how far a mode may be from where the shaper expects it, at a tolerated vibration.

Band edges are roots of V(f) - tolerance between the located extrema of V, never points of a grid.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.checks import tolerance_of
from preshape.errors import InputError
from preshape.mode import ModesLike, one_mode
from preshape.shaper import Shaper
from preshape.vibration.residual import checked_frequency_and_damping, residual_vibration
from preshape.vibration.transform import transform

__all__ = ["Insensitivity", "insensitivity", "tolerated_bands", "total_insensitivity"]

TOUCHING = 1e-8
"""A hump of V higher than the tolerance by less than this fraction only touches it (EI shapers are built to touch)."""

SAMPLES_PER_RIPPLE = 32
"""Samples per 1/duration of frequency when extrema of V are searched; V^2 has no faster ripple than 1/duration."""

HIGHEST_RATIO = 64.0
"""Insensitivity is searched up to this multiple of the mode's frequency; a band still open there is infinite."""


@dataclass(frozen=True)
class Insensitivity:
    """The contiguous band of natural frequencies around a mode in which V stays at or below a tolerance.

    Parameters
    ----------
    low, high : float
        Edges of the band [Hz]; both equal the mode's frequency when V exceeds the tolerance there.
    value : float
        (high - low) / mode frequency [-], the literature's I; infinite if the band has no upper end.
    """

    low: float
    high: float
    value: float


def tolerated_bands(
    shaper: Shaper, tolerance: float, damping: float, low: float, high: float
) -> list[tuple[float, float]]:
    """All bands of natural frequency in [low, high] in which V <= tolerance, edges found as roots, not on a grid.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    tolerance : float
        V allowed [-], between 0 and 1.
    damping : float
        Damping ratio [-].
    low, high : float
        Range of natural frequencies [Hz].

    Returns
    -------
    list of (float, float)
        Band edges [Hz], in order.
    """
    tolerance_of(tolerance)
    f_low, f_high = (float(value) for value in checked_frequency_and_damping([low, high], damping)[0])
    if f_high <= f_low:
        raise InputError(f"the range {low:g} ... {high:g} Hz is empty: give the lower frequency first.")
    vibration, slope = _curve_functions(shaper, damping)
    count = int(np.ceil((f_high - f_low) * shaper.duration * SAMPLES_PER_RIPPLE)) + 2
    grid = np.linspace(f_low, f_high, count)
    slopes = slope(grid)
    turning = [
        _root(lambda f: float(slope(np.array([f]))[0]), grid[k], grid[k + 1])
        for k in np.flatnonzero((slopes[:-1] >= 0.0) != (slopes[1:] >= 0.0))
    ]
    nodes = np.unique([f_low, *turning, f_high])
    values = vibration(nodes)
    above = values > tolerance * (1.0 + TOUCHING)
    edges: list[float] = [] if above[0] else [f_low]
    for k in np.flatnonzero(above[:-1] != above[1:]):
        ends = values[k : k + 2] - tolerance
        if ends[0] * ends[1] > 0.0:
            edges.append(float(nodes[k + int(above[k])]))  # the lower end only touches: it is the edge
        else:
            edges.append(_root(lambda f: float(vibration(np.array([f]))[0]) - tolerance, nodes[k], nodes[k + 1]))
    if not above[-1]:
        edges.append(f_high)
    return list(zip(edges[::2], edges[1::2], strict=True))


def insensitivity(shaper: Shaper, mode: ModesLike, tolerance: float = 0.05) -> Insensitivity:
    """The band of natural frequency around `mode` in which V <= `tolerance`, at the mode's damping ratio.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    mode : Mode or (frequency, damping)
        The centre; frequency [Hz].
    tolerance : float
        V allowed [-], between 0 and 1.

    Examples
    --------
    >>> import preshape
    >>> round(insensitivity(preshape.design.zv((1.0, 0.0)), (1.0, 0.0), 0.05).value, 5)
    0.06369
    """
    centre = one_mode(mode)
    tolerance_of(tolerance)
    f = centre.frequency
    if float(residual_vibration(shaper, f, centre.damping)) > tolerance * (1.0 + TOUCHING):
        return Insensitivity(f, f, 0.0)
    reach = 2.0
    while True:
        bands = tolerated_bands(shaper, tolerance, centre.damping, 0.0, reach * f)
        low, high = next((a, b) for a, b in bands if a <= f * (1.0 + TOUCHING) and f <= b * (1.0 + TOUCHING))
        if high < reach * f:
            return Insensitivity(low, high, (high - low) / f)
        if reach >= HIGHEST_RATIO:
            return Insensitivity(low, math.inf, math.inf)
        reach *= 2.0


def total_insensitivity(
    shaper: Shaper,
    mode: ModesLike,
    tolerance: float = 0.05,
    *,
    relative_frequencies: tuple[float, float] = (0.5, 1.5),
    dampings: tuple[float, float] = (0.0, 0.2),
) -> float:
    """Area in frequency x damping, frequency relative to the mode's, in which V <= `tolerance` [-].

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    mode : Mode or (frequency, damping)
        Its frequency scales the frequency axis.
    tolerance : float
        V allowed [-], between 0 and 1.
    relative_frequencies, dampings : (float, float)
        The rectangle in which the area is measured; both axes have no unit.

    References
    ----------
    Pao (1996), as quoted by Robertson, section I.
    """
    from scipy.integrate import quad

    centre = one_mode(mode)
    low, high = (float(ratio) * centre.frequency for ratio in relative_frequencies)
    z_low, z_high = (float(z) for z in checked_frequency_and_damping(1.0, dampings)[1])

    def width(damping: float) -> float:
        return sum(b - a for a, b in tolerated_bands(shaper, tolerance, damping, low, high)) / centre.frequency

    area, _ = quad(width, z_low, z_high, epsabs=1e-7, epsrel=1e-6, limit=200)
    return float(area)


def _root(function: Callable[[float], float], low: float, high: float) -> float:
    """The root between two frequencies at which, evaluated among others, the function had different signs.

    Evaluated alone, a value that is only rounding (the slope on the top of an EI hump) can have the other sign: then
    that end is the root.
    """
    from scipy.optimize import brentq

    at_low, at_high = function(low), function(high)
    if at_low * at_high > 0.0:
        return float(low if abs(at_low) <= abs(at_high) else high)
    return float(brentq(function, low, high, xtol=1e-15, rtol=8.9e-16))


def _curve_functions(
    shaper: Shaper, damping: float
) -> tuple[Callable[[NDArray[np.float64]], NDArray[np.float64]], Callable[[NDArray[np.float64]], NDArray[np.float64]]]:
    """V(f) and d(V^2)/df as functions of frequencies [Hz] at one damping ratio."""
    rate = 2.0 * math.pi * complex(damping, math.sqrt(1.0 - damping**2))
    end = shaper.duration

    def value(f: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.abs(transform(shaper, np.multiply(rate, f), origin=end))

    def slope(f: NDArray[np.float64]) -> NDArray[np.float64]:
        base = transform(shaper, np.asarray(rate * f), origin=end)
        change = rate * transform(shaper, np.asarray(rate * f), origin=end, moment=1)
        return 2.0 * np.real(base.conj() * change)

    return value, slope
