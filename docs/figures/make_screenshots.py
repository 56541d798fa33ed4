"""The studio as it looks in Chromium, as docs/images/studio*.png; run by `make figures`, needs Chromium."""

from __future__ import annotations

import io
import re
import shutil
import subprocess
import sys
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, sync_playwright

from preshape import Mode
from preshape.files import write_atomically
from preshape.workflow.workbench import AskedDesign, Workbench, to_text

ROOT = Path(__file__).resolve().parent.parent.parent
IMAGES = ROOT / "docs" / "images"
MEASUREMENT = ROOT / "examples" / "data" / "gantry_x.csv"

BENCH = Workbench(
    (Mode(47.3, 0.045), Mode(78.6, 0.06)),
    (AskedDesign("A", "direct"), AskedDesign("B", "ei"), AskedDesign("C", "zv")),
)

SCREEN = {"viewport": {"width": 1280, "height": 720}}
PHONE = {"viewport": {"width": 390, "height": 844}, "is_mobile": True, "has_touch": True}

COLOURS = 128
"""Few enough for small files, enough for smooth letters."""


def main() -> None:
    """Open the studio and look at it."""
    command = [sys.executable, "-m", "preshape", "studio", "--no-browser", "--port", "0"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        told = re.search(r"http://\S+", server.stdout.readline())
        assert told is not None
        try:
            with sync_playwright() as player:
                browser = player.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
                _look(browser, told[0], "studio", {**SCREEN, "color_scheme": "light"})
                _look(browser, told[0], "studio-dark", {**SCREEN, "color_scheme": "dark"}, to="#chart-poles")
                _look(browser, told[0], "studio-phone", PHONE, to="#chart-sensitivity")
                browser.close()
        finally:
            server.terminate()


def _look(browser: Browser, address: str, name: str, settings: dict[str, object], to: str = "") -> None:
    page = browser.new_context(**settings).new_page()  # type: ignore[arg-type]
    page.goto(f"{address}?s={to_text(BENCH)}")
    page.wait_for_selector("html[data-ready]")
    page.set_input_files("#measurement-file", MEASUREMENT)
    page.wait_for_selector("#take", timeout=60_000)
    page.wait_for_function("!document.querySelector('#chart-trade_off .note').textContent", timeout=60_000)
    if to:
        page.locator(to).evaluate("one => one.scrollIntoView({ block: 'start' })")
    page.evaluate("document.activeElement.blur()")
    page.wait_for_timeout(1000)
    picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB").quantize(COLOURS, dither=Image.Dither.NONE)
    buffer = io.BytesIO()
    picture.save(buffer, "PNG", optimize=True)
    print(write_atomically(IMAGES / f"{name}.png", buffer.getvalue()))
    page.context.close()


if __name__ == "__main__":
    main()
