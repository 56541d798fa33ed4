"""Parts that several figures share: the impulses, the simulated move, the modes and the tolerance over frequency."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from preshape.mode import Mode
from preshape.report.calibration import SimulatedMove
from preshape.report.figures import ACCENT, INK, PALE, SECOND, new_figure, tidy
from preshape.report.tables import time_unit
from preshape.shaper import Shaper

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = [
    "NAME_WIDTH",
    "impulses_panel",
    "mark_modes",
    "mark_tolerance",
    "move_panel",
    "shown_part",
    "simulated_figure",
]

FEW = 6
"""Of so many impulses each carries its amplitude."""

ROWS_FROM, ROW = 1.11, 0.17
"""Where the rows of the modes' names begin over curves that end at 1, and how high one is."""

NAME_WIDTH = 0.12
"""Of a mode's name, as a part of the axis."""


def impulses_panel(axes: Axes, shaper: Shaper) -> None:
    """Times and amplitudes; boxes as areas as high as their share."""
    unit = time_unit(shaper)
    times = unit.per_second * shaper.times
    axes.vlines(times, 0.0, shaper.amplitudes, color=ACCENT, linewidth=3.0 if len(shaper) <= 10 * FEW else 1.0)
    axes.plot(times, shaper.amplitudes, "o", color=ACCENT, markersize=6 if len(shaper) <= 10 * FEW else 2)
    for number, box in enumerate(shaper.boxes):
        ends = [unit.per_second * box.start, unit.per_second * box.end]
        label = "box, as high as its share" if number == 0 else None
        axes.fill_between(ends, 0.0, box.mass, color=SECOND, alpha=0.5, linewidth=0, label=label)
    if shaper.boxes:
        axes.legend(fontsize=8.5, loc="upper right", frameon=True, framealpha=0.9, edgecolor="white")
    if len(shaper) <= FEW:
        for t, a in zip(times, shaper.amplitudes, strict=True):
            below = a < 0.0
            axes.annotate(
                f"{a:.3f}",
                (t, a),
                xytext=(0, -6 if below else 6),
                textcoords="offset points",
                ha="center",
                va="top" if below else "bottom",
                fontsize=8.5,
                color=INK,
            )
    sizes = [*shaper.amplitudes.tolist(), *[box.mass for box in shaper.boxes]]
    low, high = min(0.0, *sizes), max(sizes)
    axes.set_ylim(1.25 * low, high + 0.25 * (high - low))
    if low < 0.0:
        axes.axhline(0.0, color=INK, linewidth=0.8)
    span = unit.per_second * shaper.duration or 1.0
    axes.set_xlim(-0.1 * span, 1.1 * span)
    tidy(axes, f"time [{unit.name}]", "amplitude [-]", "The shaper's impulses")


def move_panel(axes: Axes, shaper: Shaper, move: SimulatedMove | None) -> None:
    """The modes in a point-to-point move."""
    if move is None:
        axes.set_axis_off()
        axes.text(0.5, 0.5, "no mode was found:\nno move was simulated", ha="center", va="center", color=INK)
        return
    unit = time_unit(shaper)
    times, end = unit.per_second * move.times, unit.per_second * move.end_shaped
    axes.axvspan(0.0, unit.per_second * move.end_unshaped, color=PALE, linewidth=0)
    axes.plot(times, 100.0 * move.unshaped, color=SECOND, linewidth=1.3, linestyle="--", label="unshaped")
    axes.plot(times, 100.0 * move.shaped, color=ACCENT, linewidth=1.9, label="shaped")
    axes.axvline(end, color=ACCENT, linewidth=0.9, linestyle=(0, (1, 2)))
    peak = 100.0 * max(float(np.abs(move.unshaped).max()), float(np.abs(move.shaped).max()))
    axes.set_ylim(-1.15 * peak, 1.45 * peak)
    axes.annotate(
        f"shaped move ends {unit.show(move.end_shaped - move.end_unshaped)} later,\n"
        f"leaves {shown_part(move.left)} of the vibration",
        (end, 1.4 * peak),
        xytext=(4, 0),
        textcoords="offset points",
        va="top",
        fontsize=8.5,
        color=ACCENT,
    )
    axes.set_xlim(0.0, times[-1])
    tidy(
        axes, f"time [{unit.name}]", "vibration [% of what is left unshaped]", "A quick move of these modes (simulated)"
    )
    axes.legend(fontsize=8.5, loc="lower right", frameon=True, framealpha=0.9, edgecolor="white")


def simulated_figure(shaper: Shaper, move: SimulatedMove) -> Figure:
    """The impulses beside the move, for a report without a measurement."""
    figure = new_figure(10.0, 3.4)
    left, right = figure.subplots(1, 2, width_ratios=[1.0, 1.7])
    impulses_panel(left, shaper)
    move_panel(right, shaper, move)
    return figure


def mark_modes(axes: Axes, modes: Iterable[Mode], end: float) -> None:
    """A line at each mode with its name above 100 %, in rows so that none hides another.

    Parameters
    ----------
    axes : Axes
        From 0 to `end` [Hz]; the vertical axis is one of parts, and is set here.
    modes : iterable of Mode
        In any order.
    end : float
        [Hz]
    """
    taken: list[float] = []
    for mode in sorted(modes, key=lambda mode: mode.frequency):
        before = mode.frequency > (1.0 - NAME_WIDTH) * end
        start = mode.frequency - (NAME_WIDTH * end if before else 0.0)
        row = next((number for number, free in enumerate(taken) if free <= start), len(taken))
        taken[row : row + 1] = [start + NAME_WIDTH * end]
        axes.axvline(mode.frequency, color=INK, linewidth=1.0)
        axes.annotate(
            f"{mode.frequency:.4g} Hz\ndamping {mode.damping:.3f}",
            (mode.frequency, ROWS_FROM + ROW * row),
            xytext=(-4 if before else 4, 0),
            textcoords="offset points",
            ha="right" if before else "left",
            va="center",
            fontsize=8.5,
            color=INK,
            bbox={"facecolor": "white", "edgecolor": "none", "pad": 0.5},
        )
    axes.set_xlim(0.0, end)
    axes.set_ylim(0.0, ROWS_FROM - 0.03 + ROW * max(2, len(taken)))
    axes.set_yticks([0.0, 0.25, 0.5, 0.75, 1.0], ["0", "25 %", "50 %", "75 %", "100 %"])


def mark_tolerance(axes: Axes, height: float, end: float, name: str) -> None:
    """A dotted line at the vibration that is allowed, named at the `end` of the horizontal axis."""
    axes.axhline(height, color=INK, linewidth=0.9, linestyle=(0, (1, 2)))
    axes.annotate(
        name,
        (end, height),
        xytext=(-3, 2),
        textcoords="offset points",
        ha="right",
        fontsize=8.5,
        color=INK,
    )


def shown_part(fraction: float) -> str:
    """A part in percent for people: rounding errors are not shown as a result."""
    return "less than 0.01 %" if fraction < 1e-4 else f"{100.0 * fraction:.2g} %"
