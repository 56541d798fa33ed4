"""Hyde, figures 2.1 to 2.15, drawn anew for the system of section 2.4."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from preshape import Shaper, design
from preshape.papers.drawing import (
    Curve,
    Vector,
    curves_figure,
    impulse_figure,
    sampled,
    staircase,
    vibration_figure,
)
from preshape.papers.hyde.chapter2 import LATE, MODE, late_copy, late_pair
from preshape.papers.reproduction import Figure
from preshape.plant import ModalPlant

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

__all__ = ["figures"]

SYSTEM = "[1 Hz, z = 0.1: the system of section 2.4; the caption names none]"
END = 4.0
"""Of the time axis [s]."""


def figures() -> list[Figure]:
    """The figures of the chapter."""
    two, three, pair, triple = design.zv(MODE), design.zvd(MODE), late_pair(), late_copy()
    single = Shaper([0.0], [1.0])
    late = f"[second impulse {100 * (LATE - 1):.0f} % late]"
    second = Curve("second impulse", *_kick(two.times[1], two.amplitudes[1]))
    frequencies = sampled(0.4, 1.6)
    return [
        Figure(
            "2.1",
            f"Second order system response to single impulse input {SYSTEM}",
            lambda: _responses("One impulse makes the system ring", [Curve("response", *_response(single))]),
        ),
        Figure(
            "2.2",
            "Individual second order system response to two impulses",
            lambda: _responses(
                "The second impulse's ringing is opposite to the first's",
                [Curve("first impulse", *_kick(0.0, two.amplitudes[0])), second],
                marks=[(two.times[1], "second impulse")],
            ),
        ),
        Figure(
            "2.3",
            "Combined second order system response to two impulses",
            lambda: _responses(
                "Together: still after the second impulse",
                [Curve("response", *_response(two))],
                marks=[(two.times[1], "second impulse")],
            ),
        ),
        Figure(
            "2.4",
            "Two impulse sequence (1 Hz, z = 0.1)",
            lambda: impulse_figure("Two impulses for 1 Hz, z = 0.1", ("two", two)),
        ),
        Figure(
            "2.5",
            "Insensitivity curve for two impulse sequence",
            lambda: vibration_figure(
                "Two impulses: zero at 1 Hz, steep beside it",
                [("two impulses", two, 0.1)],
                frequencies,
                modes=[1.0],
                top=80,
            ),
        ),
        Figure(
            "2.6",
            f"System response using an improperly positioned second impulse {late}",
            lambda: _responses(
                "A late second impulse leaves vibration",
                [Curve("late", *_response(pair)), Curve("in time", *_response(two))],
                marks=[(pair.times[1], "late impulse")],
            ),
        ),
        Figure(
            "2.7",
            f"Combining two two-impulse sequences into one three-impulse sequence {late}",
            lambda: impulse_figure(
                "The late pair and its copy: three impulses", ("combined", triple), ("late pair", pair)
            ),
        ),
        Figure(
            "2.8",
            "Repeating the effects of the incorrect two impulse shaper",
            lambda: _responses(
                "The copy's vibration is opposite to what the pair left",
                [
                    Curve("pair", *_response(pair, pair.amplitudes[0])),
                    Curve("its copy", *_delayed(pair, pair.times[1], pair.amplitudes[1])),
                ],
                marks=[(triple.times[1], ""), (triple.duration, "last impulse")],
            ),
        ),
        Figure(
            "2.9",
            "Response to three impulse shaper",
            lambda: _responses(
                "Together: nearly still, although both are flawed",
                [Curve("three impulses", *_response(triple)), Curve("late pair alone", *_response(pair))],
                marks=[(triple.duration, "last impulse")],
            ),
        ),
        Figure(
            "2.10",
            "Single mode three impulse shaper",
            lambda: impulse_figure("Three impulses for 1 Hz, z = 0.1", ("three", three)),
        ),
        Figure(
            "2.11",
            "Insensitivity curve for three impulse sequence [two impulses of figure 2.5 for comparison]",
            lambda: vibration_figure(
                "Three impulses: flat at 1 Hz",
                [("three impulses", three, 0.1), ("two impulses", two, 0.1)],
                frequencies,
                modes=[1.0],
                top=80,
            ),
        ),
        *_steps("2.12", "2.13", "two", two),
        *_steps("2.14", "2.15", "three", three),
    ]


def _steps(command: str, response: str, words: str, shaper: Shaper) -> list[Figure]:
    def commands() -> list[Curve]:
        return [
            Curve("shaped", *staircase(shaper.times, shaper.amplitudes, END)),
            Curve("step", *staircase(np.zeros(1), np.ones(1), END)),
        ]

    def responses() -> list[Curve]:
        times = sampled(0.0, END)
        plant = ModalPlant(MODE)
        return [
            Curve("shaped", times, plant.step_train(shaper.times, shaper.amplitudes, at=times).output),
            Curve("unshaped", times, plant.step_train([0.0], [1.0], at=times).output),
        ]

    return [
        Figure(
            command,
            f"Step input as modified by {words} impulse shaper",
            lambda: curves_figure(
                f"A step through {words} impulses is a staircase",
                "time [s]",
                "command [-]",
                commands(),
                legend="lower right",
                marks=[(shaper.duration, "last impulse")],
            ),
        ),
        Figure(
            response,
            f"Responses to inputs of figure {command}",
            lambda: curves_figure(
                f"Response through {words} impulses",
                "time [s]",
                "response [-]",
                responses(),
                legend="lower right",
                marks=[(shaper.duration, "last impulse")],
            ),
        ),
    ]


def _responses(title: str, curves: list[Curve], marks: list[tuple[float, str]] | None = None) -> Drawing:
    return curves_figure(title, "time [s]", "response [-]", curves, marks=marks or [], level=0.0)


def _response(shaper: Shaper, scale: float = 1.0) -> tuple[Vector, Vector]:
    """Response (2.1) to a train of impulses."""
    times = sampled(0.0, END)
    plant = ModalPlant(MODE, [MODE.omega_d / MODE.omega**2])
    return times, plant.impulse_train(shaper.times, scale * shaper.amplitudes, at=times).output


def _kick(time: float, amplitude: float) -> tuple[Vector, Vector]:
    """The same to a single impulse."""
    return _delayed(Shaper([0.0], [1.0]), time, amplitude)


def _delayed(shaper: Shaper, delay: float, scale: float) -> tuple[Vector, Vector]:
    times = sampled(0.0, END)
    plant = ModalPlant(MODE, [MODE.omega_d / MODE.omega**2])
    return times, plant.impulse_train(shaper.times + delay, scale * shaper.amplitudes, at=times).output
