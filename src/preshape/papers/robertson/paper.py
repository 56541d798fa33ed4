"""Robertson's paper: one impulse and bang-bang, robustness and deflection of moves, deflection of shaped commands."""

from __future__ import annotations

from preshape.papers.reproduction import Paper
from preshape.papers.robertson import (
    baseline,
    deflection,
    move_figures,
    optimum,
    robustness,
    tracking,
    tracking_figures,
)

__all__ = ["ROBERTSON"]

ROBERTSON = Paper(
    "robertson",
    "M. J. Robertson, Transient Deflection Performance Measures for Command Shapers, manuscript of September 2007",
    lambda: (
        [*baseline.rows(), *robustness.rows(), *optimum.rows(), *deflection.rows(), *tracking.rows()],
        [*move_figures.figures(), *tracking_figures.figures()],
    ),
)
