"""The figure of a comparison: the trade of time against robustness, and what frequency errors do to the main ones."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from preshape.errors import InputError
from preshape.report.comparison import Comparison, Contender, Kind
from preshape.report.comparison_table import LengthUnit, comparison_sentences, length_unit, move_sentence
from preshape.report.figures import ACCENT, GREEN, INK, MUTED, PALE, SECOND, SERIES, new_figure, tidy
from preshape.report.labels import label_points

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["comparison_figure"]

LOOKS: dict[Kind, tuple[str, str]] = {
    "unshaped": (INK, "s"),
    "smooth": (GREEN, "o"),
    "filtered": (MUTED, "D"),
    "shaped": (ACCENT, "^"),
    "rest-to-rest": (SECOND, "v"),
}
"""Colour and mark of each kind."""

DECADES = 4.0
"""How far below the reference vibration is shown; what is less is drawn on the lower edge."""

LINEAR_TO, ROUND = 3.0, (1.0, 1.5, 2.0, 3.0, 5.0, 7.0)
"""Up to this ratio of times their axis is linear; beyond, it has ticks at these times powers of ten."""

SAME = 1e-2
"""Points nearer than this part of both their values share a label."""


def comparison_figure(comparison: Comparison) -> Figure:
    """Left: when each command ends and what it leaves at the worst frequency; right: what is left over frequency.

    Parameters
    ----------
    comparison : Comparison
        From :func:`preshape.workflow.compare`.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        If the comparison has no contenders.
    """
    if not comparison.contenders:
        raise InputError(
            f"no command can make this move, so there is nothing to draw: all {len(comparison.left_out)} are left out, "
            "with their reasons in the table without a figure; allow more."
        )
    figure = new_figure(12.5, 6.4)
    left, right = figure.subplots(1, 2, width_ratios=[1.35, 1.0])
    shown = length_unit(comparison)
    _curves(right, comparison, shown)
    points = _points(left, comparison, shown)
    first, robust = comparison_sentences(comparison)
    figure.suptitle(
        f"{move_sentence(comparison)}\n{first}\n{robust}", fontsize=11, fontweight="bold", color=INK, x=0.01, ha="left"
    )
    label_points(left, points)
    return figure


def _points(axes: Axes, comparison: Comparison, shown: LengthUnit) -> list[tuple[float, float, str]]:
    """The contenders as points; returns where their labels belong."""
    floor = 10.0**-DECADES * comparison.reference
    heights = [max(one.worst_residual, floor) * shown.per_unit for one in comparison.contenders]
    for kind, (colour, mark) in LOOKS.items():
        for still, fill in ((True, colour), (False, "white")):
            at = [
                (one.move_time, height)
                for one, height in zip(comparison.contenders, heights, strict=True)
                if one.kind == kind and (one.settling_time <= one.move_time) == still
            ]
            if at:
                x, y = np.array(at).T
                axes.plot(x, y, mark, color=colour, markerfacecolor=fill, markeredgewidth=1.6, markersize=8)
    handles = [
        axes.plot([], [], mark, color=colour, markersize=8, label=kind)[0]
        for kind, (colour, mark) in LOOKS.items()
        if any(one.kind == kind for one in comparison.contenders)
    ]
    handles += axes.plot([], [], "o", color=INK, markerfacecolor="white", markeredgewidth=1.6, label="not still yet")
    axes.axhline(comparison.within * shown.per_unit, color=INK, linewidth=0.9, linestyle=(0, (1, 2)))
    axes.set_yscale("log")
    times = np.array([one.move_time for one in comparison.contenders])
    _time_axis(axes, float(times.min()), float(times.max()))
    low, high = min(*heights, comparison.within * shown.per_unit), max(heights)
    axes.set_ylim(low / 2.5, high * 2.5)
    tidy(
        axes,
        "the command ends [s]",
        f"vibration left, at worst with frequencies off by ±{100.0 * comparison.frequency_error:g} % [{shown.name}]",
        "Sooner is left, more robust is down",
    )
    axes.annotate(
        f"settled: {shown.show(comparison.within)}",
        (axes.get_xlim()[1], comparison.within * shown.per_unit),
        xytext=(-3, 3),
        textcoords="offset points",
        ha="right",
        fontsize=8.5,
        color=INK,
    )
    axes.figure.legend(handles=handles, fontsize=8.5, loc="outside lower left", ncols=len(handles), frameon=False)
    return _labels(comparison, heights)


def _time_axis(axes: Axes, first: float, last: float) -> None:
    """From a little before the first time to well after the last, for their labels; in decades if they need it."""
    if last < LINEAR_TO * first:
        span = max(last - first, 0.1 * last)
        axes.set_xlim(first - 0.12 * span, last + 0.22 * span)
        return
    span = last / first
    axes.set_xscale("log")
    axes.set_xlim(first / span**0.1, last * span**0.16)
    low, high = axes.get_xlim()
    decades = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1.0)
    ticks = [float(t) for t in np.multiply.outer(decades, ROUND).ravel() if low <= t <= high]
    axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    axes.set_xticks([], minor=True)


def _labels(comparison: Comparison, heights: list[float]) -> list[tuple[float, float, str]]:
    """One label a point; commands that fall together share it, and name what they shape once."""
    found: list[tuple[float, float, str]] = []
    for one, height in zip(comparison.contenders, heights, strict=True):
        for number, (x, y, text) in enumerate(found):
            if abs(x - one.move_time) <= SAME * x and abs(y - height) <= SAME * y:
                base, plus, _ = text.partition(" + ")
                found[number] = (x, y, f"{text}, {one.name.removeprefix(base + plus) if plus else one.name}")
                break
        else:
            found.append((one.move_time, height, one.name))
    return found


def _main(comparison: Comparison) -> list[Contender]:
    """The few whose curves are drawn: the unshaped base, the winners, the most robust shaped and smooth ones."""
    base = "trapezoid" if comparison.maximum_jerk is None else "S-curve"
    wanted = [one for one in comparison.contenders if one.name == base]
    wanted += [comparison.first_to_settle]
    wanted += [] if comparison.first_robust is None else [comparison.first_robust]
    for kind in ("shaped", "smooth"):
        of_kind = [one for one in comparison.contenders if one.kind == kind]
        if of_kind:
            wanted += [of_kind[0], min(of_kind, key=lambda one: one.worst_residual)]
    chosen: list[Contender] = []
    for one in wanted:
        if all(one is not other for other in chosen):
            chosen.append(one)
    return chosen[: len(SERIES)]


def _curves(axes: Axes, comparison: Comparison, shown: LengthUnit) -> None:
    """Vibration left over the error of the frequency."""
    percent = 100.0 * (comparison.frequency_ratios - 1.0)
    floor = 10.0**-DECADES * comparison.reference
    error = 100.0 * comparison.frequency_error
    axes.axvspan(-error, error, color=PALE, linewidth=0)
    for one, (colour, style, width) in zip(_main(comparison), SERIES, strict=False):
        left = np.maximum(one.residual_curve, floor) * shown.per_unit
        axes.plot(percent, left, color=colour, linestyle=style, linewidth=width, label=one.name)
    axes.axhline(comparison.within * shown.per_unit, color=INK, linewidth=0.9, linestyle=(0, (1, 2)))
    axes.set_yscale("log")
    axes.set_xlim(percent[0], percent[-1])
    axes.set_ylim(bottom=floor * shown.per_unit)
    tidy(
        axes,
        "actual frequencies off by [%]",
        f"vibration left at the command's end [{shown.name}]",
        "What is left when the machine is not as modelled",
    )
    axes.figure.legend(
        *axes.get_legend_handles_labels(), fontsize=8.5, loc="outside lower right", ncols=3, frameon=False
    )
