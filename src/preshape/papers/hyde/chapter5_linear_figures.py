"""Hyde, figures 5.1 to 5.6: the linear MACE model, the shaped torque, and the far end's vibration."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from preshape.papers.drawing import Curve, Vector, curves_figure, impulse_figure, legend_below, sampled
from preshape.papers.hyde.chapter5_linear import Slewed
from preshape.papers.reproduction import Figure
from preshape.plant import linear_mace_beam
from preshape.profile import Profile
from preshape.report.figures import ACCENT, INK, MUTED, SECOND, new_figure, tidy
from preshape.shaper import Shaper

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

__all__ = ["figures"]

END = 1.6
"""Of the time axis of the whole slew [s]."""

DETAIL, CLOSER = (1.15, 1.65), (1.15, 1.3)
"""Of the details [s]: both commands have ended; what three cancelled modes leave is fast."""

FINE = 6001
"""Points of a detail: at least nine to a period of the fastest mode, which is a tenth of a micrometre."""

PULSES = "[0.25 s, 0.75 s apart; torque for 1.2 mm of vibration]"


def figures(slew: Slewed) -> list[Figure]:
    """In the order of the section."""
    return [
        Figure("5.1", "MATLAB linear finite element model of MACE [payload's arm not to scale]", _model),
        Figure(
            "5.2",
            "Direct solution input shaper designed for 9.8 Hz, 31.7 Hz, and 66.1 Hz, z = 0.0 in all modes "
            "[the shortest there is]",
            lambda: impulse_figure(
                f"Three modes: {1e3 * slew.printed.duration:.2f} ms, {len(slew.printed)} impulses",
                ("three modes", slew.printed),
            ),
        ),
        Figure("5.3", f"System inputs adjusted by the input shaper {PULSES}", lambda: _inputs(slew)),
        Figure("5.4", "Bus endpoint translation due to inputs [from where it ends]", lambda: _whole(slew)),
        Figure(
            "5.5",
            "Response to unshaped input (detail) [from the middle of the vibration]",
            lambda: _detail(
                slew,
                f"Unshaped: {1e3 * slew.left():.2f} mm from peak to peak",
                [("unshaped", None)],
                ("far end [mm]", 1e3),
                DETAIL,
            ),
        ),
        Figure(
            "5.6",
            "Response to shaped input (detail) [micrometres; all twelve modes for comparison]",
            lambda: _detail(
                slew,
                f"Three modes cancelled: {100.0 * slew.left(slew.printed) / slew.left():.1f} % left; twelve: nothing",
                [("shaped for 3 modes", slew.printed), ("shaped for all 12", slew.direct[12])],
                ("far end [µm]", 1e6),
                CLOSER,
            ),
        ),
    ]


def _model() -> Drawing:
    beam = linear_mace_beam()
    hinge = float(beam.nodes[-1])
    figure = new_figure(6.6, 2.8)
    axes = figure.add_subplot()
    axes.plot(beam.nodes, np.zeros_like(beam.nodes), color=ACCENT, linewidth=4.0, zorder=2)
    axes.plot(
        beam.nodes,
        np.zeros_like(beam.nodes),
        "o",
        color=ACCENT,
        markerfacecolor="white",
        markersize=8,
        zorder=3,
    )
    axes.plot([hinge, hinge], [0.0, 0.3], color=INK, linewidth=2.0, zorder=1)
    axes.plot([hinge], [0.3], "o", color=INK, markersize=16)
    axes.annotate(
        "payload: point mass\non a rigid member",
        (hinge, 0.3),
        xytext=(-16, 0),
        textcoords="offset points",
        ha="right",
        va="center",
        fontsize=8.5,
        color=INK,
    )
    axes.annotate(
        "gimbal torque",
        (hinge, 0.0),
        xytext=(0, -16),
        textcoords="offset points",
        ha="center",
        va="top",
        fontsize=8.5,
        color=SECOND,
    )
    angle = np.linspace(-0.4, 1.2, 60) * np.pi
    axes.plot(hinge + 0.055 * np.cos(angle), 0.055 * np.sin(angle), color=SECOND, linewidth=1.6, zorder=4)
    axes.plot(hinge + 0.055 * np.cos(angle[-1]), 0.055 * np.sin(angle[-1]), "v", color=SECOND, markersize=6, zorder=4)
    axes.annotate("", (0.0, 0.22), xytext=(0.0, 0.04), arrowprops={"arrowstyle": "->", "color": MUTED})
    axes.annotate("far node: seen", (0.02, 0.16), fontsize=8.5, color=INK)
    axes.annotate(
        "bus: six elements,\na displacement and a slope at each node", (0.375, -0.14), fontsize=8.5, color=INK
    )
    axes.set_xlim(-0.1, 1.68)
    axes.set_aspect("equal", adjustable="datalim")
    axes.set_yticks([])
    tidy(axes, "along the bus [m]", "", "A free bus, and a payload that a motor turns at its right end")
    return figure


def _inputs(slew: Slewed) -> Drawing:
    shaped = slew.command.shaped(slew.printed)
    return curves_figure(
        "Each edge of the torque becomes a staircase of eight steps",
        "time [s]",
        "gimbal torque [N m]",
        [Curve("shaped", *_stairs(shaped)), Curve("unshaped", *_stairs(slew.command))],
        level=0.0,
        legend="upper right",
    )


def _stairs(command: Profile) -> tuple[Vector, Vector]:
    """Corners of a command made of steps."""
    times = np.concatenate([[-0.1], np.repeat(command.times, 2), [END]])
    levels = np.concatenate([[0.0], np.repeat(np.cumsum(command.jumps), 2)])
    return times, np.insert(levels, 1, 0.0)[: times.size]


def _whole(slew: Slewed) -> Drawing:
    t = sampled(0.0, END, 1601)
    curves = [
        Curve(words, t, 1e3 * slew.motion(shaper)("left", t))
        for words, shaper in (("shaped", slew.printed), ("unshaped", None))
    ]
    return curves_figure(
        "The far end swings out and stays; shaped, a shaper's length later",
        "time [s]",
        "far end [mm]",
        curves,
        legend="lower right",
    )


def _detail(
    slew: Slewed,
    title: str,
    shapers: list[tuple[str, Shaper | None]],
    scale: tuple[str, float],
    when: tuple[float, float],
) -> Drawing:
    t = sampled(*when, FINE)
    curves = []
    for words, shaper in shapers:
        y = scale[1] * slew.motion(shaper)("left", t)
        curves.append(Curve(words, t, y - 0.5 * (y.max() + y.min())))
    figure = curves_figure(title, "time [s]", scale[0], curves, level=0.0, legend=None)
    if len(curves) > 1:
        legend_below(figure)
    return figure
