"""When the move stops in each of several recordings of it, and how surely.

The stop of the first unshaped recording is found in itself, or is its beginning and the time that the move is known to
take. All others follow from it by laying the recordings over each other. Where that fails, each stands for itself.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from preshape.errors import InputError
from preshape.identify import TimeSeries
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
"""A stop whose standard deviation is larger is not known [s]."""

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
    trouble: list[str] = []
    first = _alone(*before[0], sides[0][0], lasting)
    side_b, _, odd = _laid_over(before[0][1], first, before, sides[0], None)
    trouble += [f"{name}: {_OTHER}" for name in odd]
    if shaper is not None:
        side_a, overlays, odd = _laid_over(before[0][1], first, after, sides[1], shaper)
    if shaper is None or odd or None in overlays:
        if shaper is not None and odd:
            trouble.append(
                f"{', '.join(odd)}: the recording is not what the shaper makes of {before[0][0]}: the machine executed "
                "another shaper, or it was another move."
            )
        alone = _alone(*after[0], sides[1][0], None)
        side_a, _, odd = _laid_over(after[0][1], alone, after, sides[1], None)
        trouble += [f"{name}: {_OTHER}" for name in odd]
        between = math.hypot(first.spread, alone.spread)
    else:
        known = [one for one in overlays if one is not None]
        between = float(np.mean([one.spread for one in known]))
        trouble += _stretched(known, shaper)
    spread = max(motion.spread for motion in (*side_b, *side_a))
    doubtful = spread > VAGUE
    if doubtful:
        trouble.append(
            f"the stop was not found to better than {1e3 * spread:.0f} ms: give it, or how long the move lasts."
        )
    return Stops(tuple(side_b), tuple(side_a), between, SURELY_AFTER * spread, doubtful, tuple(trouble))


_OTHER = "the recording is not of the same move as the first of its kind."


def _alone(name: str, series: TimeSeries, motion: Motion, lasting: float | None) -> Motion:
    """A motion with the stop that its own recording shows."""
    if lasting is None:
        at, spread = find_stop(series, motion.begin)
        return replace(motion, stop=at, spread=spread)
    if motion.begin is None:
        raise InputError(
            f"{name} does not show the beginning of the move, which --lasting counts from: record from rest, or give "
            "the stop."
        )
    return replace(motion, stop=motion.begin + lasting, spread=motion.begin_spread)


def _laid_over(
    reference: TimeSeries, known: Motion, side: Named, motions: Sequence[Motion], shaper: Shaper | None
) -> tuple[list[Motion], list[Overlay | None], list[str]]:
    """Motions whose stops follow from a known one, how each recording lies over it, and names of what does not fit."""
    found: list[Motion] = []
    overlays: list[Overlay | None] = []
    odd: list[str] = []
    for (name, series), motion in zip(side, motions, strict=True):
        overlay = None
        if series is reference:
            found.append(known)
            overlays.append(None)
            continue
        if known.floor is not None and motion.floor is not None:
            overlay = overlaid(reference, series, shaper, (known.floor, motion.floor))
            if overlay.unexplained > OTHER_MOVE:
                odd.append(name)
                overlay = None
        if overlay is not None:
            at, spread = known.stop + overlay.later, math.hypot(known.spread, overlay.spread)
        else:
            at, spread = find_stop(series, motion.begin)
        overlays.append(overlay)
        found.append(replace(motion, stop=at, spread=spread))
    return found, overlays, odd


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
