"""The hump equations of a k-hump EI shaper at any damping, solved by Newton's method from the undamped closed form.

Time in periods, frequency as the ratio x to the mode's. Unknown are k + 2 amplitudes, their times, n = k + 1 zeros and
k humps; the middle hump (k odd) or the middle zero (k even) stays at x = 1:
  V(zero) = 0 (real and imaginary part);  V(hump) = tolerance, V'(hump) = 0;  amplitudes sum to 1.
Solutions are followed from z = 0 upwards. They end at a damping where the highest zero runs to infinity and the last
two impulses merge: beyond it no such shaper exists, and we say so.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError

__all__ = ["equal_humps"]

FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 0.02, 0.05, 1e-4
"""Steps of damping ratio while a solution is followed."""

SOLVED = 1e-12
"""Largest error of the equations, humps relative to the tolerance; rounding over a small tolerance is added to it."""

MAXIMUM_ITERATIONS = 12

HIGHEST_ZERO = 1e3
"""A zero at more than this multiple of the mode's frequency is none: the solution has ended."""


@dataclass(frozen=True)
class _State:
    """times counted back from the last impulse [periods], amplitudes, zeros and humps as frequency ratios."""

    times: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    zeros: NDArray[np.float64]
    humps: NDArray[np.float64]

    def vector(self) -> NDArray[np.float64]:
        return np.concatenate([self.times, self.amplitudes, self.zeros, self.humps])

    @classmethod
    def from_vector(cls, vector: NDArray[np.float64], humps: int) -> _State:
        count = humps + 2
        return cls(*np.split(vector, [count, 2 * count, 2 * count + humps + 1]))


@lru_cache(maxsize=256)
def _solution(humps: int, tolerance: float, damping: float) -> _State:
    """Follow the solution from the undamped closed form to `damping`."""
    state, z = _undamped(humps, tolerance), 0.0
    before, z_before, step = state, 0.0, FIRST_STEP
    while z < damping:
        target = min(z + step, damping)
        slope = (state.vector() - before.vector()) / (z - z_before) if z > z_before else 0.0
        found = _newton(state.vector() + slope * (target - z), humps, tolerance, target)
        if found is None:
            step /= 2.0
            if step < SMALLEST_STEP:
                raise InputError(
                    f"no {humps}-hump EI shaper with tolerance {tolerance:g} exists at damping {damping:g}: its humps "
                    f"end near damping {z:.2g}; use a smaller tolerance, fewer humps, or zvd."
                )
        else:
            before, z_before, state, z = state, z, found, target
            step = min(1.5 * step, LARGEST_STEP)
    return state


def equal_humps(humps: int, tolerance: float, damping: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times [undamped periods] from 0 and amplitudes [-] of the k-hump EI shaper.

    Parameters
    ----------
    humps : int
        k, at least 1.
    tolerance : float
        Hump height [-] in (0, 1).
    damping : float
        Damping ratio [-] in [0, 1).

    Raises
    ------
    InputError
        If no such shaper exists at this damping.
    """
    state = _solution(humps, tolerance, damping)
    return state.times - state.times[0], state.amplitudes / state.amplitudes.sum()


def _undamped(humps: int, tolerance: float) -> _State:
    """The Chebyshev closed form."""
    n = humps + 1
    stretch = math.cosh(math.acosh(1.0 / tolerance) / n)
    angles = np.pi * np.arange(4 * n) / (2 * n)
    values = tolerance * np.polynomial.chebyshev.chebval(stretch * np.cos(angles), [0.0] * n + [1.0])
    amplitudes = np.array([np.mean(values * np.cos((n - 2 * i) * angles)) for i in range(n + 1)])
    zeros = np.arccos(np.cos(np.pi * (np.arange(1, n + 1) - 0.5) / n) / stretch)
    tops = np.arccos(np.cos(np.pi * np.arange(1, n) / n) / stretch)
    return _State((np.arange(n + 1) - n) / 2.0, amplitudes, zeros * 2.0 / np.pi, tops * 2.0 / np.pi)


def _newton(start: NDArray[np.float64], humps: int, tolerance: float, damping: float) -> _State | None:
    """Newton's method at one damping; None when it does not converge to a positive, ordered shaper."""
    rate = 2.0 * np.pi * complex(damping, math.sqrt(1.0 - damping**2))
    free = np.ones(start.size, dtype=bool)
    free[humps + 1] = False  # the last impulse is the origin of time
    middle = humps // 2
    free[2 * (humps + 2) + middle + (0 if humps % 2 == 0 else humps + 1)] = False
    vector = start.copy()
    for _ in range(MAXIMUM_ITERATIONS):
        state = _State.from_vector(vector, humps)
        ordered = np.diff(state.times).min() > 0.0 and 0.0 < state.zeros.min() and state.zeros.max() < HIGHEST_ZERO
        if not (np.isfinite(vector).all() and ordered and state.amplitudes.min() > 0.0):
            return None
        equations, jacobian = _equations(state, tolerance, rate)
        if float(np.abs(equations).max()) < SOLVED + np.finfo(float).eps / tolerance * 8.0:
            between = np.sort(np.concatenate([state.zeros, state.humps]))
            return state if (np.diff(between) > 0.0).all() and (np.diff(state.zeros) > 0.0).all() else None
        vector[free] -= np.linalg.lstsq(jacobian[:, free], equations, rcond=1e-14)[0]
    return None


def _equations(state: _State, tolerance: float, rate: complex) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The equations and their derivatives by every entry of the state's vector."""
    t, a, zeros, tops = state.times, state.amplitudes, state.zeros, state.humps
    count, n, k = t.size, zeros.size, tops.size
    wave_zero = np.exp(rate * np.multiply.outer(zeros, t))
    wave_top = np.exp(rate * np.multiply.outer(tops, t))
    factor = rate * t
    at_zero, top, slope = wave_zero @ a, wave_top @ a, wave_top @ (a * factor)
    curve = wave_top @ (a * factor**2)
    scale = 1.0 / tolerance**2
    equations = np.concatenate(
        [
            at_zero.real,
            at_zero.imag,
            scale * np.abs(top) ** 2 - 1.0,
            2.0 * scale * (top.conj() * slope).real,
            [a.sum() - 1.0],
        ]
    )

    zero_columns = np.zeros((n, 2 * count + n + k), dtype=complex)
    zero_columns[:, :count] = wave_zero * a * rate * zeros[:, None]
    zero_columns[:, count : 2 * count] = wave_zero
    zero_columns[:, 2 * count : 2 * count + n] = np.diag(wave_zero @ (a * factor))
    top_columns = np.zeros((k, 2 * count + n + k), dtype=complex)
    top_columns[:, :count] = wave_top * a * rate * tops[:, None]
    top_columns[:, count : 2 * count] = wave_top
    top_columns[:, 2 * count + n :] = np.diag(slope)
    slope_columns = np.zeros_like(top_columns)
    slope_columns[:, :count] = wave_top * a * rate * (1.0 + factor * tops[:, None])
    slope_columns[:, count : 2 * count] = wave_top * factor
    slope_columns[:, 2 * count + n :] = np.diag(curve)
    sum_row = np.zeros((1, 2 * count + n + k))
    sum_row[0, count : 2 * count] = 1.0
    height = 2.0 * scale * (top.conj()[:, None] * top_columns).real
    flat = 2.0 * scale * (top_columns.conj() * slope[:, None] + top.conj()[:, None] * slope_columns).real
    return equations, np.vstack([zero_columns.real, zero_columns.imag, height, flat, sum_row])
