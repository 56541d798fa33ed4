"""What makes a comparison of recordings without and with a shaper doubtful, as sentences."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from preshape.identify import TimeSeries
from preshape.workflow.mixed_files import SAME_RATE, axis_of
from preshape.workflow.stop_time import Motion

__all__ = ["comparison_trouble", "move_trouble"]

SAME_SPEED = 0.15
"""Relative difference of the largest speeds within which it is the same move: vibration adds to the measured speed."""


def comparison_trouble(
    before: Sequence[str], after: Sequence[str], recordings: Sequence[tuple[str, TimeSeries]]
) -> list[str]:
    """Sentences on sensors and axes; and what the readers remarked, by file."""
    found = []
    rates = [one.sample_rate for _, one in recordings]
    if max(rates) > (1.0 + SAME_RATE) * min(rates):
        listed = ", ".join(f"{name}: {one.sample_rate:.4g} Hz" for name, one in recordings)
        found.append(f"the recordings have different sample rates ({listed}): record all with the same sensor setting.")
    axes = {name: axis_of(name, one) for name, one in recordings if not name.startswith(("before ", "after "))}
    if len({axis for axis in axes.values() if axis}) > 1:
        listed = "; ".join(f"{name}: {axis}" for name, axis in axes.items() if axis)
        found.append(f"the recordings seem to be of different axes ({listed}): compare moves of the same axis.")
    found += [f"{name}: {remark}" for name, one in recordings for remark in one.remarks]
    for side, names in (("before", before), ("after", after)):
        if len(names) == 2:
            found.append(f"two repeats {side} do not tell how much repeats differ: record three or more, or trust one.")
    return found


def move_trouble(sides: Sequence[Sequence[tuple[str, TimeSeries]]], motions: Sequence[Sequence[Motion]]) -> list[str]:
    """A sentence on moves whose speeds are not the same; the beginning of the move must be recorded for that."""
    tops = [
        [top for (_, series), motion in zip(side, moved, strict=True) if (top := motion.top(series))]
        for side, moved in zip(sides, motions, strict=True)
    ]
    if all(tops):
        slow, fast = sorted(float(np.mean(side)) for side in tops)
        if fast > (1.0 + SAME_SPEED) * slow:
            return [
                f"the moves before and after do not seem to be the same: their largest speeds differ by "
                f"{100.0 * (fast / slow - 1.0):.0f} %."
            ]
    return []
