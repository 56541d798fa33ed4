"""A shaper on a controller's sample grid, with what that costs at the design modes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from preshape.design.each_mode import recorded
from preshape.shaper import Shaper

__all__ = ["on_grid"]


def on_grid(shaper: Shaper, dt: float) -> Shaper:
    """The shaper with every impulse on a multiple of `dt` [s], each split linearly between its two neighbours.

    The mean delay stays exact; ``design.residual`` is the residual vibration that is left at the design modes.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    dt : float
        Sample time of the controller [s].

    Raises
    ------
    InputError
        If dt is not a positive number.

    Examples
    --------
    >>> import preshape
    >>> coarse = on_grid(preshape.design.zv((40.0, 0.0)), 0.001)
    >>> coarse.times.round(6).tolist(), coarse.design.residual < 0.01
    ([0.0, 0.012, 0.013], True)
    """
    delays, weights = shaper.taps(dt)
    settings = {**shaper.design.settings, "dt": float(dt)}
    status = "feasible" if shaper.design.status in ("exact", "optimal") else shaper.design.status
    design = replace(shaper.design, settings=settings, status=status, certificate=None)
    return recorded(Shaper(delays * np.float64(dt), weights / weights.sum()), design)
