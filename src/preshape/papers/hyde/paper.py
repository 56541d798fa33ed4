"""Hyde's thesis, chapter by chapter."""

from __future__ import annotations

from preshape.papers.hyde import chapter2, chapter2_figures, chapter3_figures, convolution, exact, lengths, mesh
from preshape.papers.reproduction import Figure, Paper, Row

__all__ = ["HYDE"]


def _contents() -> tuple[list[Row], list[Figure]]:
    meshed = mesh.designs()
    rows = [
        *chapter2.rows(),
        *convolution.rows(),
        *lengths.rows(),
        *mesh.rows(meshed),
        *exact.rows(meshed),
    ]
    figures = [
        *chapter2_figures.figures(),
        *convolution.figures(),
        *chapter3_figures.figures(meshed),
    ]
    return rows, figures


HYDE = Paper(
    "hyde",
    "J. M. Hyde, Multiple Mode Vibration Suppression in Controlled Flexible Systems, MIT AI-TR 1295, 1991: "
    "chapters 2 and 3",
    _contents,
)
