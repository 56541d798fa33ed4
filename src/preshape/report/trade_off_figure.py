"""The figure of a trade-off: what is left of the vibration over smoothing, of every family and of the optimum."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from preshape.report.figures import ACCENT, INK, MUTED, SECOND, new_figure, tidy
from preshape.report.labels import label_points
from preshape.report.trade_off import TradeOff, TradePoint

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["trade_off_figure"]

TRADE_OFF_TITLE = "What smoothing buys"

WIDER = (0.8, 1.25)
"""The axis of smoothing reaches from this part of the curve's beginning to this part of its end or the stock choice."""

PICKS = {"performance": (">", "performance"), "quality": ("v", "quality"), "improved": ("*", "improved")}
"""Marker of each pick."""

TOGETHER = (0.015, 0.05)
"""Marks closer than these parts of the width and of the height share a label."""

LEAST_HEIGHT = 0.08
"""The axis of vibration reaches at least this far [-]."""


def trade_off_figure(trade: TradeOff) -> Figure:
    """Families as labelled marks, the optimum as a line, the stock choice and the picks marked.

    Parameters
    ----------
    trade : TradeOff
        From :func:`preshape.workflow.design_within`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    figure = new_figure(10.0, 4.6)
    axes = figure.add_subplot()
    ends = [one.score.smoothing for one in (*trade.optimum, trade.stock, *trade.picks)]
    low, high = WIDER[0] * min(ends), WIDER[1] * max(ends)
    shown = [one for one in trade.families if low <= one.score.smoothing <= high and one is not trade.stock]
    if trade.optimum:
        found = [one for one in (trade.quality, trade.improved) if one is not None]
        x, y = _places(_front([*trade.optimum, *found]))
        label = f"optimum found, at most {trade.impulses} impulses"
        axes.plot(x, y, color=ACCENT, linewidth=2.2, marker=".", markersize=7, label=label, zorder=3)
    for own, marker, label in ((True, "s", "Klipper's families"), (False, "o", "families of preshape")):
        group = [one for one in shown if one.name.startswith("Klipper ") == own]
        if group:
            x, y = _places(group)
            (marks,) = axes.plot(x, y, marker, color=MUTED, markersize=6, label=label, zorder=4)
            marks.set(markerfacecolor=MUTED if own else "white", clip_on=False)  # whole at the end of the axis
    x, y = _places([trade.stock])
    stock = f"stock choice: {trade.stock.name.removeprefix('Klipper ')}"
    axes.plot(x, y, "D", color=SECOND, markersize=9, markeredgecolor=INK, label=stock, zorder=5)
    for pick in trade.picks:
        marker, name = PICKS[pick.name]
        x, y = _places([pick])
        label = f"{name}: max_accel {pick.score.maximum_acceleration:.0f} mm/s²"
        size = 14 if marker == "*" else 10
        axes.plot(x, y, marker, color=ACCENT, markersize=size, markeredgecolor=INK, label=label, zorder=6)
    drawn = [*trade.optimum, *shown, trade.stock, *trade.picks]
    top = max(LEAST_HEIGHT, *(one.score.remaining_vibration for one in drawn))
    axes.axhline(100.0 * trade.allowed, color=INK, linewidth=0.9, linestyle=(0, (1, 2)), zorder=1)
    axes.set_xlim(low, high)
    axes.set_ylim(-4.0 * top, 120.0 * top)
    faster = 100.0 * trade.acceleration_gain
    gain = f"max_accel {faster:+.1f} %" if faster >= 0.5 else "no gain in max_accel"
    tidy(
        axes,
        "smoothing [mm] at 5000 mm/s²",
        "vibration left, by Klipper's measure [%]",
        f"{TRADE_OFF_TITLE}; at no more vibration and smoothing than stock: {gain}",
    )
    axes.legend(fontsize=8.5, loc="upper right", frameon=True, framealpha=0.9, edgecolor="white")
    label_points(axes, _names(shown, high - low), avoid=list(zip(*_places(drawn), strict=True)))
    return figure


def _places(points: Sequence[TradePoint]) -> tuple[list[float], list[float]]:
    return (
        [one.score.smoothing for one in points],
        [100.0 * one.score.remaining_vibration for one in points],
    )


def _front(points: Sequence[TradePoint]) -> list[TradePoint]:
    """Those than which no other is better in both, by rising smoothing."""
    front: list[TradePoint] = []
    for one in sorted(points, key=lambda one: (one.score.smoothing, one.score.remaining_vibration)):
        if not front or one.score.remaining_vibration < front[-1].score.remaining_vibration:
            front.append(one)
    return front


def _names(shown: Sequence[TradePoint], width: float) -> list[tuple[float, float, str]]:
    """Short names and where they belong; marks that lie together share a label."""
    top = max((one.score.remaining_vibration for one in shown), default=0.0)
    groups: list[list[TradePoint]] = []
    for one in sorted(shown, key=lambda one: one.score.smoothing):
        for group in groups:
            aside = abs(one.score.smoothing - group[0].score.smoothing) / width
            above = abs(one.score.remaining_vibration - group[0].score.remaining_vibration) / max(top, LEAST_HEIGHT)
            if aside < TOGETHER[0] and above < TOGETHER[1]:
                group.append(one)
                break
        else:
            groups.append([one])
    named = []
    for group in groups:
        names = dict.fromkeys(one.name.removeprefix("Klipper ").replace(" Hz", "") for one in group)
        named.append((group[0].score.smoothing, 100.0 * group[0].score.remaining_vibration, ", ".join(names)))
    return named
