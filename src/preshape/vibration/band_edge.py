"""How far from a mode V stays within a tolerance: the edge of its band, found outwards from the mode.

Only what lies on the way is looked at. Between two samples V^2 is a cubic to within the fourth derivative, which is
bounded: so only a maximum that can reach the tolerance is located, and no band edge is missed between samples.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Mode
from preshape.shaper import Shaper
from preshape.vibration.transform import transform, transform_uniform

__all__ = ["SAMPLES_PER_RIPPLE", "TOUCHING", "curve_functions", "root", "tolerated_until"]

TOUCHING = 1e-8
"""A hump of V higher than the tolerance by less than this fraction only touches it (EI shapers are built to touch)."""

SAMPLES_PER_RIPPLE = 32
"""Samples per 1/duration of frequency when extrema of V are searched; V^2 has no faster ripple than 1/duration."""

FIRST_LOOK, LONGEST_LOOK = 32, 1024
"""Samples in the first stretch from the mode, doubled for each further one, and in the longest."""

Samples = NDArray[np.float64]


def tolerated_until(shaper: Shaper, tolerance: float, mode: Mode, end: float) -> float:
    """The natural frequency [Hz] up or down to which V stays at or below a tolerance, from the mode's on.

    Parameters
    ----------
    shaper : Shaper
        Any shaper; V is within the tolerance at the mode.
    tolerance : float
        V allowed [-], between 0 and 1.
    mode : Mode
        Where to start, and the damping ratio.
    end : float
        Where to stop looking [Hz]: 0, or above the mode's frequency.

    Returns
    -------
    float
        The edge [Hz], a root; `end` if V stays within the tolerance up to there.
    """
    vibration, slope = curve_functions(shaper, mode.damping)
    start, span = mode.frequency, end - mode.frequency
    count = max(2, math.ceil(abs(span) * shaper.duration * SAMPLES_PER_RIPPLE))
    step, done, look = span / count, 0, FIRST_LOOK
    while done < count:
        steps = min(look, count - done)
        # A stretch begins at the sample where the last one ended.
        grid = np.clip(start + step * np.arange(done, done + steps + 1), 0.0, None)
        if done + steps == count:
            grid[-1] = end
        squares, slopes = _squares(shaper, mode.damping, float(grid[0]), step, steps + 1)
        for k in _suspects(shaper, mode.damping, tolerance, step, squares, slopes):
            near, far = float(grid[k]), float(grid[k + 1])
            if slopes[k] * step > 0.0 >= slopes[k + 1] * step:  # a maximum between
                top = root(lambda f: float(slope(np.array([f]))[0]), near, far)
                far = top if _above(vibration, top, tolerance) else far
            if _above(vibration, far, tolerance):
                return _edge(vibration, tolerance, near, far)
        done, look = done + steps, min(2 * look, LONGEST_LOOK)
    return end


def _squares(shaper: Shaper, damping: float, first: float, step: float, count: int) -> tuple[Samples, Samples]:
    """V^2 and its slope [1/Hz] at evenly spaced frequencies."""
    rate = 2.0 * math.pi * complex(damping, math.sqrt(1.0 - damping**2))
    end = shaper.duration
    base = transform_uniform(shaper, rate * first, rate * step, count, origin=end)
    change = rate * transform_uniform(shaper, rate * first, rate * step, count, origin=end, moment=1)
    return np.abs(base) ** 2, 2.0 * np.real(base.conj() * change)


def _suspects(
    shaper: Shaper, damping: float, tolerance: float, step: float, squares: Samples, slopes: Samples
) -> list[int]:
    """The intervals in which V may exceed the tolerance, in order.

    The cubic through values and slopes at both ends misses V^2 by at most h^4 / 384 of its fourth derivative, which is
    at most (2 pi T sqrt(1 + 3 z^2))^4 times the square of the amplitudes' sum of sizes.
    """
    h = abs(step)
    fourth = (2.0 * math.pi * shaper.duration) ** 4 * (1.0 + 3.0 * damping**2) ** 2 * shaper.magnitude**2
    bends = (
        4.0 / 27.0 * h * (np.maximum(slopes[:-1] * np.sign(step), 0.0) + np.maximum(-slopes[1:] * np.sign(step), 0.0))
    )
    most = np.maximum(squares[:-1], squares[1:]) + bends + fourth * h**4 / 384.0
    return [int(k) for k in np.flatnonzero(most > tolerance**2)]


def _above(vibration: Callable[[Samples], Samples], f: float, tolerance: float) -> bool:
    return float(vibration(np.array([f]))[0]) > tolerance * (1.0 + TOUCHING)


def _edge(vibration: Callable[[Samples], Samples], tolerance: float, near: float, far: float) -> float:
    """The root between a frequency within the tolerance and one above it; the first itself where V only touches."""
    if float(vibration(np.array([near]))[0]) >= tolerance:
        return near
    return root(lambda f: float(vibration(np.array([f]))[0]) - tolerance, near, far)


def root(function: Callable[[float], float], low: float, high: float) -> float:
    """The root between two frequencies at which, evaluated among others, the function had different signs.

    Evaluated alone, a value that is only rounding (the slope on the top of an EI hump) can have the other sign: then
    that end is the root.
    """
    from scipy.optimize import brentq

    at_low, at_high = function(low), function(high)
    if at_low * at_high > 0.0:
        return float(low if abs(at_low) <= abs(at_high) else high)
    return float(brentq(function, low, high, xtol=1e-15, rtol=8.9e-16))


def curve_functions(
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
