"""Robertson, figure 2 and figures 5 to 12; 1, 3 and 4 show how shapers work and which masses, springs and dampers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from preshape import design
from preshape.papers.drawing import Curve, curves_figure, legend_below, level_line, sampled, vibration_figure
from preshape.papers.reproduction import Figure
from preshape.papers.robertson.moves import DISTANCES, FORCE, LIMIT, MODE, OSCILLATOR, Kind, band, move, peaks
from preshape.vibration import command_vibration

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

__all__ = ["figures"]

BENCHMARK = "m1 = m2 = 1 kg, k = 1 N/m, force 1 N"

SHORTEST, FARTHEST = 1.2, 25.0
"""Of the axis of figure 5 [m]; on-off exists from 1.1 m."""

NAMES: dict[Kind, str] = {"limited": "limited to 0.3", "on-off": "On-Off"}

ERRORS = ((1.0, "as modelled"), (0.9, "actual frequency 10 % lower"), (1.1, "10 % higher"))
"""Of figures 10 and 11: actual by modelled frequency."""


def figures() -> list[Figure]:
    """In the order of the paper."""
    return [
        Figure("2", "Sensitivity Plot [of the ZV and ZVD shaper, undamped, 1 Hz]", _shapers),
        Figure("5", f"Residual Vibration Robustness [I at 5 % over the move distance; {BENCHMARK}]", _robustness),
        Figure("6", "Position Responses for Bang-Bang Commands [second mass, 5, 10, 15 units]", _positions),
        Figure("7", "Deflection Responses for Bang-Bang Commands [5, 10, 15 units]", _deflections),
        Figure(
            "8",
            "Residual Vibration (Compared to Bang-Bang) for Move Distance = 5",
            lambda: _against_bang_bang(5.0, "5 units: the limited command is the more robust"),
        ),
        Figure(
            "9",
            "Residual Vibration (Compared to Bang-Bang) for Move Distance = 15",
            lambda: _against_bang_bang(15.0, "15 units: On-Off is the more robust"),
        ),
        Figure(
            "10",
            "Deflection Response of 60% Deflection-Limited Command, Move Distance = 5 Units [errors of 10 % chosen]",
            lambda: _response(5.0, "5 units: only a lower frequency exceeds the limit"),
        ),
        Figure(
            "11",
            "Deflection Response of 60% Deflection-Limited Command, Move Distance = 10 Units [errors of 10 % chosen]",
            lambda: _response(10.0, "10 units: a higher frequency exceeds it too"),
        ),
        Figure("12", "Transient Deflection Sensitivity [5, 10, 15, 20 units; limit 0.3]", _sensitivity),
    ]


def _shapers() -> Drawing:
    return vibration_figure(
        "ZVD stays below 5 % over a wider range than ZV",
        [("ZV", design.zv((1.0, 0.0)), 0.0), ("ZVD", design.zvd((1.0, 0.0)), 0.0)],
        sampled(0.6, 1.4, 401),
        modes=[1.0],
        top=40.0,
    )


def _robustness() -> Drawing:
    x = sampled(SHORTEST, FARTHEST, 120)
    curves = [Curve(NAMES[kind], x, np.array([band(kind, float(d)) for d in x])) for kind in NAMES]
    figure = curves_figure(
        "Which command is more robust depends on the distance",
        "move distance [m]",
        "insensitivity I [-]",
        curves,
        legend=None,
        marks=[(distance, f"{distance:g} units") for distance in DISTANCES],
    )
    figure.axes[0].set_ylim(0.0, 0.42)
    legend_below(figure)
    return figure


def _bang_bang(output: str, end: float) -> list[Curve]:
    t, curves = sampled(0.0, end), []
    for distance in (10.0, 5.0, 15.0):
        motion = OSCILLATOR.motion(move("bang-bang", distance).force)
        curves.append(Curve(f"{distance:g} units", t, motion(output, t)))
    return curves


def _positions() -> Drawing:
    return curves_figure(
        "Bang-bang: 5 and 15 units vibrate on, 10 units hardly",
        "time [s]",
        "position of the second mass [m]",
        _bang_bang("second_position", 25.0),
        legend="lower right",
    )


def _deflections() -> Drawing:
    figure = curves_figure(
        "10 units end still, but bend twice as far as On-Off would",
        "time [s]",
        "deflection [m]",
        _bang_bang("deflection", 25.0),
        level=0.0,
        legend=None,
    )
    for sign in (1.0, -1.0):
        level_line(figure.axes[0], sign * OSCILLATOR.static_deflection(FORCE), "On-Off")
    legend_below(figure)
    return figure


def _against_bang_bang(distance: float, title: str) -> Drawing:
    r = sampled(0.8, 1.25, 901)
    curves = []
    for kind, name in NAMES.items():
        command = move(kind, distance).force
        v = command_vibration(command, r * MODE.frequency, relative_to="bang-bang", maximum_force=FORCE)
        curves.append(Curve(name, r, 100.0 * v))
    figure = curves_figure(
        title,
        "actual / modelled frequency [-]",
        "vibration [% of bang-bang]",
        curves,
        legend=None,
    )
    level_line(figure.axes[0], 5.0, "5 %")
    figure.axes[0].set_ylim(0.0, 40.0)
    legend_below(figure)
    return figure


def _response(distance: float, title: str) -> Drawing:
    command = move("limited", distance).force
    t = sampled(0.0, command.duration + 5.0)
    curves = [Curve(words, t, OSCILLATOR.retuned(r).motion(command)("deflection", t)) for r, words in ERRORS]
    return deflection_figure(title, curves, LIMIT)


def deflection_figure(title: str, curves: Sequence[Curve], limit: float) -> Drawing:
    """Deflections over time between the lines of a limit, the legend below."""
    figure = curves_figure(title, "time [s]", "deflection [m]", curves, level=0.0, legend=None)
    for sign in (1.0, -1.0):
        level_line(figure.axes[0], sign * limit, "limit")
    legend_below(figure)
    return figure


def _sensitivity() -> Drawing:
    r = sampled(0.9, 1.1, 201)
    curves = [Curve(f"{distance:g} units", r, 100.0 * peaks(distance, r)) for distance in DISTANCES]
    return curves_figure(
        "A lower frequency always exceeds the limit, a higher one sometimes",
        "actual / modelled frequency [-]",
        "peak deflection [% of limit]",
        curves,
        level=100.0,
        legend="upper right",
        marks=[(1.0, "as modelled")],
    )
