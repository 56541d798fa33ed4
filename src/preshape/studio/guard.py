"""Who may talk to the studio, and how much: host names, origins, a token, and the size of what is sent.

A page of another site cannot reach it: its name for our address is refused (DNS rebinding), its origin is not ours, and
no answer allows other origins to read it.
"""

from __future__ import annotations

import hmac
import ipaddress
import re
from collections.abc import Awaitable, Callable, MutableMapping
from dataclasses import dataclass
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qsl, urlencode, urlsplit

from starlette.exceptions import HTTPException
from starlette.responses import JSONResponse, RedirectResponse, Response

__all__ = ["COOKIE", "Guard", "Rules", "is_loopback"]

Scope = MutableMapping[str, Any]
Message = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[Message]]
Send = Callable[[Message], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

COOKIE = "preshape_studio"

REFUSED_SOCKET = 1008
"""What a web socket is closed with: a policy does not allow it."""

PROTECTION = (
    (
        b"content-security-policy",
        b"default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; frame-ancestors 'none'",
    ),
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"same-origin"),
)
"""Said with every answer: the browser loads nothing from anywhere else, and shows the studio in nobody's frame."""

LOCAL_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})


@dataclass(frozen=True)
class Rules:
    """What is allowed.

    Parameters
    ----------
    names : frozenset of str
        Host names by which the studio may be called, in lower case; besides, if `token` is set, any address that is a
        number.
    token : str
        What a client must know; empty where it is bound to loopback only.
    largest_upload : int
        Bytes of a file.
    largest_request : int
        Bytes of any other request.
    upload_paths : tuple of str
        Patterns of paths that take files.
    """

    names: frozenset[str] = LOCAL_NAMES
    token: str = ""
    largest_upload: int = 200_000_000
    largest_request: int = 1_000_000
    upload_paths: tuple[str, ...] = (r"/api/identify", r"/page/measurement")


class Guard:
    """The outermost layer of the app: what breaks a rule gets no further.

    Parameters
    ----------
    app : ASGI app
        What is guarded.
    rules : Rules
        What is allowed.
    """

    def __init__(self, app: App, rules: Rules) -> None:
        self.app, self.rules = app, rules

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """As ASGI asks."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        headers = {name.lower(): value for name, value in reversed(scope["headers"])}
        refusal = self._refusal(scope, headers)
        if refusal is None and scope["type"] == "http":
            limit = self._limit(scope["path"])
            refusal = _too_large_by_its_word(headers, limit)
            receive = _counted(receive, limit)
        if scope["type"] == "http":
            send = _protected(send)
        if refusal is None:
            await self.app(scope, receive, send)
        elif scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": REFUSED_SOCKET})
        else:
            await refusal(scope, receive, send)

    def _refusal(self, scope: Scope, headers: dict[bytes, bytes]) -> Response | None:
        host = headers.get(b"host", b"").decode("latin-1")
        if not self._is_ours(host):
            return _problem(403, "this name is not the studio's: open it by the address that preshape studio printed.")
        origin = headers.get(b"origin")
        if origin is not None and urlsplit(origin.decode("latin-1")).netloc.lower() != host.lower():
            return _problem(403, "another site's page asked: only the studio's own page may.")
        return self._token_refusal(scope, headers) if self.rules.token else None

    def _is_ours(self, host: str) -> bool:
        match = re.fullmatch(r"(?:\[([0-9A-Fa-f:.]+)\]|([^:\[\]]+))(?::[0-9]{1,5})?", host)
        if match is None:
            return False
        name = (match[1] or match[2]).lower()
        return name in self.rules.names or (bool(self.rules.token) and _is_number(name))

    def _token_refusal(self, scope: Scope, headers: dict[bytes, bytes]) -> Response | None:
        """None for a client that knows the token: from its cookie, a header, or the address that was printed."""
        given = _cookie(headers.get(b"cookie", b"")) or _bearer(headers.get(b"authorization", b""))
        if given and self._knows(given):
            return None
        query = parse_qsl(scope.get("query_string", b"").decode("latin-1"), keep_blank_values=True)
        asked = next((value for name, value in query if name == "token"), "")
        if scope["type"] == "http" and asked and self._knows(asked):
            rest = urlencode([(name, value) for name, value in query if name != "token"])
            # Not the path as it came: "//elsewhere" would lead to another host.
            path = "/" + scope["path"].lstrip("/\\")
            answer = RedirectResponse(path + (f"?{rest}" if rest else ""), 303)
            answer.set_cookie(COOKIE, self.rules.token, httponly=True, samesite="strict", path="/")
            answer.headers["Referrer-Policy"] = "no-referrer"
            answer.headers["Cache-Control"] = "no-store"
            return answer
        return _problem(401, "the studio asks for its token: open it by the address that preshape studio printed.")

    def _knows(self, given: str) -> bool:
        return hmac.compare_digest(given.encode("utf-8", "replace"), self.rules.token.encode())

    def _limit(self, path: str) -> int:
        takes_files = any(re.fullmatch(pattern, path) for pattern in self.rules.upload_paths)
        return self.rules.largest_upload if takes_files else self.rules.largest_request


def is_loopback(host: str) -> bool:
    """Whether an address can be reached from this computer only."""
    name = host.strip("[]").lower()
    return name == "localhost" or (_is_number(name) and ipaddress.ip_address(name).is_loopback)


def _is_number(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _protected(send: Send) -> Send:
    """Adds the headers of `PROTECTION` to an answer that does not have them."""

    async def protected(message: Message) -> None:
        if message["type"] == "http.response.start":
            there = {name.lower() for name, _ in message.get("headers", ())}
            more = [pair for pair in PROTECTION if pair[0] not in there]
            message = {**message, "headers": [*message.get("headers", ()), *more]}
        await send(message)

    return protected


def _too_large_by_its_word(headers: dict[bytes, bytes], limit: int) -> Response | None:
    said = headers.get(b"content-length", b"0")
    if said.isdigit() and int(said[:20]) > limit:
        return _problem(413, _too_large(limit))
    return None


def _counted(receive: Receive, limit: int) -> Receive:
    """Counts what really comes, whatever the header said."""
    total = 0

    async def counted() -> Message:
        nonlocal total
        message = await receive()
        total += len(message.get("body", b""))
        if total > limit:
            raise HTTPException(413, _too_large(limit))
        return message

    return counted


def _too_large(limit: int) -> str:
    return f"the request is larger than {limit / 1e6:g} MB: cut the part of the file that holds the vibration."


def _cookie(header: bytes) -> str:
    try:
        found = SimpleCookie(header.decode("latin-1")).get(COOKIE)
    except CookieError:
        return ""
    return found.value if found is not None else ""


def _bearer(header: bytes) -> str:
    scheme, _, given = header.decode("latin-1").partition(" ")
    return given.strip() if scheme.lower() == "bearer" else ""


def _problem(status: int, sentence: str) -> Response:
    return JSONResponse({"detail": sentence}, status, headers={"Cache-Control": "no-store"})
