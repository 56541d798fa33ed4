"""Squashing: neighbouring impulses of a mesh shaper combined into one, on the grid or halfway between (Hyde 3.4.2.c).

Optimisation on a mesh often fills two neighbouring slots where it would like one impulse between them. Fewer impulses
spare a controller work; what they cost in residual vibration is measured.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from preshape.checks import positive
from preshape.design.each_mode import impulses_only, recorded
from preshape.errors import InputError
from preshape.shaper import Shaper

__all__ = ["slots_of", "squashed"]

ON_SLOT = 1e-6
"""An impulse is on the grid when it is nearer to a slot than this fraction of dt."""


def squashed(shaper: Shaper, dt: float, keep_grid: bool = True) -> Shaper:
    """The shaper with each pair of impulses in adjacent slots combined into one.

    Pairs are taken from the first impulse on, and no impulse twice: three in a row become a pair and one.

    Parameters
    ----------
    shaper : Shaper
        Positive impulses on a grid, as from :func:`mesh`.
    dt : float
        The grid [s].
    keep_grid : bool
        True: the sum of both stands in the slot of the larger one (of two equal ones, the earlier). False: halfway
        between them, off the grid, as Hyde's first phase of interpretation has it.

    Returns
    -------
    Shaper
        ``design.residual`` is what it leaves at the design modes; the status is "given", since it meets no constraint
        exactly any more. Without neighbours it is the same shaper.

    Raises
    ------
    InputError
        If an impulse is not on the grid, or negative.

    References
    ----------
    Hyde, 3.4.2.c and 3.4.3.a.

    Examples
    --------
    >>> shaper = Shaper([0.0, 0.01, 0.05], [0.3, 0.2, 0.5])
    >>> squashed(shaper, 0.01).times.tolist(), squashed(shaper, 0.01, keep_grid=False).times.round(9).tolist()
    ([0.0, 0.05], [0.0, 0.045])
    """
    places, a = slots_of(shaper, dt), shaper.amplitudes
    kept, amplitudes, i = [], [], 0
    while i < a.size:
        paired = i + 1 < a.size and places[i + 1] - places[i] == 1
        if not paired:
            kept.append(float(places[i]))
        elif keep_grid:
            kept.append(float(places[i] if a[i] >= a[i + 1] else places[i + 1]))
        else:
            kept.append(places[i] + 0.5)
        amplitudes.append(float(a[i : i + 1 + paired].sum()))
        i += 1 + paired
    if len(kept) == a.size:
        return shaper
    settings = {**shaper.design.settings, "squashed": "on the grid" if keep_grid else "halfway"}
    design = replace(shaper.design, settings=settings, status="given", certificate=None)
    return recorded(Shaper.normalised((np.array(kept) - kept[0]) * dt, amplitudes), design)


def slots_of(shaper: Shaper, dt: float) -> NDArray[np.intp]:
    """The slot of each impulse; InputError when one has none, or is negative."""
    impulses_only(shaper, "combining neighbours")
    position = shaper.times / positive("dt", dt, "s")
    places = np.rint(position)
    off = np.abs(position - places)
    if off.max() > ON_SLOT:
        worst = int(np.argmax(off))
        raise InputError(
            f"impulse {worst + 1} at {shaper.times[worst]:.9g} s is not on a grid of {dt:g} s: give the shaper's own "
            "servo period, or put it on the grid with design.rounded."
        )
    if (shaper.amplitudes <= 0.0).any():
        first = int(np.argmax(shaper.amplitudes <= 0.0))
        raise InputError(
            f"impulse {first + 1} is {shaper.amplitudes[first]:g}: only positive impulses are combined; give a shaper "
            "from design.mesh."
        )
    return places.astype(np.intp)
