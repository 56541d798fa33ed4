"""Labels beside points that hide neither each other nor a point: the first free place around each."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from preshape.report.figures import INK, MUTED

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["label_points"]

LETTER, LINE = 0.57, 1.3
"""Width of a letter and height of a line, over the size of the type."""

POINT = 6.0
"""Half the width of what a marker covers, in points."""

DISTANCES = (9.0, 16.0, 26.0, 38.0, 52.0, 70.0)
"""How far from its point a label may be, in points; the nearest free place is taken."""

DIRECTIONS = 16

LEADER_FROM = 14.0
"""A label farther away than this, in points, is tied to its point by a line."""

BEAD = 3.0
"""Distance of the squares that stand for such a line, in points."""


def label_points(
    axes: Axes,
    labels: Sequence[tuple[float, float, str]],
    size: float = 8.0,
    avoid: Sequence[tuple[float, float]] = (),
) -> None:
    """Write the labels, each as near its point as there is room.

    Parameters
    ----------
    axes : Axes
        Whose limits and place in the figure are final; nothing is drawn outside.
    labels : sequence of (x, y, text)
        Points in data coordinates.
    size : float
        Of the type, in points.
    avoid : sequence of (x, y)
        Other points that no label may hide; nor does one hide the legend of the axes.
    """
    figure = axes.get_figure(root=True)
    assert figure is not None
    figure.draw_without_rendering()
    scale = 72.0 / figure.dpi
    centres = np.array([axes.transData.transform((x, y)) for x, y, _ in labels]) * scale
    edges = axes.get_window_extent()
    frame = np.array([edges.x0, edges.y0, edges.x1, edges.y1]) * scale
    taken = [np.array([x - POINT, y - POINT, x + POINT, y + POINT]) for x, y in centres]
    others = [axes.transData.transform(point) * scale for point in avoid]
    taken += [np.array([x - POINT, y - POINT, x + POINT, y + POINT]) for x, y in others]
    if (legend := axes.get_legend()) is not None:
        covered = legend.get_window_extent()
        taken.append(np.array([covered.x0, covered.y0, covered.x1, covered.y1]) * scale)
    for (x, y, text), centre in zip(labels, centres, strict=True):
        box = np.array([LETTER * size * len(text), LINE * size])
        place, offset = _place(centre, box, taken, frame)
        leader = _leader(centre, place)
        taken += [place, *leader]
        far = bool(leader)
        axes.annotate(
            text,
            (x, y),
            xytext=(float(offset[0]), float(offset[1])),
            textcoords="offset points",
            ha="center",
            va="center",
            fontsize=size,
            color=INK,
            arrowprops={"arrowstyle": "-", "color": MUTED, "linewidth": 0.6, "shrinkB": 4.0} if far else None,
        )


def _place(
    centre: NDArray[np.float64], box: NDArray[np.float64], taken: list[NDArray[np.float64]], frame: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The rectangle of a label and the offset of its middle: the first place that is free, or the least covered."""
    best, least = None, math.inf
    for distance in DISTANCES:
        for k in range(DIRECTIONS):
            angle = 2.0 * np.pi * k / DIRECTIONS
            way = np.array([np.cos(angle), np.sin(angle)])
            offset = way * distance + 0.5 * box * np.clip(1.5 * way, -1.0, 1.0)
            place = np.concatenate([centre + offset - 0.5 * box, centre + offset + 0.5 * box])
            outside = (place[:2] < frame[:2]).any() or (place[2:] > frame[2:]).any()
            hidden = [_overlap(part, other) for part in (place, *_leader(centre, place)) for other in taken]
            covered = sum(hidden) + (1e6 if outside else 0.0)
            if covered < least:
                best, least = (place, offset), covered
        if least == 0.0:
            break
    assert best is not None
    return best


def _leader(centre: NDArray[np.float64], place: NDArray[np.float64]) -> list[NDArray[np.float64]]:
    """The line from a far label, on the way to its middle, to its point, as small squares; none of a near one."""
    if float(np.hypot(*_gap(centre, place))) <= LEADER_FROM:
        return []
    way = 0.5 * (place[:2] + place[2:]) - centre
    spots = [centre + part * way for part in np.arange(POINT + 1.0, float(np.hypot(*way)), BEAD) / np.hypot(*way)]
    outside = [spot for spot in spots if (spot < place[:2]).any() or (spot > place[2:]).any()]
    return [np.concatenate([spot - 0.5, spot + 0.5]) for spot in outside]


def _overlap(a: NDArray[np.float64], b: NDArray[np.float64]) -> float:
    sides = np.minimum(a[2:], b[2:]) - np.maximum(a[:2], b[:2])
    return float(max(sides[0], 0.0) * max(sides[1], 0.0))


def _gap(point: NDArray[np.float64], place: NDArray[np.float64]) -> NDArray[np.float64]:
    """From a point to the nearest of a rectangle."""
    nearest: NDArray[np.float64] = np.clip(point, place[:2], place[2:]) - point
    return nearest
