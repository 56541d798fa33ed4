"""An independent judge of time-optimal moves: the farthest move in a time, as a plain linear programme by HiGHS.

Levels are constant on an even grid. Outputs are kept on the grid and between its nodes, so what it finds may exceed
limits a little between samples; and what it misses, by its coarse levels, is little as well.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import linprog

from preshape.band import Band
from preshape.command.rest_to_rest import RestToRest
from preshape.mode import Mode
from preshape.plant import FlexibleBody

Matrix = NDArray[np.float64]

SIDES = 16
"""Of the polygon inside the circle that vibration is kept in."""


def left_by_levels(mode: Mode, times: Matrix) -> NDArray[np.complex128]:
    """What a unit level in each interval leaves of a mode, relative to one step."""
    waves = np.exp(np.conj(mode.pole) * (times[-1] - times))
    return np.asarray(waves[:-1] - waves[1:])


def step_response(mode: Mode, static: float, lag: Matrix) -> Matrix:
    """Of d'' + 2 z w d' + w^2 d = w^2 static from rest at 0, and nothing before [m]."""
    since = np.maximum(lag, 0.0)
    decay, turn = np.exp(-mode.damping * mode.omega * since), mode.omega * np.sqrt(1.0 - mode.damping**2) * since
    slope = mode.damping / np.sqrt(1.0 - mode.damping**2)
    return np.asarray(static * (1.0 - decay * (np.cos(turn) + slope * np.sin(turn))))


def deflections_by_steps(move: RestToRest, times: Matrix) -> Matrix:
    """The modes' deflections under a move [m], shape (mode, time)."""
    steps = np.diff(move.levels, prepend=0.0, append=0.0)
    lag = np.subtract.outer(times, move.switch_times)
    statics = move.body.static_deflections(1.0)
    return np.array(
        [step_response(mode, static, lag) @ steps for mode, static in zip(move.body.modes, statics, strict=True)]
    )


def deflections_by_levels(body: FlexibleBody, force: float, times: Matrix, samples: int) -> Matrix:
    """The modes' deflections [m] at samples of an even grid under unit levels: (mode, sample, level)."""
    count = times.size - 1
    moments = np.arange(1, count * samples + 1) * times[-1] / (count * samples)
    found = []
    for mode, static in zip(body.modes, body.static_deflections(force), strict=True):
        responses = step_response(mode, static, np.subtract.outer(moments, times))
        found.append(responses[:, :-1] - responses[:, 1:])
    return np.array(found)


def farthest_distance(
    body: FlexibleBody,
    force: float,
    duration: float,
    *,
    weights: Matrix | None = None,
    limits: Sequence[float] = (),
    bands: Sequence[Band] = (),
    tolerance: float = 0.05,
    intervals: int = 300,
    samples: int = 2,
) -> float:
    """How far [m] a move from rest to rest in `duration` [s] can go, about."""
    times = np.linspace(0.0, duration, intervals + 1)
    step = duration / intervals
    rest = [np.full(intervals, 1.0 / intervals)]
    for mode in body.modes:
        left = left_by_levels(mode, times)
        rest += [left.real, left.imag]
    rows, sides = [np.zeros((1, intervals))], [np.zeros(1)]
    if limits:
        outputs = np.eye(len(body.modes)) if weights is None else weights
        shown = np.tensordot(outputs, deflections_by_levels(body, force, times, samples), axes=1)
        for output, limit in zip(shown, limits, strict=True):
            if np.isfinite(limit):
                rows += [output / limit, -output / limit]
                sides += [np.ones(2 * output.shape[0])]
    for band in bands:
        for frequency in np.linspace(band.low, band.high, 3 + int(8.0 * (band.high - band.low) * duration)):
            left = left_by_levels(Mode(float(frequency), band.least_damping), times)
            angles = np.exp(-2j * np.pi * np.arange(SIDES) / SIDES)
            rows.append(np.real(np.multiply.outer(angles, left)))
            sides.append(np.full(SIDES, tolerance * np.cos(np.pi / SIDES)))
    middle = duration - 0.5 * (times[:-1] + times[1:])
    found = linprog(
        -middle * step / duration**2,
        A_ub=np.concatenate(rows),
        b_ub=np.concatenate(sides),
        A_eq=np.array(rest),
        b_eq=np.zeros(len(rest)),
        bounds=(-1.0, 1.0),
        method="highs-ipm",
    )
    assert found.status == 0, found.message
    return float(-found.fun) * duration**2 * force / body.mass
