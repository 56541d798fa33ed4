"""What a stream is made of: numbers, shapers on the grid, the kernel that is there."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError
from preshape.kernel import EngineLike, ReferenceEngine, Taps, compiled
from preshape.shaper import Shaper

__all__ = ["engine_of", "numbers", "row_of", "taps_of"]

MOST_STAGES = 64
LARGEST_GAIN = 1e18
"""The stages' magnitudes multiplied may not exceed this: with the kernel's limit of a sample, nothing overflows."""


def engine_of(axes: int, stages: tuple[Taps, ...], pass_bad: bool) -> EngineLike:
    """The compiled kernel, or its twin in NumPy with a warning."""
    if compiled is not None:
        engine: EngineLike = compiled.Engine(axes, stages, pass_bad)
        return engine
    warnings.warn(
        "preshape was installed without a C compiler: streams run on NumPy, to the same bits but slower",
        RuntimeWarning,
        stacklevel=1,
    )
    return ReferenceEngine(axes, stages, pass_bad)


def row_of(shaper: Shaper | Sequence[Shaper]) -> tuple[Shaper, ...]:
    """One shaper, or several in a row, as a tuple; InputError when they are none."""
    shapers = [shaper] if isinstance(shaper, Shaper) else shaper
    if not isinstance(shapers, Sequence) or not all(isinstance(one, Shaper) for one in shapers):
        raise InputError(f"{shaper!r} is no shaper: give a Shaper, or a list of them.")
    if not 1 <= len(shapers) <= MOST_STAGES:
        raise InputError(f"{len(shapers)} shapers were given: give 1 to {MOST_STAGES} in a row.")
    return tuple(shapers)


def taps_of(shapers: Sequence[Shaper], dt: float) -> tuple[Taps, ...]:
    """The stages on the grid."""
    gain = float(np.prod([one.magnitude for one in shapers]))
    if not gain <= LARGEST_GAIN:
        raise InputError(f"these shapers in a row may amplify by {gain:g}: up to {LARGEST_GAIN:g} is allowed.")
    taps = [one.taps(dt) for one in shapers]
    return tuple((delays.astype(np.uint32), np.ascontiguousarray(weights)) for delays, weights in taps)


def numbers(values: ArrayLike) -> NDArray[np.float64]:
    """The values as floats; InputError when they are none."""
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{values!r} is not made of numbers.") from None
