"""The figure of a calibration: which shaper, and why, at one look."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from preshape.report.calibration import Calibration
from preshape.report.figures import ACCENT, INK, MUTED, SECOND, SOFT, new_figure, tidy
from preshape.report.tables import time_unit
from preshape.vibration import residual_vibration

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["calibration_figure"]

RUNNERS_UP = 2
"""How many of the other candidates are drawn beside the chosen one."""

SHOWN_ABOVE = 2.2
"""The frequency axis ends at this multiple of the highest mode, if the measurement reaches that far."""

LINE_STYLES = ("--", ":")


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
    _impulses(figure.add_subplot(grid[1, 0]), calibration)
    _move(figure.add_subplot(grid[1, 1]), calibration)
    shaper = calibration.shaper
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
    others = [c for c in calibration.candidates if c is not calibration.chosen and not c.excluded][:RUNNERS_UP]
    for candidate, style in zip(others, LINE_STYLES, strict=False):
        v = residual_vibration(candidate.shaper, f, damping)
        axes.plot(f, v, color=SECOND, linestyle=style, linewidth=1.4, label=f"left by {candidate.name}")
    chosen = calibration.chosen
    v = residual_vibration(chosen.shaper, f, damping)
    axes.plot(f, v, color=ACCENT, linewidth=2.4, label=f"left by {chosen.name} (at damping {damping:.3f})")
    axes.axhline(calibration.tolerance, color=INK, linewidth=0.9, linestyle=(0, (1, 2)))
    axes.annotate(
        f"{100.0 * calibration.tolerance:g} %",
        (high, calibration.tolerance),
        xytext=(-3, 2),
        textcoords="offset points",
        ha="right",
        fontsize=8.5,
        color=INK,
    )
    for number, mode in enumerate(sorted(calibration.modes, key=lambda mode: mode.mode.frequency)):
        axes.axvline(mode.mode.frequency, color=INK, linewidth=1.0)
        axes.annotate(
            f"{mode.mode.frequency:.4g} Hz\ndamping {mode.mode.damping:.3f}",
            (mode.mode.frequency, 1.12 if number % 2 == 0 else 1.3),
            xytext=(4, 0),
            textcoords="offset points",
            va="center",
            fontsize=8.5,
            color=INK,
        )
    axes.set_xlim(0.0, high)
    axes.set_ylim(0.0, 1.42)
    axes.set_yticks([0.0, 0.25, 0.5, 0.75, 1.0], ["0", "25 %", "50 %", "75 %", "100 %"])
    tidy(
        axes,
        "frequency [Hz]",
        "of the highest power / of the vibration",
        "What vibrates, and how much of it each shaper leaves",
    )
    axes.legend(fontsize=8.5, loc="upper right", frameon=True, framealpha=0.9, edgecolor="white")


def _percent(fraction: float) -> str:
    """A fraction for people: rounding errors are not shown as a result."""
    return "less than 0.01 %" if fraction < 1e-4 else f"{100.0 * fraction:.2g} %"


def _highest_shown(calibration: Calibration) -> float:
    """Where the frequency axis ends [Hz]."""
    measured = max(float(file.scored.frequencies[-1]) for file in calibration.files)
    if not calibration.modes:
        return measured
    return min(measured, SHOWN_ABOVE * max(mode.mode.frequency for mode in calibration.modes))


def _impulses(axes: Axes, calibration: Calibration) -> None:
    """Times and amplitudes."""
    shaper = calibration.shaper
    unit = time_unit(shaper)
    times = unit.per_second * shaper.times
    axes.vlines(times, 0.0, shaper.amplitudes, color=ACCENT, linewidth=3.0)
    axes.plot(times, shaper.amplitudes, "o", color=ACCENT, markersize=6)
    top = float(shaper.amplitudes.max())
    if len(shaper) <= 6:
        for t, a in zip(times, shaper.amplitudes, strict=True):
            axes.annotate(
                f"{a:.3f}", (t, a), xytext=(0, 6), textcoords="offset points", ha="center", fontsize=8.5, color=INK
            )
    axes.set_ylim(0.0, 1.2 * top)
    span = float(times[-1])
    axes.set_xlim(-0.1 * span, 1.1 * span)
    tidy(axes, f"time [{unit.name}]", "amplitude [-]", "The shaper's impulses")


def _move(axes: Axes, calibration: Calibration) -> None:
    """The identified modes in a point-to-point move."""
    move = calibration.move
    if move is None:
        axes.set_axis_off()
        axes.text(0.5, 0.5, "no mode was found:\nno move was simulated", ha="center", va="center", color=INK)
        return
    unit = time_unit(calibration.shaper)
    times, end = unit.per_second * move.times, unit.per_second * move.end_shaped
    axes.axvspan(0.0, unit.per_second * move.end_unshaped, color="#f3f3f3", linewidth=0)
    axes.plot(times, 100.0 * move.unshaped, color=SECOND, linewidth=1.3, linestyle="--", label="unshaped")
    axes.plot(times, 100.0 * move.shaped, color=ACCENT, linewidth=1.9, label="shaped")
    axes.axvline(end, color=ACCENT, linewidth=0.9, linestyle=(0, (1, 2)))
    peak = 100.0 * max(float(np.abs(move.unshaped).max()), float(np.abs(move.shaped).max()))
    axes.set_ylim(-1.15 * peak, 1.45 * peak)
    axes.annotate(
        f"shaped move ends {unit.show(move.end_shaped - move.end_unshaped)} later,\n"
        f"leaves {_percent(move.left)} of the vibration",
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
