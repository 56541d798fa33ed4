"""Klipper's own pulses, as its firmware executes them.

They are not the exact designs of :mod:`preshape.design`: the EI family uses published fits in the damping ratio, and
Klipper's frequency is the undamped natural frequency. Use these to know what a printer does, those to design.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial.polynomial import polyval
from numpy.typing import ArrayLike

from preshape.checks import tolerance_of
from preshape.errors import InputError
from preshape.export.damped_humps import (
    THREE_HUMP_AMPLITUDES,
    THREE_HUMP_TIMES,
    TWO_HUMP_AMPLITUDES,
    TWO_HUMP_TIMES,
)
from preshape.mode import Mode, Modes
from preshape.provenance import Design
from preshape.shaper import Shaper

__all__ = ["DEFAULT_DAMPING", "FAMILIES", "KlipperFamily", "ei", "mzv", "three_hump_ei", "two_hump_ei", "zv", "zvd"]

DEFAULT_DAMPING = 0.1
"""The damping ratio [-] that Klipper assumes for its shapers unless it is configured."""

MOST_IMPULSES = 10
"""Klipper refuses longer shapers (since 2026-03; 5 before)."""

NEGATIVE_AMPLITUDE = 1e-5
"""Klipper refuses a generalised MZV with an amplitude below minus this."""


def zv(frequency: float, damping: float = DEFAULT_DAMPING) -> Shaper:
    """Klipper's `zv`: two impulses half a damped period apart.

    Parameters
    ----------
    frequency : float
        Undamped natural frequency [Hz], what `shaper_freq` holds.
    damping : float
        Damping ratio [-], 0 to 0.99, what `damping_ratio` holds.

    Returns
    -------
    Shaper

    Raises
    ------
    InputError
        If the frequency is not above 0, or the damping is outside Klipper's range for the family.

    Examples
    --------
    >>> zv(50.0, 0.1).amplitudes.round(8).tolist()
    [0.57828618, 0.42171382]
    """
    mode = _mode("zv", frequency, damping)
    return _binomial("zv", mode, [1.0, 1.0])


def zvd(frequency: float, damping: float = DEFAULT_DAMPING) -> Shaper:
    """Klipper's `zvd`: three impulses over one damped period; parameters as for :func:`zv`.

    Examples
    --------
    >>> zvd(50.0, 0.1).amplitudes.round(8).tolist()
    [0.33441491, 0.48774255, 0.17784254]
    """
    mode = _mode("zvd", frequency, damping)
    return _binomial("zvd", mode, [1.0, 2.0, 1.0])


def mzv(frequency: float, damping: float = DEFAULT_DAMPING, *, impulses: int = 3, periods: float = 0.75) -> Shaper:
    """Klipper's `mzv`, also the generalised `mzv(n, t)` that it has since 2026.

    The n impulses are evenly spaced over t damped periods. Read as a polynomial in the delay of one spacing, the
    amplitudes have n - 1 roots on the unit circle; the first is at the mode, the last is its mirror image, the others
    lie evenly between: zero vibration at 1, 1 + 1/tau, 1 + 2/tau ... times the frequency.

    Parameters
    ----------
    frequency : float
        Undamped natural frequency [Hz].
    damping : float
        Damping ratio [-], 0 to 0.99.
    impulses : int
        Klipper's n, 3 to 10.
    periods : float
        Klipper's t, the duration in damped periods; n must be above 2 t + 1.

    Raises
    ------
    InputError
        As for :func:`zv`, if n and t do not fit, or if they would ask for a negative amplitude.

    References
    ----------
    Klipper pull request 7231 (the zeros); the polynomial is ours.

    Examples
    --------
    >>> (mzv(50.0, 0.0).amplitudes * (1 + 2**0.5)).round(6).tolist()
    [0.707107, 1.0, 0.707107]
    """
    mode = _mode("mzv", frequency, damping)
    if not (isinstance(impulses, int) and 3 <= impulses <= MOST_IMPULSES):
        raise InputError(f"mzv with n = {impulses!r} impulses: Klipper takes whole numbers from 3 to {MOST_IMPULSES}.")
    if not (0.0 < periods and 2.0 * periods + 1.0 < impulses):
        raise InputError(
            f"mzv with n = {impulses} impulses over t = {periods:g} periods: t must be above 0 and n above 2 t + 1, "
            "so give more impulses or a shorter time."
        )
    steps = impulses - 1
    first = 2.0 * math.pi * periods / steps
    roots = np.exp(1j * np.linspace(first, 2.0 * math.pi - first, steps))
    amplitudes = np.poly(roots).real
    amplitudes /= amplitudes.sum()
    if amplitudes.min() < -NEGATIVE_AMPLITUDE:
        raise InputError(
            f"mzv(n={impulses}, t={periods:g}) has an amplitude of {amplitudes.min():.3g}, and Klipper refuses "
            "negative ones: give fewer impulses or a longer time."
        )
    decay = mode.decay_per_half_period ** (2.0 * periods / steps)
    times = np.linspace(0.0, periods * mode.damped_period, impulses)
    settings = {"impulses": impulses, "periods": float(periods)}
    return _shaper("mzv", mode, times, amplitudes * decay ** np.arange(impulses), settings)


def ei(frequency: float, damping: float = DEFAULT_DAMPING, *, tolerance: float = 0.05) -> Shaper:
    """Klipper's `ei`: three impulses over one damped period, from the published fit for damped modes.

    Parameters
    ----------
    frequency : float
        Undamped natural frequency [Hz].
    damping : float
        Damping ratio [-], 0 to 0.4.
    tolerance : float
        Klipper's `v_tol`, the vibration left at the mode [-], in (0, 1). The fit meets it to about 2 %.

    Raises
    ------
    InputError
        As for :func:`zv`, or if the tolerance is outside (0, 1).

    Examples
    --------
    >>> ei(50.0, 0.1).amplitudes.round(4).tolist()
    [0.3549, 0.453, 0.1921]
    """
    mode = _mode("ei", frequency, damping)
    z, v = mode.damping, tolerance_of(tolerance)
    first = 0.24968 + 0.24961 * v + (0.80008 + 1.23328 * v) * z + (0.49599 + 3.17316 * v) * z**2
    last = 0.25149 + 0.21474 * v + (-0.83249 + 1.41498 * v) * z + (0.85181 - 4.90094 * v) * z**2
    middle = 0.49990 + polyval(z, [0.0, 0.46159, 4.26169, 1.75601]) * v
    middle += polyval(z, [0.0, 8.57843, -108.644, 336.989]) * v**2
    times = np.array([0.0, middle, 1.0]) * mode.damped_period
    return _shaper("ei", mode, times, [first, 1.0 - first - last, last], {"tolerance": float(tolerance)})


def two_hump_ei(frequency: float, damping: float = DEFAULT_DAMPING) -> Shaper:
    """Klipper's `2hump_ei`, tolerance 5 %: four impulses; damping 0 to 0.3, else as for :func:`zv`.

    Examples
    --------
    >>> len(two_hump_ei(50.0))
    4
    """
    mode = _mode("2hump_ei", frequency, damping)
    return _fitted("2hump_ei", mode, TWO_HUMP_TIMES, TWO_HUMP_AMPLITUDES)


def three_hump_ei(frequency: float, damping: float = DEFAULT_DAMPING) -> Shaper:
    """Klipper's `3hump_ei`, tolerance 5 %: five impulses; damping 0 to 0.2, else as for :func:`zv`.

    Mainline had a slip in this table from 2025-09 to 2026-03 (a missing comma); these are the mended pulses.

    Examples
    --------
    >>> len(three_hump_ei(50.0))
    5
    """
    mode = _mode("3hump_ei", frequency, damping)
    return _fitted("3hump_ei", mode, THREE_HUMP_TIMES, THREE_HUMP_AMPLITUDES)


@dataclass(frozen=True)
class KlipperFamily:
    """One row of Klipper's table of shapers.

    Parameters
    ----------
    name : str
        What `shaper_type` holds.
    pulses : callable
        (frequency [Hz], damping [-]) -> Shaper.
    minimum_frequency : float
        Where the scan of frequencies ends [Hz].
    maximum_damping : float
        Largest damping ratio [-] that Klipper takes.
    tuned : bool
        Whether Klipper tries it when it recommends.
    """

    name: str
    pulses: Callable[[float, float], Shaper]
    minimum_frequency: float
    maximum_damping: float
    tuned: bool = True


FAMILIES: dict[str, KlipperFamily] = {
    family.name: family
    for family in (
        KlipperFamily("zv", zv, 21.0, 0.99),
        KlipperFamily("mzv", mzv, 23.0, 0.99),
        KlipperFamily("zvd", zvd, 29.0, 0.99, tuned=False),
        KlipperFamily("ei", ei, 29.0, 0.4),
        KlipperFamily("2hump_ei", two_hump_ei, 39.0, 0.3),
        KlipperFamily("3hump_ei", three_hump_ei, 48.0, 0.2),
    )
}
"""By name, in the order in which Klipper tries them."""


def _mode(name: str, frequency: float, damping: float) -> Mode:
    """The mode, if Klipper allows this family for it."""
    mode = Mode(frequency, damping)
    limit = FAMILIES[name].maximum_damping
    if mode.damping > limit:
        raise InputError(
            f"damping ratio {mode.damping:g} is above {limit:g}, the most that Klipper allows for {name}: "
            "give less, or take a family with fewer impulses."
        )
    return mode


def _binomial(name: str, mode: Mode, weights: Sequence[float]) -> Shaper:
    """Impulses half a damped period apart, each weaker by what that time leaves of the vibration."""
    index = np.arange(len(weights))
    amplitudes = np.asarray(weights) * mode.decay_per_half_period**index
    return _shaper(name, mode, 0.5 * mode.damped_period * index, amplitudes, {})


def _fitted(name: str, mode: Mode, times: Sequence[Sequence[float]], amplitudes: Sequence[Sequence[float]]) -> Shaper:
    """The impulses that the coefficients give at the mode's damping ratio; times count undamped periods."""
    periods = [0.0, *(float(polyval(mode.damping, row)) for row in times)]
    weights = [float(polyval(mode.damping, row)) for row in amplitudes]
    return _shaper(name, mode, np.array(periods) / mode.frequency, weights, {"tolerance": 0.05})


def _shaper(name: str, mode: Mode, times: ArrayLike, amplitudes: ArrayLike, settings: dict[str, float]) -> Shaper:
    design = Design(family=name, modes=Modes(mode), settings={"executed_by": "Klipper", **settings})
    return Shaper.normalised(times, amplitudes, design)
