"""The shortest positive shaper with zero vibration of given orders at given modes, and the certificate that it is.

(1) Bisection on the duration T with non-negative least squares on a coarse mesh; (2) just below the shortest T the
nearest measure on the continuum shows the impulses and the separating polynomial; (3) Newton's method on the optimality
system makes them exact; (4) the certificate is checked on the continuum. When (3) or (4) fails, (2) moves closer.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import Basis
from preshape.engine.newton import Polished, polish
from preshape.engine.projection import FEASIBLE, Projection, nearest_on, project
from preshape.engine.unresolved import convolved_positive, is_resolved, with_fewer_constraints
from preshape.mode import Modes
from preshape.provenance import TOUCHING, Certificate

__all__ = ["Shortest", "shortest_positive"]

MESH_PER_PERIOD = 16
"""Mesh points in a period of the fastest mode for the bisection."""

BISECTION = 3e-3
"""Relative width at which the bisection on the mesh stops: the mesh itself is no better."""

BELOW = (1e-3, 1e-4, 1e-5, 1e-6)
"""Relative distances below the shortest duration at which the impulses are looked for, in turn."""

SAME_IMPULSE = 0.5
"""Support points closer than this many mesh steps are one impulse that lies between them."""


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


def shortest_positive(modes: Modes, orders: tuple[int, ...]) -> Shortest:
    """Find and prove the shortest positive shaper.

    Parameters
    ----------
    modes : Modes
        Where the residual vibration is to vanish.
    orders : tuple of int
        Derivatives of the residual that vanish with it, at each mode (0: ZV, 1: ZVD ...).
    """
    convolved = sum((order + 1) * mode.damped_period / 2.0 for mode, order in zip(modes, orders, strict=True))
    if not is_resolved(modes, orders, convolved):
        return _unresolved(modes, orders)
    fastest = max(mode.frequency for mode in modes)
    mesh = np.linspace(0.0, 1.0, int(np.ceil(MESH_PER_PERIOD * fastest * convolved)) + 2)
    too_short, enough = _bisect(modes, orders, mesh, convolved)
    step = 1.0 / (MESH_PER_PERIOD * fastest)
    points = mesh
    for below in BELOW:
        duration, nearest = _just_infeasible(modes, orders, points, too_short, enough, below)
        too_short = duration
        basis = Basis(modes, orders, duration)
        for width in (SAME_IMPULSE, SAME_IMPULSE / 4.0):
            times, amplitudes = _clustered(nearest, width * step)
            if times.size < 2:
                continue
            polished = polish(basis, times, amplitudes, nearest.multipliers)
            if polished.converged:
                polished = polished.without_empty_impulses()
                certificate = _certify(basis, polished)
                if certificate.holds:
                    return Shortest(polished.times, polished.amplitudes, certificate, 0.0)
        points = np.union1d(mesh, nearest.times / duration)
    return _feasible(modes, orders, points, too_short, enough)


def _bisect(modes: Modes, orders: tuple[int, ...], mesh: NDArray[np.float64], convolved: float) -> tuple[float, float]:
    """A duration too short on the mesh (relative times), and one that is enough on it [s]."""
    low, high = 0.0, 1.02 * convolved
    while nearest_on(Basis(modes, orders, high), mesh * high).distance > FEASIBLE:
        low, high = high, 1.1 * high
    while high - low > BISECTION * high:
        middle = 0.5 * (low + high)
        if nearest_on(Basis(modes, orders, middle), mesh * middle).distance > FEASIBLE:
            low = middle
        else:
            high = middle
    return low, high


def _just_infeasible(
    modes: Modes, orders: tuple[int, ...], points: NDArray[np.float64], low: float, high: float, below: float
) -> tuple[float, Projection]:
    """A duration short of the shortest by about the fraction `below`, with the nearest measure there.

    The distance falls to zero linearly in the duration, so two durations that are too short predict the shortest.
    """
    duration = low * (1.0 - below)
    nearest = project(Basis(modes, orders, duration), points * duration)
    back = 4.0 * below
    while not nearest.infeasible:  # the mesh called it too short, the continuum does not
        high, duration, back = duration, duration * (1.0 - back), min(2.0 * back, 0.1)
        nearest = project(Basis(modes, orders, duration), points * duration)
    shorter = duration * (1.0 - 4.0 * below)
    other = project(Basis(modes, orders, shorter), points * shorter)
    for _ in range(8):
        slope = (other.distance - nearest.distance) / (duration - shorter)
        if slope <= 0.0:
            break
        predicted = min(duration + nearest.distance / slope, high)
        target = predicted * (1.0 - below)
        if target <= duration * (1.0 + 0.5 * below):
            break
        candidate = project(Basis(modes, orders, target), points * target)
        if not candidate.infeasible:
            high = target
            continue
        shorter, other, duration, nearest = duration, nearest, target, candidate
    return duration, nearest


def _clustered(nearest: Projection, width: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Support points closer than `width` [s] as one impulse at their centroid."""
    group = np.concatenate([[0], np.cumsum(np.diff(nearest.times) > width)])
    amplitudes = np.bincount(group, nearest.amplitudes).astype(float)
    return np.bincount(group, nearest.amplitudes * nearest.times) / amplitudes, amplitudes


def _certify(basis: Basis, polished: Polished) -> Certificate:
    """Check on the continuum that nothing shorter can do it."""
    duration = float(polished.times[-1])
    minima = basis.minima(polished.multipliers, duration)
    fine = np.linspace(0.0, duration, basis.samples_needed(duration))
    largest = float(np.abs(polished.multipliers @ basis(fine)).max())
    values = polished.multipliers @ basis(minima) / largest
    contacts = minima[values < TOUCHING]
    before = np.union1d(contacts[contacts < duration * (1.0 - 1e-9)], polished.times[:-1])
    return Certificate(
        modes=basis.modes,
        orders=basis.orders,
        duration=duration,
        coefficients=basis.coefficients(polished.multipliers, duration),
        minimum=float(values.min()),
        contacts=tuple(float(t) for t in contacts),
        exclusion=nearest_on(Basis(basis.modes, basis.orders, duration), before).distance,
    )


def _feasible(
    modes: Modes, orders: tuple[int, ...], points: NDArray[np.float64], too_short: float, enough: float
) -> Shortest:
    """What is left when Newton does not confirm: a shaper that meets the constraints, and how short it might be."""
    nearest = nearest_on(Basis(modes, orders, enough), points * enough)
    times = nearest.times - nearest.times[0]
    convolved = convolved_positive(modes, orders)
    if times[-1] >= convolved.duration:
        return Shortest(convolved.times, convolved.amplitudes, None, 1.0 - too_short / convolved.duration)
    return Shortest(times, nearest.amplitudes, None, float(1.0 - too_short / times[-1]))


def _unresolved(modes: Modes, orders: tuple[int, ...]) -> Shortest:
    """The convolved shaper, and the bound that fewer constraints give, when the modes are too near to search."""
    convolved = convolved_positive(modes, orders)
    bound = shortest_positive(*with_fewer_constraints(modes, orders))
    lower = float(bound.times[-1]) * (1.0 - bound.gap)
    return Shortest(convolved.times, convolved.amplitudes, None, max(0.0, 1.0 - lower / convolved.duration))
