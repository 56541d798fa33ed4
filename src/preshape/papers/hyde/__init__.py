"""Hyde, MIT AI-TR 1295 (1991): a file or two a chapter."""

from preshape.papers.hyde.paper import HYDE

__all__ = ["HYDE"]
