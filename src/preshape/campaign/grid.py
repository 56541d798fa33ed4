"""A grid of parameters: axes in a campaign file, and the values at each of its points."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Annotated

import msgspec
import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError

__all__ = ["AxisSettings", "Grid"]

MOST_POINTS = 10_000_000
"""Of a campaign: their results are held in memory together at its end, a gigabyte."""


class AxisSettings(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    """One axis: values, or so many from low to high."""

    values: Annotated[list[float], msgspec.Meta(min_length=1, max_length=100_000)] | None = None
    low: float | None = None
    high: float | None = None
    count: Annotated[int, msgspec.Meta(ge=2, le=100_000)] | None = None


class Grid:
    """Each value of the first axis with each of the second, and so on; the last axis runs fastest.

    Parameters
    ----------
    axes : mapping of str to AxisSettings
        By parameter.
    units : mapping of str to str
        Of the parameters that there are.

    Raises
    ------
    InputError
        If an axis is no parameter, its values do not increase, or there are too many points.

    Examples
    --------
    >>> grid = Grid({"length": AxisSettings(low=1.0, high=3.0, count=3)}, {"length": "m"})
    >>> len(grid), dict(grid.at(2))
    (3, {'length': 3.0})
    """

    def __init__(self, axes: Mapping[str, AxisSettings], units: Mapping[str, str]) -> None:
        if not 1 <= len(axes) <= 6:
            raise InputError(f"the grid has {len(axes)} axes: give one to six.")
        for name in axes:
            if name not in units:
                known = f"it has {', '.join(units)}" if units else "it has none"
                raise InputError(f"the axis {name!r} is no parameter of the machine: {known}.")
        self.axes: dict[str, NDArray[np.float64]] = {name: _values(name, axis) for name, axis in axes.items()}
        self.units = {name: units[name] for name in axes}
        self.shape = tuple(axis.size for axis in self.axes.values())
        if math.prod(self.shape) > MOST_POINTS:
            raise InputError(f"the grid has {math.prod(self.shape)} points: give at most {MOST_POINTS}.")

    def __len__(self) -> int:
        return math.prod(self.shape)

    def indices(self, point: int) -> Sequence[int]:
        """Of the values of each axis, of a point."""
        return [int(k) for k in np.unravel_index(point, self.shape)]

    def at(self, point: int) -> Mapping[str, float]:
        """The values of a point, by axis [its unit]."""
        return {name: float(axis[k]) for (name, axis), k in zip(self.axes.items(), self.indices(point), strict=True)}


def _values(name: str, axis: AxisSettings) -> NDArray[np.float64]:
    ends = (axis.low, axis.high, axis.count)
    if (axis.values is None) == (None in ends) or (axis.values is not None and any(end is not None for end in ends)):
        raise InputError(f"the axis {name!r} needs values, or low, high and count: give one of the two.")
    if axis.values is not None:
        values = np.array(axis.values)
    else:
        assert axis.low is not None and axis.high is not None and axis.count is not None
        values = np.linspace(axis.low, axis.high, axis.count)
    if not np.isfinite(values).all() or (np.diff(values) <= 0.0).any():
        raise InputError(f"the values of the axis {name!r} do not increase: give finite ones, each once, in order.")
    return values
