"""How far a mode bends when it sets off at a shaped speed, relative to setting off at once: exact, one number."""

from __future__ import annotations

import math

import numpy as np

from preshape.kernel import DrivenOutput, driven_phasors, extremum
from preshape.mode import ModesLike, one_mode
from preshape.shaper import Shaper

__all__ = ["deflection_ratio", "ramp_deflection"]


def ramp_deflection(mode: ModesLike) -> float:
    """Peak deflection [m] of a mode that sets off at 1 m/s at once: exp(-s phi) / w, cos(phi) = z, s = z/sqrt(1 - z^2).

    Parameters
    ----------
    mode : Mode or (frequency, damping)
        d'' + 2 z w d' + w^2 d = r'', the deflection of a mass on a carrier at r.
    """
    one = one_mode(mode)
    z = one.damping
    return math.exp(-z / math.sqrt(1.0 - z**2) * math.acos(z)) / one.omega


def deflection_ratio(shaper: Shaper, mode: ModesLike) -> float:
    """The largest deflection of a mode that sets off at a shaped constant speed, over that without the shaper [-].

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    mode : Mode or (frequency, damping)
        Natural frequency [Hz] and damping ratio [-] of what bends, which need not be that of the design.

    References
    ----------
    Robertson, section III.

    Examples
    --------
    >>> import preshape
    >>> round(deflection_ratio(preshape.design.zv((1.0, 0.0)), (1.0, 0.0)), 12)
    0.5
    """
    one = one_mode(mode)
    edges = [edge for box in shaper.boxes for edge in (box.start, box.end)]
    starts = np.unique(np.concatenate([shaper.times, edges]))
    density = np.zeros((starts.size, 1))
    for box in shaper.boxes:
        density[(starts >= box.start) & (starts < box.end)] = box.density
    kicks = np.zeros((1, starts.size), dtype=complex)
    kicks[0, np.searchsorted(starts, shaper.times)] = shaper.amplitudes
    phasors = driven_phasors(np.array([one.pole]), starts, density, kicks)
    # d = Im q / w_d for q' = s q + the shaper's density.
    output = DrivenOutput(phasors, np.array([-1j / one.omega_d]), np.zeros((starts.size, 1)))
    return extremum(output).value / ramp_deflection(one)
