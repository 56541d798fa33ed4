"""What the page asks of whoever computes for it, and how long each thing may take."""

from __future__ import annotations

import logging
from collections.abc import Callable
from typing import ParamSpec, Protocol, TypeVar

from preshape.errors import InputError
from preshape.studio.page.fields import sentence
from preshape.studio.workers import Overdue

__all__ = [
    "EXPORT_TIME",
    "FILE_TIME",
    "REPORT_TIME",
    "TRADE_OFF_PATIENCE",
    "TRADE_OFF_TIME",
    "VIEW_TIME",
    "FAILURES",
    "Compute",
    "told",
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


FAILURES = (InputError, Overdue, RuntimeError)
"""What may come instead of a result: a refusal, a job that took too long, or a fault of ours."""


def told(failure: Exception) -> str:
    """What the user is told; a fault goes to the log, with its trace."""
    if isinstance(failure, (InputError, Overdue)):
        return sentence(str(failure))
    logging.getLogger(__name__).error("a job of the studio failed: %s", failure)
    return "This failed within preshape; the state is kept, and the terminal shows what to report."


class Compute(Protocol):
    """Runs functions beside the event loop: :class:`preshape.studio.workers.Workers`."""

    async def run(self, seconds: float, function: Callable[P, T], *args: P.args, **kwargs: P.kwargs) -> T:
        """What the function returns; InputError as it does, or if it takes longer."""
        ...
