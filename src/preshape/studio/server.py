"""The studio's server: the page and the API in one app, guarded, on this computer unless told otherwise."""

from __future__ import annotations

import contextlib
import errno
import importlib
import importlib.util
import secrets
import socket
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass, field
from typing import Any

from fastapi import FastAPI

from preshape.errors import InputError
from preshape.studio.api import api_app
from preshape.studio.guard import LOCAL_NAMES, Guard, Rules, is_loopback
from preshape.studio.workers import Workers
from preshape.workflow.workbench import LARGEST_FILE, Workbench

__all__ = ["DEFAULT_HOST", "DEFAULT_PORT", "Studio", "create_app", "free_socket", "new_token", "rules_for", "serve"]

DEFAULT_HOST = "127.0.0.1"
DEFAULT_PORT = 8420

PORTS_TRIED = 20
"""Ports after the default one, if that is taken and none was asked for."""

PAGE = "preshape.studio.page"
"""The module of the page; its ``build(app, studio)`` adds the page to the app."""


@dataclass(frozen=True)
class Studio:
    """What the page is given.

    Parameters
    ----------
    workers : Workers
        Who compute: ``await studio.workers.run(seconds, function, *arguments)``.
    largest_upload : int
        Bytes of a dropped file.
    workbench : Workbench
        What a page shows that is opened without a link.
    dropped : (str, bytes) or None
        Name and content of the measurement that the studio was opened with.
    """

    workers: Workers
    largest_upload: int = LARGEST_FILE
    workbench: Workbench = field(default_factory=Workbench)
    dropped: tuple[str, bytes] | None = None


def create_app(studio: Studio, rules: Rules) -> Any:
    """The app: API, page if there is one, and the guard around them.

    Parameters
    ----------
    studio : Studio
        What the page is given; its workers start with the app.
    rules : Rules
        Who may talk to it.

    Returns
    -------
    ASGI app
    """

    @contextlib.asynccontextmanager
    async def working(_: FastAPI) -> AsyncIterator[None]:
        studio.workers.start()
        try:
            yield
        finally:
            studio.workers.stop()

    app = FastAPI(lifespan=working, docs_url=None, redoc_url=None, openapi_url=None)
    app.mount("/api", api_app(studio.workers, largest_upload=studio.largest_upload))
    if importlib.util.find_spec(PAGE) is not None:
        importlib.import_module(PAGE).build(app, studio)
    return Guard(app, rules)


def rules_for(host: str, token: str = "", largest_upload: int = LARGEST_FILE) -> Rules:
    """The rules for an address to be bound to; InputError if others can reach it and there is no token."""
    if is_loopback(host):
        return Rules(LOCAL_NAMES | {host.strip("[]").lower()}, token, largest_upload)
    if not token:
        raise InputError(f"host {host} can be reached from other computers: the studio needs a token then.")
    return Rules(LOCAL_NAMES | {host.strip("[]").lower(), socket.gethostname().lower()}, token, largest_upload)


def new_token() -> str:
    """A random token, 256 bits."""
    return secrets.token_urlsafe(32)


def free_socket(host: str, port: int | None) -> socket.socket:
    """A socket that listens at a port; the next free one after the default if none is asked for.

    Raises
    ------
    InputError
        If the port is taken or not allowed, the host is none of this computer's, or all tried ports are taken.
    """
    if port is not None and not 0 <= port <= 65535:
        raise InputError(f"port {port} is none: give 1024 to 65535, or 0 for any that is free.")
    first = DEFAULT_PORT if port is None else port
    for trial in range(first, first + (PORTS_TRIED if port is None else 1)):
        try:
            return _bound(host, trial)
        except PermissionError:
            raise InputError(f"port {trial} is not allowed to you: give one of 1024 and above.") from None
        except socket.gaierror:
            raise InputError(f"host {host} is not known: give an address of this computer, such as 0.0.0.0.") from None
        except OSError as error:
            if error.errno != errno.EADDRINUSE:
                reason = (error.strerror or str(error)).lower()
                raise InputError(f"host {host} cannot be used ({reason}): give an address of this computer.") from None
    if port is None:
        raise InputError(f"ports {first} to {first + PORTS_TRIED - 1} are all taken: name a free one with --port.")
    raise InputError(f"port {port} is taken, perhaps by another studio: name another with --port, or leave it out.")


def serve(app: Any, listening: socket.socket, opened: Callable[[], None]) -> None:
    """Serve until interrupted; `opened` is called when the page can be reached."""
    import uvicorn

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets)
            opened()

    config = uvicorn.Config(
        app, log_level="warning", access_log=False, server_header=False, timeout_graceful_shutdown=2
    )
    Server(config).run(sockets=[listening])


def _bound(host: str, port: int) -> socket.socket:
    family, kind, _, _, address = socket.getaddrinfo(host.strip("[]"), port, type=socket.SOCK_STREAM)[0]
    listening = socket.socket(family, kind)
    try:
        listening.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        listening.bind(address)
        listening.listen(128)
    except BaseException:
        listening.close()
        raise
    return listening
