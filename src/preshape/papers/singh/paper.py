"""Singh & Heppler's paper: theory, example, figures."""

from __future__ import annotations

from preshape.papers.reproduction import Paper
from preshape.papers.singh import comparison, example, figures, theory

__all__ = ["SINGH"]

SINGH = Paper(
    "singh",
    "T. Singh, G. R. Heppler, Shaped Input Control of a System With Multiple Modes, ASME J. Dynamic Systems, "
    "Measurement, and Control 115, 1993",
    lambda: ([*theory.rows(), *example.rows(), *comparison.rows()], figures.figures()),
)
