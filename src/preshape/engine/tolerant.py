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
from numpy.typing import NDArray

from preshape.band import Band
from preshape.engine.basis import Basis
from preshape.engine.certify import exclusion_of
from preshape.engine.constraints import VibrationAtMost, ZeroVibration
from preshape.engine.edges import Contact, Edge, edges_of, largest_vibration, vibration_peaks
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

SMALLEST = 1e-9
"""A multiplier below this does not belong to a contact (of all together the squares sum to 1)."""

SAME_RATE = 1e-9
"""Rates that agree to this fraction are the same corner of a band."""

MAXIMUM_PIVOTS = 6

SMALL = 1e-7
"""What interior-point methods leave where there is no impulse [-]."""

LONGER = 1e-5
"""First relative step of the duration: up, for the little by which a shaper without these impulses exceeds the
tolerance, and down, for the little that is missing to a proof that a duration is too short."""


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
            if start.leads.size in (1, *tried):
                continue
            tried.append(start.leads.size)
            exact = _confirmed(below.basis, start, edges, below.duration)
            if exact is not None:
                times = exact.leads[-1] - exact.leads[::-1]
                return Shortest(times, exact.amplitudes[::-1], _certificate(below.basis, exact, bands), 0.0)
    return _feasible(asked, below, above)


def _start(trial: Trial, width: float) -> TolerantPoint:
    """Impulses and contacts of a trial: neighbours on the mesh, and on an edge, are one between them."""
    step = trial.step
    a = trial.solution.amplitudes
    support = np.flatnonzero(a > NO_IMPULSE * a.max())
    group = np.concatenate([[0], np.cumsum(np.diff(trial.leads[support]) > width * step)])
    amplitudes = np.bincount(group, a[support])
    leads = np.bincount(group, a[support] * trial.leads[support]) / amplitudes
    leads[0] = 0.0
    edges, places, waves = _contacts(trial)
    multipliers = trial.solution.multipliers
    scale = math.sqrt(float(np.sum(np.abs(waves) ** 2)) + float(multipliers @ multipliers))
    return TolerantPoint(
        leads=leads,
        amplitudes=amplitudes / amplitudes.sum(),
        multipliers=multipliers / scale,
        sizes=np.abs(waves) / scale,
        phases=np.angle(waves),
        edges=edges,
        places=places,
    )


def _contacts(trial: Trial) -> tuple[tuple[Edge, ...], NDArray[np.float64], NDArray[np.complex128]]:
    """Edges, places and multipliers of the contacts of a trial; a corner, where edges meet, is one."""
    waves = trial.solution.waves
    found: list[tuple[Edge, float, complex]] = []
    for edge in dict.fromkeys(edge for edge, _ in trial.points):
        own = sorted((w, waves[i]) for i, (e, w) in enumerate(trial.points) if e == edge)
        spacing = 1.01 * max(np.diff([w for w, _ in own]), default=1.0)
        for w, wave in [(w, wave) for w, wave in own if abs(wave) > NO_WAVE * np.abs(waves).max()]:
            if found and found[-1][0] == edge and w - found[-1][1] <= spacing and 0.0 < found[-1][1] and w < 1.0:
                _, place, total = found.pop()
                place = (abs(total) * place + abs(wave) * w) / (abs(total) + abs(wave))
                found.append((edge, place, total + wave))
            else:
                found.append((edge, w, complex(wave)))
    contacts: list[Contact] = []
    sums: list[complex] = []
    for edge, place, total in found:
        contact = Contact(edge, place, edge.tolerance)
        same = [i for i, other in enumerate(contacts) if _coincide(contact, other)]
        if same:
            sums[same[0]] += total
        else:
            contacts.append(contact)
            sums.append(total)
    return tuple(one.edge for one in contacts), np.array([one.w for one in contacts]), np.array(sums, dtype=complex)


def _coincide(one: Contact, other: Contact) -> bool:
    """Whether both are the same corner of a band."""
    return abs(one.rate - other.rate) < SAME_RATE * abs(one.rate) and one.edge.tolerance == other.edge.tolerance


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
        if (now.sizes < SMALLEST).any():
            now = _contacts_kept(now, now.sizes >= SMALLEST)
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
    """The same with a contact at a peak: one from the end beside it, or one more.

    Where V falls from the peak to the end of the edge, with no other maximum between, a contact at that end was taken
    for this peak. (A corner of a band is the end of two edges.)
    """
    maxima = [other.w for other in vibration_peaks([peak.edge], now.leads, now.amplitudes)]
    ends = [end for end, nearest in ((0.0, maxima[0]), (1.0, maxima[-1])) if nearest == peak.w and end not in maxima]
    rates = np.array([complex(peak.edge.rate(np.array(end))) for end in ends])
    moved = (np.abs(now.rates[:, None] - rates[None, :]) < SAME_RATE * np.abs(now.rates)[:, None]).any(axis=1)
    total = complex(np.exp(-peak.rate * now.leads) @ now.amplitudes)
    kept = _contacts_kept(now, ~moved)
    return replace(
        kept,
        sizes=np.append(kept.sizes, now.sizes[moved].sum()),
        phases=np.append(kept.phases, np.angle(total)),
        edges=(*kept.edges, peak.edge),
        places=np.append(kept.places, peak.w),
    )


def _contacts_kept(now: TolerantPoint, keep: NDArray[np.bool_]) -> TolerantPoint:
    """The same with only some of the contacts."""
    edges = tuple(edge for edge, kept in zip(now.edges, keep, strict=True) if kept)
    return replace(
        now, sizes=now.sizes[keep], phases=now.phases[keep], edges=edges, places=now.places[keep], error=np.inf
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
    duration, longer = above.duration, LONGER
    while True:
        trial = trial_at(asked, duration, above.active, above.support)
        amplitudes = np.where(trial.solution.amplitudes > SMALL, trial.solution.amplitudes, 0.0)
        amplitudes[0] = max(amplitudes[0], SMALL)  # V is measured at the last impulse, also where it is one to wait for
        amplitudes /= amplitudes.sum()
        if largest_vibration(asked.edges, trial.leads, amplitudes).excess <= MEETS:
            break
        duration, longer = duration * (1.0 + longer), 2.0 * longer
    used = np.flatnonzero(amplitudes)
    leads = trial.leads[used] - trial.leads[used[0]]
    times = leads[-1] - leads[::-1]
    return Shortest(times, amplitudes[used][::-1], None, 1.0 - _too_short(asked, below) / float(times[-1]))


def _too_short(asked: Asked, below: Trial) -> float:
    """A duration near the trial's that is proved too short: its polynomial is above zero on the continuum [s]."""
    shorter = LONGER
    while shorter < 0.5:
        _, values, _ = below.polynomial.minima(below.duration, 1e-9)
        if values.min() > 0.0:
            return below.duration
        below = trial_at(asked, below.duration * (1.0 - shorter), below.active, below.support)
        shorter *= 2.0
    return 0.0
