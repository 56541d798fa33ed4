"""Band: natural frequencies and damping ratios that a mode may have, as a rectangle."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from numbers import Real
from typing import TypeAlias

from preshape.errors import InputError

__all__ = ["Band", "BandsLike", "bands_of"]


@dataclass(frozen=True, slots=True)
class Band:
    """Every mode with a natural frequency in [low, high] and a damping ratio in [least_damping, most_damping].

    Parameters
    ----------
    low, high : float
        Natural frequencies [Hz], 0 < low <= high; equal ones make a single frequency.
    least_damping, most_damping : float
        Damping ratios [-], 0 <= least_damping <= most_damping < 1; `most_damping` left out means the same.

    Raises
    ------
    InputError
        If the band is empty, reaches 0 Hz, or a damping ratio is out of range.

    Examples
    --------
    >>> Band(8.0, 12.0, 0.01, 0.03)
    Band(low=8.0, high=12.0, least_damping=0.01, most_damping=0.03)
    """

    low: float
    high: float
    least_damping: float = 0.0
    most_damping: float | None = None

    def __post_init__(self) -> None:
        if self.most_damping is None:
            object.__setattr__(self, "most_damping", self.least_damping)
        for name in ("low", "high", "least_damping", "most_damping"):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, Real) or not math.isfinite(value):
                raise InputError(f"a band's {name} is {value!r}: give a finite number.")
            object.__setattr__(self, name, float(value))
        if not 0.0 < self.low <= self.high:
            raise InputError(
                f"the band {self.low:g} to {self.high:g} Hz is no band of natural frequencies: give two frequencies "
                "above 0 Hz, the lower one first; a machine part that does not vibrate (0 Hz) needs no shaper."
            )
        if not 0.0 <= self.least_damping <= self.highest_damping < 1.0:
            raise InputError(
                f"the damping ratios {self.least_damping:g} to {self.highest_damping:g} are outside [0, 1) or in the "
                "wrong order: give the lower one first, such as 0.01 and 0.03."
            )

    @property
    def highest_damping(self) -> float:
        """`most_damping` as a number [-]."""
        return self.least_damping if self.most_damping is None else self.most_damping

    @property
    def middle(self) -> tuple[float, float]:
        """Frequency [Hz] and damping ratio [-] in the middle."""
        return 0.5 * (self.low + self.high), 0.5 * (self.least_damping + self.highest_damping)

    def __str__(self) -> str:
        frequencies = f"{self.low:.6g} Hz" if self.low == self.high else f"{self.low:.6g} to {self.high:.6g} Hz"
        if self.least_damping == self.highest_damping:
            return f"{frequencies}, damping {self.least_damping:.3g}"
        return f"{frequencies}, damping {self.least_damping:.3g} to {self.highest_damping:.3g}"


BandsLike: TypeAlias = "Band | tuple[float, ...] | Iterable[Band | tuple[float, ...]]"
"""A Band, (low, high) in hertz, (low, high, damping) or (low, high, least, most damping), or several of them."""


def bands_of(bands: BandsLike) -> tuple[Band, ...]:
    """Anything that :data:`BandsLike` allows, as a tuple of bands; InputError when it is none."""
    given: object = bands
    if isinstance(given, Band):
        return (given,)
    items = list(given) if isinstance(given, Iterable) and not isinstance(given, str | bytes) else [given]
    if items and all(isinstance(item, Real) for item in items):
        items = [tuple(items)]
    found = []
    for item in items:
        if isinstance(item, Band):
            found.append(item)
        elif isinstance(item, list | tuple) and 2 <= len(item) <= 4:
            found.append(Band(*item))
        else:
            raise InputError(f"{item!r} is not a band: give (low, high) in hertz, with damping ratios after them.")
    if not found:
        raise InputError("no band was given: a shaper for bands needs at least one (low, high) pair in hertz.")
    return tuple(found)
