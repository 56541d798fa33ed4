"""Singer & Seering, MIT AI Memo 1027 (1988)."""

from preshape.papers.singer.paper import SINGER

__all__ = ["SINGER"]
