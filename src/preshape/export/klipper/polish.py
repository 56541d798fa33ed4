"""From a shaper that is nearly best by Klipper's measures to the best one close by, times and amplitudes both free.

A sequential quadratic programme (SciPy's SLSQP) on the exact formulas and their derivatives. It finds a local optimum;
several starts, and the linear programme on a mesh, see to it that it is a good one.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.export.klipper.measure import Moving, VibrationMeasure, corner_deviations, slownesses

__all__ = ["Asked", "Pulses", "Room", "on_grid", "polished", "reduced"]

Vector = NDArray[np.float64]

KEPT_BACK = 1e-4
"""The optimiser aims this far inside the bounds, relatively, so that its own tolerance does not break them."""

CLOSEST = 0.01
"""Neighbouring impulses keep this part of the longest start's duration between them, or a sample of the grid."""

LEAST_SCALE = 1e-4
"""Vibration [-] below which differences are not looked for."""

NOTHING, MARGIN = 1e-5, 2e-3
"""Where less vibration than the first may remain, none may: the threshold is lowered by the second, so that what the
optimiser still leaves above it is below the true one."""

ROUNDS, PRECISION = 40, 1e-5

ROUNDING = 1e-9


@dataclass(frozen=True, eq=False)
class Pulses:
    """Times [s], increasing from 0, and amplitudes [-], positive with sum 1; shape (impulse,) each."""

    times: Vector
    amplitudes: Vector


@dataclass(frozen=True)
class Room:
    """What a controller leaves a shaper.

    Parameters
    ----------
    impulses : int
        At most so many.
    smallest : float
        Least amplitude [-].
    shortest, longest : float
        Durations [s].
    tail : float
        Longest time from the centroid to the last impulse [s]: Klipper measures vibration at the last impulse, and a
        later moment would look like an improvement.
    dt : float or None
        Time grid [s]; None: any times.
    """

    impulses: int
    smallest: float
    shortest: float
    longest: float
    tail: float
    dt: float | None = None

    def fits(self, pulses: Pulses) -> bool:
        """Whether it holds such a shaper."""
        duration = float(pulses.times[-1])
        enough = pulses.times.size <= self.impulses and pulses.amplitudes.min() >= self.smallest * (1.0 - ROUNDING)
        in_time = self.shortest * (1.0 - ROUNDING) <= duration <= self.longest * (1.0 + ROUNDING)
        early = duration - pulses.amplitudes @ pulses.times <= self.tail * (1.0 + ROUNDING)
        return bool(enough and in_time and early and self._on_grid(pulses.times))

    def _on_grid(self, times: Vector) -> bool:
        return self.dt is None or bool(np.abs(times / self.dt - np.round(times / self.dt)).max() < 1e-6)


@dataclass(frozen=True)
class Asked:
    """Bounds, and what to make small within them.

    Parameters
    ----------
    vibration : float or None
        At most so much may remain [-], and the highest acceleration is looked for; None: the least vibration is.
    smoothing : float
        At most [mm]; infinite for no bound.
    """

    vibration: float | None
    smoothing: float


def polished(start: Pulses, measure: VibrationMeasure, asked: Asked, room: Room, *, move: bool = True) -> Pulses | None:
    """The best shaper near `start` with as many impulses; None when the search broke down.

    Parameters
    ----------
    start : Pulses
        Need not meet the bounds.
    measure : VibrationMeasure
        Of the spectra.
    asked : Asked
        What to look for.
    room : Room
        Bounds on the impulses; their number is not changed.
    move : bool
        False: the times stay.
    """
    from scipy.optimize import minimize

    if asked.vibration is not None and asked.vibration < NOTHING:
        measure, asked = measure.stricter(MARGIN), replace(asked, vibration=0.1 * NOTHING)
    problem = _Problem(start, measure, asked, room, move)
    settings: dict[str, Any] = {
        "jac": problem.pressed_slope,
        "method": "SLSQP",
        "bounds": problem.bounds,
        "constraints": [
            {"type": "ineq", "fun": problem.slack, "jac": problem.slopes},
            {"type": "eq", "fun": problem.sum_to_one, "jac": problem.sum_slope},
        ],
        "options": {"maxiter": ROUNDS, "ftol": PRECISION},
    }
    with warnings.catch_warnings():  # a step outside the bounds is clipped, and SciPy says so each time
        warnings.filterwarnings("ignore", "Values in x were outside bounds", RuntimeWarning)
        found = minimize(problem.pressed, problem.first, **settings)
    if not np.isfinite(found.x).all():
        return None
    times, amplitudes = problem.split(found.x)
    if amplitudes.min() <= 0.0 or np.diff(times).min(initial=np.inf) <= 0.0:
        return None
    return Pulses(times, amplitudes / amplitudes.sum())


class _Problem:
    """Variables: times after the first by the unit, amplitudes, and the bound that is pressed down."""

    def __init__(self, start: Pulses, measure: VibrationMeasure, asked: Asked, room: Room, move: bool) -> None:
        n = start.times.size
        self.n, self.measure, self.asked, self.room = n, measure, asked, room
        self.unit = float(start.times[-1])
        left = float(measure.left(start.times, start.amplitudes).values.max())
        self.vibration_scale = max(left if asked.vibration is None else asked.vibration, LEAST_SCALE)
        self.slowness_scale = float(slownesses(start.times, start.amplitudes).values.max())
        self.gap = CLOSEST if room.dt is None else max(room.dt / self.unit, 1e-9)
        later = start.times[1:] / self.unit
        span = [(0.0, room.longest / self.unit)] * (n - 1) if move else [(one, one) for one in later.tolist()]
        self.bounds = [*span, *[(room.smallest, 1.0)] * n, (0.0, None)]
        self.moves = move
        amplitudes = np.maximum(start.amplitudes, room.smallest)
        pressed = left / self.vibration_scale if asked.vibration is None else 1.0
        self.first = np.concatenate([later, amplitudes / amplitudes.sum(), [pressed]])
        self.last = np.zeros(2 * n)
        self.last[-1] = 1.0
        self.ones = np.zeros((1, 2 * n))
        self.ones[0, n - 1 : 2 * n - 1] = 1.0
        self.known: tuple[bytes, Vector, Vector] | None = None

    def split(self, x: Vector) -> tuple[Vector, Vector]:
        return np.concatenate([[0.0], x[: self.n - 1]]) * self.unit, x[self.n - 1 : 2 * self.n - 1]

    def pressed(self, x: Vector) -> float:
        return float(x[-1])

    def pressed_slope(self, x: Vector) -> Vector:
        return self.last

    def sum_slope(self, x: Vector) -> Vector:
        return self.ones

    def sum_to_one(self, x: Vector) -> Vector:
        return np.array([x[self.n - 1 : 2 * self.n - 1].sum() - 1.0])

    def slack(self, x: Vector) -> Vector:
        return self._evaluated(x)[0]

    def slopes(self, x: Vector) -> Vector:
        return self._evaluated(x)[1]

    def _evaluated(self, x: Vector) -> tuple[Vector, Vector]:
        """Slack of every inequality, and its derivatives; SLSQP asks for both at the same point."""
        key = x.tobytes()
        if self.known is None or self.known[0] != key:
            times, amplitudes = self.split(x)
            parts = [*self._bounds_on_measures(times, amplitudes, float(x[-1])), *self._bounds_on_times(x, times)]
            self.known = key, np.concatenate([part[0] for part in parts]), np.vstack([part[1] for part in parts])
        return self.known[1], self.known[2]

    def _bounds_on_measures(self, t: Vector, a: Vector, pressed: float) -> list[tuple[Vector, Vector]]:
        asked, parts = self.asked, []
        vibration = self.measure.left(t, a)
        if asked.vibration is None:
            parts.append(self._below(vibration, self.vibration_scale, pressed, 1.0))
        else:
            most = asked.vibration * (1.0 - KEPT_BACK) / self.vibration_scale
            parts.append(self._below(vibration, self.vibration_scale, most, 0.0))
            parts.append(self._below(slownesses(t, a), self.slowness_scale, pressed, 1.0))
        if asked.smoothing < np.inf:
            parts.append(self._below(corner_deviations(t, a), asked.smoothing, 1.0 - KEPT_BACK, 0.0))
        return parts

    def _below(self, moving: Moving, scale: float, bound: float, follows: float) -> tuple[Vector, Vector]:
        """bound - quantity / scale >= 0; `follows` is the bound's derivative by what is pressed down."""
        rows = np.zeros((moving.values.size, 2 * self.n))
        rows[:, : self.n - 1] = -moving.by_time[:, 1:] * (self.unit / scale)
        rows[:, self.n - 1 : 2 * self.n - 1] = -moving.by_amplitude / scale
        rows[:, -1] = follows
        return bound - moving.values / scale, rows

    def _bounds_on_times(self, x: Vector, times: Vector) -> list[tuple[Vector, Vector]]:
        n, unit = self.n, self.unit
        amplitudes = x[n - 1 : 2 * n - 1]
        tail = np.zeros((1, 2 * n))
        tail[0, : n - 1] = amplitudes[1:]
        tail[0, n - 2] -= 1.0
        tail[0, n - 1 : 2 * n - 1] = times / unit
        late = np.array([(self.room.tail * (1.0 - KEPT_BACK) - times[-1] + amplitudes @ times) / unit])
        ends = [(late, tail)] if self.room.tail < np.inf else []
        if not self.moves:
            return ends
        gaps = np.zeros((n, 2 * n))
        gaps[np.arange(n - 1), np.arange(n - 1)] = 1.0
        gaps[np.arange(1, n - 1), np.arange(n - 2)] = -1.0
        gaps[-1, n - 2] = 1.0
        apart = np.diff(times) / unit - self.gap
        long_enough = (times[-1] - self.room.shortest) / unit
        return [*ends, (np.append(apart, long_enough), gaps)]


def reduced(pulses: Pulses, most: int, smallest: float) -> Pulses:
    """At most so many impulses, none too small: the smallest joins its nearer neighbour, the centroid kept."""
    times, amplitudes = pulses.times.tolist(), pulses.amplitudes.tolist()
    while len(times) > 2 and (len(times) > most or min(amplitudes) < smallest):
        i = int(np.argmin(amplitudes))
        if i == 0 or (i < len(times) - 1 and times[i + 1] - times[i] < times[i] - times[i - 1]):
            i += 1  # the pair (i - 1, i) becomes one
        mass = amplitudes[i - 1] + amplitudes[i]
        middle = (amplitudes[i - 1] * times[i - 1] + amplitudes[i] * times[i]) / mass
        times[i - 1 : i + 1], amplitudes[i - 1 : i + 1] = [middle], [mass]
    t, a = np.array(times), np.array(amplitudes)
    return Pulses(t - t[0], a / a.sum())


def on_grid(pulses: Pulses, measure: VibrationMeasure, asked: Asked, room: Room) -> Pulses | None:
    """The times on the room's grid, the amplitudes the best for them; impulses that meet become one."""
    if room.dt is None:
        return pulses
    samples, which = np.unique(np.round(pulses.times / room.dt), return_inverse=True)
    if samples.size < 2:
        return None
    placed = Pulses(samples * room.dt, np.bincount(which, pulses.amplitudes).astype(np.float64))
    return polished(placed, measure, asked, replace(room, longest=np.inf), move=False)
