"""Which shaper to take when several are equally short: the flattest, or the one with the fewest impulses.

At the shortest duration the impulses can only be where the certificate's polynomial touches zero. When there are more
such places than the constraints need (harmonics), the amplitudes are a face, and a second objective picks one.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from preshape.engine.basis import Basis, plain_rows
from preshape.engine.constraints import ImpulsesBetween, ZeroVibration
from preshape.engine.fewest import fewest
from preshape.engine.flattest import flattest
from preshape.engine.programme import gather
from preshape.engine.shortest import Shortest
from preshape.errors import InputError

__all__ = ["PREFERENCES", "preferred"]

PREFERENCES = ("flattest", "fewest")

SAME = 1e-7
"""Contacts and impulses closer than this fraction of the duration are the same place."""

NOTHING = 1e-12
"""An amplitude of this size is zero."""

MET = 1e-11
"""Largest miss of the constraints [-] that a choice may have."""


def preferred(found: Shortest, preference: str) -> Shortest:
    """The equally short shaper with the least next derivative of the residual (Hyde 3.2), or with fewest impulses.

    Parameters
    ----------
    found : Shortest
        With a certificate; without one nothing is known about other shapers, and it is returned as it is.
    preference : str
        "flattest" or "fewest".
    """
    if preference not in PREFERENCES:
        raise InputError(f"prefer is {preference!r}: choose one of {', '.join(PREFERENCES)}.")
    proof = found.certificate
    if proof is None or proof.modes is None or proof.points:
        return found
    duration = float(found.times[-1])
    leads = _places(duration - found.times[::-1], duration - np.array(proof.contacts[::-1]), duration)
    if leads.size <= found.times.size:
        return found
    basis = Basis(proof.modes, proof.orders, proof.reference, proof.groups)
    if preference == "fewest":
        start = np.zeros(leads.size)
        start[np.searchsorted(leads, duration - found.times[::-1])] = found.amplitudes[::-1]
        zeros = [ZeroVibration(mode, order) for mode, order in zip(proof.modes, proof.orders, strict=True)]
        few = fewest(gather([*zeros, ImpulsesBetween(0.0)], leads, basis), start)
        order = np.argsort(few.leads)
        leads, amplitudes = few.leads[order], few.amplitudes[order]
    else:
        rows, _ = plain_rows(proof.modes, tuple(order + 1 for order in proof.orders), leads, duration)
        amplitudes = flattest(basis(leads), rows)
    keep = amplitudes > NOTHING
    leads, amplitudes = leads[keep], amplitudes[keep] / amplitudes[keep].sum()
    rows, _ = plain_rows(proof.modes, proof.orders, leads, duration)
    if float(np.abs(rows @ amplitudes).max()) > MET:
        return found
    return replace(found, times=leads[-1] - leads[::-1], amplitudes=amplitudes[::-1])


def _places(impulses: NDArray[np.float64], contacts: NDArray[np.float64], duration: float) -> NDArray[np.float64]:
    """The impulses and the contacts that are not at one of them [s]."""
    away = np.abs(contacts[:, None] - impulses[None, :]).min(axis=1) > SAME * duration
    return np.sort(np.concatenate([impulses, contacts[away]]))
