"""Hyde's two-phase interpretation (3.4.3.a): the many impulses of a mesh become the few of an exact shaper.

Phase one squashes neighbours halfway between their slots. Phase two replaces the closest two impulses, one pair at a
time, by one at their amplitude-weighted mean, until the number is right.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from preshape.checks import whole_number
from preshape.design.each_mode import recorded
from preshape.design.mesh.problem import orders_of
from preshape.design.mesh.squash import squashed
from preshape.errors import InputError
from preshape.shaper import Shaper

__all__ = ["interpreted", "needed_impulses"]

MOST_IMPULSES = 10_000


def interpreted(shaper: Shaper, dt: float, impulses: int | None = None) -> Shaper:
    """A mesh shaper with fewer impulses, as a guess of the exact one; see :func:`solved_from`.

    Parameters
    ----------
    shaper : Shaper
        Positive impulses on a grid, as from :func:`mesh`.
    dt : float
        The grid [s].
    impulses : int, optional
        How many to keep. By default as many as make the constraint equations square: one, and one for each mode and
        each order up to its own (2m + 1 for m modes and order 1, as Hyde has it).

    Returns
    -------
    Shaper
        Status "given": it meets no constraint exactly; ``design.residual`` is what it leaves.

    Raises
    ------
    InputError
        If the impulses are not on the grid, or their number is needed and the shaper does not know its modes.

    References
    ----------
    Hyde, 3.4.3.a.

    Examples
    --------
    >>> import preshape
    >>> modes = [(0.20, 0.0), (0.26, 0.0), (0.45, 0.0), (0.59, 0.0)]
    >>> shaper = preshape.design.mesh(modes, dt=0.1)
    >>> len(shaper), len(interpreted(shaper, dt=0.1))
    (17, 9)
    """
    wanted = needed_impulses(shaper) if impulses is None else whole_number("impulses", impulses, 1, MOST_IMPULSES)
    half = squashed(shaper, dt, keep_grid=False)
    times, amplitudes = half.times.tolist(), half.amplitudes.tolist()
    while len(times) > wanted:
        i = int(np.argmin(np.diff(times)))
        first, second = amplitudes[i], amplitudes[i + 1]
        mean = (first * times[i] + second * times[i + 1]) / (first + second)
        times[i : i + 2], amplitudes[i : i + 2] = [mean], [first + second]
    settings = {**shaper.design.settings, "interpreted": len(times)}
    design = replace(shaper.design, settings=settings, status="given", certificate=None)
    return recorded(Shaper.normalised(times, amplitudes), design)


def needed_impulses(shaper: Shaper) -> int:
    """One, and one for each complex equation: the number that makes Hyde's equations square."""
    modes = shaper.design.modes
    if modes is None:
        raise InputError("this shaper does not know its modes: say how many impulses to keep.")
    return 1 + sum(order + 1 for order in orders_of(modes, shaper.design.settings.get("order", 1)))
