"""What all open pages of one server share."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field

from preshape.studio.page.compute import Compute
from preshape.studio.page.measurements import Measurements

__all__ = ["Shared"]


@dataclass(frozen=True)
class Shared:
    """What all open pages of one server share.

    Parameters
    ----------
    compute : Compute
        Who computes.
    measurements : Measurements
        What was dropped.
    slow : asyncio.Semaphore
        The lane of what may wait: exports and trade-offs go one by one, so that pictures always find someone free.
    """

    compute: Compute
    measurements: Measurements
    slow: asyncio.Semaphore = field(default_factory=lambda: asyncio.Semaphore(1))
