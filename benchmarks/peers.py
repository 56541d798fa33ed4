"""What anybody would do with SciPy instead: a bisection of linear programmes on a mesh, and sequential programming."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape import Modes, design

__all__ = ["Sequential", "interior_point_bisection", "sequential", "shortest_by_slsqp", "zero_vibration"]

MESH_PER_PERIOD = 16
WIDTH = 1e-3
"""The bisection stops at this relative width: a finer one costs in proportion to its logarithm."""


def interior_point_bisection(modes: Modes, give_up: float = math.inf) -> float:
    """The shortest ZVD-robust duration on a mesh [s], by HiGHS' interior point; it proves nothing.

    Each trial minimises the sum of what is missed, with orthonormal rows: on a plain feasibility problem the solver may
    run for ever.
    """
    from scipy.optimize import linprog

    fastest = max(mode.frequency for mode in modes)
    low, high = 0.0, design.zvd(modes).duration
    while high - low > WIDTH * high:
        duration = 0.5 * (low + high)
        leads = np.linspace(0.0, duration, int(MESH_PER_PERIOD * fastest * duration) + 2)
        q, _ = np.linalg.qr(zero_vibration(modes, leads, duration)[0].T)
        m, n = q.shape[1], leads.size
        answer = linprog(
            np.concatenate([np.zeros(n), np.ones(2 * m)]),
            A_eq=np.block([[q.T, np.eye(m), -np.eye(m)], [np.ones((1, n)), np.zeros((1, 2 * m))]]),
            b_eq=np.append(np.zeros(m), 1.0),
            method="highs-ipm",
            options={"time_limit": min(give_up, 60.0)},
        )
        if answer.fun is None:
            return math.nan
        low, high = (low, duration) if float(answer.fun) < 1e-8 else (duration, high)
    return high


@dataclass(frozen=True)
class Sequential:
    """The best end of several starts of SLSQP.

    Parameters
    ----------
    duration : float
        Of the shortest shaper that meets the constraints [s]; infinite when none does.
    met : int
        How many starts ended at a shaper that meets them.
    amplitudes, leads : ndarray, shape (impulse,)
        The best shaper; the lead is the time before its last impulse [s].
    """

    duration: float
    met: int
    amplitudes: NDArray[np.float64]
    leads: NDArray[np.float64]


def sequential(
    count: int,
    scale: float,
    starts: int,
    constraints: list[dict[str, Any]],
    missed: Callable[[NDArray[np.float64]], float],
) -> Sequential:
    """SLSQP from seeded random starts, amplitudes and leads of `count` impulses free: x = (a_1.., u_2.. / scale).

    `constraints` are SciPy's, besides those every shaper has; `missed` says by how much x misses them at most, up to
    1e-9 counts as met.
    """
    from scipy.optimize import minimize

    random = np.random.default_rng(1991)
    order = np.zeros((count - 1, 2 * count - 1))
    order[:, count:] = np.eye(count - 1) - np.eye(count - 1, k=-1)
    last = np.append(np.zeros(2 * count - 2), 1.0)
    total = np.append(np.ones(count), np.zeros(count - 1))
    every: list[dict[str, Any]] = [
        {"type": "eq", "fun": lambda x: total @ x - 1.0, "jac": lambda x: total},
        {"type": "ineq", "fun": lambda x: order @ x, "jac": lambda x: order},
        *constraints,
    ]
    settings: dict[str, Any] = {
        "jac": lambda x: last,
        "method": "SLSQP",
        "bounds": [(0.0, 1.0)] * count + [(0.0, 2.0)] * (count - 1),
        "constraints": every,
        "options": {"maxiter": 300, "ftol": 1e-12},
    }

    def duration(x: NDArray[np.float64]) -> float:
        return float(x[-1])

    best, met = Sequential(math.inf, 0, np.zeros(0), np.zeros(0)), 0
    for _ in range(starts):
        leads = np.cumsum(random.uniform(0.2, 1.8, count - 1))
        x = np.concatenate([random.dirichlet(np.full(count, 3.0)), leads * (random.uniform(0.8, 1.1) / leads[-1])])
        answer = minimize(duration, x, **settings)
        if max(missed(answer.x), abs(float(total @ answer.x) - 1.0)) < 1e-9 and answer.x.min() >= -1e-9:
            met += 1
            if answer.x[-1] * scale < best.duration:
                ends = np.append(0.0, answer.x[count:]) * scale
                best = Sequential(float(answer.x[-1]) * scale, met, answer.x[:count], ends)
    return Sequential(best.duration, met, best.amplitudes, best.leads)


def shortest_by_slsqp(modes: Modes, starts: int) -> Sequential:
    """Zero vibration and zero slope at all modes with 2 m + 3 impulses, analytic derivatives."""
    count, scale = 2 * len(modes) + 3, design.zvd(modes).duration

    def equations(x: NDArray[np.float64]) -> NDArray[np.float64]:
        missed: NDArray[np.float64] = zero_vibration(modes, np.append(0.0, x[count:]) * scale, scale)[0] @ x[:count]
        return missed

    def slopes(x: NDArray[np.float64]) -> NDArray[np.float64]:
        rows, changes = zero_vibration(modes, np.append(0.0, x[count:]) * scale, scale)
        return np.concatenate([rows, (changes * x[:count] * scale)[:, 1:]], axis=1)

    constraint = {"type": "eq", "fun": equations, "jac": slopes}
    return sequential(count, scale, starts, [constraint], lambda x: float(np.abs(equations(x)).max()))


def zero_vibration(
    modes: Modes, leads: NDArray[np.float64], scale: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """exp(-s u) and (u / scale) exp(-s u) of every mode, real and imaginary parts, and their derivatives by u [1/s]."""
    rows, changes = [], []
    for mode in modes:
        rate = np.conj(mode.pole)
        wave = np.exp(rate * leads)
        for value, change in ((wave, rate * wave), (wave * leads / scale, (rate * leads + 1.0) * wave / scale)):
            rows += [value.real, value.imag]
            changes += [change.real, change.imag]
    return np.array(rows), np.array(changes)
