"""The slew of the non-linear MACE model, unshaped beside shaped, as docs/images/mace-slew.gif; run by `make figures`.

Needs the extra `preshape[plants]`.
"""

from __future__ import annotations

import io
import math
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from preshape import design
from preshape.files import write_atomically
from preshape.plant import Simulation
from preshape.plant.mace import CALIBRATED_GAINS, Mace
from preshape.report.figures import ACCENT, INK, MUTED, SECOND, new_figure, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes

IMAGES = Path(__file__).resolve().parent.parent / "images"

DT, END = 0.005, 8.0
"""Sample interval of the command and length of the film [s]."""

RATE = 12.5
"""Frames per second; the film runs at the machine's own speed."""

MAGNIFIED = 60.0
"""The bus's bending is drawn so many times as large; angles are as they are."""

HALF, SENSOR, ARM = 0.75, 0.75 - 1.5 / 8.0, 0.35
"""Of the bus, where its sensors sit, and of a payload [m]."""


def slew() -> tuple[Simulation, Simulation]:
    """120 degrees from outboard to inboard, as a step of the commanded angle would be, unshaped and shaped."""
    plant = Mace(CALIBRATED_GAINS, angle=math.radians(-60.0))
    times = np.arange(0.0, END, DT)
    command = np.radians(np.clip(-60.0 + 120.0 * (times - 0.5) / 0.4, -60.0, 60.0))
    shaper = design.on_grid(design.direct(plant.modes(math.radians(60.0)), order=1), DT)
    shaped = shaper.shape(command, DT, initial=command[0])[: times.size]
    return plant.simulate(command, DT), plant.simulate(shaped, DT)


def bus_shape(run: Simulation, frame: int) -> NDArray[np.float64]:
    """The bus as a smooth line through its sensors, magnified, turned by its angle: x and y, shape (2, point) [m]."""
    places = np.array([-HALF, -SENSOR, SENSOR])
    seen = np.array([run.outputs[name][frame] for name in ("left end", "left sensor", "right sensor")])
    square, cube, fourth = np.linalg.solve(np.column_stack([places**2, places**3, places**4]), seen)
    x = np.linspace(-HALF, HALF, 61)
    y = MAGNIFIED * (square * x**2 + cube * x**3 + fourth * x**4)
    turn = float(run.outputs["bus angle"][frame])
    return np.array([x * math.cos(turn) - y * math.sin(turn), x * math.sin(turn) + y * math.cos(turn)])


def draw_machine(axes: Axes, run: Simulation, frame: int, colour: str, title: str) -> None:
    """The bus, the payload that turns, and the one that is clamped upright."""
    axes.clear()
    line = bus_shape(run, frame)
    axes.plot(*line, color=colour, linewidth=3.0, solid_capstyle="round")
    payload = float(run.outputs["payload angle"][frame])
    for end, angle in ((0, 0.0), (-1, payload)):
        x, y = line[:, end]
        axes.plot([x, x - ARM * math.sin(angle)], [y, y + ARM * math.cos(angle)], color=INK, linewidth=5.0)
        axes.plot(x, y, "o", color=INK, markersize=7)
    axes.plot(*line[:, 30], "s", color=INK, markersize=10)
    axes.set(xlim=(-1.15, 1.15), ylim=(-0.3, 0.5), aspect="equal")
    axes.set_axis_off()
    axes.set_title(title, loc="left", fontsize=10.5, color=INK, fontweight="bold")


def film() -> bytes:
    """All frames, as the bytes of a GIF."""
    from PIL import Image

    unshaped, shaped = slew()
    figure = new_figure(7.2, 4.6)
    grid = figure.add_gridspec(2, 2, height_ratios=[1.0, 1.1])
    left, right = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[0, 1])
    curve = figure.add_subplot(grid[1, :])
    times = unshaped.times
    frames = []
    for k in np.arange(0.0, END, 1.0 / RATE):
        frame = min(round(k / DT), times.size - 1)
        draw_machine(left, unshaped, frame, SECOND, f"unshaped, bending {MAGNIFIED:g} times")
        draw_machine(right, shaped, frame, ACCENT, "shaped for the modes of its end")
        curve.clear()
        for run, colour, style, name in ((unshaped, SECOND, "--", "unshaped"), (shaped, ACCENT, "-", "shaped")):
            seen = slice(0, frame + 1)
            curve.plot(times[seen], 1e3 * run.outputs["left end"][seen], style, color=colour, linewidth=1.6, label=name)
        curve.set(xlim=(0.0, END), ylim=(-2.0, 2.0))
        curve.axhline(0.0, color=MUTED, linewidth=0.8)
        curve.legend(loc="upper right", fontsize=9, frameon=False, ncols=2)
        tidy(curve, "time [s]", "far end, across the bus [mm]", "The right payload turns by 120 degrees")
        page = io.BytesIO()
        figure.savefig(page, format="png", dpi=90)
        frames.append(Image.open(page).convert("RGB").quantize(32))
    film_bytes = io.BytesIO()
    frames[0].save(
        film_bytes, format="GIF", save_all=True, append_images=frames[1:], duration=round(1000.0 / RATE), loop=0
    )
    return film_bytes.getvalue()


if __name__ == "__main__":
    IMAGES.mkdir(exist_ok=True)
    print(write_atomically(IMAGES / "mace-slew.gif", film()))
