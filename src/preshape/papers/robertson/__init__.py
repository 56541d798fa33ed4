"""Robertson, transient deflection performance measures for command shapers (2007)."""

from preshape.papers.robertson.paper import ROBERTSON

__all__ = ["ROBERTSON"]
