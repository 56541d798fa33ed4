"""Hyde, section 6.2: shapers that follow modes which sweep by +-20 % along a move, against shapers that stay.

The plant is :class:`preshape.plant.ChangingModes`. The command has constant speed, and the frequencies go with it; it
takes 8.5 mean periods, and the half makes the kicks at both ends add up, so that plain there is much to remove.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape import Shaper
from preshape.design import direct, specified_insensitivity, zv, zvd
from preshape.mode import ModesLike
from preshape.plant import ChangingModes
from preshape.stream import Schedule, Stream

__all__ = ["CENTRE", "DT", "MOVE", "SPREAD", "Sweep", "laws", "part_done", "sweep"]

CENTRE, SPREAD = (1.0, 2.7), 0.2
"""Middle of the frequencies [Hz] and how far they go to either side [-]; the first rises, the second falls."""

MOVE = 8.5
"""Duration of sweep and command [s]: that many mean periods of the first mode."""

DT, CALLS = 5e-3, 5e-2
"""Sample time, and time between two calls of `track` unless said otherwise [s]."""

REST = 4.0
"""Simulated after the move [s]; the last half of it is looked at."""

LATE, OFF = 0.2, 1.02
"""An estimate that is this late [s], or off by this factor."""

ROWS = 5
"""Of the table of the schedule, evenly along the move."""

TOLERANCE = 0.05
"""Of the band-insensitive shaper [-]."""

RATES = (0.01, 0.02, 0.04)
"""Change of the frequency within a period [-] at which the laws are measured."""

PARTS = 200
"""Samples a period there; every impulse falls on one."""

ModesAt = Callable[[float], ModesLike]


@dataclass(frozen=True)
class Sweep:
    """What each method leaves, relative to the plain command, and how long its shapers are.

    Attributes
    ----------
    plain : float
        What the plain command leaves, relative to the move [-].
    left : mapping of str to float
        By method, relative to that [-].
    durations : mapping of str to float
        By method [s]; of a shaper that changes, the longest.
    warm : float
        Part of all redesigns that needed no search [-].
    """

    plain: float
    left: Mapping[str, float]
    durations: Mapping[str, float]
    warm: float


def part_done(t: float) -> float:
    """The configuration: 0 before the move, 1 after it."""
    return min(max(t / MOVE, 0.0), 1.0)


def sweep(count: int) -> Sweep:
    """All methods on a plant of one mode or two."""
    study = _Study(count)
    middle = [(f, 0.0) for f in CENTRE[:count]]
    bands = [((1.0 - SPREAD) * f, (1.0 + SPREAD) * f) for f in CENTRE[:count]]
    study.fixed("fixed ZV", zv(middle))
    study.fixed("fixed ZVD", zvd(middle))
    study.fixed("fixed direct", direct(middle))
    study.fixed("fixed direct, order 2", direct(middle, 2))
    study.fixed("band +-20 %, 5 %", specified_insensitivity(bands, TOLERANCE))
    now = study.modes
    table = Schedule({x: now(x * MOVE) for x in np.linspace(0.0, 1.0, ROWS).tolist()})
    study.tracking("tracked", now)
    if count == 1:
        study.tracking("tracked every sample", now, every=DT)
    study.tracking("tracked every 0.25 s", now, every=0.25)
    study.tracking("tracked, 0.2 s late", lambda t: now(t - LATE))
    study.tracking("tracked, 2 % off", lambda t: [(OFF * f, z) for f, z in now(t)])
    study.tracking(f"scheduled, {ROWS} rows", lambda t: table.modes(part_done(t)))
    study.tracking("tracked, half a shaper ahead", now, ahead=0.5)
    study.tracking("tracked, order 2", now, order=2)
    study.tracking("tracked, order 2, ahead", now, order=2, ahead=0.5)
    return Sweep(study.plain, study.left, study.durations, 1.0 - study.searched / study.redesigned)


class _Study:
    """A plant of the first modes, the command, and what has been tried on them."""

    def __init__(self, count: int) -> None:
        self._count = count
        self._times = DT * np.arange(round((MOVE + REST) / DT) + 1, dtype=float)
        self._command = np.minimum(self._times / MOVE, 1.0)
        self._plant = ChangingModes(self.modes)
        self.left: dict[str, float] = {}
        self.durations: dict[str, float] = {}
        self.redesigned = self.searched = 0
        self.plain = self._residual(self._command)

    def modes(self, t: float) -> list[tuple[float, float]]:
        """What vibrates at t [s]."""
        swing = SPREAD * (1.0 - 2.0 * part_done(t))
        return [(CENTRE[0] * (1.0 - swing), 0.0), (CENTRE[1] * (1.0 + swing), 0.0)][: self._count]

    def fixed(self, name: str, shaper: Shaper) -> None:
        """One shaper all the time."""
        self.durations[name] = shaper.duration
        self.left[name] = self._residual(np.asarray(shaper.shape(self._command, DT))) / self.plain

    def tracking(
        self, name: str, believed: ModesAt, *, order: int = 1, every: float = CALLS, ahead: float = 0.0
    ) -> None:
        """`believed` tracked, by `ahead` durations of the shaper in force earlier."""
        shaper = direct(believed(0.0), order)
        stream, shaped, longest = Stream(shaper, DT), np.empty_like(self._command), shaper.duration
        step = round(every / DT)
        for start in range(0, shaped.size, step):
            found = stream.track(believed(start * DT + ahead * stream.latency))
            self.redesigned += found.changed
            self.searched += found.start == "full"
            longest = max(longest, found.shaper.duration)
            stream.push_block(self._command[start : start + step], out=shaped[start : start + step])
        self.durations[name] = longest
        self.left[name] = self._residual(shaped) / self.plain

    def _residual(self, shaped: NDArray[np.float64]) -> float:
        found = self._plant.simulate(shaped[: self._times.size], DT).outputs["output"]
        return float(np.abs(found[self._times >= MOVE + 0.5 * REST] - 1.0).max())


def laws() -> Mapping[str, tuple[float, ...]]:
    """What one step leaves through the shaper of its time, by :data:`RATES`: of order 0, 1 and 2, and ahead."""
    found = {}
    for order in (0, 1, 2):
        for name, ahead in ((f"order {order}", 0.0), (f"order {order}, ahead", 0.5)):
            found[name] = tuple(_one_step(order, rate, ahead) for rate in RATES)
    return found


def _one_step(order: int, rate: float, ahead: float) -> float:
    """Relative to the plain step, the frequency rising evenly from 1 Hz at the step to the shaper's last impulse."""
    duration = 0.5 * (order + 1)
    for _ in range(20):  # the duration depends on the frequency ahead, and that on the duration
        frequency = 1.0 + rate * ahead * duration
        duration = 0.5 * (order + 1) / frequency
    dt = 1.0 / (PARTS * frequency)
    plant = ChangingModes(lambda t: (1.0 + rate * min(t, duration), 0.0))
    weights = np.array([math.comb(order + 1, k) for k in range(order + 2)]) / 2.0 ** (order + 1)
    count = (order + 1) * PARTS // 2
    shaped, plain = np.ones((2, count + PARTS))
    shaped[:count] = np.repeat(np.cumsum(weights)[:-1], PARTS // 2)
    left = [np.abs(plant.simulate(u, dt).outputs["output"][count:] - 1.0).max() for u in (shaped, plain)]
    return float(left[0] / left[1])
