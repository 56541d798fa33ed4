"""Singh & Heppler, figures 1 to 15."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from preshape import Shaper
from preshape.papers.drawing import Curve, curves_figure, sampled
from preshape.papers.reproduction import Figure
from preshape.papers.singh.example import TABLE_2, shaper_of
from preshape.papers.singh.signals import (
    DAMPED,
    ENVELOPED,
    LOWEST,
    UNDAMPED,
    Term,
    Vector,
    applied,
    envelope,
    response,
    signal,
)
from preshape.report.figures import ACCENT, INK, MUTED, SECOND, new_figure, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure as Drawing

__all__ = ["figures"]

END = 8.0
"""Of the time axes of figures 6 to 15 [s]."""

SINGLE = Shaper([0.0], [1.0])


def figures() -> list[Figure]:
    """In the order of the paper; of 11 to 13 as captioned, which differs from the text."""
    two, three = shaper_of("two", UNDAMPED), shaper_of("three", UNDAMPED)
    damped = shaper_of("two", DAMPED)
    table = Shaper(TABLE_2.times, TABLE_2.amplitudes)
    return [
        Figure("1", "y = sin(t) + sin(2 t)", _no_antiperiod),
        Figure("2", "exp(-0.1 t) sin(t) + exp(-1.2 t) sin(3 t)/3 and its envelope", _enveloped),
        Figure("3", "Impulse response by means of a rotating vector [of the signal of figure 2]", _rotating),
        Figure("4", "Phasor diagram for a two impulse controller", lambda: _phasors("Two", damped)),
        Figure("5", "Phasor diagram for a three impulse controller", lambda: _phasors("Three", table)),
        Figure(
            "6",
            "Response of a system without damping to a unit impulse",
            lambda: _motion("Undamped: the second half period mirrors the first", SINGLE, UNDAMPED, antiperiod=True),
        ),
        Figure(
            "7",
            "System without damping, two impulses; perfect application of the second impulse [to 0.01 s]",
            lambda: _motion("Two impulses, in time", applied(two), UNDAMPED),
        ),
        Figure(
            "8",
            "System without damping, two impulses; imperfect application of the second impulse [0.01 s late]",
            lambda: _motion("Two impulses, the second 0.01 s late", applied(two, [0, 1]), UNDAMPED),
        ),
        Figure(
            "9",
            "System without damping, three impulses; perfect application",
            lambda: _motion("Three impulses, in time", applied(three), UNDAMPED),
        ),
        Figure(
            "10",
            "System without damping, three impulses; imperfect application [second and third 0.01 s late]",
            lambda: _motion("Three impulses, two of them 0.01 s late", applied(three, [0, 1, 1]), UNDAMPED),
        ),
        Figure(
            "11",
            "Response of a system with damping to a two impulse controller",
            lambda: _motion("z = 0.01, two impulses: vibration remains", applied(damped), DAMPED),
        ),
        Figure(
            "12",
            "Response of a system with damping to a unit impulse",
            lambda: _motion("z = 0.01, unit impulse", SINGLE, DAMPED),
        ),
        Figure(
            "13",
            "Response of a system with damping to a classical controller with four impulses",
            lambda: _motion("z = 0.01, four impulses (two convolved)", applied(shaper_of("four", DAMPED)), DAMPED),
        ),
        Figure(
            "14",
            "Response of a system with damping to a classical controller with nine impulses",
            lambda: _motion("z = 0.01, nine impulses (two convolved)", applied(shaper_of("nine", DAMPED)), DAMPED),
        ),
        Figure(
            "15",
            "Response of a system with damping to a three impulse controller [table 2]",
            lambda: _motion("z = 0.01, three impulses", applied(table), DAMPED),
        ),
    ]


def _no_antiperiod() -> Drawing:
    t = sampled(0.0, 4.0 * math.pi)
    y = np.sin(t) + np.sin(2.0 * t)
    shifted = -(np.sin(t + math.pi) + np.sin(2.0 * (t + math.pi)))
    return curves_figure(
        "sin t + sin 2t is not its own negative after half a period",
        "time [s]",
        "y [-]",
        [Curve("y(t)", t, y), Curve("-y(t + pi)", t, shifted)],
        level=0.0,
        legend="lower left",
    )


def _enveloped() -> Drawing:
    t = sampled(0.0, 20.0)
    e = envelope(ENVELOPED, 1.0, t)
    figure = curves_figure(
        "Signal and envelope: y = sin(t) E(t)",
        "time [s]",
        "y [-]",
        [Curve("y(t)", t, signal(ENVELOPED, 1.0, t)), Curve("E(t), -E(t)", t, e)],
        level=0.0,
        legend="upper right",
    )
    figure.axes[0].plot(t, -e, color=SECOND, linestyle="--", linewidth=1.6)
    return figure


def _rotating() -> Drawing:
    t = sampled(0.0, 4.0 * math.pi)
    e, at = envelope(ENVELOPED, 1.0, t), 1.0
    length = float(envelope(ENVELOPED, 1.0, np.array([at]))[0])
    figure = new_figure(7.2, 3.0)
    left, right = figure.subplots(1, 2, width_ratios=[1.4, 1.9], sharey=True)
    left.plot(e * np.cos(t), e * np.sin(t), color=MUTED, linewidth=1.3)
    _arrow(left, 0.0, 0.0, length * math.cos(at), length * math.sin(at), ACCENT)
    left.set_xlim(-0.8, 2.1)
    tidy(left, "E(t) cos(w t) [-]", "E(t) sin(w t) [-]", f"The vector at t = {at:g} s")
    right.plot(t, e * np.sin(t), color=ACCENT, linewidth=2.0)
    right.plot([at], [length * math.sin(at)], "o", color=ACCENT)
    for axes in (left, right):
        axes.axhline(length * math.sin(at), color=INK, linewidth=0.9, linestyle=(0, (1, 2)))
    right.set_xlim(0.0, t[-1])
    tidy(right, "time [s]", "y [-]", "Its projection is the response")
    return figure


def _phasors(count: str, shaper: Shaper) -> Drawing:
    """The impulses' vectors at the last impulse, one after the other: they close."""
    left = shaper.duration - shaper.times
    lengths = (shaper.amplitudes / shaper.amplitudes[-1]) * envelope(DAMPED, LOWEST, left)
    x = lengths * np.cos(
        LOWEST * left
    )  # the other component, with the sine, is zero at an antiperiod and its multiples
    figure = new_figure(6.6, 2.4)
    axes = figure.add_subplot()
    rows = np.arange(len(shaper), dtype=float)[::-1]
    for i, (dx, row, color) in enumerate(zip(x, rows, (SECOND, ACCENT, INK), strict=False)):
        _arrow(axes, 0.0, row, float(dx), row, color)
        axes.annotate(
            f"impulse {i + 1}: {dx:+.2f}",
            (float(dx) / 2.0, row),
            xytext=(0, 5),
            textcoords="offset points",
            ha="center",
            fontsize=8.5,
            color=INK,
        )
    axes.axvline(0.0, color=INK, linewidth=0.8)
    span = 1.15 * float(np.abs(x).max())
    axes.set_xlim(-span, span)
    axes.set_ylim(-0.6, len(shaper) - 0.3)
    axes.set_yticks([])
    tidy(
        axes,
        f"component in phase [-], sum {abs(float(x.sum())):.3f}",
        "",
        f"{count} impulses, seen at the last one, add to nothing",
    )
    return figure


def _motion(title: str, shaper: Shaper, terms: tuple[Term, ...], antiperiod: bool = False) -> Drawing:
    t = sampled(0.0, END, 2001)
    curves = [Curve("response", t, response(shaper, terms, t))]
    if len(shaper) > 1:
        curves.append(Curve("to a unit impulse", t, response(SINGLE, terms, t)))
    marks = [(shaper.duration, "last impulse")] if len(shaper) > 1 else []
    if antiperiod:
        marks = [(math.pi / 2.0, "antiperiod"), (math.pi, "period")]
    figure = curves_figure(title, "time [s]", "y [-]", curves[:1], marks=marks, level=0.0)
    if len(curves) > 1:
        _behind(figure.axes[0], curves[1].x, curves[1].y)
    figure.axes[0].set_ylim(-3.0, 2.5)
    return figure


def _behind(axes: Axes, x: Vector, y: Vector) -> None:
    axes.plot(x, y, color=SECOND, linewidth=0.9, linestyle="--", zorder=1.5, label="to a unit impulse")
    axes.legend(fontsize=8.5, loc="lower right", ncols=2, frameon=True, framealpha=0.9, edgecolor="white")


def _arrow(axes: Axes, x: float, y: float, to_x: float, to_y: float, color: str) -> None:
    axes.annotate("", (to_x, to_y), xytext=(x, y), arrowprops={"arrowstyle": "-|>", "color": color, "linewidth": 2.0})
