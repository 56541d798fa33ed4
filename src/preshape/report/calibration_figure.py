"""The figure of a calibration: which shaper, and why, at one look."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from preshape.report.calibration import Calibration
from preshape.report.figures import ACCENT, MUTED, SECOND, SERIES, SOFT, new_figure, tidy
from preshape.report.panels import NAME_WIDTH, impulses_panel, mark_modes, mark_tolerance, move_panel
from preshape.report.tables import time_unit
from preshape.vibration import residual_vibration

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["calibration_figure"]

LEGEND_FROM = 0.68
"""The legend stands right of this part of the frequency axis, unless a mode is named there."""

RUNNERS_UP = (SERIES[1], SERIES[3])
"""Looks of the other candidates that are drawn beside the chosen one; dots are the tolerance's."""

SHOWN_ABOVE = 2.2
"""The frequency axis ends at this multiple of the highest mode, if the measurement reaches that far."""


def calibration_figure(calibration: Calibration) -> Figure:
    """Measured spectrum with modes and shaper curves; impulses; the move unshaped and shaped.

    Parameters
    ----------
    calibration : Calibration
        From :func:`preshape.workflow.calibrate`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(10.0, 7.2)
    grid = figure.add_gridspec(2, 2, height_ratios=[1.25, 1.0], width_ratios=[1.0, 1.7])
    _spectrum(figure.add_subplot(grid[0, :]), calibration)
    shaper = calibration.shaper
    impulses_panel(figure.add_subplot(grid[1, 0]), shaper)
    move_panel(figure.add_subplot(grid[1, 1]), shaper, calibration.move)
    proof = "; proved shortest" if shaper.design.status == "optimal" else ""
    warning = "" if calibration.clear else "See to the machine first. Until then:\n"
    unit = time_unit(shaper)
    figure.suptitle(
        f"{warning}{calibration.chosen.name}: {len(shaper)} impulses, {unit.show(shaper.duration)}, "
        f"at most {100.0 * calibration.chosen.left:.1f} % vibration left{proof}",
        fontsize=13,
        fontweight="bold",
        color=ACCENT if calibration.chosen.left <= calibration.tolerance else SECOND,
        x=0.01,
        ha="left",
    )
    return figure


def _spectrum(axes: Axes, calibration: Calibration) -> None:
    """Measured power, what the shaper leaves of it, the modes, and V of the shaper."""
    high = _highest_shown(calibration)
    spectra = [(file.scored.frequencies, row) for file in calibration.files for row in file.scored.power]
    for number, (frequencies, row) in enumerate(spectra):
        shown = frequencies <= high
        f, power = frequencies[shown], row[shown] / row.max()
        axes.fill_between(f, power, color=SOFT, linewidth=0, label="measured spectrum" if number == 0 else None)
        axes.plot(f, power, color=MUTED, linewidth=1.0)
    f = np.linspace(0.0, high, 1200)
    damping = calibration.modes[0].mode.damping if calibration.modes else 0.1
    others = [c for c in calibration.candidates if c is not calibration.chosen and not c.excluded]
    for candidate, (colour, line, _) in zip(others, RUNNERS_UP, strict=False):
        v = residual_vibration(candidate.shaper, f, damping)
        axes.plot(f, v, color=colour, linestyle=line, linewidth=1.4, label=f"left by {candidate.name}")
    chosen = calibration.chosen
    v = residual_vibration(chosen.shaper, f, damping)
    axes.plot(f, v, color=ACCENT, linewidth=2.4, label=f"left by {chosen.name} (at damping {damping:.3f})")
    mark_tolerance(axes, calibration.tolerance, high, f"{100.0 * calibration.tolerance:g} %")
    mark_modes(axes, [mode.mode for mode in calibration.modes], high)
    tidy(
        axes,
        "frequency [Hz]",
        "of the highest power / of the vibration",
        "What vibrates, and how much of it each shaper leaves",
    )
    place: dict[str, Any] = {"loc": "upper right"}
    if any(mode.mode.frequency > (LEGEND_FROM - NAME_WIDTH) * high for mode in calibration.modes):
        place = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.17), "ncols": 2}
    axes.legend(fontsize=8.5, frameon=True, framealpha=0.9, edgecolor="white", **place)


def _highest_shown(calibration: Calibration) -> float:
    """Where the frequency axis ends [Hz]."""
    measured = max(float(file.scored.frequencies[-1]) for file in calibration.files)
    if not calibration.modes:
        return measured
    return min(measured, SHOWN_ABOVE * max(mode.mode.frequency for mode in calibration.modes))
