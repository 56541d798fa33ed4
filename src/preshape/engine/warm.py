"""The shortest shaper at or near one that is known: Newton's method alone, verified as any other.

When modes have moved by little (a robot in another pose, a payload), impulses, duration and multipliers have moved by
little too. The constraint functions keep their form when time is stretched with the periods, so the old solution,
stretched, is the start. This is the real-time redesign that Hyde's chapter 6 asks for.
"""

from __future__ import annotations

import math

import numpy as np

from preshape.engine.basis import Basis
from preshape.engine.repair import confirmed
from preshape.engine.shortest import Shortest, proved
from preshape.mode import Modes
from preshape.shaper import Shaper

__all__ = ["shortest_from", "shortest_near"]

PIVOTS, STEPS = 3, 12
"""Impulses that may appear, vanish or merge on the way, and Newton steps each; beyond that the search is quicker."""


def shortest_near(modes: Modes, orders: tuple[int, ...], previous: Shaper) -> Shortest | None:
    """The proved shortest shaper by Newton's method from `previous`, or None when it does not lead there.

    Parameters
    ----------
    modes, orders
        As for :func:`preshape.engine.shortest_positive`.
    previous : Shaper
        With a certificate for as many modes of the same orders, in the same order.
    """
    proof = previous.design.certificate
    if proof is None or proof.modes is None or proof.points or proof.orders != orders or not proof.groups:
        return None
    logarithms = [math.log(old.frequency / new.frequency) for old, new in zip(proof.modes, modes, strict=True)]
    stretch = math.exp(sum(logarithms) / len(logarithms))
    basis = Basis(modes, orders, proof.reference * stretch, proof.groups)
    multipliers = basis.multipliers(np.array(proof.coefficients))
    leads = (previous.duration - previous.times[::-1]) * stretch
    found = confirmed(basis, leads, previous.amplitudes[::-1], multipliers, pivots=PIVOTS, steps=STEPS)
    return None if found is None else proved(basis, found)


def shortest_from(modes: Modes, orders: tuple[int, ...], closed_form: Shaper) -> Shortest | None:
    """The proof that a closed form is the shortest shaper, or None when it is not.

    A closed form knows no multipliers: the polynomial that is zero at its impulses, and flat at those inside, is unique
    up to its sign; the rest is verified as ever.
    """
    leads = closed_form.duration - closed_form.times[::-1]
    basis = Basis(modes, orders, closed_form.duration)
    raw = basis.raw(leads)
    touching = np.concatenate([basis.values(raw).T, basis.slopes(raw, 1).T[1:-1] * closed_form.duration])
    multipliers = np.linalg.svd(touching)[2][-1]
    between = 0.5 * (leads[1:] + leads[:-1])
    if float((multipliers @ basis(between)).sum()) < 0.0:
        multipliers = -multipliers
    found = confirmed(basis, leads, closed_form.amplitudes[::-1], multipliers, pivots=0)
    return None if found is None else proved(basis, found)
