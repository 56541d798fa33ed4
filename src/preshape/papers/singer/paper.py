"""Singer & Seering's memo: what it states, and its figures."""

from __future__ import annotations

from preshape.papers.reproduction import Paper
from preshape.papers.singer import figures, robustness, sequences

__all__ = ["SINGER"]

SINGER = Paper(
    "singer",
    "N. C. Singer, W. P. Seering, Preshaping Command Inputs to Reduce System Vibration, MIT AI Memo 1027, 1988",
    lambda: ([*sequences.rows(), *robustness.rows()], figures.figures()),
)
