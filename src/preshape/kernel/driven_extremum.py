"""The exact extremum over all time of an output of driven phasors: y(t) = Re sum_j w_j q_j(t) + a piecewise polynomial.

Samples only start the search. On an interval of width h the output cannot exceed its larger end by more than
h^2/8 max|y''|, and what max|y''| can be is known from the phasors at the interval's start, because |q| cannot grow but
by the input. Intervals that cannot hold the extremum are dropped; where y'' keeps its sign the one root of y' is found
by safeguarded Newton; the rest is split. So nothing between samples is missed, however coarse they are.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.kernel.driven_output import DrivenOutput
from preshape.kernel.driven_phasors import DrivenPhasors, taylor_shifted

__all__ = ["Extremum", "Stretch", "extremum", "first_stretches", "parts_of", "split"]

SAMPLES_PER_PERIOD = 8
"""First samples in a period of the fastest phasor; more or fewer change the cost, not the result."""

PARTS = 4
"""Into how many an interval is split: the second-order bound tightens by 16 each time."""

BLOCK = 1 << 14
"""Intervals looked at together, so that a long motion does not need all its samples at once."""

MOST_INTERVALS = 1 << 20
"""Split no further beyond this many at a time: then the bound is above the value, and says so."""

TAIL_PERIODS = 64
"""Free vibration of several undamped modes never repeats and comes as near to the sum of its amplitudes as one likes;
it is followed for this many periods of the slowest phasor, and the bound says what may come later."""

ROUNDING = 8.0 * np.finfo(float).eps
"""Differences below this fraction of what is added up are rounding."""

NEWTON_STEPS = 60
"""More than bisection alone would need."""

CLOSE = 1e-6
"""A Newton step of this fraction of the interval is the last: the next would be about its square."""


@dataclass(frozen=True, slots=True)
class Extremum:
    """Where an output is largest.

    Parameters
    ----------
    value : float
        The largest value found, as measured (of \\|y\\|, y, or -y); infinite when the output grows for ever.
    time : float
        When [s]; the earliest found.
    bound : float
        What it cannot exceed at any time; above `value` only for endless undamped vibration that
        has another mode beside it, and comes ever nearer to its largest value without reaching it.
    """

    value: float
    time: float
    bound: float


def extremum(output: DrivenOutput, sign: int = 0) -> Extremum:
    """The largest \\|y\\| (sign 0), y (sign 1) or -y (sign -1) over all time, the rest at 0 before the start included.

    Parameters
    ----------
    output : DrivenOutput
        The output.
    sign : int
        What is measured.
    """
    if output.phasors.starts.size == 0:
        return Extremum(0.0, 0.0, 0.0)
    search = _Search(output, sign)
    for stretch in first_stretches(output.phasors):
        search.run(stretch)
    last = np.array([output.phasors.starts.size - 1])
    search.see(last, np.zeros(1), output.values(last, np.zeros(1))[0])
    return search.tail()


@dataclass(frozen=True, eq=False, slots=True)
class Stretch:
    """Stretches of segments, each to be cut into equal intervals.

    Parameters
    ----------
    segment : ndarray of int, shape (stretch,)
        Which segment each lies in.
    since, length : ndarray, shape (stretch,)
        Where it begins in it, and how long it is [s].
    parts : ndarray of int, shape (stretch,)
        Into how many intervals it is cut.
    """

    segment: NDArray[np.intp]
    since: NDArray[np.float64]
    length: NDArray[np.float64]
    parts: NDArray[np.intp]

    def nodes(self) -> tuple[NDArray[np.intp], NDArray[np.float64], NDArray[np.float64], NDArray[np.intp]]:
        """Segment, offset and width of the interval that begins at each node, and which nodes begin one.

        The end of a stretch is a node of its own, in its own segment: at a step the output may jump after it.
        """
        count = self.parts + 1
        ends = np.cumsum(count)
        position = np.arange(int(ends[-1])) - np.repeat(ends - count, count)
        width = np.repeat(self.length / self.parts, count)
        begins = np.ones(position.size, dtype=bool)
        begins[ends - 1] = False
        return (
            np.repeat(self.segment, count),
            np.repeat(self.since, count) + position * width,
            width,
            np.flatnonzero(begins),
        )


def first_stretches(phasors: DrivenPhasors) -> Iterator[Stretch]:
    """All segments but the endless last, in order, cut into intervals for the fastest phasor, block by block."""
    gaps = np.diff(phasors.starts)
    which = np.flatnonzero(gaps)
    gaps = gaps[which]
    parts = parts_of(phasors, gaps)
    if 0 < parts.sum() <= BLOCK:
        yield Stretch(which, np.zeros(gaps.size), gaps, parts)
        return
    for segment, gap, count in zip(which, gaps, parts, strict=True):
        blocks = -(-int(count) // BLOCK)
        for k in range(blocks):
            yield split(int(segment), k * gap / blocks, gap / blocks, -(-int(count) // blocks))


def parts_of(phasors: DrivenPhasors, lengths: NDArray[np.float64]) -> NDArray[np.intp]:
    """How many intervals to begin with in stretches of these lengths [s]."""
    fastest = float(np.abs(phasors.poles).max(initial=0.0))
    return np.ceil(lengths * (fastest * SAMPLES_PER_PERIOD / (2.0 * np.pi))).astype(np.intp) + 1


def split(segment: int, since: float, length: float, parts: int) -> Stretch:
    """One stretch."""
    return Stretch(np.array([segment]), np.array([since]), np.array([length]), np.array([parts]))


class _Search:
    """The best found so far, and what is done to find a better one."""

    def __init__(self, output: DrivenOutput, sign: int) -> None:
        self.output, self.sign = output, sign
        self.best, self.time = 0.0, float(output.phasors.starts[0])
        self.scale, self.unresolved = 0.0, 0.0

    def measure(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        return np.abs(values) if self.sign == 0 else self.sign * values

    def see(self, segment: NDArray[np.intp], since: NDArray[np.float64], values: NDArray[np.float64]) -> None:
        """Keep the best of `values`."""
        measured = self.measure(values)
        at = int(np.argmax(measured))
        if measured[at] > self.best + ROUNDING * self.scale:
            self.time = float(self.output.phasors.starts[segment[at]] + since[at])
        self.best = max(self.best, float(measured[at]))

    def run(self, stretch: Stretch) -> None:
        """Search stretches, splitting what cannot be decided."""
        while True:
            segment, since, width, begin = stretch.nodes()
            here = self.output.looked(segment, since, width)
            self.scale = max(self.scale, float(here.size.max()))
            self.see(segment, since, here.value)
            measured = self.measure(here.value)
            ends = np.maximum(measured[begin], measured[begin + 1])
            most = ends + width[begin] ** 2 / 8.0 * here.most_curvature[begin]
            open_ = np.flatnonzero(most > self.best + ROUNDING * self.scale)
            at = begin[open_]
            bent = np.abs(here.curvature[at]) > width[at] * here.most_third[at]
            turns = at[bent & (here.slope[at] * here.slope[at + 1] < 0.0)]
            if turns.size:
                self._newton(segment[turns], since[turns], width[turns], here.slope[turns], here.slope[turns + 1])
            left = ~bent & (most[open_] > self.best + ROUNDING * self.scale)
            at = at[left]
            if at.size == 0:
                return
            if at.size * PARTS > MOST_INTERVALS:
                self.unresolved = max(self.unresolved, float(most[open_][left].max()))
                return
            stretch = Stretch(segment[at], since[at], width[at], np.full(at.size, PARTS))

    def _newton(
        self,
        segment: NDArray[np.intp],
        since: NDArray[np.float64],
        width: NDArray[np.float64],
        first: NDArray[np.float64],
        last: NDArray[np.float64],
    ) -> None:
        """The root of y' in each interval in which y'' keeps its sign and y' goes from `first` through 0 to `last`."""
        low, high = since, since + width
        t = since + width * (first / (first - last))
        for _ in range(NEWTON_STEPS):
            value, slope, curvature = self.output.values(segment, t, 2)
            before = slope * first > 0.0
            low, high = np.where(before, t, low), np.where(before, high, t)
            step = -slope / np.where(curvature == 0.0, np.inf, curvature)
            inside = (t + step >= low) & (t + step <= high) & (curvature != 0.0)
            step = np.where(inside, step, 0.5 * (low + high) - t)
            t = t + step
            if (np.abs(step) <= CLOSE * width)[inside].all() and ((high - low) <= CLOSE * width)[~inside].all():
                break
        # On the parabola that Newton's last step assumes, half the slope over that step is what is left to gain.
        self.see(segment, t, value + np.where(inside, 0.5 * slope * step, 0.0))

    def tail(self) -> Extremum:
        """Follow the motion after the last step until it cannot exceed the best any more."""
        phasors = self.output.phasors
        last, sizes = phasors.starts.size - 1, np.abs(phasors.poles)
        level, free = self.output.ending()
        level = self.sign * level if self.sign else np.abs(level)
        moving = np.flatnonzero(level[1:])
        if moving.size and level[1 + moving[-1]] > 0.0:
            return Extremum(float("inf"), float("inf"), float("inf"))

        def later(since: float) -> float:
            """What the measured output cannot exceed later than `since` after the last step."""
            then = taylor_shifted(level[np.newaxis], np.array([since]))[:, 0] if since else level
            rest = then[0] + free @ np.exp(phasors.poles.real * since)
            return float(rest) if (then[1:] <= 0.0).all() else float("inf")

        since, used, periods = 0.0, 0, 0
        block = 2.0 * np.pi / float(sizes.min()) if sizes.size else 0.0
        bound = later(0.0)
        while bound > self.best + 16.0 * ROUNDING * max(self.scale, bound):
            count = int(parts_of(phasors, np.array([block]))[0])
            if periods >= TAIL_PERIODS or block == 0.0 or used + count > MOST_INTERVALS:
                return Extremum(self.best, self.time, max(bound, self.unresolved))
            pieces = -(-count // BLOCK)
            for k in range(pieces):
                self.run(split(last, since + k * block / pieces, block / pieces, -(-count // pieces)))
            since, used, periods = since + block, used + count, periods + 1
            bound = later(since)
        return Extremum(self.best, self.time, max(self.best, self.unresolved))
