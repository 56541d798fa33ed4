"""A studio, a browser, and pages that note every request and every error they see."""

from __future__ import annotations

import base64
import re
import shutil
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import pytest
from playwright.sync_api import Browser, Locator, Page, expect, sync_playwright
from tests.tools import needed

from preshape.workflow.workbench import Workbench, from_text

WAIT = 30_000
"""Milliseconds after which something that should happen counts as not happening; machines are busy."""

OpenPage = Callable[..., Page]


class Server:
    """`preshape studio` in a process of its own."""

    def __init__(self, port: int = 0, *arguments: str) -> None:
        command = [sys.executable, "-m", "preshape", "studio", "--no-browser", "--port", str(port), *arguments]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        assert self.process.stdout is not None
        told = re.search(r"http://\S+", self.process.stdout.readline())
        assert told is not None, "the studio printed no address"
        self.address = told[0]
        self.port = urlsplit(self.address).port

    def stop(self) -> None:
        """End it."""
        self.process.terminate()
        self.process.wait(20)
        assert self.process.stdout is not None
        self.process.stdout.close()


@pytest.fixture(scope="session")
def server() -> Iterator[Server]:
    needed("chromium")
    started = Server()
    yield started
    started.stop()


@pytest.fixture(scope="module")  # an event loop runs as long as it does, and other modules' tests have their own
def browser() -> Iterator[Browser]:
    needed("chromium")
    expect.set_options(timeout=WAIT)
    with sync_playwright() as player:
        started = player.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
        yield started
        started.close()


@pytest.fixture
def open_page(browser: Browser, server: Server) -> Iterator[OpenPage]:
    """Opens pages; at the end of the test no request has left this computer, and nothing went wrong in a console."""
    requests: list[str] = []
    errors: list[str] = []
    contexts = []

    def opened(query: str = "", *, address: str = "", **settings: object) -> Page:
        settings.setdefault("viewport", {"width": 1280, "height": 720})
        context = browser.new_context(**settings)  # type: ignore[arg-type]
        context.set_default_timeout(WAIT)
        contexts.append(context)
        page = context.new_page()
        page.on("request", lambda request: requests.append(request.url))
        page.on("console", lambda message: errors.append(message.text) if message.type == "error" else None)
        page.on("pageerror", lambda error: errors.append(str(error)))
        page.goto((address or server.address) + query)
        ready(page)
        return page

    yield opened
    for context in contexts:
        context.close()
    foreign = [url for url in requests if urlsplit(url).hostname not in ("127.0.0.1", None)]
    assert requests or not contexts
    assert not foreign
    assert not [error for error in errors if "ERR_CONNECTION" not in error and "WebSocket" not in error]


def ready(page: Page) -> None:
    """Wait until the page has drawn."""
    page.wait_for_selector("html[data-ready]")
    expect(page.locator("#numbers")).to_be_visible()


def state(page: Page) -> Workbench:
    """What the page's address holds."""
    return from_text(parse_qs(urlsplit(page.url).query)["s"][0])


def field(page: Page, name: str) -> Locator:
    """A field by its name."""
    return page.locator(f'[data-field="{name}"]')


def trouble(page: Page, name: str) -> Locator:
    """What is said beside a field."""
    return page.locator(f'[data-error="{name}"]')


def number(page: Page, row: str, column: int = 1) -> Locator:
    """A cell of the numbers, by the beginning of its row's name."""
    return page.locator("#numbers tr", has=page.locator("th", has_text=re.compile(f"^{re.escape(row)}"))).locator(
        f"td:nth-child({column + 1})"
    )


def dropped(page: Page, *files: tuple[str, bytes]) -> None:
    """Drop files onto the page, as a file manager does."""
    transfer = page.evaluate_handle(
        """files => {
          const transfer = new DataTransfer();
          for (const [name, text] of files) {
            const bytes = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
            transfer.items.add(new File([bytes], name));
          }
          return transfer;
        }""",
        [[name, base64.b64encode(content).decode()] for name, content in files],
    )
    for kind in ("dragenter", "dragover", "drop"):
        page.dispatch_event("#results", kind, {"dataTransfer": transfer})


EXAMPLES = Path(__file__).parents[3] / "examples" / "data"
