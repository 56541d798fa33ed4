"""From a shaper for one mode to one for several: convolution, with the record of what was asked for."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import reduce
from typing import Any

from preshape.errors import InputError
from preshape.mode import Mode, Modes, ModesLike
from preshape.provenance import Design
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = ["check_tolerance", "convolve_each", "recorded", "whole_number"]


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
        residual = max(float(residual_vibration(shaper, mode.frequency, mode.damping)) for mode in design.modes)
    return Shaper(shaper.times, shaper.amplitudes, replace(design, residual=residual))


def check_tolerance(tolerance: float) -> float:
    """The tolerance as a float; InputError outside (0, 1)."""
    if not (math.isfinite(tolerance) and 0.0 < tolerance < 1.0):
        raise InputError(f"tolerance {tolerance:g} is outside (0, 1): give 0.05 for 5 % of the unshaped vibration.")
    return float(tolerance)


def whole_number(name: str, value: int, low: int, high: int) -> int:
    """The value as an int; InputError unless it is whole and within [low, high]."""
    if isinstance(value, bool) or int(value) != value or not low <= value <= high:
        raise InputError(f"{name} is {value!r}: give a whole number from {low} to {high}.")
    return int(value)
