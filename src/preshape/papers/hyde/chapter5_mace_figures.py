"""Hyde, figures 5.7 to 5.29 and 6.1: the non-linear MACE model, its shapers and its slews."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from preshape import Shaper, design
from preshape.papers.drawing import Curve, Vector, curves_figure, impulse_figure, sampled, vibration_figure
from preshape.papers.hyde.chapter5_slews import ADDED, ASSUMED, DT, PERIOD, Experiments, Slew
from preshape.papers.reproduction import Figure
from preshape.plant.mace import CALIBRATED
from preshape.plant.mace.structure import LENGTH, SENSOR
from preshape.report.figures import ACCENT, INK, MUTED, SECOND, new_figure, tidy

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

__all__ = ["figures"]

MESH = 5e-3
"""Of the sequences on a mesh [s]."""

DETAIL = (3.0, 10.0)
"""Of the details [s]."""

OUR = "[our model's frequencies]"


def figures(done: Experiments) -> list[Figure]:
    """In the order of the section."""
    vertical = [(f, ASSUMED) for f in done.vertical.averaged.peaks]
    outboard = [(mode.frequency, ASSUMED) for mode in done.outboard.rung]
    inboard = [mode.frequency for mode in done.inboard.rung]
    return [
        Figure("5.7", "DISCOS non-linear flexible model of MACE [ours, payload at 30 deg outboard]", _model),
        *_meshed(("5.8", "5.9"), "Shaping sequence for the open-loop frequencies", vertical),
        _signal("5.10", "Bus endpoint response to unshaped input [open loop, 40 deg]", done.open_loop["unshaped"]),
        _signal("5.11", "Bus endpoint response to shaped input [open loop, 40 deg]", done.open_loop["open loop"]),
        *_meshed(("5.12", "5.13"), "Shaping sequence for the 60 deg outboard frequencies", outboard),
        Figure("5.14", "Closed loop 40 deg payload slew", lambda: _angle(done.small, "40 deg")),
        _signal("5.15", "Endpoint response to unshaped 40 deg slew", done.small["unshaped"]),
        _signal("5.16", "Endpoint response to shaped 40 deg slew", done.small["outboard"]),
        Figure("5.17", "Closed loop 120 deg payload slew", lambda: _angle(done.large, "120 deg")),
        _signal("5.18", "Endpoint response to unshaped 120 deg slew", done.large["unshaped"]),
        _signal("5.19", "Endpoint response to shaped 120 deg slew", done.large["outboard"]),
        _detail("5.20", "Detail of residual vibration from figure 5.19", done.large["outboard"]),
        _sequence("5.21", "Shaping sequence for the 60 deg inboard frequencies", done.shapers["inboard"]),
        _signal("5.22", "Endpoint response to shaped 120 deg slew [inboard shaper]", done.large["inboard"]),
        _detail("5.23", "Detail of residual vibration [from figure 5.22]", done.large["inboard"]),
        _sequence("5.24", "Shaping sequence for the inboard frequencies and 1.50 Hz", done.shapers["with 1.5 Hz"]),
        _curve("5.25", "Insensitivity curve for shaper of figure 5.24", done, "with 1.5 Hz", [*ADDED[:1], *inboard]),
        _detail("5.26", "Detail of response found using sequence of figure 5.24", done.large["with 1.5 Hz"]),
        _sequence(
            "5.27", "Shaping sequence for the inboard frequencies, 1.5 and 2.0 Hz", done.shapers["with 1.5 and 2.0 Hz"]
        ),
        _curve(
            "5.28", "Insensitivity curve for sequence of figure 5.27", done, "with 1.5 and 2.0 Hz", [*ADDED, *inboard]
        ),
        _detail("5.29", "Detail of response found using sequence of figure 5.27", done.large["with 1.5 and 2.0 Hz"]),
        Figure(
            "6.1",
            "MACE endpoint response to shaped and unshaped 120 deg slew [and ours: 2 % over what was measured]",
            lambda: _compared(done),
        ),
    ]


def _meshed(numbers: tuple[str, str], caption: str, modes: list[tuple[float, float]]) -> list[Figure]:
    raw = design.mesh(modes, MESH)
    combined = design.squashed(raw, MESH)
    return [
        Figure(
            numbers[0],
            f"{caption} [mesh of {1e3 * MESH:g} ms] {OUR}",
            lambda: impulse_figure(f"On the mesh: {raw.duration:.3f} s, {len(raw)} impulses", ("mesh", raw)),
        ),
        Figure(
            numbers[1],
            f"Modified sequence from figure {numbers[0]}",
            lambda: impulse_figure(f"Neighbours combined: {len(combined)} impulses", ("combined", combined)),
        ),
    ]


def _sequence(number: str, caption: str, shaper: Shaper) -> Figure:
    return Figure(
        number,
        f"{caption} {OUR}",
        lambda: impulse_figure(f"{shaper.duration:.3f} s, {len(shaper)} impulses", ("direct", shaper)),
    )


def _curve(number: str, caption: str, done: Experiments, name: str, modes: list[float]) -> Figure:
    return Figure(
        number,
        f"{caption} [inboard shaper for comparison]",
        lambda: vibration_figure(
            "Flatter around the fundamental",
            [(name, done.shapers[name], ASSUMED), ("inboard", done.shapers["inboard"], ASSUMED)],
            sampled(0.5, 4.0),
            modes=[frequency for frequency in modes if frequency < 4.0],
        ),
    )


def _signal(number: str, caption: str, slew: Slew) -> Figure:
    return Figure(number, caption, lambda: _drawn(slew, f"{slew.name.capitalize()}: the far end, across the bus", 0.0))


def _detail(number: str, caption: str, slew: Slew) -> Figure:
    return Figure(
        number,
        f"{caption} [slow motion taken out]",
        lambda: _drawn(slew, f"{slew.name.capitalize()}: {1e6 * slew.residual:.2f} µm left after 6 s", DETAIL[0]),
    )


def _drawn(slew: Slew, title: str, start: float) -> Drawing:
    times, values = _from(slew, start)
    scale, unit = (1e6, "µm") if start else (1e3, "mm")
    if start:  # a detail: the vibration about its mean over a period
        count = round(PERIOD / DT)
        mean = np.convolve(values, np.full(count, 1.0 / count), mode="valid")
        first = count // 2
        times, values = times[first : first + len(mean)], values[first : first + len(mean)] - mean
    return curves_figure(
        title, "time [s]", f"left sensor [{unit}]", [Curve(slew.name, times, scale * values)], level=0.0
    )


def _from(slew: Slew, start: float) -> tuple[Vector, Vector]:
    inside = slew.simulation.times >= start
    return slew.simulation.times[inside], slew.simulation.outputs["left sensor"][inside]


def _angle(slews: object, what: str) -> Drawing:
    assert isinstance(slews, dict)
    curves = [
        Curve(name, slews[name].simulation.times, np.degrees(slews[name].simulation.outputs["payload angle"]))
        for name in ("unshaped", "outboard")
    ]
    return curves_figure(
        f"Inertial payload angle, {what}", "time [s]", "payload angle [deg]", curves, legend="lower right"
    )


def _compared(done: Experiments) -> Drawing:
    curves = []
    for name in ("unshaped", "with 1.5 and 2.0 Hz", "ours"):
        times, values = _from(done.large[name], 0.0)
        curves.append(Curve(name, times, 1e3 * values))
    return curves_figure(
        "120 deg: unshaped, Hyde's best, and ours in a third of the time",
        "time [s]",
        "left sensor [mm]",
        curves,
        legend="upper right",
        level=0.0,
    )


def _model() -> Drawing:
    figure = new_figure(6.6, 3.0)
    axes = figure.add_subplot()
    s, half, angle = CALIBRATED, 0.5 * LENGTH, math.radians(-30.0)
    axes.plot([-half, half], [0.0, 0.0], color=MUTED, linewidth=4.0, zorder=1)
    nodes = np.linspace(-half, half, 5)
    axes.plot(nodes, np.zeros(5), "s", color=INK, markersize=7, label="nodes")
    for x, lean, word in ((-half, 0.0, "clamped payload"), (half, angle, "payload")):
        axis = (x, s.axis_height)
        tip = (x - s.arm * math.sin(lean), s.axis_height + s.arm * math.cos(lean))
        axes.plot([x, x], [0.0, s.axis_height], color=INK, linewidth=2.5)
        axes.plot([axis[0], tip[0]], [axis[1], tip[1]], color=ACCENT, linewidth=2.5)
        axes.plot(*axis, "o", color=INK, markersize=6)
        axes.plot(*tip, "o", color=ACCENT, markersize=13)
        axes.annotate(word, tip, xytext=(12, -3), textcoords="offset points", fontsize=8.5, color=INK)
    axes.plot([0.0, 0.0], [0.0, -s.attitude_offset], color=INK, linewidth=2.5)
    axes.plot(0.0, -s.attitude_offset, "o", color=INK, markersize=15)
    axes.annotate("attitude unit", (0.06, -s.attitude_offset), va="center", fontsize=8.5, color=INK)
    places = [-half + SENSOR, half - SENSOR]
    axes.plot(places, [0.0, 0.0], "^", color=SECOND, markersize=8, label="sensors")
    axes.set_xlim(-0.95, 1.3)
    axes.set_ylim(-0.32, 0.45)
    axes.set_aspect("equal")
    axes.legend(fontsize=8.5, loc="lower left", frameon=False)
    tidy(axes, "along the bus [m]", "across [m]", "Bus, two gimballed payloads, attitude unit")
    return figure
