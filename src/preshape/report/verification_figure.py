"""The figure of a verification: ringing without and with the shaper, spectra, measured against predicted."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from preshape.report.figures import ACCENT, INK, MUTED, SECOND, new_figure, tidy
from preshape.report.verification import Ringing, Verification

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["verification_figure"]

SIDES = ((SECOND, "--", 1.3, "without the shaper"), (ACCENT, "-", 1.9, "with the shaper"))
"""Colour, line, width and name: told apart in grey print by the line and by its lightness."""


def verification_figure(verification: Verification) -> Figure:
    """Above the ringing in time of the loudest axis; below the spectra, and the ratio of each mode with its prediction.

    Parameters
    ----------
    verification : Verification
        From :func:`preshape.workflow.verify`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    from textwrap import fill

    figure = new_figure(10.0, 7.2)
    grid = figure.add_gridspec(2, 2, height_ratios=[1.0, 1.1], width_ratios=[1.35, 1.0])
    _times(figure.add_subplot(grid[0, :]), verification)
    _spectra(figure.add_subplot(grid[1, 0]), verification)
    _ratios(figure.add_subplot(grid[1, 1]), verification)
    figure.suptitle(fill(verification.sentence, 112), fontsize=11, fontweight="bold", color=INK, x=0.01, ha="left")
    return figure


def _sides(verification: Verification) -> tuple[tuple[Ringing, ...], tuple[Ringing, ...]]:
    return verification.unshaped, verification.shaped


def _times(axes: Axes, verification: Verification) -> None:
    loudest = int(np.argmax([one.value for one in verification.before[:-1]]))
    for side, (colour, line, width, name) in zip(_sides(verification), SIDES, strict=True):
        for number, one in enumerate(side):
            axes.plot(
                1e3 * one.times, one.values[loudest], color=colour, linestyle=line, linewidth=width,
                label=name if number == 0 else None,
            )  # fmt: skip
    unit = f" [{verification.unit}]" if verification.unit else ""
    tidy(axes, "time after the stop [ms]", f"{verification.axes[loudest]}{unit}", "What rings after the stop")
    axes.set_xlim(0.0, 1e3 * max(one.times[-1] for side in _sides(verification) for one in side))
    axes.legend(fontsize=8.5, loc="upper right", frameon=True, framealpha=0.9, edgecolor="white")


def _spectra(axes: Axes, verification: Verification) -> None:
    high = verification.below  # what the root mean square counts
    top = 0.0
    for side, (colour, line, width, name) in zip(_sides(verification), SIDES, strict=True):
        for number, one in enumerate(side):
            shown = one.frequencies <= high
            top = max(top, float(one.amplitude[shown].max()))
            axes.plot(
                one.frequencies[shown], one.amplitude[shown], color=colour, linestyle=line, linewidth=width,
                label=name if number == 0 else None,
            )  # fmt: skip
    for mode in verification.modes:
        axes.axvline(mode.mode.mode.frequency, color=MUTED, linewidth=0.9, linestyle=(0, (1, 2)))
        text = f"{mode.mode.mode.frequency:.3g}" + (" new" if mode.new else "")
        axes.annotate(
            text, (mode.mode.mode.frequency, 1.1 * top), xytext=(2, 0), textcoords="offset points", fontsize=8.5,
            color=INK, rotation=90, va="top",
        )  # fmt: skip
    axes.set_ylim(0.0, 1.12 * top)
    axes.set_xlim(0.0, high)
    unit = f" [{verification.unit}/Hz]" if verification.unit else ""
    tidy(axes, "frequency [Hz]", f"amplitude{unit}", "Spectra after the stop, all axes")


def _ratios(axes: Axes, verification: Verification) -> None:
    tidy(axes, "", "left of the amplitude [%]", "Measured and predicted, 95 % intervals")
    shown = [one for one in verification.modes if math.isfinite(one.ratio.value)]
    if not shown:
        axes.set_axis_off()
        axes.text(0.5, 0.5, "no mode could be compared", ha="center", va="center", color=INK)
        return
    ends = [value for one in shown for value in (one.ratio.value, one.ratio.high) if math.isfinite(value)]
    top = 100.0 * max([1.0, *ends])
    for number, one in enumerate(shown):
        if one.predicted is not None:
            low, middle, high = (100.0 * value for value in one.predicted)
            axes.fill_between([number + 0.08, number + 0.32], low, high, color=SECOND, alpha=0.35, linewidth=0)
            axes.plot(number + 0.2, middle, "D", color=SECOND, markersize=7, markerfacecolor="white",
                      label="predicted" if number == 0 else None)  # fmt: skip
        low, high = 100.0 * one.ratio.low, min(100.0 * one.ratio.high, 1.2 * top)
        axes.plot([number, number], [low, high], color=ACCENT, linewidth=2.0)
        axes.plot(number, 100.0 * one.ratio.value, "o", color=ACCENT, markersize=7,
                  label="measured" if number == 0 else None)  # fmt: skip
    axes.axhline(100.0, color=INK, linewidth=0.9, linestyle=(0, (1, 2)))
    axes.set_xticks(range(len(shown)), [f"{one.mode.mode.frequency:.3g} Hz" for one in shown])
    axes.set_xlim(-0.5, len(shown) - 0.2)
    axes.set_ylim(-0.05 * top, 1.25 * top)  # room for a point at 0
    axes.legend(fontsize=8.5, loc="upper right", frameon=True, framealpha=0.9, edgecolor="white", ncols=2)
