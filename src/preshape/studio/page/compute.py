"""What the page asks of whoever computes for it, and how long each thing may take."""

from __future__ import annotations

from collections.abc import Callable
from typing import ParamSpec, Protocol, TypeVar

__all__ = [
    "EXPORT_TIME",
    "FILE_TIME",
    "REPORT_TIME",
    "TRADE_OFF_PATIENCE",
    "TRADE_OFF_TIME",
    "VIEW_TIME",
    "Compute",
]

P = ParamSpec("P")
T = TypeVar("T")

VIEW_TIME = 20.0
"""Seconds for a picture with all its designs."""

TRADE_OFF_TIME, TRADE_OFF_PATIENCE = 40.0, 4.0
"""Seconds for the trade-off, and those after which it begins no further point."""

FILE_TIME = 60.0
EXPORT_TIME = 20.0
REPORT_TIME = 120.0


class Compute(Protocol):
    """Runs functions beside the event loop: :class:`preshape.studio.workers.Workers`."""

    async def run(self, seconds: float, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """What the function returns; InputError as it does, or if it takes longer."""
        ...
