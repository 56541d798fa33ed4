"""From a shaper for one mode to one for several: convolution, with the record of what was asked for."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import reduce
from typing import Any

import numpy as np

from preshape.errors import InputError
from preshape.mode import Mode, Modes, ModesLike
from preshape.provenance import Design
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = ["convolve_each", "impulses_only", "recorded"]


def convolve_each(
    modes: ModesLike, family: str, one: Callable[[Mode], Shaper], settings: Mapping[str, Any] | None = None
) -> Shaper:
    """One shaper a mode, convolved; status "exact"."""
    wanted = Modes(modes)
    shaper = reduce(Shaper.convolve, [one(mode) for mode in wanted])
    return recorded(shaper, Design(family, wanted, settings or {}, "exact"))


def recorded(shaper: Shaper, design: Design) -> Shaper:
    """The shaper with its design, the residual at the design modes measured."""
    residual = None
    if design.modes is not None:
        frequencies, dampings = np.array([(mode.frequency, mode.damping) for mode in design.modes]).T
        residual = float(residual_vibration(shaper, frequencies, dampings).max())
    return shaper.with_design(replace(design, residual=residual))


def impulses_only(shaper: Shaper, what: str) -> Shaper:
    """`shaper`, if it has no boxes; `what` cannot do with them."""
    if shaper.boxes:
        raise InputError(
            f"{what} takes impulses only, and this shaper has parts of constant density: put it on a sample grid first "
            "(design.on_grid)."
        )
    return shaper
