"""Structure: what a force does one after the other, in arcs: full force, or holding an output on its limit."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

__all__ = ["Arc", "Structure", "Touch"]


@dataclass(frozen=True)
class Arc:
    """One level of the force.

    Parameters
    ----------
    start : float
        When it begins [s].
    level : float
        [-], in units of the largest force.
    row : int or None
        The output that it holds on its limit; None for full force.
    sign : float
        On which limit: 1 or -1.
    """

    start: float
    level: float
    row: int | None = None
    sign: float = 0.0


@dataclass(frozen=True)
class Touch:
    """An output that reaches its limit and turns back: when [s], which one, and which limit (1 or -1)."""

    time: float
    row: int
    sign: float


@dataclass(frozen=True)
class Structure:
    """Arcs one after the other up to `end` [s], and the touches during them."""

    arcs: tuple[Arc, ...]
    touches: tuple[Touch, ...]
    end: float

    @property
    def times(self) -> NDArray[np.float64]:
        """Starts of the arcs and the end [s], shape (arc + 1,)."""
        return np.array([arc.start for arc in self.arcs] + [self.end])

    @property
    def levels(self) -> NDArray[np.float64]:
        """[-], shape (arc,)."""
        return np.array([arc.level for arc in self.arcs])

    @property
    def steps(self) -> NDArray[np.float64]:
        """By how much the force steps at each time, the end included [-], shape (arc + 1,)."""
        return np.diff(self.levels, prepend=0.0, append=0.0)

    def without(self, number: int) -> Structure:
        """Without one arc; its neighbours meet in the middle of it, or are one if they do the same."""
        first, last = number == 0, number == len(self.arcs) - 1
        times = self.times
        middle = 0.5 * float(times[number] + times[number + 1])
        arcs = [*self.arcs[:number], *self.arcs[number + 1 :]]
        if first:
            arcs[0] = replace(arcs[0], start=float(times[0]))
        elif not last:
            before, after = arcs[number - 1], arcs[number]
            same = (before.level, before.row, before.sign) == (after.level, after.row, after.sign)
            arcs[number - 1 : number + 1] = [before] if same else [before, replace(after, start=middle)]
        return Structure(tuple(arcs), self.touches, self.end)

    @property
    def contacts(self) -> list[tuple[float, int, float]]:
        """When an output reaches a limit [s], which output, and which limit: first the holds, then the touches."""
        held = [(arc.start, arc.row, arc.sign) for arc in self.arcs if arc.row is not None]
        return held + [(touch.time, touch.row, touch.sign) for touch in self.touches]
