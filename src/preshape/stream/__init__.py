"""The shaper at work, sample by sample and block by block."""

from preshape.stream.stream import Stream

__all__ = ["Stream"]
