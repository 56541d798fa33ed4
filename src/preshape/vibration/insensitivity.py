"""Insensitivity: how far a mode may be from where the shaper expects it, at a tolerated vibration.

Band edges are roots of V(f) - tolerance between the located extrema of V, never points of a grid.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from preshape.checks import positive, tolerance_of
from preshape.errors import InputError
from preshape.mode import ModesLike, one_mode
from preshape.shaper import Shaper
from preshape.vibration.band_edge import SAMPLES_PER_RIPPLE, TOUCHING, curve_functions, root, tolerated_until
from preshape.vibration.residual import checked_frequency_and_damping, residual_vibration

__all__ = ["Insensitivity", "insensitivity", "tolerated_bands", "total_insensitivity"]

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
    vibration, slope = curve_functions(shaper, damping)
    count = int(np.ceil((f_high - f_low) * shaper.duration * SAMPLES_PER_RIPPLE)) + 2
    grid = np.linspace(f_low, f_high, count)
    slopes = slope(grid)
    turning = [
        root(lambda f: float(slope(np.array([f]))[0]), grid[k], grid[k + 1])
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
            edges.append(root(lambda f: float(vibration(np.array([f]))[0]) - tolerance, nodes[k], nodes[k + 1]))
    if not above[-1]:
        edges.append(f_high)
    return list(zip(edges[::2], edges[1::2], strict=True))


def insensitivity(
    shaper: Shaper, mode: ModesLike, tolerance: float = 0.05, *, highest: float | None = None
) -> Insensitivity:
    """The band of natural frequency around `mode` in which V <= `tolerance`, at the mode's damping ratio.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    mode : Mode or (frequency, damping)
        The centre; frequency [Hz].
    tolerance : float
        V allowed [-], between 0 and 1.
    highest : float, optional
        Where to stop looking [Hz], above the mode; a band still open there is infinite. 64 times the mode's frequency
        unless given.

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
    low = tolerated_until(shaper, tolerance, centre, 0.0)
    end = HIGHEST_RATIO * f if highest is None else positive("highest", highest, "Hz")
    if end <= f:
        raise InputError(f"highest is {end:g} Hz, which is not above the mode: give more than {f:g} Hz.")
    high = tolerated_until(shaper, tolerance, centre, end)
    if high >= end:
        return Insensitivity(low, math.inf, math.inf)
    return Insensitivity(low, high, (high - low) / f)


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
