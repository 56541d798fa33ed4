"""The certified shortest shaper for four modes against a general linear-programme solver and sequential programming."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from timing import best_of, once, row

from preshape import Modes, design

MODES = [(1.65, 0.01), (5.42, 0.01), (6.90, 0.01), (19.08, 0.01)]
STARTS = 20
MET = 1e-9


def bisection() -> float:
    """HiGHS' interior point on a mesh, bisected to 1e-3; proves nothing [s]."""
    from scipy.optimize import linprog

    modes = Modes(MODES)
    low, high = 0.0, design.zvd(MODES).duration
    while high - low > 1e-3 * high:
        duration = 0.5 * (low + high)
        times = np.linspace(0.0, duration, int(16 * 19.08 * duration) + 2)
        q, _ = np.linalg.qr(_rows(modes, times, duration).T)
        m, n = q.shape[1], times.size
        answer = linprog(
            np.concatenate([np.zeros(n), np.ones(2 * m)]),
            A_eq=np.block([[q.T, np.eye(m), -np.eye(m)], [np.ones((1, n)), np.zeros((1, 2 * m))]]),
            b_eq=np.append(np.zeros(m), 1.0),
            method="highs-ipm",
            options={"time_limit": 20.0},
        )
        low, high = (low, duration) if float(np.asarray(answer.fun)) < 1e-8 else (duration, high)
    return high


def sequential() -> float:
    """SLSQP with free times and amplitudes of 2 m + 3 impulses, the best of the starts that meet the equations [s]."""
    from scipy.optimize import minimize

    modes, count = Modes(MODES), 2 * len(MODES) + 3
    scale = design.zvd(MODES).duration
    random = np.random.default_rng(1991)
    best = np.inf
    gaps = np.zeros((count - 1, 2 * count - 1))
    gaps[:, count:] = np.eye(count - 1) - np.eye(count - 1, k=-1)
    goal = np.append(np.zeros(2 * count - 2), 1.0)

    def equations(x: NDArray[np.float64]) -> NDArray[np.float64]:
        leads = np.append(0.0, x[count:]) * scale
        return np.append(_lead_rows(modes, leads, scale)[0] @ x[:count], x[:count].sum() - 1.0)

    def slopes(x: NDArray[np.float64]) -> NDArray[np.float64]:
        rows, changes = _lead_rows(modes, np.append(0.0, x[count:]) * scale, scale)
        top = np.concatenate([rows, (changes * x[:count] * scale)[:, 1:]], axis=1)
        return np.vstack([top, np.append(np.ones(count), np.zeros(count - 1))])

    settings: dict[str, Any] = {
        "jac": lambda x: goal,
        "method": "SLSQP",
        "bounds": [(0.0, 1.0)] * count + [(0.0, 2.0)] * (count - 1),
        "constraints": [
            {"type": "eq", "fun": equations, "jac": slopes},
            {"type": "ineq", "fun": lambda x: gaps @ x, "jac": lambda x: gaps},
        ],
        "options": {"maxiter": 300, "ftol": 1e-12},
    }
    for _ in range(STARTS):
        leads = np.cumsum(random.uniform(0.2, 1.8, count - 1))
        x = np.concatenate([random.dirichlet(np.full(count, 3.0)), leads * (random.uniform(0.8, 1.1) / leads[-1])])
        answer = minimize(_last, x, **settings)
        if np.abs(equations(answer.x)).max() < MET and (answer.x[:count] >= -MET).all():
            best = min(best, float(answer.x[-1]) * scale)
    return best


def _last(x: NDArray[np.float64]) -> float:
    return float(x[-1])


def _rows(modes: Modes, times: NDArray[np.float64], duration: float) -> NDArray[np.float64]:
    return _lead_rows(modes, duration - times, duration)[0]


def _lead_rows(
    modes: Modes, leads: NDArray[np.float64], scale: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Value and slope of every mode's constraint, and their derivatives by the lead."""
    rows, changes = [], []
    for mode in modes:
        rate = np.conj(mode.pole)
        wave = np.exp(rate * leads)
        for value, change in (
            (wave, rate * wave),
            (wave * leads / scale, (rate * leads + 1.0) * wave / scale),
        ):
            rows += [value.real, value.imag]
            changes += [change.real, change.imag]
    return np.array(rows), np.array(changes)


def main() -> None:
    """Compare; ours is proved and never longer."""
    shaper = design.direct(MODES)
    ours = best_of(lambda: design.direct(MODES), runs=5)
    assert shaper.design.status == "optimal" and abs(bisection() / shaper.duration - 1.0) < 3e-3
    row(
        "direct design, 4 modes, certified",
        ours,
        "HiGHS interior-point bisection to 1e-3",
        best_of(bisection, runs=2),
        "claim: under 6 ms, and proved",
    )
    found, seconds = once(sequential)
    assert found >= shaper.duration * (1.0 - 1e-6)
    row(
        "direct design, 4 modes, certified",
        ours,
        f"SLSQP, best of {STARTS} starts ({100.0 * (found / shaper.duration - 1.0):.2f} % longer)",
        seconds,
        "claim: >= 20, never longer",
    )
    every = [(1.01 * frequency, damping) for frequency, damping in MODES]
    row(
        "the same, warm: all modes moved by 1 %",
        best_of(lambda: design.direct(every, near=shaper)),
        "cold",
        best_of(lambda: design.direct(every), runs=3),
        "claim: under 0.5 ms",
    )
    random = np.random.default_rng(7)
    searched, times = 0, []
    for _ in range(20):
        moved = [(f * (1.0 + 0.01 * random.choice([-1.0, 1.0])), z) for f, z in MODES]
        again, seconds = once(lambda moved=moved: design.direct(moved, near=shaper))  # type: ignore[misc]
        times.append(seconds)
        searched += again.design.settings["start"] == "full"
    print(
        f"each mode moved by +-1 % on its own: median {1e3 * float(np.median(times)):.2f} ms, {searched} of 20 in full"
    )


if __name__ == "__main__":
    main()
