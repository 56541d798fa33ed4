"""Shapers whose amplitudes are given and whose impulse times are solved for: Newton's method, followed in damping.

Time in damped periods, damping as the decay s = z / sqrt(1 - z^2), so that a mode is exp(2 pi (s + i) t) and the times
stay below one at any damping. They are counted back from the last impulse, so that nothing overflows. Unknown are

- zero vibration with q derivatives: 2 (q + 1) times;  sum a_i t_i^k exp(r t_i) = 0, k = 0 ... q, r = 2 pi (s + i);
- one hump of height v: 4 times and the ratios x1 < 1 < x2 of two zeros to the mode's frequency;  F(x1) = F(x2) = 0,
  |F(1)| = v, d|F(x)|/dx = 0 at x = 1, F(x) = sum a_i exp(r x t_i): 4 + 1 + 1 = 6 real equations for 6 unknowns.

Both are square. The solution is followed from the undamped one. It ends where two impulses merge, or where the shaper
is longer than a damped period: a positive shaper with the same constraints is no longer than that.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

__all__ = ["Followed", "hump_times", "zero_vibration_times"]

LARGEST_STEP, SMALLEST_STEP = 0.1, 1e-5
"""Steps in the decay s, or in the logarithm of the tolerance; the smallest is how exactly an end is located."""

CLOSEST = 1e-8
"""Impulses closer than this [damped periods] are one: convolution merges them, and opposite ones would vanish."""

LONGEST = 1.0
"""Damped periods. The curve of hump solutions goes on beyond, to shapers that wait while the mode decays by itself."""

AS_LONG_AS_A_PERIOD = 0.99 * LONGEST
"""A solution that ended with this length ended for it: those whose impulses merge are 0.5 or 0.95 long by then."""

SOLVED, ROUNDING = 1e-13, 20.0 * np.finfo(float).eps
"""Largest error of the equations, humps relative to their height, and what rounding adds to it over that height."""

MAXIMUM_ITERATIONS = 12

UNDAMPED_HUMP, UNDAMPED_HUMP_HEIGHT = (0.094076, 0.368366, 0.642656, 0.736732, 0.870372, 1.122758), 0.05
"""Times and zeros for the amplitudes 1, -1, 1, -1, 1 where following them in the hump's height begins."""

Vector = NDArray[np.float64]
Equations = Callable[[Vector, float], tuple[Vector, NDArray[np.float64]]]
"""Errors and their derivatives by the unknowns, as functions of the unknowns and the parameter that is followed."""


@dataclass(frozen=True)
class Followed:
    """Where following a solution led to.

    Parameters
    ----------
    times : ndarray, shape (impulse,), or None
        Impulse times [damped periods] from 0; None where there is no such shaper.
    reached : float
        The damping ratio [-] asked for, or the one at which the solution ended.
    end : str
        Why it ended; empty when it did not.
    """

    times: Vector | None
    reached: float
    end: str = ""


@lru_cache(maxsize=256)
def zero_vibration_times(amplitudes: tuple[float, ...], undamped: tuple[float, ...], damping: float) -> Followed:
    """Times at which impulses of given amplitudes leave no vibration, nor its first derivatives.

    Parameters
    ----------
    amplitudes : tuple of float, length 2 q + 3
        q = 0: ZV, q = 1: ZVD.
    undamped : tuple of float, one less
        Times after the first impulse [periods] from which Newton's method finds the undamped solution.
    damping : float
        Damping ratio [-] in [0, 1).

    Examples
    --------
    >>> zero_vibration_times((1.0, -1.0, 1.0), (0.17, 0.33), 0.0).times.round(6).tolist()
    [0.0, 0.166667, 0.333333]
    """
    a = np.array(amplitudes)
    powers = np.arange((a.size - 1) // 2)[:, None]

    def equations(unknown: Vector, decay: float) -> tuple[Vector, NDArray[np.float64]]:
        t, rate = np.append(unknown, 0.0), _rate(decay)
        wave = a * np.exp(rate * t)
        values = (t**powers * wave).sum(axis=1)
        slopes = (powers * t ** np.maximum(powers - 1, 0) + rate * t**powers) * wave
        return _real(values), _real(slopes[:, :-1])

    start = np.append(0.0, undamped[:-1]) - undamped[-1]
    return _followed_in_damping(equations, start, damping, SOLVED, a.size)


@lru_cache(maxsize=256)
def hump_times(amplitudes: tuple[float, ...], height: float, damping: float) -> Followed:
    """Times at which five impulses of amplitudes 1, -1, 1, -1, 1 leave a hump of given height between two zeros.

    Parameters
    ----------
    amplitudes : tuple of float, length 5
        The only ones for which a start is known are 1, -1, 1, -1, 1.
    height : float
        V at the mode [-], in (0, 1).
    damping : float
        Damping ratio [-] in [0, 1).

    Examples
    --------
    >>> hump_times((1.0, -1.0, 1.0, -1.0, 1.0), 0.05, 0.0).times.round(6).tolist()
    [0.0, 0.094076, 0.368366, 0.642656, 0.736732]
    """
    a = np.array(amplitudes)

    def equations(unknown: Vector, decay: float, height: float = height) -> tuple[Vector, NDArray[np.float64]]:
        t, zeros, rate = np.append(unknown[:-2], 0.0), unknown[-2:], _rate(decay)
        at_zero = a * np.exp(rate * np.multiply.outer(zeros, t))
        at_mode = a * np.exp(rate * t)
        value, slope = at_mode.sum(), (rate * t * at_mode).sum()
        value_by_times, slope_by_times = rate * at_mode, rate * (1.0 + rate * t) * at_mode
        zero_by_times = rate * zeros[:, None] * at_zero
        zero_by_zeros = np.diag((rate * t * at_zero).sum(axis=1))
        by_times = [
            2.0 * (np.conj(value) * value_by_times).real / height**2,
            2.0 * (np.conj(value_by_times) * slope + np.conj(value) * slope_by_times).real / height**2,
        ]
        errors = [abs(value) ** 2 / height**2 - 1.0, 2.0 * (np.conj(value) * slope).real / height**2]
        jacobian = np.vstack(
            [
                _real(np.hstack([zero_by_times[:, :-1], zero_by_zeros])),
                np.hstack([np.array(by_times)[:, :-1], np.zeros((2, 2))]),
            ]
        )
        return np.append(_real(at_zero.sum(axis=1)), errors), jacobian

    seed = np.append(0.0, UNDAMPED_HUMP)
    seed[:5] -= seed[4]
    start, _, _ = _followed(
        lambda unknown, logarithm: equations(unknown, 0.0, math.exp(logarithm)),
        np.delete(seed, 4),
        math.log(UNDAMPED_HUMP_HEIGHT),
        math.log(height),
        SOLVED + ROUNDING / min(height, UNDAMPED_HUMP_HEIGHT),
        a.size,
    )
    return _followed_in_damping(equations, start, damping, SOLVED + ROUNDING / height, a.size)


def _rate(decay: float) -> complex:
    """The mode's exponent over one damped period."""
    return 2.0 * math.pi * complex(decay, 1.0)


def _real(values: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Real parts, then imaginary parts, along the first axis."""
    return np.concatenate([values.real, values.imag])


def _followed_in_damping(equations: Equations, start: Vector, damping: float, solved: float, impulses: int) -> Followed:
    decay = damping / math.sqrt(1.0 - damping**2)
    found, decay_reached, arrived = _followed(equations, start, 0.0, decay, solved, impulses)
    times = np.append(found[: impulses - 1], 0.0)
    times -= times[0]
    if arrived:
        return Followed(times, damping)
    end = "it becomes longer than a damped period" if times[-1] > AS_LONG_AS_A_PERIOD else "two of its impulses merge"
    return Followed(None, decay_reached / math.hypot(1.0, decay_reached), end)


def _followed(
    equations: Equations, start: Vector, first: float, last: float, solved: float, impulses: int
) -> tuple[Vector, float, bool]:
    """Follow the solution from near `start` at `first` to `last`: the furthest found, where it is, and if at `last`."""
    exact = _newton(equations, start, first, solved)
    now = start if exact is None else exact
    parameter, step, direction = first, LARGEST_STEP, math.copysign(1.0, last - first)
    motion = np.zeros_like(now)
    while parameter != last:
        ahead = last if abs(last - parameter) <= step else parameter + direction * step
        found = _newton(equations, now + (ahead - parameter) * motion, ahead, solved)
        if found is None or not _is_shaper(found, impulses):
            step /= 2.0
            if step < SMALLEST_STEP:
                return now, parameter, False
            continue
        motion = (found - now) / (ahead - parameter)
        now, parameter, step = found, ahead, min(2.0 * step, LARGEST_STEP)
    return now, last, True


def _newton(equations: Equations, start: Vector, parameter: float, solved: float) -> Vector | None:
    """Newton's method, with one step more than needed so that only rounding is left; None if it does not converge."""
    unknown, done = start, False
    for _ in range(MAXIMUM_ITERATIONS):
        errors, jacobian = equations(unknown, parameter)
        if done:
            return unknown
        done = float(np.abs(errors).max()) < solved
        unknown = unknown - np.linalg.lstsq(jacobian, errors, rcond=1e-14)[0]
        if not (np.isfinite(unknown).all() and float(np.abs(unknown).max()) < 10.0):
            return None
    return None


def _is_shaper(unknown: Vector, impulses: int) -> bool:
    """Whether the impulses are in order, apart, within a damped period, and the mode is between the zeros."""
    steps = np.diff(np.append(unknown[: impulses - 1], 0.0))
    zeros = unknown[impulses - 1 :]
    return bool(
        (steps > CLOSEST).all() and steps.sum() <= LONGEST and (zeros.size == 0 or 0.0 < zeros[0] < 1.0 < zeros[1])
    )
