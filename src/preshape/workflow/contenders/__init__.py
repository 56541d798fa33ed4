"""The commands that a comparison compares: each the same move within the same limits."""

from preshape.workflow.contenders.entries import Entry, entries
from preshape.workflow.contenders.limited import Limited, Move

__all__ = ["Entry", "Limited", "Move", "entries"]
