"""Hyde, section 6.2, on his non-linear MACE model: shapers that follow the payload's angle during the slew of 120 deg.

The gimbal is commanded at constant speed instead of by a step: of a step there is only one increment, and it goes
through the shaper of the beginning, whatever is tracked later. The angle that is tracked is what the payload did in the
run before; a second pass moves it by less than a degree.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape import Shaper
from preshape.design import direct, specified_insensitivity
from preshape.mode import Modes
from preshape.papers.hyde.chapter5_identified import article
from preshape.papers.hyde.chapter5_slews import DT, END, OURS, SETTLED, residual
from preshape.plant import Simulation
from preshape.stream import Schedule, Stream

__all__ = ["ANGLES", "Follow", "SLEW", "follow"]

ANGLES = tuple(float(angle) for angle in range(-60, 61, 20))
"""Where the model is linearised [deg]."""

SLEW = 2.0
"""Duration of the commanded turn [s]."""

CALLS = 10
"""Samples between two calls of `track`."""

SAME = 1e-4
"""Tolerance of the tracking [-]: once the payload hardly turns, the shaper stays."""


@dataclass(frozen=True, eq=False)
class Follow:
    """What is left of each slew.

    Attributes
    ----------
    modes : mapping of float to Modes
        Fundamental and fastest mode up to 30 Hz, closed loop, by payload angle [deg].
    left : mapping of str to float
        By method: the far end's swing after 6 s, peak to peak [m].
    durations : mapping of str to float
        Of the shapers [s]; of one that changes, the longest.
    settled : float
        How far the payload's path of the last pass is from the one tracked [deg].
    angles : ndarray, shape (sample,)
        That path [deg], at the samples of :data:`DT`.
    """

    modes: Mapping[float, Modes]
    left: Mapping[str, float]
    durations: Mapping[str, float]
    settled: float
    angles: NDArray[np.float64]


def follow() -> Follow:
    """The modes on the way, then every slew."""
    modes = {angle: _vibrating(angle) for angle in ANGLES}
    table = Schedule(modes, outside="hold")
    times = DT * np.arange(round(END / DT) + 1, dtype=float)
    command = 2.0 * math.radians(60.0) * np.minimum(times / SLEW, 1.0)
    shapers = {
        "unshaped": Shaper([0.0], [1.0]),
        "fixed, outboard": direct(modes[-60.0]),
        "fixed, vertical": direct(modes[0.0]),
        "fixed, inboard": direct(modes[60.0]),
        "fixed, vertical, order 2": direct(modes[0.0], 2),
        "band of all, 2 %": specified_insensitivity(_bands(modes), OURS),
    }
    left, durations, path, settled = {}, {}, np.zeros(0), 0.0
    for name, shaper in shapers.items():
        done = _slewed(np.asarray(shaper.shape(command, DT)))
        left[name], durations[name] = residual(done, SETTLED), shaper.duration
        path = _turned(done) if name == "unshaped" else path
    for name, order, passes in (("tracked", 1, 2), ("tracked, order 2", 2, 1)):
        for _ in range(passes):
            shaped, durations[name] = _tracked(command, table, path, order)
            done = _slewed(shaped)
            before, path = path, _turned(done)
            settled = float(np.abs(path - before).max()) if order == 1 else settled
        left[name] = residual(done, SETTLED)
    return Follow(modes, left, durations, settled, path)


def _vibrating(angle: float) -> Modes:
    """Hyde's two (5.3.5): what lies between is damped away, or not excited from the gimbal."""
    found = article(0.0).modes(math.radians(angle))
    return Modes([found[0], found[-1]])


def _bands(modes: Mapping[float, Modes]) -> list[tuple[float, float, float, float]]:
    bands = []
    for k in (0, 1):
        frequencies = [each[k].frequency for each in modes.values()]
        dampings = [each[k].damping for each in modes.values()]
        bands.append((min(frequencies), max(frequencies), min(dampings), max(dampings)))
    return bands


def _slewed(shaped: NDArray[np.float64]) -> Simulation:
    plant = article(-60.0)
    return plant.simulate(shaped[: round(END / DT) + 1] + plant.angle, DT, step=DT)


def _turned(done: Simulation) -> NDArray[np.float64]:
    return np.degrees(done.outputs["payload angle"])


def _tracked(
    command: NDArray[np.float64], table: Schedule, path: NDArray[np.float64], order: int
) -> tuple[NDArray[np.float64], float]:
    """The command through a shaper that follows the angle, and the longest shaper [s]."""
    stream = Stream(direct(table.modes(ANGLES[0]), order), DT)
    shaped, longest = np.empty_like(command), stream.latency
    for start in range(0, command.size, CALLS):
        if start * DT <= SLEW:  # afterwards nothing is commanded
            found = stream.track(table.modes(path[start]), tolerance=SAME)
            longest = max(longest, found.shaper.duration)
        part = slice(start, start + CALLS)
        stream.push_block(command[part], out=shaped[part])
    return shaped, longest
