"""Singer & Seering, figures 1 to 10; 11 is a block diagram, 12 stands in shuttle_arm_figures."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from preshape import Mode, Shaper, design
from preshape.command import trapezoid
from preshape.papers.drawing import Curve, curves_figure, draw_impulses, impulse_figure, sampled, vibration_figure
from preshape.papers.reproduction import Figure
from preshape.papers.singer.robustness import TWO
from preshape.papers.singer.sequences import CLOSED
from preshape.plant import ModalPlant
from preshape.report.figures import ACCENT, SECOND, new_figure, tidy
from preshape.vibration import residual_vibration

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

__all__ = ["figures"]

DAMPINGS = (0.0, 0.1, 0.2)
"""Of figures 3, 5, 7: "three different values", which the memo does not name."""

CHOSEN = "[z = 0, 0.1, 0.2 chosen, each with the sequence for it]"


def figures() -> list[Figure]:
    """In the order of the memo."""
    mode = Mode(1.0, 0.1)
    return [
        Figure("1", "Two impulse responses that add to no vibration [1 Hz, z = 0.1 chosen]", lambda: _cancelling(mode)),
        *_sequence_and_error("2", "3", "two"),
        *_sequence_and_error("4", "5", "three"),
        *_sequence_and_error("6", "7", "four"),
        Figure(
            "8",
            "Vibration error vs. damping ratio for two, three and four impulses for a system with z = 0.05",
            _over_damping,
        ),
        Figure(
            "9",
            "Two three-impulse sequences convolved into one for two modes [1 and 2.5 Hz, z = 0.05 chosen]",
            _two_modes,
        ),
        Figure(
            "10",
            "Convolution of a command (a) with a two-impulse sequence (b) yields the system input (c) [1 Hz, z = 0.1]",
            lambda: _convolution(mode),
        ),
    ]


def _cancelling(mode: Mode) -> Drawing:
    shaper, times = design.zv(mode), sampled(0.0, 3.0)
    plant = ModalPlant(mode, [mode.omega_d / mode.omega**2])
    parts = [
        plant.impulse_train([t], [a], at=times).output for t, a in zip(shaper.times, shaper.amplitudes, strict=True)
    ]
    return curves_figure(
        "Two responses that cancel after the second impulse",
        "time [s]",
        "response [-]",
        [
            Curve("sum", times, np.asarray(parts[0] + parts[1])),
            Curve("first impulse", times, parts[0]),
            Curve("second impulse", times, parts[1]),
        ],
        marks=[(shaper.duration, "second impulse")],
        level=0.0,
    )


def _sequence_and_error(sequence: str, error: str, words: str) -> list[Figure]:
    def over_frequency() -> Drawing:
        shapers = [(f"z = {z:g}", CLOSED[words]((1.0, z)), z) for z in DAMPINGS]
        title = f"{words.capitalize()} impulses: vibration over frequency"
        return vibration_figure(title, shapers, sampled(0.4, 1.6), modes=[1.0], top=60.0)

    return [
        Figure(
            sequence,
            f"{words.capitalize()}-impulse input [drawn for 1 Hz, z = 0.1]",
            lambda: impulse_figure(
                f"{words.capitalize()} impulses for 1 Hz, z = 0.1", (words, CLOSED[words]((1.0, 0.1)))
            ),
        ),
        Figure(
            error,
            f"Vibration error vs. system natural frequency, {words}-impulse sequence {CHOSEN}",
            over_frequency,
        ),
    ]


def _over_damping() -> Drawing:
    dampings = sampled(0.0, 0.6)
    curves = [
        Curve(f"{words} impulses", dampings, 100.0 * residual_vibration(shape((1.0, 0.05)), 1.0, dampings))
        for words, shape in CLOSED.items()
    ]
    figure = curves_figure(
        "Designed for z = 0.05: vibration over the actual damping",
        "actual damping ratio [-]",
        "residual vibration [%]",
        curves,
        marks=[(0.05, "designed for")],
        level=5.0,
    )
    figure.axes[0].set_ylim(0.0, 40.0)
    return figure


def _two_modes() -> Drawing:
    figure = new_figure(6.6, 4.4)
    rows = figure.subplots(3, 1, sharex=True)
    shapers: list[tuple[str, Shaper]] = [
        ("1 Hz", design.zvd(TWO[0])),
        ("2.5 Hz", design.zvd(TWO[1])),
        ("convolved: still at both", design.convolved(TWO)),
    ]
    for axes, (label, shaper) in zip(rows, shapers, strict=True):
        draw_impulses(axes, (label, shaper))
        tidy(axes, "", "amplitude [-]", label)
    rows[-1].set_xlabel("time [s]")
    rows[-1].set_xlim(-0.08, 1.08 * shapers[-1][1].duration)
    return figure


def _convolution(mode: Mode) -> Drawing:
    shaper, dt = design.zv(mode), 0.002
    command = trapezoid(1.0, maximum_speed=1.0, maximum_acceleration=4.0, dt=dt, rest=1.2, quantity="position [m]")
    requested = command.velocity
    assert requested is not None
    shaped = shaper.shape(requested, dt)[: requested.size]
    figure = new_figure(6.6, 4.8)
    top, middle, bottom = figure.subplots(3, 1, sharex=True)
    top.plot(command.times, requested, color=SECOND, linewidth=1.8)
    tidy(top, "", "speed [m/s]", "(a) requested")
    draw_impulses(middle, ("two impulses", shaper))
    tidy(middle, "", "amplitude [-]", "(b) two impulses for 1 Hz, z = 0.1")
    bottom.plot(command.times, requested, color=SECOND, linestyle="--", linewidth=1.3, label="requested")
    bottom.plot(command.times, shaped, color=ACCENT, linewidth=2.0, label="shaped")
    tidy(bottom, "time [s]", "speed [m/s]", "(c) what the machine is given")
    bottom.legend(fontsize=8.5, frameon=True, framealpha=0.9, edgecolor="white")
    bottom.set_xlim(-0.1, float(command.times[-1]))
    return figure
