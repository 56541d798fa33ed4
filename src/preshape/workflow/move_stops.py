"""When the move stops in each of several recordings of it, and how surely.

The recordings are laid over each other, so that the stop of one tells those of all. Each recording gives its vote on
where that is; how far the votes are apart is how surely it is known. Where the time that the move takes is known, the
stop is so long after the beginning. Where the recordings do not fit, each stands for itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from preshape.errors import InputError
from preshape.identify import TimeSeries, ring_down
from preshape.mode import Mode
from preshape.shaper import Shaper
from preshape.workflow.same_move import Overlay, overlaid
from preshape.workflow.stop_time import Motion, find_motion, find_stop

__all__ = ["Stops", "find_stops"]

OTHER_MOVE = 0.12
"""What does not fit, as a part of the motion, from which on another shaper or another move was executed: of fresh
machines that did what they were told at most 0.09 was seen."""

SURELY_AFTER = 2.0
"""The vibration is free so many standard deviations after the stop."""

VAGUE = 0.003
"""A stop whose standard deviation is larger is said not to be known [s]."""

ALONE = 0.001
"""Standard deviation of a stop that was found, at least [s]."""

LATEST = 0.02
"""The guard is at most so long [s]."""

FEWEST = 32
"""Samples in which modes are looked for."""

Named = Sequence[tuple[str, TimeSeries]]


@dataclass(frozen=True)
class Stops:
    """The moves in the recordings.

    Parameters
    ----------
    before, after : tuple of Motion
        For each recording.
    between : float
        Standard deviation of the stops after minus the stops before [s]: what a ratio of amplitudes is off by.
    guard : float
        Time after each stop from which on the vibration is surely free [s].
    doubtful : bool
        Whether nothing can be said of amplitudes before the stops are given.
    trouble : tuple of str
        Sentences.
    """

    before: tuple[Motion, ...]
    after: tuple[Motion, ...]
    between: float
    guard: float
    doubtful: bool
    trouble: tuple[str, ...]

    @property
    def spread(self) -> float:
        """Standard deviation of the stops [s]; infinite where that is too much for a window that begins at them."""
        largest = max(motion.spread for motion in (*self.before, *self.after))
        return math.inf if self.doubtful or largest > VAGUE else largest


def find_stops(
    before: Named,
    after: Named,
    shaper: Shaper | None,
    stop: tuple[float, float] | None,
    lasting: float | None,
) -> Stops:
    """Stops of all recordings: as given, or found.

    Parameters
    ----------
    before, after : sequence of (name, TimeSeries)
        Without and with the shaper.
    shaper : Shaper or None
        What was to be executed.
    stop : pair of float or None
        Before and after [s], where they are known.
    lasting : float or None
        How long the unshaped move takes [s], where that is known.
    """
    sides = [[find_motion(one) for _, one in side] for side in (before, after)]
    if stop is not None:
        given = [tuple(replace(m, stop=at, spread=0.0) for m in side) for side, at in zip(sides, stop, strict=True)]
        return Stops(given[0], given[1], 0.0, 0.0, False, ())
    if lasting is not None:
        for (name, _), motion in zip(before, sides[0], strict=True):
            if motion.begin is None:
                raise InputError(
                    f"{name} does not show the beginning of the move, from which the time it takes is counted: record "
                    "from rest, or give the stop."
                )
    trouble: list[str] = []
    starts = [_alone(before[k][1], m, lasting) for k, m in enumerate(sides[0])]
    known = _modes_after(before[0][1], starts[0][0])
    ends = [find_stop(one, m.begin, known) for (_, one), m in zip(after, sides[1], strict=True)]
    # Without the shaper nothing is known of how one recording follows from the other.
    overlays = [
        None if shaper is None else _overlay(before[0], sides[0][0], one, m, shaper)
        for one, m in zip(after, sides[1], strict=True)
    ]
    odd = [
        name for (name, _), one in zip(after, overlays, strict=True) if one is not None and one.unexplained > OTHER_MOVE
    ]
    if odd:
        trouble.append(
            f"{', '.join(odd)}: the recording is not what the shaper makes of {before[0][0]}: the machine executed "
            "another shaper, or it was another move."
        )
    fitting = [one for one in overlays if one is not None and one.unexplained <= OTHER_MOVE]
    if shaper is None or len(fitting) < len(after):
        moved = [
            [replace(m, stop=at, spread=max(spread, ALONE)) for m, (at, spread) in zip(side, found, strict=True)]
            for side, found in zip(sides, (starts, ends), strict=True)
        ]
        begun = all(m.begin is not None for side in sides for m in side)
        spread = max(m.spread for side in moved for m in side) if begun else 0.0
        between = math.sqrt(2.0) * spread
        if shaper is None and begun:
            trouble.append(
                "without the shaper the stops cannot be held against each other, and one alone is not to be trusted: "
                "give the shaper (--shaper), or the stops (--stop)."
            )
        doubtful = bool(trouble) or spread > VAGUE
        if not begun:  # a recording that starts at the stop has no earlier one to look for
            moved = [[replace(m, spread=0.0) for m in side] for side in moved]
        return _told(moved, between, spread, doubtful, trouble)
    # Every recording tells the stop of the first one.
    same = [_overlay(before[0], sides[0][0], one, m, None) for one, m in zip(before[1:], sides[0][1:], strict=True)]
    off = [name for (name, _), one in zip(before[1:], same, strict=True) if one is None or one.unexplained > OTHER_MOVE]
    if off:
        trouble.append(f"{', '.join(off)}: the move is not that of {before[0][0]}.")
    later = [0.0, *(one.later if one is not None else 0.0 for one in same)]
    votes = [at - shift for (at, _), shift in zip(starts, later, strict=True)]
    if lasting is None:
        votes += [at - one.later for (at, _), one in zip(ends, fitting, strict=True)]
        spread = max(max(votes) - min(votes), ALONE)
    else:
        spread = max(sides[0][0].begin_spread, max(votes) - min(votes), 0.25 / before[0][1].sample_rate)
    middle = float(np.median(votes))
    moved = [
        [replace(m, stop=middle + shift, spread=spread) for m, shift in zip(sides[0], later, strict=True)],
        [replace(m, stop=middle + one.later, spread=spread) for m, one in zip(sides[1], fitting, strict=True)],
    ]
    trouble += _stretched(fitting, shaper)
    return _told(moved, float(np.mean([one.spread for one in fitting])), spread, False, trouble)


def _told(
    moved: Sequence[Sequence[Motion]], between: float, spread: float, doubtful: bool, trouble: list[str]
) -> Stops:
    if spread > VAGUE:
        trouble = [
            *trouble,
            f"the stop was not found to better than {1e3 * spread:.0f} ms, and amplitudes are so much less sure: "
            "give it (--stop), or how long the unshaped move lasts (--lasting).",
        ]
    return Stops(
        tuple(moved[0]), tuple(moved[1]), between, min(SURELY_AFTER * spread, LATEST), doubtful, tuple(trouble)
    )


def _alone(series: TimeSeries, motion: Motion, lasting: float | None) -> tuple[float, float]:
    """The stop of an unshaped recording by itself, and its standard deviation [s]."""
    if lasting is not None and motion.begin is not None:
        return motion.begin + lasting, motion.begin_spread
    return find_stop(series, motion.begin)


def _modes_after(series: TimeSeries, stop: float) -> list[Mode]:
    first = max(round((stop - series.start) * series.sample_rate), 0)
    values = series.values[:, first:]
    if values.shape[-1] < FEWEST:
        return []
    return [one.mode for one in ring_down(replace(series, values=values, remarks=())).modes]


def _overlay(
    first: tuple[str, TimeSeries], begun: Motion, second: tuple[str, TimeSeries], motion: Motion, shaper: Shaper | None
) -> Overlay | None:
    """None where one of them does not show the beginning."""
    if begun.floor is None or motion.floor is None:
        return None
    return overlaid(first[1], second[1], shaper, (begun.floor, motion.floor))


def _stretched(overlays: Sequence[Overlay], shaper: Shaper) -> list[str]:
    stretches = [one.stretch for one in overlays if one.stretch != 1.0]
    if not stretches:
        return []
    stretch = float(np.mean(stretches))
    return [
        f"the recordings fit the shaper better when its impulses come {abs(100.0 * (stretch - 1.0)):.0f} % "
        f"{'later' if stretch > 1.0 else 'sooner'}, as of one for a frequency by so much "
        f"{'lower' if stretch > 1.0 else 'higher'}: see what the machine was told; it seems to have executed "
        f"{1e3 * stretch * shaper.duration:.1f} ms instead of {1e3 * shaper.duration:.1f} ms."
    ]
