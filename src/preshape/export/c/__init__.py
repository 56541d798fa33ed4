"""C99 for any controller."""

from preshape.export.c.target import C

__all__ = ["C"]
