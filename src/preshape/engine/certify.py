"""The certificate of an exact optimum, with its two numbers: how low p comes, and how far the contacts before the end
are from meeting the constraints without it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import Basis
from preshape.engine.newton import Polished
from preshape.engine.polynomial import Polynomial
from preshape.engine.projection import nearest_on
from preshape.provenance import TOUCHING, Certificate, Tolerated

__all__ = ["SAME_LEAD", "certified", "exclusion_of"]

SAME_LEAD = 1e-9
"""Leads that agree to this fraction of the duration are the same."""

PRECISION = 1e-9
"""Precision of the contacts relative to the duration."""


def certified(basis: Basis, polished: Polished) -> Certificate:
    """The proof that nothing shorter than `polished` can do it; its numbers are measured on the continuum."""
    duration = float(polished.leads[-1])
    minima, values, largest = polished.minima or Polynomial(basis, polished.multipliers).minima(duration, PRECISION)
    contacts = minima[values < TOUCHING * largest]
    return Certificate(
        modes=basis.modes,
        orders=basis.orders,
        duration=duration,
        reference=basis.duration,
        groups=basis.groups,
        coefficients=basis.coefficients(polished.multipliers),
        minimum=float(values.min()) / largest,
        contacts=tuple(float(duration - u) for u in contacts[::-1]),
        exclusion=exclusion_of(basis, (), np.union1d(contacts, polished.leads), duration),
    )


def exclusion_of(
    basis: Basis | None, points: tuple[Tolerated, ...], contacts: NDArray[np.float64], duration: float
) -> float:
    """How far impulses at the contacts, the first impulse of the shaper left out, are from meeting the constraints.

    In units of the rounding of the functions: what is many units away is away. (The first impulse has the largest
    lead; shapers on a shorter interval cannot have it. Where the certificate's polynomial is zero on all impulses, the
    vibration at its points must have just the tolerated size and the multiplier's phase.)
    """
    before = contacts[contacts < duration * (1.0 - SAME_LEAD)]
    if not points:
        assert basis is not None
        return nearest_on(basis, before).distance / basis.rounding
    from scipy.optimize import nnls

    rates = np.array([point.rate for point in points])
    waves = np.exp(np.multiply.outer(-rates, before))
    wanted = np.array([point.tolerance * point.multiplier / abs(point.multiplier) for point in points])
    rows = np.concatenate([waves.real, waves.imag, np.ones((1, before.size))])
    target = np.concatenate([wanted.real, wanted.imag, [1.0]])
    rounding = float(np.finfo(float).eps) * (1.0 + float(np.abs(rates).max()) * duration)
    if basis is not None:
        rows, target = np.concatenate([rows, basis(before)]), np.concatenate([target, np.zeros(basis.size)])
        rounding = max(rounding, basis.rounding)
    _, distance = nnls(rows, target, maxiter=1000 + 50 * before.size)
    return float(distance) / rounding
