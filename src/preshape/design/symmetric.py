"""Symmetric shapers for two and for three modes without damping: Hyde's reformulation, carried through.

Impulses that are symmetric about the middle have a real residual, V(w) = |sum a_i cos(w tau_i)| with tau counted from
the middle, so one equation a mode does what two do otherwise. Zero slope is one more, sum a_i tau_i sin(w tau_i) = 0.

Two modes have a closed form. Impulses 1, -2 c, 1 a time h = 1 / (f1 + f2) apart vanish where cos(w h) = c, and w1 h and
w2 h = 2 pi - w1 h have the same cosine; convolved with itself this has zero slope as well, and the length is Hyde's
R = 4 / (f1 + f2). All impulses are positive exactly if c <= 0, f2 <= 3 f1. Three modes have one only on some surfaces
of the space of frequencies; from there the solution is followed (symmetric_branches.py).

Both also hold for modes of equal decay rate s: multiplying the impulses by exp(-s t) moves every zero of their
transform by s, from the frequency axis to the poles.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from preshape.checks import whole_number
from preshape.design.each_mode import recorded
from preshape.design.symmetric_branches import shortest_branch
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.provenance import Design
from preshape.shaper import Shaper

__all__ = ["symmetric_three_modes", "symmetric_two_modes"]

EQUAL_DECAY = 1e-13
"""Decay rates that differ by less than this fraction of the lowest mode's angular frequency are equal: what is left of
the vibration is of that size."""

EXACTLY_THREE = 1e-12
"""f2 / f1 may exceed 3 by this much [relative]: then c = 0, and three of the five impulses are left."""


def symmetric_two_modes(modes: ModesLike, order: int = 1) -> Shaper:
    """The shortest positive shaper for two modes with f2 <= 3 f1, in closed form.

    Parameters
    ----------
    modes : two modes or (frequency, damping) pairs
        Frequencies [Hz]; damping 0, or such that both decay rates are equal.
    order : {0, 1}
        0: zero vibration, impulses 1, -2c, 1 divided by 2 - 2c, length 2 / (f1 + f2). 1: zero slope as well, impulses
        1, -4c, 2 + 4c^2, -4c, 1 divided by 4 (1 - c)^2, length 4 / (f1 + f2). c = cos(2 pi f1 / (f1 + f2)).

    Raises
    ------
    InputError
        If there are not two modes, their decay rates differ, or f2 > 3 f1, where impulses would be negative.

    References
    ----------
    Hyde, section 3.4.3.c (the length R, found by experiment) and 3.4.3.d.

    Examples
    --------
    >>> shaper = symmetric_two_modes([(1.0, 0.0), (2.0, 0.0)])
    >>> (9.0 * shaper.amplitudes).round(12).tolist(), round(shaper.duration, 6)
    ([1.0, 2.0, 3.0, 2.0, 1.0], 1.333333)
    """
    wanted, order, frequencies, decay = _checked(modes, 2, order)
    low, high = frequencies
    if high > 3.0 * low * (1.0 + EXACTLY_THREE):
        raise InputError(
            f"{high:g} Hz is more than three times {low:g} Hz: the symmetric shaper would need negative impulses; use "
            "design.direct, which has no such limit."
        )
    c = min(0.0, math.cos(2.0 * math.pi * low / (low + high))) if high < 3.0 * low * (1.0 - EXACTLY_THREE) else 0.0
    amplitudes = np.array([1.0, -2.0 * c, 1.0])
    if order == 1:
        amplitudes = np.convolve(amplitudes, amplitudes)
    times = np.arange(amplitudes.size, dtype=float) / (low + high)
    return _damped(times, amplitudes, decay, Design("symmetric", wanted, {"order": order}, "exact"))


def symmetric_three_modes(modes: ModesLike, order: int = 1) -> Shaper:
    """A symmetric positive shaper for three modes with one impulse a constraint: 4 of them, or 7 with zero slope.

    For f3 <= 3 f1 it was as short as the proved optimum of :func:`direct`, to 1e-7, in all of 3000 random cases. For
    wider spacing it may be longer, as Hyde says of his symmetric solutions (13 % of the cases with f3 <= 5 f1, and 25 %
    with zero slope), or not be found (1 %, and 16 %).

    Parameters
    ----------
    modes : three modes or (frequency, damping) pairs
        Frequencies [Hz]; damping 0, or such that all decay rates are equal.
    order : {0, 1}
        0: zero vibration, 4 impulses. 1: zero slope as well, 7 impulses.

    Returns
    -------
    Shaper
        ``design.settings["start"]`` says from which closed form the solution was followed.

    Raises
    ------
    InputError
        If there are not three modes, their decay rates differ, or no positive solution was found.

    References
    ----------
    Hyde, section 3.4.3.d.

    Examples
    --------
    >>> shaper = symmetric_three_modes([(1.0, 0.0), (2.0, 0.0), (3.0, 0.0)], order=0)
    >>> shaper.times.round(12).tolist(), shaper.amplitudes.round(12).tolist()
    ([0.0, 0.25, 0.5, 0.75], [0.25, 0.25, 0.25, 0.25])
    """
    wanted, order, frequencies, decay = _checked(modes, 3, order)
    found = shortest_branch(frequencies, order)
    if found is None:
        names = ", ".join(f"{f:g}" for f in frequencies)
        raise InputError(
            f"no positive symmetric shaper with {3 * order + 4} impulses was found for {names} Hz: use design.direct."
        )
    settings = {"order": order, "start": found.start}
    return _damped(found.times, found.amplitudes, decay, Design("symmetric", wanted, settings, "exact"))


def _checked(modes: ModesLike, count: int, order: int) -> tuple[Modes, int, tuple[float, ...], float]:
    """Modes, order, their damped frequencies [Hz] in rising order, and their common decay rate [1/s]."""
    wanted = Modes(modes)
    if len(wanted) != count:
        raise InputError(
            f"{len(wanted)} modes were given where {count} are expected: use design.direct for any number."
        )
    rates = [mode.damping * mode.omega for mode in wanted]
    if max(rates) - min(rates) > EQUAL_DECAY * min(mode.omega for mode in wanted):
        raise InputError(
            f"the decay rates (damping ratio times angular frequency) differ, {min(rates):g} to {max(rates):g} 1/s: a "
            "symmetric solution needs undamped modes, or equal rates; use design.direct."
        )
    frequencies = tuple(sorted(mode.omega_d / (2.0 * math.pi) for mode in wanted))
    return wanted, whole_number("order", order, 0, 1), frequencies, sum(rates) / count


def _damped(times: NDArray[np.float64], amplitudes: NDArray[np.float64], decay: float, design: Design) -> Shaper:
    """The symmetric impulses moved to the decay rate [1/s], with their design."""
    return recorded(Shaper.normalised(times, amplitudes * np.exp(-decay * times)), design)
