"""Dropped files: taken in memory up to a limit, and kept under a key that a link can name."""

from __future__ import annotations

import hashlib
from collections import OrderedDict
from typing import TYPE_CHECKING

from preshape.errors import InputError
from preshape.studio.page.compute import FILE_TIME, Compute, told
from preshape.studio.workers import Overdue
from preshape.workflow.workbench import Measured, measured

if TYPE_CHECKING:
    from fastapi import FastAPI

__all__ = ["ADDRESS", "Measurements"]

ADDRESS = "page/measurement"
"""Where files go up, relative to the page; not part of the HTTP API."""

MOST_KEPT = 16
"""Measurements that the server holds, of all its pages together; the one looked at longest ago goes first."""


class Measurements:
    """The measurements that pages may ask for."""

    def __init__(self, compute: Compute, largest: int) -> None:
        self._compute, self.largest = compute, largest
        self._kept: OrderedDict[str, Measured] = OrderedDict()

    async def read(self, content: bytes, name: str) -> str:
        """Read a file; the key under which it is kept. InputError if it is not a measurement."""
        key = hashlib.sha256(name.encode() + b"\0" + content).hexdigest()[:16]
        found = self.get(key)
        if found is None:
            found = await self._compute.run(FILE_TIME, measured, content, name, largest=self.largest)
        self._kept[key] = found
        while len(self._kept) > MOST_KEPT:
            self._kept.popitem(last=False)
        return key

    def get(self, key: str) -> Measured | None:
        """What is kept under a key; None if it is not there, or no more."""
        if key in self._kept:
            self._kept.move_to_end(key)
        return self._kept.get(key)

    def serve(self, app: FastAPI) -> None:
        """Take files under :data:`ADDRESS`."""
        from fastapi import Request
        from fastapi.responses import JSONResponse

        async def take(request: Request, name: str = "") -> JSONResponse:
            parts, size = [], 0
            async for part in request.stream():
                size += len(part)
                if size > self.largest:
                    limit = f"The file has more than {self.largest / 1e6:g} MB: cut the part that holds the vibration."
                    return JSONResponse({"trouble": limit}, status_code=413)
                parts.append(part)
            try:
                key = await self.read(b"".join(parts), name[:200])
            except (InputError, Overdue) as error:
                return JSONResponse({"trouble": str(error)})
            except RuntimeError as failure:
                return JSONResponse({"trouble": told(failure)})
            return JSONResponse({"key": key})

        # Annotations are text here, and the framework looks them up among the module's names.
        take.__annotations__ = {"request": Request, "name": str}
        app.add_api_route("/" + ADDRESS, take, methods=["POST"], include_in_schema=False, response_model=None)
