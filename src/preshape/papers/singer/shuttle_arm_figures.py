"""Singer & Seering, figure 12: one move of the Shuttle arm, plain and shaped, and what two hundred moves leave."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from preshape.papers.reproduction import Figure
from preshape.papers.singer.shuttle_arm import PRINTED
from preshape.papers.singer.shuttle_moves import ALL, LINEAR, TIGHT, Experiment
from preshape.report.figures import ACCENT, INK, MUTED, SECOND, new_figure, tidy

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

__all__ = ["figures"]

NAMES = {
    LINEAR: "linear joints",
    "stiffening": "stiffening gears",
    "freeplay": "freeplay",
    "friction": "friction, stiction",
    "saturation": "saturation",
    "digital": "digital commands",
    TIGHT: "all but freeplay",
    ALL: "all",
}
"""From the top of the figure down."""


def figures(done: Experiment) -> list[Figure]:
    """The memo's, and the distribution."""
    return [
        Figure(
            "12",
            "Response of the Shuttle arm to a pulse, with the original controller and shaped by three impulses [our "
            "arm, all imperfections on; both shoulder joints at half their fastest rate for 4 s, in the pose of the "
            "calibration]",
            lambda: _move(done),
        ),
        Figure(
            "12-moves",
            "Three impulses on 200 random moves, each imperfection alone: what they divide the residual by; line 10 to "
            "90 %, bar the middle half, dot median [ours; the memo has one move]",
            lambda: _moves(done),
        ),
    ]


def _move(done: Experiment) -> Drawing:
    figure = new_figure(6.6, 5.0)
    whole, close = figure.subplots(2, 1, sharex=True)
    plain, shaped = done.drawn["unshaped"], done.drawn["three"]
    ends = {
        name: np.array([one.outputs[f"end point {axis}"] for axis in "xyz"])
        for name, one in (("plain", plain), ("shaped", shaped))
    }
    rest = {
        name: path[:, done.ended[key] :].mean(axis=1)
        for (name, path), key in zip(ends.items(), done.ended, strict=True)
    }
    way = rest["shaped"] - ends["shaped"][:, 0]
    way = way / np.linalg.norm(way)
    for axes, unit in ((whole, 1.0), (close, 1e3)):
        for name, color, dash, label in (("plain", SECOND, "--", "pulse"), ("shaped", ACCENT, "-", "three impulses")):
            path = unit * (way @ (ends[name] - rest[name][:, np.newaxis]))
            axes.plot(plain.times, path, color=color, linestyle=dash, linewidth=1.8, label=label)
    tidy(whole, "", "end point to rest [m]", "The end point along its way, from where it comes to rest")
    tidy(close, "time [s]", "the same [mm]", f"Close up: divided by {done.drawn_factor():.1f}")
    most = 1.3e3 * np.abs(way @ (ends["plain"] - rest["plain"][:, np.newaxis]))[done.ended["unshaped"] :].max()
    close.set_ylim(-most, most)
    close.set_xlim(0.0, float(plain.times[-1]))
    whole.legend(fontsize=8.5, frameon=True, framealpha=0.9, edgecolor="white")
    return figure


def _moves(done: Experiment) -> Drawing:
    figure = new_figure(6.6, 3.6)
    axes = figure.add_subplot()
    places = np.arange(len(NAMES), 0, -1)
    for place, variant in zip(places, NAMES, strict=True):
        low, quarter, median, three, high = np.percentile(done.factors(variant), [10, 25, 50, 75, 90])
        axes.hlines(place, low, high, color=MUTED, linewidth=1.6)
        axes.hlines(place, quarter, three, color=ACCENT, linewidth=7.0)
        axes.plot([median], [place], "o", color="white", markeredgecolor=INK, markersize=6)
    axes.axvline(PRINTED, color=SECOND, linestyle="--", linewidth=1.6)
    axes.annotate("the memo: 25", (PRINTED, 0.45), xytext=(4, 0), textcoords="offset points", fontsize=8.5, color=INK)
    axes.set_xscale("log")
    axes.set_xticks([1, 2, 5, 10, 25, 50, 100], labels=["1", "2", "5", "10", "25", "50", "100"])
    axes.minorticks_off()
    axes.set_yticks(places, labels=list(NAMES.values()))
    axes.set_ylim(0.3, len(NAMES) + 0.6)
    tidy(
        axes,
        "residual vibration divided by [-]",
        "what is on",
        "Three impulses on 200 moves of the empty arm",
    )
    return figure
