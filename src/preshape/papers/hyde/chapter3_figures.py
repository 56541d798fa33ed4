"""Hyde, figures 3.7 to 3.19: sequences on the time mesh, interpreted, and exact."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from preshape import design
from preshape.papers.drawing import impulse_figure, sampled, vibration_figure
from preshape.papers.hyde.convolution import SHUTTLE
from preshape.papers.hyde.exact import interpretation
from preshape.papers.hyde.mesh import DT, SHUTTLE_DT, Meshed, adjacent
from preshape.papers.reproduction import Figure
from preshape.report.figures import ACCENT, INK, MUTED, new_figure, tidy

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

__all__ = ["figures"]

AROUND_TEN = sampled(0.0, 12.0, 1201)
SHUTTLE_RANGE = sampled(0.0, 0.8, 1201)


def figures(meshed: Meshed) -> list[Figure]:
    """In the order of the chapter."""
    steps = interpretation(meshed.shuttle)
    shuttle_modes = [f for f, _ in SHUTTLE]
    certified = design.direct(SHUTTLE)
    return [
        Figure(
            "3.7",
            "Defining the time mesh [the beginning of figure 3.12]",
            lambda: _mesh(meshed),
        ),
        Figure(
            "3.8",
            "Direct solution sequence for 1 Hz and 10 Hz, z = 0, zero cost function",
            lambda: impulse_figure(f"Mesh 5 ms, zero cost: {len(meshed.zero)} impulses", ("zero cost", meshed.zero)),
        ),
        Figure(
            "3.9",
            "Insensitivity curve for sequence of figure 3.8",
            lambda: vibration_figure(
                "Zero cost: zero at 1 and 10 Hz", [("zero cost", meshed.zero, 0.0)], AROUND_TEN, modes=[1.0, 10.0]
            ),
        ),
        Figure(
            "3.10",
            'Direct solution sequence for 1 Hz and 10 Hz, z = 0, "second derivative" cost function',
            lambda: impulse_figure(
                f"Second-derivative cost: {len(meshed.flat)} impulses, {adjacent(meshed.flat, DT)} pairs of neighbours",
                ("second derivative", meshed.flat),
            ),
        ),
        Figure(
            "3.11",
            "Insensitivity curve for the sequence of figure 3.10 [figure 3.9 for comparison]",
            lambda: vibration_figure(
                "Second-derivative cost: flatter at 10 Hz",
                [("second derivative", meshed.flat, 0.0), ("zero cost", meshed.zero, 0.0)],
                AROUND_TEN,
                modes=[1.0, 10.0],
            ),
        ),
        Figure(
            "3.12",
            "Minimal time impulse sequence for 1 Hz and 10 Hz, z = 0, second derivative cost function",
            lambda: impulse_figure(
                f"Shortest on the mesh: {meshed.shortest.duration:.3f} s, {len(meshed.shortest)} impulses",
                ("shortest", meshed.shortest),
            ),
        ),
        Figure(
            "3.13",
            "Insensitivity curve for sequence of figure 3.12",
            lambda: vibration_figure(
                "Shortest on the mesh: odd multiples of 1 Hz are back",
                [("shortest", meshed.shortest, 0.0)],
                AROUND_TEN,
                modes=[1.0, 10.0],
            ),
        ),
        Figure(
            "3.14",
            f"Direct solution sequence for 0.20, 0.26, 0.45 and 0.59 Hz, z = 0 [mesh {SHUTTLE_DT:g} s]",
            lambda: impulse_figure(
                f"Shuttle arm: {meshed.shuttle.duration:.2f} s, {len(meshed.shuttle)} impulses",
                ("mesh", meshed.shuttle),
            ),
        ),
        Figure(
            "3.15",
            "Sequence of figure 3.12 with neighboring impulses combined",
            lambda: impulse_figure(
                f"Neighbours combined: {len(meshed.shortest)} impulses become {len(meshed.squashed)}",
                ("combined", meshed.squashed),
            ),
        ),
        Figure(
            "3.16",
            "Insensitivity curve for sequence of figure 3.15 [figure 3.13 for comparison]",
            lambda: vibration_figure(
                "Combining neighbours costs little",
                [("combined", meshed.squashed, 0.0), ("figure 3.13", meshed.shortest, 0.0)],
                AROUND_TEN,
                modes=[1.0, 10.0],
            ),
        ),
        Figure(
            "3.17",
            "Interpreted sequence from figure 3.14, initial guess of the non-linear solver",
            lambda: impulse_figure(
                f"Interpreted: {len(meshed.shuttle)} impulses become {len(steps.guess)}", ("guess", steps.guess)
            ),
        ),
        Figure(
            "3.18",
            "Exact direct solution sequence for 0.20, 0.26, 0.45 and 0.59 Hz, z = 0 [figure 3.17 for comparison]",
            lambda: impulse_figure(
                f"Exact: {steps.solved.duration:.4f} s; the proved shortest is {certified.duration:.4f} s",
                ("exact", steps.solved),
                ("guess of figure 3.17", steps.guess),
            ),
        ),
        Figure(
            "3.19",
            "Insensitivity curve for sequence of figure 3.18",
            lambda: vibration_figure(
                "Exact Shuttle arm sequence: zero and flat at four modes",
                [("exact", steps.solved, 0.0)],
                SHUTTLE_RANGE,
                modes=shuttle_modes,
            ),
        ),
    ]


def _mesh(meshed: Meshed) -> Drawing:
    figure = new_figure(6.6, 2.6)
    axes = figure.add_subplot()
    slots = DT * np.arange(14)
    axes.vlines(slots, 0.0, 0.02, color=MUTED, linewidth=1.0)
    inside = meshed.shortest.times <= slots[-1] + 1e-9
    axes.vlines(meshed.shortest.times[inside], 0.0, meshed.shortest.amplitudes[inside], color=ACCENT, linewidth=2.6)
    axes.plot(meshed.shortest.times[inside], meshed.shortest.amplitudes[inside], "o", color=ACCENT, markersize=6)
    axes.annotate(
        "", (slots[5], 0.04), xytext=(slots[4], 0.04), arrowprops={"arrowstyle": "<->", "color": INK, "linewidth": 1.0}
    )
    axes.annotate(f"{1000.0 * DT:g} ms", (0.5 * (slots[4] + slots[5]), 0.047), ha="center", fontsize=8.5, color=INK)
    axes.set_ylim(0.0, 1.25 * float(meshed.shortest.amplitudes[inside].max()))
    tidy(axes, "time [s]", "amplitude [-]", "A slot every 5 ms; most amplitudes come out as zero")
    return figure
