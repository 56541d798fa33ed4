"""Checking a proof that comes from elsewhere: everything is computed anew from the certificate's coefficients."""

from __future__ import annotations

from dataclasses import astuple

import numpy as np

from preshape.band import Band
from preshape.engine.basis import Basis, plain_rows
from preshape.engine.certify import SAME_LEAD, exclusion_of
from preshape.engine.edges import edges_of, largest_vibration
from preshape.engine.polynomial import Polynomial
from preshape.engine.unresolved import is_resolved
from preshape.kernel.divided_exponentials import RADIUS
from preshape.provenance import EXCLUDED_AT, MINIMUM_ALLOWED, TOUCHING, Certificate, Tolerated
from preshape.shaper import Shaper

__all__ = ["basis_of", "is_proved_shortest"]

MET = 1e-10
"""Largest miss of the constraint integrals (rows scaled to 1) that counts as met by a shaper from a file."""

MET_APART = 1e-8
"""The same for orthonormal rows, which near-equal modes cannot hide in: of theirs, scaled rows show next to nothing."""

NEARBY = 10.0
"""The interval that a proof's functions are made for is not longer or shorter than the shaper by more than this."""

MOST_PERIODS = 100_000.0
"""A proof over more periods of its fastest mode than this is not looked at: it would take gigabytes."""

KEPT = 1e-8
"""Vibration over a tolerance by less than this fraction is rounding."""

PRECISION = 1e-9
"""Precision of the minima's places relative to the duration."""


def is_proved_shortest(shaper: Shaper) -> bool:
    """Whether the certificate that a shaper carries proves it shortest; nothing that it says of itself is believed.

    The impulses are positive and meet the certificate's constraints; its polynomial is nowhere below zero and touches
    zero at every impulse; and the points where it touches, but the first impulse, cannot meet the constraints.

    Parameters
    ----------
    shaper : Shaper
        As designed, or loaded from a file.

    Examples
    --------
    >>> import preshape
    >>> is_proved_shortest(preshape.design.direct([(1.0, 0.0), (2.3, 0.0)]))
    True
    >>> is_proved_shortest(preshape.design.zvd([(1.0, 0.0), (2.3, 0.0)]))
    False
    """
    proof = shaper.design.certificate
    if proof is None or shaper.boxes or not _same_end(proof, shaper) or not _is_about(proof, shaper):
        return False
    if not np.isfinite([*proof.coefficients, *(point.multiplier for point in proof.points)]).all():
        return False
    leads, amplitudes = shaper.duration - shaper.times[::-1], shaper.amplitudes[::-1]
    if not (amplitudes > 0.0).all():
        return False
    basis: Basis | None = None
    multipliers = np.zeros(0)
    if proof.modes is not None:
        rows, _ = plain_rows(proof.modes, proof.orders, leads, shaper.duration)
        if np.abs(rows @ amplitudes).max() > MET:
            return False
        basis = basis_of(proof)
        if basis is None or np.abs(basis(leads) @ amplitudes).max() > max(MET_APART, 10.0 * basis.zero):
            return False
        multipliers = basis.multipliers(np.array(proof.coefficients))
    rates = np.array([point.rate for point in proof.points], dtype=complex)
    waves = np.array([point.multiplier for point in proof.points], dtype=complex)
    tolerances = np.array([point.tolerance for point in proof.points])
    if (np.abs(np.exp(np.multiply.outer(-rates, leads)) @ amplitudes) > tolerances * (1.0 + KEPT)).any():
        return False
    polynomial = Polynomial(basis, multipliers, rates, waves, float(tolerances @ np.abs(waves)))
    minima, values, largest = polynomial.minima(shaper.duration, PRECISION)
    if largest == 0.0 or values.min() < MINIMUM_ALLOWED * largest:
        return False
    if float(np.abs(polynomial(leads)).max()) > TOUCHING * largest:
        return False
    contacts = np.union1d(minima[values < TOUCHING * largest], leads)
    return exclusion_of(basis, proof.points, contacts, shaper.duration) > EXCLUDED_AT


def basis_of(proof: Certificate) -> Basis | None:
    """The functions that the proof is made of, if they are such as doubles tell apart on an interval like the shaper's.

    Where a function was left out as dependent on the others, a shaper could miss it unseen; and divided differences of
    rates far from each other are not what their series say.
    """
    assert proof.modes is not None
    periods = proof.duration * max(mode.frequency for mode in proof.modes)
    if not 1.0 / NEARBY <= proof.reference / proof.duration <= NEARBY or periods > MOST_PERIODS:
        return None
    poles = np.array([mode.pole for mode in proof.modes])
    for group in proof.groups:
        apart = np.abs(poles[list(group), None] - poles[None, list(group)]).max() * proof.reference / 2.0
        if apart > 2.0 * RADIUS:
            return None
    basis = Basis(proof.modes, proof.orders, proof.reference, proof.groups)
    full = basis.size == 2 * sum(order + 1 for order in proof.orders)
    return basis if full and is_resolved(basis) else None


def _is_about(proof: Certificate, shaper: Shaper) -> bool:
    """Whether the proof is about what the shaper was designed for: its modes, and every band with its tolerance."""
    if proof.modes is None:
        tolerance = shaper.design.settings.get("tolerance")
        if not proof.bands or not proof.points or not isinstance(tolerance, float):
            return False
        if [list(astuple(band)) for band in proof.bands] != shaper.design.settings.get("bands"):
            return False
        edges = edges_of(proof.bands, tolerance)
        leads = shaper.duration - shaper.times[::-1]
        if largest_vibration(edges, leads, shaper.amplitudes[::-1]).excess > KEPT:
            return False
        return all(point.tolerance >= tolerance and _inside(point, proof.bands) for point in proof.points)
    return proof.modes == shaper.design.modes and not proof.points


def _inside(point: Tolerated, bands: tuple[Band, ...]) -> bool:
    """Whether a point lies in one of the bands, to rounding."""
    return any(
        band.low * (1.0 - SAME_LEAD) <= point.frequency <= band.high * (1.0 + SAME_LEAD)
        and band.least_damping - SAME_LEAD <= point.damping <= band.highest_damping + SAME_LEAD
        for band in bands
    )


def _same_end(proof: Certificate, shaper: Shaper) -> bool:
    return abs(proof.duration - shaper.duration) <= SAME_LEAD * shaper.duration
