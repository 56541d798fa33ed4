"""The drawings of the slides, numbered in their order; the block diagram and MACE are not drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from preshape import Shaper, design
from preshape.papers.drawing import (
    Curve,
    curves_figure,
    draw_impulses,
    impulse_figure,
    sampled,
    staircase,
    vibration_figure,
)
from preshape.papers.hyde.convolution import SHUTTLE, TWO
from preshape.papers.hyde.exact import Interpretation
from preshape.papers.reproduction import Figure
from preshape.papers.slides.statements import MODE
from preshape.plant import ModalPlant
from preshape.report.figures import ACCENT, SECOND, new_figure, tidy

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

__all__ = ["figures"]

END = 4.0
"""Of the time axes [s]."""


def figures(sequence: Shaper, steps: Interpretation) -> list[Figure]:
    """In the order of the slides; one-mode drawings for 1 Hz, z = 0.1, as in the thesis."""
    three = design.zvd(MODE)
    return [
        Figure("1", "Linear system impulse response [1 Hz, z = 0.1]", lambda: _responses("One impulse", [1])),
        Figure("2", 'Response to "N" impulses [three, at 0, 0.3, 0.9 s]', lambda: _responses("Three impulses", [2])),
        Figure("3", "Eliminating residual vibration [two impulses]", lambda: _responses("Two that cancel", [3])),
        Figure("4", "Using the impulse sequence [a step through three impulses]", lambda: _using(three)),
        Figure("5", "Response to inputs", lambda: _to_inputs(three)),
        Figure(
            "6",
            "Insensitivity of three-impulse sequence",
            lambda: vibration_figure(
                "Three impulses: flat at 1 Hz", [("three", three, 0.1)], sampled(0.4, 1.6), modes=[1.0], top=60.0
            ),
        ),
        Figure("7", "Convolution [1 and 10 Hz, as in the thesis]", _convolving),
        Figure(
            "8",
            "Convolution sequence problems: 0.20, 0.26, 0.45, 0.59 Hz",
            lambda: impulse_figure("Convolved: 81 impulses, 12.76 s", ("convolved", design.convolved(SHUTTLE))),
        ),
        Figure(
            "9",
            "Linear approximation sequence [mesh 0.05 s]",
            lambda: impulse_figure(f"On the mesh: {len(sequence)} impulses", ("mesh", sequence)),
        ),
        Figure(
            "10",
            "Interpreted linear sequence",
            lambda: impulse_figure(f"Interpreted: {len(steps.guess)} impulses", ("interpreted", steps.guess)),
        ),
        Figure(
            "11",
            "Exact direct solution sequence",
            lambda: impulse_figure(
                f"Exact: {len(steps.solved)} impulses, {steps.solved.duration:.2f} s", ("exact", steps.solved)
            ),
        ),
    ]


def _responses(title: str, which: list[int]) -> Drawing:
    trains = {1: Shaper([0.0], [1.0]), 2: Shaper([0.0, 0.3, 0.9], [0.5, 0.2, 0.3]), 3: design.zv(MODE)}
    times, train = sampled(0.0, END), trains[which[0]]
    plant = ModalPlant(MODE, [MODE.omega_d / MODE.omega**2])
    curves = [Curve("response", times, plant.impulse_train(train.times, train.amplitudes, at=times).output)]
    if len(train) > 1:
        for i, (t, a) in enumerate(zip(train.times, train.amplitudes, strict=True)):
            curves.append(Curve(f"impulse {i + 1} alone", times, plant.impulse_train([t], [a], at=times).output))
    return curves_figure(title, "time [s]", "response [-]", curves, level=0.0, legend="upper right")


def _using(three: Shaper) -> Drawing:
    figure = new_figure(7.2, 2.6)
    first, second, third = figure.subplots(1, 3)
    first.plot(*staircase(np.zeros(1), np.ones(1), 2.0), color=SECOND, linewidth=1.8)
    tidy(first, "time [s]", "command [-]", "A step,")
    draw_impulses(second, ("three", three))
    second.set_xlim(-0.35, 1.35)
    tidy(second, "time [s]", "amplitude [-]", "three impulses,")
    third.plot(*staircase(three.times, three.amplitudes, 2.0), color=ACCENT, linewidth=2.0)
    tidy(third, "time [s]", "command [-]", "the shaped step")
    return figure


def _to_inputs(three: Shaper) -> Drawing:
    times, plant = sampled(0.0, END), ModalPlant(MODE)
    return curves_figure(
        "The step and the shaped step, answered",
        "time [s]",
        "response [-]",
        [
            Curve("shaped", times, plant.step_train(three.times, three.amplitudes, at=times).output),
            Curve("step", times, plant.step_train([0.0], [1.0], at=times).output),
        ],
        legend="lower right",
        marks=[(three.duration, "last impulse")],
    )


def _convolving() -> Drawing:
    figure = new_figure(6.6, 4.4)
    trains = [("1 Hz", design.zvd(TWO[0])), ("10 Hz", design.zvd(TWO[1])), ("convolved", design.convolved(TWO))]
    axes = figure.subplots(3, 1, sharex=True)
    for one, (label, shaper) in zip(axes, trains, strict=True):
        draw_impulses(one, (label, shaper))
        tidy(one, "", "amplitude [-]", label)
    axes[-1].set_xlabel("time [s]")
    axes[-1].set_xlim(-0.08, 1.2)
    return figure
