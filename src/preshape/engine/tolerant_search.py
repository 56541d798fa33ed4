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
from preshape.engine.polynomial import Polynomial
from preshape.engine.programme import Solution, gather, solve
from preshape.errors import InputError

__all__ = ["Asked", "Trial", "brackets", "sampled_points", "trial_at"]

MESH_PER_PERIOD = 16
"""Mesh points in a period of the highest frequency."""

POINTS_PER_RIPPLE = 6
"""Points of a band in 1/duration of frequency to begin with; the exchange adds what they miss."""

ROOT = (1e-2, 1e-3, 1e-4)
"""Relative widths of the search over the duration at which Newton's method is tried, in turn."""

MISSED, LOOSE = 1e-3, 0.1
"""Vibration between the points may exceed what the programme achieved by the first fraction (of itself, or of the
tolerance) before a point is added, or by the second fraction of what is left below the tolerance: far from the shortest
duration nothing finer is needed."""

LONGEST = 60.0
"""Durations beyond this many periods of the lowest frequency are not searched."""

GROWTH, MOST_GROWTH = 1.2, 1.6
"""From a duration that is too short to the next; each further one grows by the square of the last, but not more than
the second factor: a programme that is much too long takes seconds."""

INACTIVE = 1e-6
"""Part of the largest multiplier below which a point does not matter."""

LARGEST = 150_000
"""Impulses times points of a programme; beyond it a single one takes seconds."""

HOPELESS = 50_000
"""The same for a shaper of one period of the lowest frequency, which is about the least that wide bands need."""

WIDEST = 12.0
"""Ratio of frequencies that is still solved in seconds at 5 %; named in the advice only."""

MAXIMUM_EXCHANGES = 20

FINE, FINEST = 1e-5, 1e-5
"""What MISSED is on the continuum of leads, and the relative width of that last bracket: the gap if all else fails."""

RESOLVED = 1e-8
"""What the conic solver tells from nothing [-], ten times what it is asked for."""

PRECISION = 1e-9
"""Precision of a lead relative to the duration."""

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
    """The least excess [-] at one duration [s], with what achieves it.

    `points` are in the order of the cones; `step` [s] is that of the mesh, to which single leads may have been added.
    """

    duration: float
    leads: NDArray[np.float64]
    basis: Basis | None
    solution: Solution
    points: tuple[Point, ...]
    step: float

    @property
    def excess(self) -> float:
        """By how much tolerances are exceeded at least [-]; infinite when even zero vibration is out of reach."""
        return self.solution.excess

    @property
    def active(self) -> list[Point]:
        """The points that decide the excess: what another duration should begin with."""
        waves = np.abs(self.solution.waves)
        return [point for point, wave in zip(self.points, waves, strict=True) if wave > INACTIVE * waves.max()]

    @property
    def support(self) -> NDArray[np.float64]:
        """The leads that have an impulse [s]."""
        amplitudes = self.solution.amplitudes
        support: NDArray[np.float64] = self.leads[amplitudes > INACTIVE * amplitudes.max()]
        return support

    @property
    def polynomial(self) -> Polynomial:
        """The separating polynomial; at no lead of the mesh is it below the excess."""
        rates = np.array([complex(edge.rate(np.array(w))) for edge, w in self.points])
        waves, tolerances = self.solution.waves, np.array([edge.tolerance for edge, _ in self.points])
        return Polynomial(self.basis, self.solution.multipliers, rates, waves, float(tolerances @ np.abs(waves)))


def trial_at(
    asked: Asked, duration: float, points: Sequence[Point] = (), support: NDArray[np.float64] | None = None
) -> Trial:
    """The least excess at a duration [s], `points` and an even sample of the edges asked to begin with.

    With the `support` of another trial [s] it is the least excess on the continuum of leads, not only on a mesh: leads
    at which the polynomial comes lower than the excess are added like the points.
    """
    mesh = np.linspace(0.0, duration, math.ceil(MESH_PER_PERIOD * asked.fastest * duration) + 8)
    leads, missed = mesh, MISSED
    if support is not None:
        leads, missed = np.union1d(mesh, support[support < duration]), FINE
    now = list(dict.fromkeys([*points, *sampled_points(asked.edges, duration)]))
    if support is None and leads.size * len(now) > LARGEST:
        raise InputError(_too_wide(asked))
    basis: Basis | None = None
    for left in range(MAXIMUM_EXCHANGES - 1, -1, -1):
        now.sort(key=lambda point: asked.edges.index(point[0]))
        programme = gather([*asked.zeros, ImpulsesBetween(0.0), *tolerated(now)], leads, basis)
        basis, solution = programme.basis, solve(programme)
        trial = Trial(duration, leads, basis, solution, tuple(now), float(mesh[1]))
        if left == 0 or not math.isfinite(solution.excess):
            break
        fresh = _missed_points(asked, trial, missed)
        lower = leads[:0] if support is None else _missed_leads(asked, trial)
        if not fresh and not lower.size:
            break
        now += fresh
        leads = np.union1d(leads, lower)
    return trial


def _missed_points(asked: Asked, trial: Trial, missed: float) -> list[Point]:
    """Peaks of the vibration that exceed what the trial achieved at its points."""
    excess = trial.excess
    amplitudes = np.maximum(trial.solution.amplitudes, 0.0)
    return [
        (peak.edge, peak.w)
        for peak in vibration_peaks(asked.edges, trial.leads, amplitudes / amplitudes.sum())
        if peak.vibration - peak.edge.tolerance - excess
        > max(missed * (peak.edge.tolerance + max(excess, 0.0)), -LOOSE * excess, RESOLVED)
        and (peak.edge, peak.w) not in trial.points
    ]


def _missed_leads(asked: Asked, trial: Trial) -> NDArray[np.float64]:
    """Leads at which the polynomial comes lower than the trial's excess."""
    minima, values, _ = trial.polynomial.minima(trial.duration, PRECISION)
    least = min(edge.tolerance for edge in asked.edges)
    lower: NDArray[np.float64] = minima[values < trial.excess - max(FINE * least, RESOLVED)]
    return lower


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
    """Trials just below and at or above the shortest duration, ever closer to each other; the last on the continuum.

    Raises
    ------
    InputError
        If nothing up to sixty periods of the lowest frequency meets what is asked.
    """
    below, above = _first_bracket(asked)
    for width in ROOT:
        below, above = _narrowed(asked, below, above, width)
        yield below, above
    back, support = ROOT[-1], below.support
    fine = trial_at(asked, below.duration, below.active, support)
    while fine.excess <= 0.0:  # the mesh called it too short, the continuum does not
        above = fine
        fine, back = trial_at(asked, fine.duration * (1.0 - back), fine.active, support), 2.0 * back
    yield _narrowed(asked, fine, above, FINEST, support)


def _narrowed(
    asked: Asked, below: Trial, above: Trial, width: float, support: NDArray[np.float64] | None = None
) -> tuple[Trial, Trial]:
    """Regula falsi with the Illinois weights: the excess falls steadily with the duration."""
    weights = [1.0, 1.0]
    while above.duration - below.duration > width * above.duration:
        low, high = weights[0] * min(below.excess, 1.0), weights[1] * above.excess
        part = float(np.clip(low / (low - high), 0.02, 0.98)) if low > high and below.excess < 1.0 else 0.5
        duration = below.duration + part * (above.duration - below.duration)
        middle = trial_at(asked, duration, above.active, support)
        if middle.excess > 0.0:
            below, weights = middle, [1.0, 0.5 * weights[1]]
        else:
            above, weights = middle, [0.5 * weights[0], 1.0]
    return below, above


def _too_wide(asked: Asked) -> str:
    return (
        f"the bands from {asked.lowest:g} to {asked.fastest:g} Hz are too wide to be solved soon: narrow them to a "
        f"ratio of {WIDEST:g} or so between the highest and the lowest frequency, or raise the tolerance."
    )


def _first_bracket(asked: Asked) -> tuple[Trial, Trial]:
    """One duration that is too short and one that is enough."""
    period = 1.0 / asked.lowest
    if MESH_PER_PERIOD * asked.fastest * period * len(sampled_points(asked.edges, period)) > HOPELESS:
        raise InputError(_too_wide(asked))
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
        below, duration, growth = now, growth * duration, min(growth**2, MOST_GROWTH)
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
