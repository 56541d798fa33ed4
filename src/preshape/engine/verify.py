"""Checking a proof that comes from elsewhere: everything is computed anew from the certificate's coefficients."""

from __future__ import annotations

import numpy as np

from preshape.engine.basis import Basis
from preshape.engine.projection import nearest_on
from preshape.provenance import EXCLUDED_AT, MINIMUM_ALLOWED, TOUCHING, Certificate
from preshape.shaper import Shaper

__all__ = ["is_proved_shortest"]

MET = 1e-10
"""Largest miss of the constraint integrals (rows scaled to 1) that counts as met by a shaper from a file."""

SAME_TIME = 1e-9
"""Times that agree to this fraction of the duration are the same."""


def is_proved_shortest(shaper: Shaper) -> bool:
    """Whether the certificate that a shaper carries proves it shortest; nothing that it says of itself is believed.

    The impulses are positive and meet the certificate's constraints; its polynomial is nowhere below zero and touches
    zero at every impulse; and the points where it touches before the end cannot meet the constraints without the end.

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
    if proof is None or proof.modes != shaper.design.modes or not _same_end(proof, shaper):
        return False
    basis = Basis(proof.modes, proof.orders, shaper.duration)
    if not (shaper.amplitudes > 0.0).all() or np.abs(basis.raw(shaper.times) @ shaper.amplitudes).max() > MET:
        return False
    multipliers = basis.multipliers(np.array(proof.coefficients))
    minima = basis.minima(multipliers, shaper.duration)
    fine = np.linspace(0.0, shaper.duration, basis.samples_needed(shaper.duration))
    largest = float(np.abs(multipliers @ basis(fine)).max())
    if largest == 0.0 or float((multipliers @ basis(minima)).min()) < MINIMUM_ALLOWED * largest:
        return False
    if float(np.abs(multipliers @ basis(shaper.times)).max()) > TOUCHING * largest:
        return False
    contacts = np.union1d(minima[multipliers @ basis(minima) < TOUCHING * largest], shaper.times)
    before = contacts[contacts < shaper.duration * (1.0 - SAME_TIME)]
    return nearest_on(basis, before).distance > EXCLUDED_AT


def _same_end(proof: Certificate, shaper: Shaper) -> bool:
    return abs(proof.duration - shaper.duration) <= SAME_TIME * shaper.duration
