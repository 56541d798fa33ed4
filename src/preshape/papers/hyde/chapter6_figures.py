"""Hyde, section 6.2: what each method leaves while the modes sweep, and along the slew of MACE."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from preshape.papers.hyde.chapter5_slews import DT
from preshape.papers.hyde.chapter6 import Adaptive
from preshape.papers.hyde.chapter6_mace import SLEW, Follow
from preshape.papers.hyde.chapter6_sweep import CENTRE, MOVE, REST, SPREAD, Sweep, part_done
from preshape.papers.reproduction import Figure
from preshape.report.figures import ACCENT, MUTED, SECOND, new_figure, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

__all__ = ["figures", "swept_figure"]

FIXED = ("fixed", "band", "unshaped")


def figures(done: Adaptive) -> list[Figure]:
    """The sweep, and MACE if it was simulated."""
    made = [
        Figure(
            "6.2-sweep",
            "[ours: what is left while frequencies sweep by +-20 %]",
            lambda: swept_figure(done.one, done.two),
        )
    ]
    mace = done.mace
    if mace is not None:
        made.append(
            Figure("6.2-mace", "[ours: the slew of 120 deg, shapers that stay and follow]", lambda: _mace(mace))
        )
    return made


def swept_figure(one: Sweep, two: Sweep) -> Drawing:
    """Frequencies over time; residuals by method, for one mode and for two."""
    figure = new_figure(7.4, 6.4)
    above, below = figure.subplots(2, 1, height_ratios=[1.0, 2.4])
    times = np.linspace(0.0, MOVE + 0.5 * REST, 400)
    swing = SPREAD * (1.0 - 2.0 * np.array([part_done(t) for t in times.tolist()]))
    above.plot(times, CENTRE[0] * (1.0 - swing), color=ACCENT, linewidth=2.0, label="first mode")
    above.plot(times, CENTRE[1] * (1.0 + swing), color=SECOND, linewidth=1.6, linestyle="--", label="second mode")
    _ends(above, MOVE, 0.3)
    above.set_ylim(0.0, 3.6)
    above.set_xlim(0.0, float(times[-1]))
    above.legend(fontsize=8.5, frameon=False, ncols=2, loc="upper right")
    tidy(above, "time [s]", "frequency [Hz]", "The frequencies go with the move")
    _dots(
        below,
        {
            "one mode": {name: 100.0 * value for name, value in one.left.items()},
            "two modes": {name: 100.0 * value for name, value in two.left.items()},
        },
    )
    tidy(
        below,
        "left of the plain command's vibration [%]",
        "method",
        "Shapers that stay (hollow) and that follow (filled)",
    )
    return figure


def _mace(done: Follow) -> Drawing:
    figure = new_figure(7.4, 4.6)
    above, below = figure.subplots(2, 1, height_ratios=[1.0, 1.4])
    times = DT * np.arange(done.angles.size, dtype=float)
    shown = times <= 2.5 * SLEW
    angles, fundamental = np.array([(angle, modes[0].frequency) for angle, modes in done.modes.items()]).T
    above.plot(times[shown], np.interp(done.angles, angles, fundamental)[shown], color=ACCENT, linewidth=2.0)
    _ends(above, SLEW, 1.65)
    above.set_xlim(0.0, float(times[shown][-1]))
    above.set_ylim(1.6, 2.1)
    tidy(above, "time [s]", "frequency [Hz]", "The fundamental during the slew")
    _dots(below, {"MACE": {name: 1e6 * value for name, value in done.left.items()}})
    tidy(
        below,
        r"left after 6 s, peak to peak, in 10$^{-6}$ [m]",
        "method",
        "Shapers that stay (hollow) and follow (filled)",
    )
    return figure


def _ends(axes: Axes, time: float, height: float) -> None:
    """A line where nothing more is commanded, named beside it."""
    axes.axvline(time, color=MUTED, linewidth=1.0, linestyle=":")
    axes.annotate(
        "the command ends", (time, height), xytext=(-5, 0), textcoords="offset points", fontsize=8.5, ha="right"
    )


def _dots(axes: Axes, groups: Mapping[str, Mapping[str, float]]) -> None:
    """One line a method, one mark a group, over a logarithmic axis."""
    names = list(dict.fromkeys(name for values in groups.values() for name in values))
    for (label, values), (color, mark) in zip(groups.items(), ((ACCENT, "o"), (SECOND, "s")), strict=False):
        for stays in (True, False):
            chosen = [name for name in values if name.startswith(FIXED) == stays]
            axes.plot(
                [values[name] for name in chosen],
                [names.index(name) for name in chosen],
                mark,
                color=color,
                markersize=6.5,
                markerfacecolor="white" if stays else color,
                markeredgewidth=1.5,
                label=None if stays or len(groups) == 1 else label,
            )
    axes.set_xscale("log")
    axes.set_yticks(range(len(names)), names, fontsize=8.5)
    axes.set_ylim(len(names) - 0.5, -0.5)
    axes.grid(axis="y", color="#e3e3e3", linewidth=0.8)
    axes.set_axisbelow(True)
    if len(groups) > 1:
        axes.legend(fontsize=8.5, loc="upper left", frameon=True, edgecolor="white")
