"""By how much a tolerance is exceeded at least, for a duration; and the durations around which that becomes zero.

An elastic conic programme on a mesh of leads; points of the bands where more vibration remains than it achieved are
added until the continuum has none (exchange).
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import groupby

import numpy as np
from numpy.typing import NDArray

from preshape.band import Band
from preshape.engine.basis import Basis
from preshape.engine.constraints import Constraint, ImpulsesBetween, VibrationAtMost, ZeroVibration
from preshape.engine.edges import Edge, vibration_peaks
from preshape.engine.programme import Solution, gather, solve
from preshape.errors import InputError

__all__ = ["Asked", "Trial", "brackets", "sampled_points", "trial_at"]

MESH_PER_PERIOD = 16
"""Mesh points in a period of the highest frequency."""

POINTS_PER_RIPPLE = 6
"""Points of a band in 1/duration of frequency to begin with; the exchange adds what they miss."""

ROOT = (1e-2, 1e-3, 1e-4)
"""Relative widths of the search over the duration at which Newton's method is tried, in turn."""

MISSED = 1e-3
"""Vibration between the points may exceed what the programme achieved by this fraction before a point is added."""

LONGEST = 60.0
"""Durations beyond this many periods of the lowest frequency are not searched."""

GROWTH = 1.2
"""From a duration that is too short to the next; each further one grows by the square of the last."""

INACTIVE = 1e-6
"""Part of the largest multiplier below which a point does not matter."""

LARGEST = 150_000
"""Impulses times points of a programme; beyond it a single one takes seconds."""

WIDEST = 12.0
"""Ratio of frequencies that is still solved in seconds at 5 %; named in the advice only."""

MAXIMUM_EXCHANGES = 20

Point = tuple[Edge, float]


@dataclass(frozen=True)
class Asked:
    """Zero vibration at some modes (perhaps none) and tolerated vibration on some edges (at least one)."""

    zeros: tuple[ZeroVibration, ...]
    edges: tuple[Edge, ...]

    @property
    def fastest(self) -> float:
        """Highest frequency [Hz]."""
        return max([edge.high for edge in self.edges] + [zero.mode.frequency for zero in self.zeros])

    @property
    def lowest(self) -> float:
        """Lowest frequency [Hz]."""
        return min([edge.low for edge in self.edges] + [zero.mode.frequency for zero in self.zeros])


@dataclass(frozen=True)
class Trial:
    """The least excess [-] at one duration [s], with what achieves it; `points` are in the order of the cones."""

    duration: float
    leads: NDArray[np.float64]
    basis: Basis | None
    solution: Solution
    points: tuple[Point, ...]

    @property
    def excess(self) -> float:
        """By how much tolerances are exceeded at least [-]; infinite when even zero vibration is out of reach."""
        return self.solution.excess

    @property
    def active(self) -> list[Point]:
        """The points that decide the excess: what another duration should begin with."""
        waves = np.abs(self.solution.waves)
        return [point for point, wave in zip(self.points, waves, strict=True) if wave > INACTIVE * waves.max()]


def trial_at(asked: Asked, duration: float, points: Sequence[Point] = ()) -> Trial:
    """The least excess at a duration [s], `points` and an even sample of the edges asked to begin with."""
    leads = np.linspace(0.0, duration, math.ceil(MESH_PER_PERIOD * asked.fastest * duration) + 8)
    now = list(dict.fromkeys([*points, *sampled_points(asked.edges, duration)]))
    if leads.size * len(now) > LARGEST:
        raise InputError(
            f"the bands from {asked.lowest:g} to {asked.fastest:g} Hz are too wide: a shaper of {duration:.3g} s, "
            f"which is not enough for them yet, has {leads.size} possible impulses and {len(now)} points to check; "
            f"narrow them to a ratio of {WIDEST:g} or so between the highest and the lowest frequency, or raise the "
            "tolerance."
        )
    basis: Basis | None = None
    for _ in range(MAXIMUM_EXCHANGES):
        now.sort(key=lambda point: asked.edges.index(point[0]))
        programme = gather([*asked.zeros, ImpulsesBetween(0.0), *tolerated(now)], leads, basis)
        basis, solution = programme.basis, solve(programme)
        if not math.isfinite(solution.excess):
            break
        amplitudes = np.maximum(solution.amplitudes, 0.0)
        fresh = [
            (peak.edge, peak.w)
            for peak in vibration_peaks(asked.edges, leads, amplitudes / amplitudes.sum())
            if peak.vibration > (peak.edge.tolerance + solution.excess) * (1.0 + MISSED)
            and (peak.edge, peak.w) not in now
        ]
        if not fresh:
            break
        now += fresh
    return Trial(duration, leads, basis, solution, tuple(now))


def tolerated(points: Sequence[Point]) -> list[Constraint]:
    """The cones of points that are sorted by edge, in their order."""
    constraints: list[Constraint] = []
    for edge, group in groupby(points, key=lambda point: point[0]):
        rates = edge.rate(np.array([w for _, w in group]))
        low, high = sorted((edge.low_damping, edge.high_damping))
        band = Band(edge.low, edge.high, low, high)
        constraints.append(VibrationAtMost(band, edge.tolerance, tuple(complex(rate) for rate in rates)))
    return constraints


def sampled_points(edges: Sequence[Edge], duration: float) -> list[Point]:
    """Points of every edge, ends included, close enough to show each ripple of V."""
    found: list[Point] = []
    for edge in edges:
        span = float(np.abs(edge.rate(np.array([1.0])) - edge.rate(np.array([0.0])))[0]) / (2.0 * math.pi)
        count = 1 if edge.is_point else math.ceil(POINTS_PER_RIPPLE * span * duration) + 3
        found += [(edge, float(w)) for w in np.linspace(0.0, 1.0, count)]
    return found


def brackets(asked: Asked) -> Iterator[tuple[Trial, Trial]]:
    """Trials just below and at or above the shortest duration (of the mesh), ever closer to each other.

    Raises
    ------
    InputError
        If nothing up to sixty periods of the lowest frequency meets what is asked.
    """
    below, above = _first_bracket(asked)
    weights = [1.0, 1.0]
    for width in ROOT:
        while above.duration - below.duration > width * above.duration:
            # regula falsi with the Illinois weights: the excess falls steadily with the duration
            low, high = weights[0] * min(below.excess, 1.0), weights[1] * above.excess
            part = float(np.clip(low / (low - high), 0.02, 0.98)) if low > high and below.excess < 1.0 else 0.5
            middle = trial_at(asked, below.duration + part * (above.duration - below.duration), above.active)
            if middle.excess > 0.0:
                below, weights = middle, [1.0, 0.5 * weights[1]]
            else:
                above, weights = middle, [0.5 * weights[0], 1.0]
        yield below, above


def _first_bracket(asked: Asked) -> tuple[Trial, Trial]:
    """One duration that is too short and one that is enough."""
    duration = _first_guess(asked)
    now, growth = trial_at(asked, duration), GROWTH
    below: Trial | None = now if now.excess > 0.0 else None
    while now.excess > 0.0:
        if duration * asked.lowest > LONGEST:
            least = asked.edges[0].tolerance + now.excess
            raise InputError(
                f"no positive shaper of up to {LONGEST:g} periods of {asked.lowest:g} Hz leaves at most "
                f"{asked.edges[0].tolerance:g} of the vibration in these bands (at least {least:.3g} remains): narrow "
                "the bands or raise the tolerance."
            )
        below, duration, growth = now, growth * duration, growth**2
        now = trial_at(asked, duration, now.active)
    above = now
    while below is None:
        duration, growth = duration / growth, growth**2
        now = trial_at(asked, duration, above.active)
        if now.excess > 0.0:
            below = now
        else:
            above = now
    return below, above


def _first_guess(asked: Asked) -> float:
    """Half a period of every band and mode, one period for a wide one [s]."""
    total = sum(zero.mode.damped_period * (zero.order + 1) / 2.0 for zero in asked.zeros)
    bands = {(edge.low, edge.high) for edge in asked.edges if edge.high > edge.low}
    bands = bands or {(edge.low, edge.high) for edge in asked.edges}
    widest = max(2.0 * (high - low) / (high + low) for low, high in bands)
    slowest = min(0.5 * (low + high) for low, high in bands)
    return max(total, (0.6 + 1.6 * widest) / slowest)
