"""The proved shortest rest-to-rest move against a bisection of linear programmes on a grid of levels."""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from numpy.typing import NDArray
from timing import best_of, once, row

from preshape.command.rest_to_rest import time_optimal
from preshape.plant import FlexibleBody

INTERVALS = 240
WIDTH = 1e-4
"""The bisection stops at this relative width of the duration."""

ONE = FlexibleBody(2.0, (math.sqrt(2.0) / (2.0 * math.pi), 0.0), 1.0)
"""Two masses of 1 kg on a spring of 1 N/m: Robertson's oscillator."""

FOUR = FlexibleBody(1.0, [(0.4, 0.0), (0.9, 0.02), (1.7, 0.0), (2.6, 0.05)], [1.0, 2.0, -0.5, 3.0])
TWO = FlexibleBody(2.0, [(0.2, 0.0), (0.5, 0.01)], [1.0, -0.3])

CASES: list[tuple[str, FlexibleBody, float, tuple[float, ...]]] = [
    ("one mode, held at 0.6 of the static deflection (closed form, proved)", ONE, 10.0, (0.3,)),
    ("one mode, limit above the static deflection (searched)", ONE, 10.0, (0.7,)),
    ("four modes, no limits", FOUR, 10.0, ()),
    ("two modes, both limited", TWO, 5.0, (0.8, 0.05)),
]


def main() -> None:
    """Compare; ours has a bound, and the peer's grid never beats it by more than its sampling."""
    for what, body, distance, limits in CASES:
        asked = limits or None
        move = time_optimal(body, distance, maximum_force=1.0, deflection_limits=asked)
        assert move.gap is not None and move.gap < 1e-3
        ours = partial(time_optimal, body, distance, maximum_force=1.0, deflection_limits=asked)
        seconds = best_of(ours, runs=3)
        grid, theirs = once(partial(bisection, body, distance, limits))
        difference = 100.0 * (grid / move.duration - 1.0)
        assert difference > -0.2
        row(
            f"{what}: {move.duration:.6f} s, {move.status}, gap {move.gap:.0e}",
            seconds,
            f"HiGHS bisection to 1e-4 on {INTERVALS} levels ({difference:+.3f} %, no proof)",
            theirs,
            "claim: faster, and proved",
        )


def bisection(body: FlexibleBody, distance: float, limits: tuple[float, ...]) -> float:
    """The duration in which levels on an even grid just get as far [s]; outputs are kept at the nodes."""
    low = 2.0 * math.sqrt(distance * body.mass)
    high = low
    while farthest(body, high, limits) < distance:
        low, high = high, 1.3 * high
    while high - low > WIDTH * high:
        middle = 0.5 * (low + high)
        low, high = (low, middle) if farthest(body, middle, limits) >= distance else (middle, high)
    return high


def farthest(body: FlexibleBody, duration: float, limits: tuple[float, ...]) -> float:
    """How far levels on the grid get in a duration [m]."""
    from scipy.optimize import linprog

    times = np.linspace(0.0, duration, INTERVALS + 1)
    rest, kept = [np.full(INTERVALS, 1.0 / INTERVALS)], []
    for number, (mode, static) in enumerate(zip(body.modes, body.static_deflections(1.0), strict=True)):
        waves = np.exp(mode.pole * (duration - times))
        left = waves[:-1] - waves[1:]
        rest += [left.real, left.imag]
        if limits:
            response = step_response(np.subtract.outer(times[1:], times), mode.omega, mode.damping)
            kept.append(static / limits[number] * (response[:, :-1] - response[:, 1:]))
    answer = linprog(
        -(duration - 0.5 * (times[:-1] + times[1:])) / INTERVALS / duration,
        A_ub=np.concatenate([*kept, *(-rows for rows in kept)]) if kept else None,
        b_ub=np.ones(2 * len(kept) * INTERVALS) if kept else None,
        A_eq=np.array(rest),
        b_eq=np.zeros(len(rest)),
        bounds=(-1.0, 1.0),
        method="highs-ipm",
    )
    assert answer.fun is not None, answer.message
    return -float(answer.fun) * duration**2 / body.mass


def step_response(lag: NDArray[np.float64], omega: float, damping: float) -> NDArray[np.float64]:
    """Of a mode in static deflections [-]."""
    since, root = np.maximum(lag, 0.0), math.sqrt(1.0 - damping**2)
    angle = omega * root * since
    wave = np.cos(angle) + damping / root * np.sin(angle)
    return np.asarray(1.0 - np.exp(-damping * omega * since) * wave)


if __name__ == "__main__":
    main()
