"""The figure of a campaign: its panels side by side, two in a row."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from preshape.report.campaign import CampaignPanel, CampaignSummary, Cloud, Curves
from preshape.report.figures import ACCENT, INK, SERIES, new_figure, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["campaign_figure"]

WIDTH, HEIGHT = 5.0, 3.9
"""Of a panel [in]."""

COLOURS = "cividis"
"""Its lightness rises evenly: a map in grey print reads the same."""

CONTOURS = 6

MOST_CELLS = 4000
"""Of a map that is drawn cell by cell; a finer one is an image within the figure."""


def campaign_figure(summary: CampaignSummary) -> Figure:
    """All panels of a campaign.

    Parameters
    ----------
    summary : CampaignSummary
        With at least one panel, or the figure is empty but for its title.

    Returns
    -------
    matplotlib.figure.Figure
    """
    from textwrap import fill

    count = max(len(summary.panels), 1)
    columns = min(count, 2)
    rows = math.ceil(count / columns)
    figure = new_figure(columns * WIDTH, rows * HEIGHT)
    for number, panel in enumerate(summary.panels):
        _draw(figure, figure.add_subplot(rows, columns, number + 1), panel)
    title = fill(summary.sentence, 56 * columns)
    figure.suptitle(title, fontsize=11, fontweight="bold", color=INK, x=0.01, ha="left")
    return figure


def _draw(figure: Figure, axes: Axes, panel: CampaignPanel) -> None:
    tidy(axes, panel.x_label, panel.y_label, panel.title)
    if isinstance(panel, Curves):
        for number, (name, x, y) in enumerate(panel.curves):
            colour, line, width = SERIES[number % len(SERIES)]
            axes.plot(x, y, color=colour, linestyle=line, linewidth=width, label=name)
        if panel.logarithmic:
            axes.set_xscale("log")
        if not _varies(np.concatenate([y for _, _, y in panel.curves])):  # its rounding would fill the axis
            middle = float(np.nanmean(panel.curves[0][2]))
            axes.set_ylim(min(0.0, 2.0 * middle), max(0.0, 2.0 * middle) or 1.0)
        if len(panel.curves) > 1:
            axes.legend(fontsize=8.5, loc="best", frameon=True, framealpha=0.9, edgecolor="white")
    elif isinstance(panel, Cloud):
        axes.plot(panel.x, panel.y, "o", color=ACCENT, markersize=2.5, markeredgewidth=0.0, alpha=0.6)
    else:
        axes.grid(False)
        drawn = axes.pcolormesh(
            panel.x, panel.y, np.ma.masked_invalid(panel.values), cmap=COLOURS, shading="nearest",
            edgecolors="face", linewidth=0.2, rasterized=panel.values.size > MOST_CELLS,
        )  # fmt: skip
        figure.colorbar(drawn, ax=axes)
        if min(panel.values.shape) > 1 and _varies(panel.values):
            from matplotlib.patheffects import AbstractPathEffect, withStroke

            outline: list[AbstractPathEffect] = [withStroke(linewidth=1.8, foreground=INK)]
            lines = axes.contour(panel.x, panel.y, panel.values, CONTOURS, colors="white", linewidths=0.8)
            lines.set(path_effects=outline)
            for label in axes.clabel(lines, fontsize=7.5):
                label.set_path_effects(outline)


def _varies(values: NDArray[np.float64]) -> bool:
    finite = values[np.isfinite(values)]
    return bool(finite.size and np.ptp(finite) > 1e-9 * np.abs(finite).max())
