"""Singer & Seering's memo: what it states, and its figures."""

from __future__ import annotations

from preshape.papers.reproduction import Figure, Paper, Row
from preshape.papers.singer import (
    figures,
    limits,
    robustness,
    sequences,
    shuttle_arm,
    shuttle_arm_figures,
    shuttle_moves,
)

__all__ = ["SINGER"]


def _contents() -> tuple[list[Row], list[Figure]]:
    moved = shuttle_moves.run_experiment()
    return (
        [*sequences.rows(), *robustness.rows(), *limits.rows(), *shuttle_arm.rows(moved)],
        [*figures.figures(), *shuttle_arm_figures.figures(moved)],
    )


SINGER = Paper(
    "singer",
    "N. C. Singer, W. P. Seering, Preshaping Command Inputs to Reduce System Vibration, MIT AI Memo 1027, 1988",
    _contents,
)
