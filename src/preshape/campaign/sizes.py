"""How many points a batch takes: from the measured time of a point, never typed.

A batch costs its scheduling whatever is in it, so it must be long; and it must be short, for a killed worker loses it,
and the last ones of a campaign must not leave the other cores waiting.
"""

from __future__ import annotations

import math

__all__ = ["BatchSizes"]

SHORTEST = 1.0
"""Of a batch [s], where there are points enough: a hundred times what scheduling one takes."""

KEPT_UP = 0.02
"""Of a batch for each core [s]: one client starts, fetches and keeps fifty batches a second with ease (the benchmark
says what one takes)."""

SHARES = 3.0
"""Of what is left, a core gets a third of its part at a time: batches become shorter towards the end."""

LEAST, LEAST_KEPT_UP = 0.2, 0.01
"""Of the last batches [s], and for each core [s]: long enough for 5 % of overhead at most, and for the one client."""

FORGETTING = 0.5
"""Weight of a new measurement [-]."""


class BatchSizes:
    """The number of points of the next batch.

    Parameters
    ----------
    cores : int
        Among which the points are shared.

    Examples
    --------
    >>> sizes = BatchSizes(2)
    >>> sizes.next(100_000)
    1
    >>> sizes.learn(1, 0.004)
    >>> sizes.next(100_000), sizes.next(300), sizes.next(10)
    (250, 50, 10)
    """

    def __init__(self, cores: int) -> None:
        self._cores = cores
        self._seconds: float | None = None

    def learn(self, points: int, seconds: float) -> None:
        """So many points took so long [s]."""
        each = max(seconds / points, 1e-9)
        # A first point imports what it needs, and says little of the next: what is faster counts at once.
        if self._seconds is None or each < self._seconds:
            self._seconds = each
        else:
            self._seconds += FORGETTING * (each - self._seconds)

    def next(self, left: int) -> int:
        """How many of the points that are left go into one batch; at least one."""
        if self._seconds is None:
            return 1
        wanted = max(SHORTEST, KEPT_UP * self._cores) / self._seconds
        shared = max(left / (SHARES * self._cores), max(LEAST, LEAST_KEPT_UP * self._cores) / self._seconds)
        return max(1, min(left, math.floor(min(wanted, shared))))
