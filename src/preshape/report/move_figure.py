"""The figure of a rest-to-rest command: the force, the deflection within its limit, the way."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from preshape.plant import Output
from preshape.report.figures import ACCENT, INK, MUTED, SECOND, SERIES, new_figure, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from preshape.command.rest_to_rest import RestToRest
    from preshape.plant import Motion

__all__ = ["move_figure"]

TAIL = 0.25
"""How much of the duration is drawn after the move, where all must stand still."""

SAMPLES = 2001

AT_REST = 1e-6
"""Vibration left below this part of what a step of the maximum force leaves is none."""

CURVES = (SERIES[0], *SERIES[2:])
"""Of several deflections; the second look is the limits'."""


def move_figure(move: RestToRest) -> Figure:
    """Force, deflections and position over time, one under the other.

    Parameters
    ----------
    move : RestToRest
        With its plant and, if it has any, its limits.
    """
    figure = new_figure(8.0, 6.6)
    force, deflection, position = figure.subplots(3, 1, sharex=True, height_ratios=[1.0, 1.3, 1.0])
    end = (1.0 + TAIL) * move.duration
    times, motion = np.linspace(0.0, end, SAMPLES), move.body.motion(move.force)
    _force(force, move, end)
    _deflection(deflection, move, motion, times)
    position.plot(times, motion("centre", times), color=ACCENT, linewidth=1.8)
    position.axhline(move.distance, color=MUTED, linewidth=1.0, linestyle="--")
    tidy(position, "time [s]", "centre [m]", f"The way: {move.distance:g} m in {move.duration:.4g} s")
    for axes in (force, deflection, position):
        axes.axvline(move.duration, color=MUTED, linewidth=1.0, linestyle=":")
        axes.margins(y=0.12)
    force.set_xlim(0.0, end)
    return figure


def _force(axes: Axes, move: RestToRest, end: float) -> None:
    times = np.concatenate([[0.0], move.switch_times, [end]])
    axes.step(times, np.concatenate([[0.0], move.levels, [0.0, 0.0]]), where="post", color=INK, linewidth=1.6)
    for level in (-move.maximum_force, move.maximum_force):
        axes.axhline(level, color=MUTED, linewidth=1.0, linestyle="--")
    tidy(axes, "", "force [N]", f"The {move.method} command, {move.status}: {move.levels.size} levels")


def _deflection(axes: Axes, move: RestToRest, motion: Motion, times: NDArray[np.float64]) -> None:
    rows = move.settings.get("outputs", np.eye(len(move.body.modes)).tolist())
    for k, row in enumerate(rows):
        colour, line, width = CURVES[k % len(CURVES)]
        values = motion(Output(tuple(row)), times)
        axes.plot(times, values, color=colour, linestyle=line, linewidth=width, label=f"deflection {k + 1}")
    limits = [limit for limit in move.settings.get("deflection_limits", ()) if np.isfinite(limit)]
    for limit in sorted(set(limits)):
        for side in (-limit, limit):
            axes.axhline(side, color=SECOND, linewidth=1.2, linestyle="--")
        axes.annotate(
            f"limit {limit:g} m", (times[-1], limit), xytext=(0, 3), textcoords="offset points", ha="right", fontsize=9
        )
    if len(rows) > 1:
        axes.legend(fontsize=9, frameon=False, loc="lower right", bbox_to_anchor=(1.0, 1.0), ncols=len(rows))
    peaks = ", ".join(f"{peak:.4g}" for peak in move.peak_deflections)
    left = "and nothing after the move" if move.residuals.max() < AT_REST else "and still after the move"
    tidy(axes, "", "deflection [m]", f"What bends: at most {peaks} m, {left}")
