"""The shortest positive shaper with zero vibration of given orders at given modes, and the certificate that it is.

(1) On a mesh of leads, non-negative least squares brackets the duration between two neighbouring mesh points; (2) the
nearest measure just below the shortest duration shows the impulses and the separating polynomial; (3) Newton's method
on the optimality system makes them exact; (4) the certificate is checked on the continuum. When (3) or (4) fails, the
impulses are looked for on the continuum, ever closer below the shortest duration.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import Basis, plain_rows
from preshape.engine.certify import certified
from preshape.engine.newton import Polished, settled
from preshape.engine.projection import MESH_GAP, Projection, nearest_on, nearest_on_mesh, project
from preshape.engine.repair import confirmed
from preshape.engine.unresolved import convolved_positive, halves, is_resolved, thinned
from preshape.mode import Modes
from preshape.provenance import Certificate
from preshape.shaper import Shaper

__all__ = ["Shortest", "proved", "shortest_positive"]

MESH_PER_PERIOD = 16
"""Mesh points in a period of the fastest mode for the bracket."""

MAXIMUM_REACHES = 4

ROOM = 1.06
"""The mesh reaches beyond the convolved shaper by this factor, whose impulses lie between mesh points."""

COARSE = 4
"""Every so many mesh points are a first guess at the impulses."""

FEW = 12
"""Up to so many modes the bound from leaving out single constraints is worth its time."""

DECIDED = 0.5
"""An exchange may stop when p falls short of its bound by less than this fraction: the interval is too short."""

DROWNED = 100.0
"""For dense modes a distance below this many zeros, one point below the mesh's shortest duration, is all rounding."""

ROUGH = 0.1
"""Relative width of a bracket that is narrow enough to change to functions on a shorter interval."""

MUCH_SHORTER = 0.8
"""A duration of less than this part of the mesh calls for functions that are orthonormal on the shorter interval."""

BELOW = (1e-3, 1e-4, 1e-5, 1e-6)
"""Relative distances below the shortest duration at which the impulses are looked for, in turn."""

SAME_IMPULSE = (1.5, 0.5)
"""Support points closer than this many mesh steps are one impulse that lies between them."""


MET = 1e-11
"""Largest miss of the papers' equations [-] that counts as met."""


@dataclass(frozen=True)
class Shortest:
    """The outcome of :func:`shortest_positive`.

    Parameters
    ----------
    times, amplitudes : ndarray, shape (impulse,)
        [s] and [-].
    certificate : Certificate or None
        Present when the duration is proved shortest.
    gap : float
        Relative distance from the duration to the largest duration known to be too short [-]; 0 with a certificate.
    """

    times: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    certificate: Certificate | None
    gap: float


@dataclass(frozen=True)
class _Bracket:
    """Functions on a mesh of leads [s], and the mesh's own shortest duration: too short at `low`, enough at `high`."""

    basis: Basis
    mesh: NDArray[np.float64]
    low: int
    high: int
    nearest: Projection


def shortest_positive(modes: Modes, orders: tuple[int, ...]) -> Shortest:
    """Find and prove the shortest positive shaper.

    Parameters
    ----------
    modes : Modes
        Where the residual vibration is to vanish.
    orders : tuple of int
        Derivatives of the residual that vanish with it, at each mode (0: ZV, 1: ZVD ...).
    """
    lengths = [(order + 1) * mode.damped_period / 2.0 for mode, order in zip(modes, orders, strict=True)]
    bracket = _bracketed(modes, orders, max(lengths), sum(lengths))
    if bracket is None or not is_resolved(bracket.basis):
        return _unresolved(modes, orders)
    if not bracket.basis.groups and bracket.nearest.distance < DROWNED * bracket.basis.zero:
        return _drowned(bracket)
    too_short = 0.0
    for basis, nearest, width, excluded in _starts(bracket):
        too_short = max(too_short, excluded)
        leads, amplitudes = _clustered(nearest, width)
        if leads.size < 2:
            continue
        found = confirmed(basis, leads, amplitudes, nearest.multipliers)
        if found is not None:
            return proved(basis, found)
    return _feasible(bracket, too_short)


def _drowned(bracket: _Bracket) -> Shortest:
    """One try at the optimum where rounding hides how far below it a duration is; else what remains certain."""
    basis, step = bracket.basis, float(bracket.mesh[1])
    leads, amplitudes = _clustered(bracket.nearest, SAME_IMPULSE[0] * step)
    found = confirmed(basis, leads, amplitudes, bracket.nearest.multipliers, pivots=1, steps=12)
    return proved(basis, found) if found is not None else _unresolved(basis.modes, basis.orders)


def proved(basis: Basis, polished: Polished) -> Shortest:
    """The exact shaper with its certificate."""
    exact = settled(basis, polished)
    certificate = certified(basis, exact)
    times = exact.leads[-1] - exact.leads[::-1]
    return Shortest(times, exact.amplitudes[::-1], certificate, 0.0)


def _bracketed(
    modes: Modes, orders: tuple[int, ...], longest: float, convolved: float, expected: float = math.inf
) -> _Bracket | None:
    """Search over the mesh: durations up to `longest` are too short, the `convolved` one is enough [s].

    None where floating point does not hold the functions.
    """
    fastest = max(mode.frequency for mode in modes)
    reach = ROOM * convolved
    for _ in range(MAXIMUM_REACHES):
        mesh = np.linspace(0.0, reach, math.ceil(MESH_PER_PERIOD * fastest * reach) + 8)
        basis = Basis(modes, orders, reach)
        if not basis.size:
            return None
        rows = basis(mesh)
        nearest, used = nearest_on_mesh(basis, mesh, rows, np.arange(0, mesh.size, COARSE))
        if nearest.feasible:
            break
        reach *= 1.2

    def nearest_until(last: int, gap: float) -> tuple[Projection, NDArray[np.intp]]:
        return nearest_on_mesh(basis, mesh[: last + 1], rows[:, : last + 1], _stretched(used, last), gap)

    low, high = int(longest * (1.0 - 1e-9) / mesh[1]), mesh.size - 1
    predicted, halved = expected / mesh[1], True
    while high - low > 1 and not (_much_shorter(float(mesh[high]), basis) and high - low < ROUGH * high):
        width, middle = high - low, (low + high) // 2
        if predicted < (high if halved else low + 1):
            middle = max(int(predicted), low + 1)
        nearest, used = nearest_until(middle, DECIDED)
        if nearest.feasible:
            high = middle
        else:
            low, predicted = middle, middle + nearest.distance / _fall(nearest, rows[:, middle : middle + 2])
        halved = not halved or 2 * (high - low) <= width
    if _much_shorter(float(mesh[high]), basis):
        return _bracketed(modes, orders, float(mesh[max(low - 1, 0)]), float(mesh[high]), float(predicted * mesh[1]))
    return _Bracket(basis, mesh, low, high, nearest_until(low, MESH_GAP)[0])


def _much_shorter(duration: float, basis: Basis) -> bool:
    """Whether a basis on an interval of about this `duration` [s] would be better, and is worth it."""
    return duration < MUCH_SHORTER * basis.duration and is_resolved(basis)


def _fall(nearest: Projection, rows: NDArray[np.float64]) -> float:
    """By how much the distance falls from one mesh point to the next: what moving the last impulse there takes off."""
    here, there = nearest.multipliers @ rows
    return max(float(nearest.amplitudes[-1] * (here - there)), np.finfo(float).tiny)


def _stretched(used: NDArray[np.intp], last: int) -> NDArray[np.intp]:
    """Indices of the impulses of another duration, stretched to end at index `last`, and their neighbours."""
    stretched = np.rint(used * (last / max(int(used[-1]), 1))).astype(np.intp)
    near: NDArray[np.intp] = np.concatenate([stretched - 1, stretched, stretched + 1])
    return near[(near >= 0) & (near <= last)]


def _starts(bracket: _Bracket) -> Iterator[tuple[Basis, Projection, float, float]]:
    """Starts for Newton's method, the cheap ones first, with a cluster's width and a duration proved too short."""
    basis, mesh = bracket.basis, bracket.mesh
    step, proved = float(mesh[1]), 0.0
    for width in SAME_IMPULSE:
        yield basis, bracket.nearest, width * step, proved
    low, high, points = float(mesh[bracket.low]), float(mesh[bracket.high]), mesh[: bracket.high + 1]
    for below in BELOW:
        low, nearest = _just_infeasible(basis, points, low, high, below)
        for width in (SAME_IMPULSE[-1], SAME_IMPULSE[-1] / 4.0):
            yield basis, nearest, width * step, low
        points = np.union1d(points, nearest.leads)


def _just_infeasible(
    basis: Basis, points: NDArray[np.float64], low: float, high: float, below: float
) -> tuple[float, Projection]:
    """A duration short of the shortest by about the fraction `below`, with the nearest measure there.

    The distance falls to zero linearly in the duration, so two durations that are too short predict the shortest.
    """

    def nearest_for(duration: float) -> Projection:
        return project(basis, np.append(points[points < duration], duration), duration)

    duration = low * (1.0 - below)
    nearest, back = nearest_for(duration), 4.0 * below
    while not nearest.infeasible:  # the mesh called it too short, the continuum does not
        high, duration, back = duration, duration * (1.0 - back), min(2.0 * back, 0.1)
        nearest = nearest_for(duration)
    shorter = duration * (1.0 - 4.0 * below)
    other = nearest_for(shorter)
    for _ in range(8):
        slope = (other.distance - nearest.distance) / (duration - shorter)
        if slope <= 0.0:
            break
        predicted = min(duration + nearest.distance / slope, high)
        target = predicted * (1.0 - below)
        if target <= duration * (1.0 + 0.5 * below):
            break
        candidate = nearest_for(target)
        if not candidate.infeasible:
            high = target
            continue
        shorter, other, duration, nearest = duration, nearest, target, candidate
    return duration, nearest


def _clustered(nearest: Projection, width: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Support points closer than `width` [s] as one impulse at their centroid; the last impulse keeps lead zero."""
    group = np.concatenate([[0], np.cumsum(np.diff(nearest.leads) > width)])
    amplitudes = np.bincount(group, nearest.amplitudes).astype(float)
    return np.bincount(group, nearest.amplitudes * nearest.leads) / amplitudes, amplitudes


def _feasible(bracket: _Bracket, too_short: float) -> Shortest:
    """What is left when Newton does not confirm: a shaper that meets the constraints, and how short it might be."""
    basis = bracket.basis
    nearest = nearest_on(basis, bracket.mesh[: bracket.high + 1])
    polished = settled(basis, Polished(nearest.leads, nearest.amplitudes, nearest.multipliers, math.inf))
    rows, _ = plain_rows(basis.modes, basis.orders, polished.leads, basis.duration)
    met = float(np.abs(rows @ polished.amplitudes).max()) <= MET and bool((polished.amplitudes > 0.0).all())
    if not met or polished.leads[0] != 0.0:
        return _unresolved(basis.modes, basis.orders)
    times = polished.leads[-1] - polished.leads[::-1]
    return Shortest(times, polished.amplitudes[::-1], None, 1.0 - too_short / float(times[-1]))


def _unresolved(modes: Modes, orders: tuple[int, ...]) -> Shortest:
    """Shapers for the halves of the modes, convolved, and the bound that fewer constraints give."""
    if len(modes) == 1:
        alone = convolved_positive(modes, orders)
        return Shortest(alone.times, alone.amplitudes, None, 1.0)
    parts = [shortest_positive(*half) for half in halves(modes, orders)]
    both = reduce(Shaper.convolve, [Shaper.normalised(part.times, part.amplitudes) for part in parts])
    lower = max(float(part.times[-1]) * (1.0 - part.gap) for part in parts)
    fewer = thinned(modes, orders, lower) if len(modes) <= FEW else (modes, orders)
    if fewer != (modes, orders):
        bound = shortest_positive(*fewer)
        lower = max(lower, float(bound.times[-1]) * (1.0 - bound.gap))
    return Shortest(both.times, both.amplitudes, None, max(0.0, 1.0 - lower / both.duration))
