"""Hyde's thesis, chapter by chapter."""

from __future__ import annotations

from preshape.papers.hyde import (
    chapter2,
    chapter2_figures,
    chapter3_figures,
    chapter5_linear,
    chapter5_linear_figures,
    chapter5_mace,
    chapter5_mace_figures,
    chapter5_slews,
    chapter6,
    chapter6_figures,
    convolution,
    exact,
    lengths,
    mesh,
)
from preshape.papers.reproduction import Figure, Paper, Row

__all__ = ["HYDE"]


def _contents() -> tuple[list[Row], list[Figure]]:
    meshed = mesh.designs()
    slewed = chapter5_linear.slewed()
    rows = [
        *chapter2.rows(),
        *convolution.rows(),
        *lengths.rows(),
        *mesh.rows(meshed),
        *exact.rows(meshed),
        *chapter5_linear.rows(slewed),
    ]
    figures = [
        *chapter2_figures.figures(),
        *convolution.figures(),
        *chapter3_figures.figures(meshed),
        *chapter5_linear_figures.figures(slewed),
    ]
    if chapter5_slews.installed():
        done = chapter5_slews.experiments()
        rows += chapter5_mace.rows(done)
        figures += chapter5_mace_figures.figures(done)
    else:
        rows += chapter5_mace.left_out()
    following = chapter6.adaptive(chapter5_slews.installed())
    return [*rows, *chapter6.rows(following)], [*figures, *chapter6_figures.figures(following)]


HYDE = Paper(
    "hyde",
    "J. M. Hyde, Multiple Mode Vibration Suppression in Controlled Flexible Systems, MIT AI-TR 1295, 1991: "
    "chapters 2, 3, 5 and 6",
    _contents,
)
