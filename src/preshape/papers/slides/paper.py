"""The slides: their equations, and their drawings. What they do not name is taken from Hyde's thesis."""

from __future__ import annotations

from preshape.papers.hyde import mesh
from preshape.papers.hyde.exact import interpretation
from preshape.papers.reproduction import Figure, Paper, Row
from preshape.papers.slides import figures, statements

__all__ = ["SLIDES"]


def _contents() -> tuple[list[Row], list[Figure]]:
    sequence = mesh.shuttle()
    steps = interpretation(sequence)
    return statements.rows(sequence, steps), figures.figures(sequence, steps)


SLIDES = Paper(
    "slides",
    "J. M. Hyde, K. W. Chang, W. P. Seering, Inhibiting Multiple Mode Vibration in Controlled Flexible Systems, "
    "slides, NASA N93-28172, 1991",
    _contents,
)
