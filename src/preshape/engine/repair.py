"""From a start to a proved optimum: Newton's method, and pivots where its start had an impulse too many or too few.

An impulse whose amplitude comes out negative does not belong to the shaper; a place where the polynomial falls below
zero misses one. Both are what a simplex pivot would change, done on exact impulses.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import Basis
from preshape.engine.newton import MAXIMUM_STEPS, NOTHING, Polished, polish
from preshape.engine.polynomial import Polynomial
from preshape.provenance import MINIMUM_ALLOWED

__all__ = ["confirmed"]

MAXIMUM_PIVOTS = 12

PRECISION = 1e-9
"""Precision of a minimum's place relative to the duration: p is quadratic there, so its value is good to 1e-17."""

CLOSE = 0.02
"""Impulses closer than this fraction of the duration may be one that the start had as two."""

LARGE = 1e3
"""An equation error of this many rounding levels still shows which impulses do not belong."""


def confirmed(
    basis: Basis,
    leads: NDArray[np.float64],
    amplitudes: NDArray[np.float64],
    multipliers: NDArray[np.float64],
    pivots: int = MAXIMUM_PIVOTS,
    steps: int = MAXIMUM_STEPS,
) -> Polished | None:
    """The exact optimum near a start, or None: the equations hold, amplitudes are positive, p is nowhere negative.

    Where p is negative by more than rounding, but by so little that a certificate would still do, an impulse is missing
    all the same: it is looked for, and what would do is the answer if that fails.
    """
    u, a, c = leads, amplitudes, multipliers
    would_do: Polished | None = None
    for _ in range(pivots + 1):
        polished = polish(basis, u, a, c, steps)
        if polished.error > LARGE:
            if (merged := _merged(polished)) is None:
                return would_do
            u, a = merged
            c = polished.multipliers
            continue
        negative = polished.amplitudes < -NOTHING
        if negative.any():
            keep = polished.amplitudes > min(float(polished.amplitudes.min()) / 2.0, -NOTHING)
            if keep.sum() < 2 or not keep[0]:
                return would_do
            u, a, c = polished.leads[keep], polished.amplitudes[keep], polished.multipliers
            continue
        if not polished.converged:
            return would_do
        polished = polished.without_empty_impulses()
        minima, values, largest = _lowest(basis, polished)
        if values.min() >= MINIMUM_ALLOWED * largest:
            would_do = replace(polished, minima=(minima, values, largest))
            if values.min() >= -basis.rounding:
                return would_do
        lowest = float(minima[int(np.argmin(values))])
        place = int(np.searchsorted(polished.leads, lowest))
        u = np.insert(polished.leads, place, lowest)
        a = np.insert(polished.amplitudes, place, 0.0)
        c = polished.multipliers
        if np.diff(u).min() <= PRECISION * u[-1]:
            return would_do
    return would_do


def _merged(polished: Polished) -> tuple[NDArray[np.float64], NDArray[np.float64]] | None:
    """The nearest two impulses as one, if they are so near that Newton's method was held up by their gap."""
    u, a = polished.leads, polished.amplitudes
    gaps = np.diff(u)
    k = int(np.argmin(gaps))
    if u.size < 3 or gaps[k] > CLOSE * u[-1] or a[k] + a[k + 1] <= 0.0:
        return None
    weights = np.maximum(a[k : k + 2], NOTHING)
    middle = 0.0 if k == 0 else float(weights @ u[k : k + 2] / weights.sum())
    if k + 2 == u.size:
        middle = float(u[-1])
    leads = np.concatenate([u[:k], [middle], u[k + 2 :]])
    return leads, np.concatenate([a[:k], [a[k] + a[k + 1]], a[k + 2 :]])


def _lowest(basis: Basis, polished: Polished) -> tuple[NDArray[np.float64], NDArray[np.float64], float]:
    """Where p is lowest; at an optimum that is at the impulses."""
    polynomial = Polynomial(basis, polished.multipliers)
    return polynomial.minima(float(polished.leads[-1]), PRECISION, expected=polished.leads)
