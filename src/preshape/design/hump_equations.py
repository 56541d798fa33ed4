"""The hump equations of a k-hump EI shaper at any damping, solved by Newton's method from the undamped closed form.

Time in periods, frequency as the ratio x to the mode's. Unknown are k + 2 amplitudes, their times, n = k + 1 zeros and
k humps; the middle hump (k odd) or the middle zero (k even) stays at x = 1:
  V(zero) = 0 (real and imaginary part);  V(hump) = tolerance, V'(hump) = 0;  amplitudes sum to 1.
Solutions are followed from z = 0 along their curve (pseudo-arclength continuation: for high tolerances the damping
turns back on it and forth again). The curve ends where the highest zero runs to infinity and the last two impulses
merge: at more damping than it has reached by then there is no such shaper, and we say so.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError

__all__ = ["equal_humps"]

FIRST_STEP, LARGEST_STEP, SMALLEST_STEP = 0.02, 0.1, 1e-7
"""Steps along the curve of solutions, in units of its scaled length."""

MAXIMUM_STEPS = 2000

ZERO_WEIGHT = 0.05
"""Zeros move most and matter least: this much of their change counts as length of the curve."""

SOLVED, ROUNDING = 1e-12, 200.0 * np.finfo(float).eps
"""Largest error of the equations, humps relative to the tolerance, and what rounding adds to it over a tolerance."""

MAXIMUM_ITERATIONS = 12

HIGHEST_ZERO = 25.0
"""A zero at more than this multiple of the mode's frequency is none: the last two impulses are one, the curve ends."""


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
    """Follow the curve of solutions from the undamped closed form to the first point with this damping."""
    state, z = _undamped(humps, tolerance), 0.0
    if damping == 0.0:
        return state
    free, weights = _free(humps), _weights(humps)
    tangent, reached, step = np.append(np.zeros(int(free.sum())), 1.0), 0.0, FIRST_STEP
    for _ in range(MAXIMUM_STEPS):
        tangent = _tangent(state, tolerance, z, free, weights, tangent)
        found = _corrected(state, tolerance, z, free, weights, step * tangent)
        if found is None:
            step /= 2.0
            if step < SMALLEST_STEP:
                break
            continue
        if (z - damping) * (found[1] - damping) <= 0.0:
            part = (damping - z) / (found[1] - z)
            start = state.vector() + part * (found[0].vector() - state.vector())
            exact = _newton(start, humps, tolerance, damping)
            if exact is not None:
                return exact
            step /= 2.0
            continue
        state, z = found
        reached, step = max(reached, z), min(1.5 * step, LARGEST_STEP)
    raise InputError(
        f"no {humps}-hump EI shaper with tolerance {tolerance:g} exists at damping {damping:g}: its humps end near "
        f"damping {reached:.2g}; use a smaller tolerance, fewer humps, or zvd."
    )


def _free(humps: int) -> NDArray[np.bool_]:
    """Which entries of the state's vector may move: not the last impulse, not the middle hump or zero."""
    free = np.ones(4 * (humps + 2) - 3, dtype=bool)
    free[humps + 1] = False
    free[2 * (humps + 2) + humps // 2 + (0 if humps % 2 == 0 else humps + 1)] = False
    return free


def _weights(humps: int) -> NDArray[np.float64]:
    """Scale of each free entry, and of the damping, in the length of the curve."""
    count = humps + 2
    weights = np.concatenate([np.ones(2 * count), np.full(humps + 1, ZERO_WEIGHT), np.ones(humps)])
    return np.append(weights[_free(humps)], 1.0)


def _extended(state: _State, tolerance: float, z: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The equations, and their derivatives by the state's vector and, last column, by the damping ratio."""
    equations, jacobian = _equations(state, tolerance, _rate(z))
    h = 1e-7
    ahead, _ = _equations(state, tolerance, _rate(z + h))
    behind, _ = _equations(state, tolerance, _rate(max(z - h, 0.0)))
    return equations, np.column_stack([jacobian, (ahead - behind) / (h + min(z, h))])


def _tangent(
    state: _State,
    tolerance: float,
    z: float,
    free: NDArray[np.bool_],
    weights: NDArray[np.float64],
    before: NDArray[np.float64],
) -> NDArray[np.float64]:
    """The unit direction of the curve in scaled entries, pointing on from `before`."""
    _, jacobian = _extended(state, tolerance, z)
    direction = np.linalg.svd(jacobian[:, np.append(free, True)] / weights)[2][-1]
    unit: NDArray[np.float64] = direction if direction @ before >= 0.0 else -direction
    return unit


def _corrected(
    state: _State,
    tolerance: float,
    z: float,
    free: NDArray[np.bool_],
    weights: NDArray[np.float64],
    move: NDArray[np.float64],
) -> tuple[_State, float] | None:
    """The point of the curve in the plane across `move` (scaled entries) at its end; None when there is none near."""
    humps = state.humps.size
    vector, damping = state.vector(), z
    vector[free] += move[:-1] / weights[:-1]
    damping += move[-1] / weights[-1]
    for _ in range(MAXIMUM_ITERATIONS):
        now = _State.from_vector(vector, humps)
        if not (0.0 <= damping < 1.0 and _ordered(now)):
            return None
        equations, jacobian = _extended(now, tolerance, damping)
        if float(np.abs(equations).max()) < _solved_below(tolerance):
            return now, damping
        system = np.vstack([jacobian[:, np.append(free, True)] / weights, move / np.linalg.norm(move)])
        change = np.linalg.lstsq(system, np.append(equations, 0.0), rcond=1e-14)[0] / weights
        vector[free] -= change[:-1]
        damping -= change[-1]
    return None


def _solved_below(tolerance: float) -> float:
    return SOLVED + ROUNDING / tolerance


def _rate(damping: float) -> complex:
    """The mode's rate z w + i w sqrt(1 - z^2) for a period of one."""
    return 2.0 * math.pi * complex(damping, math.sqrt(1.0 - damping**2))


def _ordered(state: _State) -> bool:
    """Whether this is a shaper at all: finite, impulses in order, amplitudes positive, zeros and humps in turn."""
    turns = np.empty(state.zeros.size + state.humps.size)
    turns[::2], turns[1::2] = state.zeros, state.humps
    return bool(
        np.isfinite(state.vector()).all()
        and (np.diff(state.times) > 0.0).all()
        and (state.amplitudes > 0.0).all()
        and turns[0] > 0.0
        and (np.diff(turns) > 0.0).all()
        and turns[-1] < HIGHEST_ZERO
    )


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
    free, vector = _free(humps), start.copy()
    for _ in range(MAXIMUM_ITERATIONS):
        state = _State.from_vector(vector, humps)
        if not _ordered(state):
            return None
        equations, jacobian = _equations(state, tolerance, _rate(damping))
        if float(np.abs(equations).max()) < _solved_below(tolerance):
            return state
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
