"""Simulation: what a plant did under a sampled command, as every plant returns it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Simulation"]


@dataclass(frozen=True, eq=False)
class Simulation:
    """The motion of a plant under a sampled command.

    Attributes
    ----------
    times : ndarray, shape (sample,)
        [s].
    command : ndarray, shape (input, sample)
        What was commanded [unit of the input].
    outputs : mapping of str to ndarray, shape (sample,)
        By name [unit of the output].
    units : mapping of str to str
        Of the outputs, by name.
    energy : mapping of str to ndarray, shape (sample,), optional
        [J], by name, where the plant accounts for it.
    """

    times: NDArray[np.float64]
    command: NDArray[np.float64]
    outputs: Mapping[str, NDArray[np.float64]]
    units: Mapping[str, str]
    energy: Mapping[str, NDArray[np.float64]] | None = None
