"""Who may talk to the studio: names, origins, tokens, sizes; other people's pages may not."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from starlette.applications import Starlette
from starlette.requests import Request
from starlette.responses import PlainTextResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.testclient import TestClient
from starlette.websockets import WebSocket, WebSocketDisconnect

from preshape.errors import InputError
from preshape.studio.guard import COOKIE, Guard, Rules, is_loopback
from preshape.studio.server import new_token, rules_for

TOKEN = new_token()


async def said(request: Request) -> Response:
    return PlainTextResponse(str(len(await request.body())))


async def talk(socket: WebSocket) -> None:
    await socket.accept()
    await socket.send_text("hello")
    await socket.close()


INNER = Starlette(
    routes=[
        Route("/", said, methods=["GET", "POST"]),
        Route("/api/identify", said, methods=["POST"]),
        Route("/other", said),
        WebSocketRoute("/socket", talk),
    ]
)


def client(rules: Rules, host: str = "127.0.0.1:8420") -> TestClient:
    return TestClient(Guard(INNER, rules), base_url=f"http://{host}", follow_redirects=False)


@pytest.mark.parametrize("host", ["127.0.0.1:8420", "localhost:8420", "LOCALHOST", "[::1]:8420"])
def test_its_own_names_are_answered(host: str) -> None:
    assert client(rules_for("127.0.0.1")).get("/", headers={"host": host}).status_code == 200


@pytest.mark.parametrize(
    "host",
    ["evil.example", "evil.example:8420", "127.0.0.1.evil.example", "10.0.0.7", "localhost@evil.example", "", "[::1"],
)
def test_a_name_that_was_turned_to_our_address_is_refused(host: str) -> None:
    answer = client(rules_for("127.0.0.1")).get("/", headers={"host": host})
    assert answer.status_code == 403 and answer.json()["detail"].endswith(".")


@pytest.mark.parametrize(
    "origin", ["http://evil.example", "null", "http://127.0.0.1:9999", "https://127.0.0.1.evil.example:8420"]
)
def test_another_site_s_page_is_refused_and_may_read_nothing(origin: str) -> None:
    for method in ("GET", "POST", "OPTIONS"):
        answer = client(rules_for("127.0.0.1")).request(method, "/", headers={"origin": origin})
        assert answer.status_code == 403
        assert not any(name.startswith("access-control") for name in answer.headers)


def test_its_own_page_is_answered() -> None:
    assert client(rules_for("127.0.0.1")).post("/", headers={"origin": "http://127.0.0.1:8420"}).status_code == 200


def test_a_browser_is_told_to_load_nothing_from_elsewhere() -> None:
    headers = client(rules_for("127.0.0.1")).get("/").headers
    assert headers["content-security-policy"].startswith("default-src 'self'")
    assert "http" not in headers["content-security-policy"]
    assert headers["x-content-type-options"] == "nosniff"


class TestToken:
    @pytest.fixture
    def guarded(self) -> Iterator[TestClient]:
        yield client(rules_for("0.0.0.0", TOKEN), "192.168.1.5:8420")

    def test_nothing_is_said_without_it(self, guarded: TestClient) -> None:
        for headers in (
            {},
            {"authorization": "Bearer wrong"},
            {"authorization": f"Bearer {TOKEN[:-1]}"},
            {"cookie": f"{COOKIE}=wrong"},
            {"cookie": 'a="'},
        ):
            assert guarded.get("/", headers=headers).status_code == 401
        assert guarded.get("/?token=wrong").status_code == 401
        assert guarded.get("/?token=%F0%9F").status_code == 401

    def test_the_printed_address_leaves_a_cookie_and_no_token_in_the_address(self, guarded: TestClient) -> None:
        answer = guarded.get(f"/other?w=abc&token={TOKEN}")
        assert answer.status_code == 303 and answer.headers["location"] == "/other?w=abc"
        cookie = answer.headers["set-cookie"].lower()
        assert "httponly" in cookie and "samesite=strict" in cookie
        assert guarded.get("/other?w=abc").status_code == 200

    def test_the_way_back_leads_to_no_other_host(self, guarded: TestClient) -> None:
        answer = guarded.get(f"//evil.example/?token={TOKEN}")
        assert not answer.headers.get("location", "/").startswith("//")

    def test_a_program_gives_it_in_a_header(self, guarded: TestClient) -> None:
        assert guarded.get("/", headers={"authorization": f"Bearer {TOKEN}"}).status_code == 200

    def test_a_web_socket_needs_it_too(self, guarded: TestClient) -> None:
        with pytest.raises(WebSocketDisconnect), guarded.websocket_connect("ws://192.168.1.5:8420/socket"):
            pass
        with guarded.websocket_connect(
            "ws://192.168.1.5:8420/socket", headers={"cookie": f"{COOKIE}={TOKEN}"}
        ) as socket:
            assert socket.receive_text() == "hello"

    def test_no_other_computer_s_address_without_one(self) -> None:
        with pytest.raises(InputError, match="needs a token"):
            rules_for("0.0.0.0")


def test_a_web_socket_of_another_site_is_refused() -> None:
    local = client(rules_for("127.0.0.1"))
    with (
        pytest.raises(WebSocketDisconnect),
        local.websocket_connect("ws://127.0.0.1:8420/socket", headers={"origin": "http://evil.example"}),
    ):
        pass
    with local.websocket_connect("ws://127.0.0.1:8420/socket", headers={"origin": "http://127.0.0.1:8420"}) as socket:
        assert socket.receive_text() == "hello"


def chunks(size: int) -> Iterator[bytes]:
    for _ in range(size // 1000):
        yield b"x" * 1000


@pytest.mark.parametrize(("path", "limit"), [("/", 10_000), ("/api/identify", 50_000)])
def test_sizes_are_limited_by_word_and_while_they_come(path: str, limit: int) -> None:
    small = client(Rules(largest_request=10_000, largest_upload=50_000))
    assert small.post(path, content=b"x" * limit).text == str(limit)
    assert small.post(path, content=chunks(limit)).text == str(limit)
    for content in (b"x" * (limit + 1), chunks(limit + 1000)):
        answer = small.post(path, content=content)
        assert answer.status_code == 413 and "larger than" in answer.text


@pytest.mark.parametrize(
    ("host", "here"),
    [("127.0.0.1", True), ("127.8.8.8", True), ("localhost", True), ("::1", True), ("[::1]", True)]
    + [("0.0.0.0", False), ("::", False), ("192.168.0.3", False), ("gantry.example", False), ("", False)],
)
def test_what_is_this_computer_only(host: str, here: bool) -> None:
    assert is_loopback(host) is here


def test_a_token_is_long_and_never_the_same() -> None:
    tokens: Any = {new_token() for _ in range(100)}
    assert len(tokens) == 100 and all(len(token) >= 43 for token in tokens)
