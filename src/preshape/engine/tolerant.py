"""The shortest positive shaper with vibration tolerated in bands, and the certificate that it is.

(1) Durations just below and above the shortest, on a mesh (tolerant_search.py); (2) impulses and contacts from just
below it, made exact by Newton's method on the optimality system (tolerant_newton.py), with pivots where the start had
one too many or too few; (3) the vibration on all edges and the polynomial on [0, T] are checked on the continuum.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from preshape.band import Band
from preshape.engine.basis import Basis
from preshape.engine.certify import exclusion_of
from preshape.engine.constraints import VibrationAtMost, ZeroVibration
from preshape.engine.edges import Contact, Edge, edges_of, largest_vibration
from preshape.engine.polynomial import Polynomial
from preshape.engine.shortest import Shortest
from preshape.engine.tolerant_newton import TolerantPoint, polish_tolerant
from preshape.engine.tolerant_search import Asked, Trial, brackets, trial_at
from preshape.provenance import MINIMUM_ALLOWED, TOUCHING, Certificate, Tolerated

__all__ = ["shortest_tolerant"]

MEETS = 1e-9
"""Vibration over the tolerance by less than this fraction is rounding."""

CONVERGED = 1e-11
"""Equation error of an exact optimum [-]."""

WORTH_A_PIVOT = 1e-6
"""An equation error up to which amplitudes still show which impulses do not belong [-]."""

SAME_IMPULSE = (1.5, 0.6, 2.5)
"""Impulses closer than this many mesh steps are one that lies between them."""

NO_WAVE, NO_IMPULSE = 1e-5, 1e-4
"""A multiplier, or an amplitude of the mesh, below this fraction of the largest is none."""

NEGATIVE = -1e-12
"""An amplitude below this does not belong to a positive shaper."""

MAXIMUM_PIVOTS = 6


def shortest_tolerant(asks: Sequence[VibrationAtMost], zeros: Sequence[ZeroVibration] = ()) -> Shortest:
    """Find and prove the shortest positive shaper that keeps to every tolerance, with zero vibration at given modes.

    Parameters
    ----------
    asks : sequence of VibrationAtMost
        Bands with their tolerances, at least one.
    zeros : sequence of ZeroVibration
        Modes at which no vibration at all may remain.

    Raises
    ------
    InputError
        If nothing up to sixty periods of the lowest frequency does it.
    """
    edges = tuple(edge for ask in asks for edge in edges_of([ask.band], ask.tolerance))
    asked = Asked(tuple(zeros), edges)
    bands = [ask.band for ask in asks]
    for bracket in brackets(asked):
        below, above = bracket
        tried: list[int] = []
        for width in SAME_IMPULSE:
            start = _start(below, width)
            if start.leads.size in tried:
                continue
            tried.append(start.leads.size)
            exact = _confirmed(below.basis, start, edges, below.duration)
            if exact is not None:
                times = exact.leads[-1] - exact.leads[::-1]
                return Shortest(times, exact.amplitudes[::-1], _certificate(below.basis, exact, bands), 0.0)
    return _feasible(asked, below, above)


def _start(trial: Trial, width: float) -> TolerantPoint:
    """Impulses and contacts of a trial: neighbours on the mesh, and on an edge, are one between them."""
    step = float(trial.leads[1])
    a = trial.solution.amplitudes
    support = np.flatnonzero(a > NO_IMPULSE * a.max())
    group = np.concatenate([[0], np.cumsum(np.diff(trial.leads[support]) > width * step)])
    amplitudes = np.bincount(group, a[support])
    leads = np.bincount(group, a[support] * trial.leads[support]) / amplitudes
    leads[0] = 0.0
    waves = trial.solution.waves
    edges: list[Edge] = []
    places: list[float] = []
    sums: list[complex] = []
    for edge in dict.fromkeys(edge for edge, _ in trial.points):
        own = sorted((w, waves[i]) for i, (e, w) in enumerate(trial.points) if e == edge)
        mine = [(w, wave) for w, wave in own if abs(wave) > NO_WAVE * np.abs(waves).max()]
        spacing = 1.01 * max(np.diff([w for w, _ in own]), default=1.0)
        for w, wave in mine:
            if edges and edges[-1] == edge and w - places[-1] <= spacing and 0.0 < places[-1] and w < 1.0:
                total = sums[-1] + wave
                places[-1] = (abs(sums[-1]) * places[-1] + abs(wave) * w) / (abs(sums[-1]) + abs(wave))
                sums[-1] = total
            else:
                edges.append(edge)
                places.append(w)
                sums.append(complex(wave))
    multipliers = trial.solution.multipliers
    scale = math.sqrt(sum(abs(wave) ** 2 for wave in sums) + float(multipliers @ multipliers))
    return TolerantPoint(
        leads=leads,
        amplitudes=amplitudes / amplitudes.sum(),
        multipliers=multipliers / scale,
        waves=np.asarray(np.array(sums) / scale, dtype=complex),
        edges=tuple(edges),
        places=np.array(places, dtype=float),
    )


def _confirmed(
    basis: Basis | None, start: TolerantPoint, edges: tuple[Edge, ...], scale: float
) -> TolerantPoint | None:
    """The exact optimum near a start, or None; impulses and contacts that are too many or missing are changed."""
    now = start
    for _ in range(MAXIMUM_PIVOTS + 1):
        now = polish_tolerant(basis, now, scale)
        if not now.error < WORTH_A_PIVOT:
            return None
        negative = now.amplitudes < NEGATIVE
        if negative.any():
            keep = ~negative
            if keep.sum() < 2 or not keep[0]:
                return None
            now = replace(now, leads=now.leads[keep], amplitudes=now.amplitudes[keep], error=np.inf)
            continue
        if now.error > CONVERGED:
            return None
        worst = largest_vibration(edges, now.leads, now.amplitudes)
        if worst.excess > MEETS:
            now = _with_contact(now, worst)
            continue
        p = _polynomial(basis, now)
        minima, values, largest = p.minima(float(now.leads[-1]), 1e-9)
        if values.min() >= MINIMUM_ALLOWED * largest:
            return now
        place = float(minima[int(np.argmin(values))])
        index = int(np.searchsorted(now.leads, place))
        if np.abs(now.leads - place).min() < 1e-9 * scale:
            return None
        now = replace(
            now,
            leads=np.insert(now.leads, index, place),
            amplitudes=np.insert(now.amplitudes, index, 0.0),
            error=np.inf,
        )
    return None


def _with_contact(now: TolerantPoint, peak: Contact) -> TolerantPoint:
    """The same with one contact more, of a small multiplier in the direction of the vibration there."""
    total = complex(np.exp(-peak.rate * now.leads) @ now.amplitudes)
    wave = 1e-3 * float(np.abs(now.waves).max()) * total / abs(total)
    return replace(
        now,
        waves=np.append(now.waves, wave),
        edges=(*now.edges, peak.edge),
        places=np.append(now.places, peak.w),
        error=np.inf,
    )


def _polynomial(basis: Basis | None, point: TolerantPoint) -> Polynomial:
    return Polynomial(basis, point.multipliers, point.rates, point.waves, point.offset)


def _certificate(basis: Basis | None, point: TolerantPoint, bands: Sequence[Band]) -> Certificate:
    """The proof, its numbers measured on the continuum."""
    duration = float(point.leads[-1])
    minima, values, largest = _polynomial(basis, point).minima(duration, 1e-9)
    contacts = minima[values < TOUCHING * largest]
    points = []
    for edge, w, wave in zip(point.edges, point.places, point.waves, strict=True):
        frequency, damping = edge.mode(float(w))
        points.append(Tolerated(frequency, damping, edge.tolerance, complex(wave)))
    return Certificate(
        modes=None if basis is None else basis.modes,
        orders=() if basis is None else basis.orders,
        duration=duration,
        reference=duration if basis is None else basis.duration,
        groups=() if basis is None else basis.groups,
        coefficients=() if basis is None else basis.coefficients(point.multipliers),
        minimum=float(values.min()) / largest,
        contacts=tuple(float(duration - u) for u in contacts[::-1]),
        exclusion=exclusion_of(basis, tuple(points), np.union1d(contacts, point.leads), duration),
        points=tuple(points),
        bands=tuple(bands),
    )


def _feasible(asked: Asked, below: Trial, above: Trial) -> Shortest:
    """What is left when Newton does not confirm: a shaper that keeps to the tolerance, and how short one might be."""
    duration = above.duration
    while True:
        trial = trial_at(asked, duration, above.active)
        amplitudes = np.where(trial.solution.amplitudes > NEGATIVE, np.maximum(trial.solution.amplitudes, 0.0), 0.0)
        amplitudes = np.where(amplitudes > 1e-9, amplitudes, 0.0)
        amplitudes /= amplitudes.sum()
        if largest_vibration(asked.edges, trial.leads, amplitudes).excess <= MEETS:
            break
        duration *= 1.002
    used = np.flatnonzero(amplitudes)
    leads = trial.leads[used] - trial.leads[used[0]]
    times = leads[-1] - leads[::-1]
    return Shortest(times, amplitudes[used][::-1], None, 1.0 - _too_short(below) / float(times[-1]))


def _too_short(below: Trial) -> float:
    """The trial's duration when its multipliers prove it too short on the continuum, else nothing."""
    waves = below.solution.waves
    rates = np.array([complex(edge.rate(np.array(w))) for edge, w in below.points])
    offset = float(np.array([edge.tolerance for edge, _ in below.points]) @ np.abs(waves))
    polynomial = Polynomial(below.basis, below.solution.multipliers, rates, waves, offset)
    _, values, _ = polynomial.minima(below.duration, 1e-9)
    return below.duration if values.min() > 0.0 else 0.0
