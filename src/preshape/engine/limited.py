"""The shortest positive shaper with no more than n impulses and vibration tolerated in bands.

A limit on the number makes the problem non-convex: no certificate proves a solution shortest. Several starts (seeded)
are improved by sequential quadratic programming, the best of them made exact by the same optimality system as without
the limit, and checked on the continuum; the proved optimum without the limit says how much could still be gained.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.engine.edges import Edge, largest_vibration, vibration_peaks
from preshape.engine.tolerant_newton import TolerantPoint, polish_tolerant
from preshape.engine.tolerant_search import Point, sampled_points

__all__ = ["shortest_limited"]

RANDOM = 12
"""Random starts beside those made from the optimum without the limit and the evenly spaced ones."""

STRETCHES = (1.02, 1.1, 1.25, 1.5, 2.0)
"""Durations of the starts, relative to the optimum without the limit."""

MEETS = 1e-9
"""Vibration over the tolerance by less than this fraction is rounding."""

MISSED = 1e-7
"""Vibration between the points over the tolerance by this fraction calls for a point there."""

NOTHING = 1e-9
"""An amplitude below this is none [-]."""

MAXIMUM_EXCHANGES = 6

SEED = 1988


def shortest_limited(
    edges: Sequence[Edge], count: int, leads: NDArray[np.float64], amplitudes: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """Leads [s] and amplitudes of the shortest shaper found with `count` impulses, or None when none was found.

    Parameters
    ----------
    edges : sequence of Edge
        Where vibration is tolerated, and how much.
    count : int
        Number of impulses, at least 2.
    leads, amplitudes : ndarray, shape (impulse,)
        The proved optimum without the limit [s] and [-], of more than `count` impulses.
    """
    best: tuple[NDArray[np.float64], NDArray[np.float64]] | None = None
    optimum = float(leads[-1])
    for start in [*_merged(leads, amplitudes, count), *_others(count, optimum)]:
        found = _improved(edges, *start, optimum)
        if found is not None and (best is None or found[0][-1] < best[0][-1] * (1.0 - 1e-9)):
            best = found
    if best is None:
        return None
    exact = _exact(edges, *best)
    return best if exact is None else exact


def _merged(
    leads: NDArray[np.float64], amplitudes: NDArray[np.float64], count: int
) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """The optimum with one pair of neighbours merged, each in turn, and then nearest pairs down to `count`."""
    for first in range(leads.size - 1):
        u, a, k = leads, amplitudes, first
        while u.size > count:
            pair = a[k : k + 2]
            middle = u[k] if k == 0 else u[k + 1] if k + 2 == u.size else pair @ u[k : k + 2] / pair.sum()
            u = np.concatenate([u[:k], [middle], u[k + 2 :]])
            a = np.concatenate([a[:k], [pair.sum()], a[k + 2 :]])
            k = int(np.argmin(np.diff(u)))
        for stretch in STRETCHES:
            yield stretch * u, a


def _others(count: int, optimum: float) -> Iterator[tuple[NDArray[np.float64], NDArray[np.float64]]]:
    """Evenly spaced binomial and even impulses, then random ones."""
    binomial = np.array([math.comb(count - 1, i) for i in range(count)], dtype=float)
    for stretch in STRETCHES:
        even = np.linspace(0.0, stretch * optimum, count)
        yield even, binomial / binomial.sum()
        yield even, np.full(count, 1.0 / count)
    random = np.random.default_rng(SEED)
    for _ in range(RANDOM):
        steps = random.uniform(0.3, 1.7, count - 1)
        leads = np.concatenate([[0.0], np.cumsum(steps)]) * (random.uniform(1.0, 1.8) * optimum / steps.sum())
        weights = random.uniform(0.3, 1.0, count)
        yield leads, weights / weights.sum()


def _improved(
    edges: Sequence[Edge], leads: NDArray[np.float64], amplitudes: NDArray[np.float64], scale: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """A local optimum near a start; points are added where the continuum shows more than the tolerance."""
    points = sampled_points(edges, float(leads[-1]))
    for _ in range(MAXIMUM_EXCHANGES):
        found = _Search(points, leads.size, scale).optimum(leads, amplitudes)
        if found is None:
            return None
        leads, amplitudes = found
        missed: list[Point] = [
            (peak.edge, peak.w) for peak in vibration_peaks(edges, leads, amplitudes) if peak.excess > MISSED
        ]
        if not missed:
            keep = amplitudes > NOTHING
            return (leads[keep], amplitudes[keep]) if keep[0] else None
        points = [*points, *missed]
    return None


class _Search:
    """Least last lead over amplitudes and leads (in units of `scale`), V kept at given points; x = (a, u_2, ..)."""

    def __init__(self, points: Sequence[Point], count: int, scale: float) -> None:
        self._rates = np.array([complex(edge.rate(np.array(w))) for edge, w in points]) * scale
        self._limits = np.array([edge.tolerance for edge, _ in points]) ** 2
        self._count, self._scale = count, scale

    def optimum(
        self, leads: NDArray[np.float64], amplitudes: NDArray[np.float64]
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
        """Sequential quadratic programming from one start; None when it does not converge."""
        from scipy.optimize import minimize

        n = self._count
        size = 2 * n - 1
        gaps, goal, total = np.zeros((n - 1, size)), np.zeros(size), np.zeros(size)
        gaps[:, n:] = np.eye(n - 1) - np.eye(n - 1, k=-1)
        goal[-1], total[:n] = 1.0, 1.0
        constraints: Any = [
            {"type": "eq", "fun": lambda x: total @ x - 1.0, "jac": lambda x: total},
            {"type": "ineq", "fun": self._room, "jac": self._room_slope},
            {"type": "ineq", "fun": lambda x: gaps @ x, "jac": lambda x: gaps},
        ]
        settings: dict[str, Any] = {
            "jac": lambda x: goal,
            "method": "SLSQP",
            "bounds": [(0.0, 1.0)] * n + [(0.0, np.inf)] * (n - 1),
            "constraints": constraints,
            "options": {"maxiter": 200, "ftol": 1e-12},
        }
        answer = minimize(_last, np.concatenate([amplitudes, leads[1:] / self._scale]), **settings)
        if not answer.success:
            return None
        a = np.maximum(answer.x[:n], 0.0)
        return np.append(0.0, answer.x[n:]) * self._scale, a / a.sum()

    def _waves(self, x: NDArray[np.float64]) -> NDArray[np.complex128]:
        waves: NDArray[np.complex128] = np.exp(np.multiply.outer(-self._rates, np.append(0.0, x[self._count :])))
        return waves

    def _room(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        room: NDArray[np.float64] = self._limits - np.abs(self._waves(x) @ x[: self._count]) ** 2
        return room

    def _room_slope(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        waves, a = self._waves(x), x[: self._count]
        total = (waves @ a).conj()[:, None]
        by_lead = 2.0 * np.real(total * self._rates[:, None] * waves * a)
        return np.concatenate([-2.0 * np.real(total * waves), by_lead[:, 1:]], axis=1)


def _last(x: NDArray[np.float64]) -> float:
    return float(x[-1])


def _exact(
    edges: Sequence[Edge], leads: NDArray[np.float64], amplitudes: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """The optimality system near a solution of the search, which knows no multipliers: least squares gives them."""
    from scipy.optimize import nnls

    touching = [peak for peak in vibration_peaks(edges, leads, amplitudes) if abs(peak.excess) < 1e-4]
    if not touching:
        return None
    rates = np.array([peak.rate for peak in touching])
    totals = np.exp(np.multiply.outer(-rates, leads)) @ amplitudes
    phases = totals / np.abs(totals)
    # p(u_i) = 0, p'(u_i) = 0 inside, for lambda_k = l_k phase_k with l_k >= 0 of sum 1
    wave = np.exp(np.multiply.outer(-rates, leads))
    value = np.real(phases.conj()[:, None] * wave) - np.array([p.edge.tolerance for p in touching])[:, None]
    slope = np.real(phases.conj()[:, None] * -rates[:, None] * wave) * leads[-1]
    rows = np.concatenate([value.T, slope.T[1:-1], np.ones((1, rates.size))])
    target = np.zeros(rows.shape[0])
    target[-1] = 1.0
    lengths, _ = nnls(rows, target)
    keep = lengths > 1e-6 * lengths.max()
    start = TolerantPoint(
        leads=leads,
        amplitudes=amplitudes,
        multipliers=np.zeros(0),
        sizes=lengths[keep] / np.linalg.norm(lengths[keep]),
        phases=np.angle(phases[keep]),
        edges=tuple(peak.edge for peak, kept in zip(touching, keep, strict=True) if kept),
        places=np.array([peak.w for peak, kept in zip(touching, keep, strict=True) if kept]),
    )
    exact = polish_tolerant(None, start, float(leads[-1]))
    better = exact.error < 1e-11 and (exact.amplitudes > 0.0).all() and (np.diff(exact.leads) > 0.0).all()
    if not better or largest_vibration(edges, exact.leads, exact.amplitudes).excess > MEETS:
        return None
    return exact.leads, exact.amplitudes
