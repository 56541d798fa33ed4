"""What makes a comparison of recordings without and with a shaper doubtful, as sentences."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from preshape.identify import TimeSeries
from preshape.shaper import Shaper
from preshape.workflow.mixed_files import SAME_RATE, axis_of
from preshape.workflow.stop_time import Motion

__all__ = ["comparison_trouble", "move_trouble", "stop_doubt"]

SAME_SPEED = 0.15
"""Relative difference of the largest speeds within which it is the same move: vibration adds to the measured speed."""

SAME_TIME = 0.006
"""Difference of durations [s] within which it is the same move, beyond the uncertainty of the stops."""


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


def move_trouble(before: Sequence[Motion], after: Sequence[Motion], shaper: Shaper | None) -> list[str]:
    """Sentences on moves that are not the same; the beginning of the move must be recorded for that."""
    found = []
    tops = [[motion.top for motion in side if motion.top] for side in (before, after)]
    if all(tops):
        slow, fast = sorted(float(np.mean(side)) for side in tops)
        if fast > (1.0 + SAME_SPEED) * slow:
            found.append(
                f"the moves before and after do not seem to be the same: their largest speeds differ by "
                f"{100.0 * (fast / slow - 1.0):.0f} %."
            )
    off = stop_doubt(before, after, shaper)
    if off > 0.0 and shaper is not None:
        found.append(
            f"how much longer the moves with the shaper last is {1e3 * off:.0f} ms off the shaper's "
            f"{1e3 * shaper.duration:.0f} ms: the stop was not found rightly (give it; until then the intervals are "
            "widened), the machine executed another shaper, or it was another move."
        )
    return found


def stop_doubt(before: Sequence[Motion], after: Sequence[Motion], shaper: Shaper | None) -> float:
    """By how much [s] the shaped moves do not last longer by the shaper's duration; 0 within the uncertainty."""
    lasting = [[m.stop - m.begin for m in side if m.begin is not None] for side in (before, after)]
    if shaper is None or not all(lasting):
        return 0.0
    off = abs(float(np.mean(lasting[1]) - np.mean(lasting[0])) - shaper.duration)
    doubt = SAME_TIME + 3.0 * max(motion.spread for motion in (*before, *after))
    return off if off > doubt else 0.0
