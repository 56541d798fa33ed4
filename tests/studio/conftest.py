"""One app for the tests of a module, with two workers."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

pytest.importorskip("fastapi")

from preshape.studio.guard import Rules
from preshape.studio.server import Studio, create_app
from preshape.studio.workers import Workers

PATIENCE = 8.0
"""[s]"""

NAMES = frozenset({"testserver", "127.0.0.1", "localhost", "::1"})


@pytest.fixture(scope="module")
def workers() -> Iterator[Workers]:
    made = Workers(2)
    made.start()
    yield made
    made.stop()


class Started(Workers):
    """Workers that run already: the app neither starts nor stops them."""

    def __init__(self, workers: Workers) -> None:
        self.__dict__ = workers.__dict__

    async def run(self, seconds: float, function: Any, *args: Any, **kwargs: Any) -> Any:
        """With less patience than the server has: what a test makes up may take minutes."""
        return await super().run(min(seconds, PATIENCE), function, *args, **kwargs)

    def start(self) -> None:
        pass

    def stop(self) -> None:
        pass


@pytest.fixture(scope="module")
def app(workers: Workers) -> Any:
    return create_app(Studio(Started(workers), largest_upload=300_000), Rules(NAMES, largest_upload=300_000))
