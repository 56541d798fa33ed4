"""The few kinds of figure that these papers have: impulses, vibration over frequency, signals over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

import numpy as np
from numpy.typing import NDArray

from preshape.report.figures import ACCENT, INK, MUTED, SECOND, new_figure, tidy
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = [
    "Curve",
    "curves_figure",
    "draw_impulses",
    "impulse_figure",
    "legend_below",
    "level_line",
    "sampled",
    "staircase",
    "vibration_figure",
]

Vector: TypeAlias = NDArray[np.float64]
Place: TypeAlias = Literal["best", "upper right", "upper left", "upper center", "lower left", "lower right"]

WIDTH, HEIGHT = 6.6, 3.0
"""Of a figure with one pair of axes [inch]."""

LABELLED = 9
"""Impulses of a shaper with at most as many carry their amplitudes."""

LINES: tuple[tuple[str, str, float], ...] = (
    (ACCENT, "-", 2.0),
    (SECOND, "--", 1.6),
    (INK, ":", 1.6),
    (MUTED, "-.", 1.4),
)
"""Colour, dash and width of the curves of a figure, in order: told apart without colour."""

TOLERATED = 5.0
"""The vibration that the papers accept [%]."""

POINTS = 900
"""Of a curve."""


@dataclass(frozen=True)
class Curve:
    """One line of a figure: what the legend calls it, and its points, both of shape (sample,)."""

    label: str
    x: Vector
    y: Vector


def sampled(start: float, stop: float, points: int = POINTS) -> Vector:
    """Evenly spaced values from start to stop."""
    return np.linspace(start, stop, points)


def staircase(times: Vector, heights: Vector, end: float) -> tuple[Vector, Vector]:
    """Corners of a staircase that rises by `heights` at `times`, from a little before 0 to `end`."""
    levels = np.concatenate([[0.0], np.cumsum(heights)])
    x = np.repeat(np.concatenate([[-0.06 * end], times, [end]]), 2)[1:-1]
    return x, np.repeat(levels, 2)


def curves_figure(
    title: str,
    x_label: str,
    y_label: str,
    curves: Sequence[Curve],
    *,
    legend: Place | None = "best",
    marks: Sequence[tuple[float, str]] = (),
    level: float | None = None,
) -> Figure:
    """Lines over a common axis; `marks` are vertical lines with a word each, `level` a horizontal one."""
    figure = new_figure(WIDTH, HEIGHT)
    axes = figure.add_subplot()
    if level is not None:
        axes.axhline(level, color=INK, linewidth=0.8)
    for curve, (color, dash, width) in zip(curves, LINES, strict=False):
        axes.plot(curve.x, curve.y, color=color, linestyle=dash, linewidth=width, label=curve.label)
    _mark(axes, marks)
    axes.margins(y=0.12 if marks else 0.05)
    axes.set_xlim(min(curve.x[0] for curve in curves), max(curve.x[-1] for curve in curves))
    tidy(axes, x_label, y_label, title)
    if len(curves) > 1 and legend is not None:
        axes.legend(fontsize=8.5, loc=legend, frameon=True, framealpha=0.9, edgecolor="white")
    return figure


def vibration_figure(
    title: str,
    shapers: Sequence[tuple[str, Shaper, float]],
    frequencies: Vector,
    *,
    modes: Sequence[float] = (),
    top: float = 105.0,
) -> Figure:
    """V over the actual frequency for (label, shaper, damping ratio); the design modes are marked.

    The legend stands below the axes: curves of several modes fill them.
    """
    curves = [
        Curve(label, frequencies, 100.0 * residual_vibration(shaper, frequencies, damping))
        for label, shaper, damping in shapers
    ]
    figure = curves_figure(title, "actual natural frequency [Hz]", "residual vibration [%]", curves, legend=None)
    axes = figure.axes[0]
    level_line(axes, TOLERATED, f"{TOLERATED:g} %")
    axes.plot(
        modes, [0.0] * len(modes), "v", color=INK, markersize=6, clip_on=False, zorder=5, label="designed for", ls=""
    )
    if len(shapers) > 1:
        legend_below(figure)
    axes.set_ylim(0.0, top)
    return figure


def level_line(axes: Axes, height: float, word: str) -> None:
    """A dotted line across the axes, named at its right end."""
    axes.axhline(height, color=INK, linewidth=0.9, linestyle=(0, (1, 2)))
    axes.annotate(
        word,
        (axes.get_xlim()[1], height),
        xytext=(3, 0),
        textcoords="offset points",
        va="center",
        annotation_clip=False,
        fontsize=8.5,
        color=INK,
    )


def legend_below(figure: Figure) -> None:
    """The legend under the axes, in one row: where curves fill them."""
    entries = len(figure.axes[0].get_legend_handles_labels()[1])
    figure.legend(fontsize=8.5, loc="outside lower center", ncols=entries, frameon=False)


def impulse_figure(title: str, *trains: tuple[str, Shaper]) -> Figure:
    """Impulses of one shaper, or of a few for comparison, the first drawn boldly."""
    figure = new_figure(WIDTH, HEIGHT)
    axes = figure.add_subplot()
    draw_impulses(axes, *trains)
    tidy(axes, "time [s]", "amplitude [-]", title)
    if len(trains) > 1:
        axes.legend(fontsize=8.5, frameon=True, framealpha=0.9, edgecolor="white")
    return figure


def draw_impulses(axes: Axes, *trains: tuple[str, Shaper]) -> None:
    """Impulses as stems with heads; amplitudes written beside those of a single short shaper."""
    span = max(shaper.duration for _, shaper in trains)
    top = max(float(shaper.amplitudes.max()) for _, shaper in trains)
    for number, ((label, shaper), (color, _, _)) in enumerate(zip(trains, LINES, strict=False)):
        filled = "white" if number else color
        axes.vlines(shaper.times, 0.0, shaper.amplitudes, color=color, linewidth=1.4 if number else 2.4)
        axes.plot(
            shaper.times,
            shaper.amplitudes,
            "os^D"[number],
            color=color,
            markerfacecolor=filled,
            markersize=6 if len(shaper) <= 30 else 3.5,
            label=label,
        )
    if len(trains) == 1 and len(trains[0][1]) <= LABELLED:
        _write_amplitudes(axes, trains[0][1], span, top)
    axes.axhline(0.0, color=INK, linewidth=0.8)
    axes.set_xlim(-0.08 * span, 1.08 * span)
    axes.set_ylim(min(0.0, 1.2 * min(float(s.amplitudes.min()) for _, s in trains)), 1.25 * top)


CROWDED = 0.07
"""Impulses nearer than this part of the axis write their amplitudes to the sides, not above."""


def _write_amplitudes(axes: Axes, shaper: Shaper, span: float, top: float) -> None:
    for i, (t, a) in enumerate(zip(shaper.times, shaper.amplitudes, strict=True)):
        after = i + 1 < len(shaper) and shaper.times[i + 1] - t < CROWDED * span
        before = i > 0 and t - shaper.times[i - 1] < CROWDED * span
        side = "right" if after and not before else "left" if before and not after else "center"
        shift = {"right": 4, "left": -4, "center": 0}[side]
        axes.annotate(
            f"{a:.3f}", (t, a), xytext=(shift, 6), textcoords="offset points", ha=side, fontsize=8.5, color=INK
        )


def _mark(axes: Axes, marks: Sequence[tuple[float, str]]) -> None:
    for x, word in marks:
        axes.axvline(x, color=MUTED, linewidth=0.9, linestyle=(0, (1, 2)))
        axes.annotate(
            word,
            (x, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(3, -2),
            textcoords="offset points",
            va="top",
            fontsize=8.5,
            color=INK,
        )
