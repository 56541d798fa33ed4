"""The studio's redraw in a real browser: a key pressed in a field, until every visible chart shows the new design.

The peer is NiceGUI's usual way in the same process: a field whose handler sets the whole options of six charts, with
numbers that were computed before, so without any design. Both are measured from the key's own time stamp to ECharts'
`rendered` events with the new numbers, then a burst of keys as fast as they go. Needs Chromium.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
import time
import urllib.request
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
from playwright.sync_api import Page, sync_playwright

from preshape import Mode
from preshape.workflow.workbench import AskedDesign, Workbench, to_text, view_of

PORT = 8479
PRESSES, BURST = 40, 40
MODES = (Mode(9.8, 0.02), Mode(17.0, 0.01), Mode(31.7, 0.015), Mode(52.0, 0.03))
VISIBLE = ("spectrum", "sensitivity", "impulses", "move", "step", "deflection")

WATCH = """
names => {
  window.times = [];
  let started = null;
  document.addEventListener('keydown', event => { started ??= event.timeStamp; }, true);
  const seen = Object.fromEntries(names.map(name => [name, document.getElementById('chart-' + name).dataset.rendered]));
  const left = new Set(names);
  const watch = () => {
    for (const name of names) {
      const now = document.getElementById('chart-' + name).dataset.rendered;
      if (now !== seen[name]) { seen[name] = now; left.delete(name); }
    }
    if (!left.size && started !== null) {
      window.times.push(performance.now() - started);
      started = null;
      for (const name of names) left.add(name);
    }
  };
  const options = { subtree: true, attributes: true, attributeFilter: ['data-rendered'] };
  new MutationObserver(watch).observe(document.body, options);
}
"""


COUNT = """
() => {
  const told = document.getElementById('chart-INDEX').dataset;
  told.rendered = 1 + Number(told.rendered ?? 0);
}
"""


def main() -> None:
    """First paint, single keys and a burst; for each family, and for the peer."""
    server = subprocess.Popen([sys.executable, __file__, "serve"], stdout=subprocess.DEVNULL)
    try:
        _wait()
        with sync_playwright() as player:
            browser = player.chromium.launch(executable_path=shutil.which("chromium"), args=["--no-sandbox"])
            for families in (("direct",), ("zvd",), ("ei",), ("zvd", "ei", "direct")):
                bench = Workbench(MODES, tuple(AskedDesign(*pair) for pair in zip("ABCD", families, strict=False)))
                page = browser.new_context(viewport={"width": 1280, "height": 720}).new_page()
                page.goto(f"http://127.0.0.1:{PORT}/?s={to_text(bench)}")
                page.wait_for_selector("html[data-ready]")
                paint = page.evaluate("performance.getEntriesByName('studio-drawn')[0].startTime")
                first = page.evaluate("performance.getEntriesByName('first-contentful-paint')[0].startTime")
                print(
                    f"{'+'.join(families)}: first paint {first:.0f} ms, charts drawn {paint:.0f} ms after the address "
                    "was entered (claim: below 1000 ms)",
                    flush=True,
                )
                page.wait_for_timeout(1500)
                _measure(page, "+".join(families), '[data-field="mode.0.frequency"]', VISIBLE)
                page.context.close()
            page = browser.new_context(viewport={"width": 1280, "height": 720}).new_page()
            page.goto(f"http://127.0.0.1:{PORT}/peer")
            page.wait_for_selector("#chart-5[data-rendered]")
            page.wait_for_timeout(1500)
            _measure(page, "peer: six ui.echart, no design", "input", [str(i) for i in range(6)])
            browser.close()
    finally:
        server.kill()


def _measure(page: Page, what: str, field: str, names: Sequence[str]) -> None:
    page.evaluate(WATCH, list(names))
    page.focus(field)
    for count in range(1, PRESSES + 1):
        page.keyboard.press("ArrowUp")
        page.wait_for_function(f"window.times.length >= {count}", timeout=30_000)
        page.wait_for_timeout(60)
    times = np.array(page.evaluate("window.times"))
    for _ in range(BURST):
        page.keyboard.press("ArrowUp")
    page.wait_for_timeout(1500)
    drawn = page.evaluate("window.times.length") - PRESSES
    p50, p90 = np.percentile(times, (50, 90))
    print(
        f"{what}: key to all six charts drawn, p50 {p50:.0f} ms, p90 {p90:.0f} ms; {BURST} keys at once drawn {drawn} "
        "times (claim: p90 below 100 ms for one design)",
        flush=True,
    )


def _serve() -> None:
    import uvicorn
    from nicegui import ui

    from preshape.studio.server import Studio, create_app, rules_for
    from preshape.studio.workers import Workers

    ui.page("/peer")(_peer)
    app = create_app(Studio(Workers()), rules_for("127.0.0.1"))
    uvicorn.run(app, host="127.0.0.1", port=PORT, log_level="warning")


def _peer() -> None:
    from nicegui import ui

    from preshape.studio.page.plots import CHARTS, Picture

    bench = Workbench(MODES, (AskedDesign("A", "direct"),))
    pictures = [Picture(view_of(replace(bench, modes=(Mode(f, 0.02), *MODES[1:]))), 80.0) for f in (9.8, 10.8)]
    options = [[_whole(chart, picture) for chart in CHARTS[:6]] for picture in pictures]
    state = {"turn": 0}

    def change() -> None:
        state["turn"] ^= 1
        for chart, option in zip(charts, options[state["turn"]], strict=True):
            chart.options.clear()
            chart.options.update(option)
            chart.update()

    ui.input(value="1").on("keydown", change)
    charts = []
    with ui.row():
        for index in range(6):
            with ui.element("div").props(f'id="chart-{index}"').style("width: 300px"):
                chart = ui.echart(options[0][index]).style("height: 200px")
                chart.on(
                    "chart:rendered",
                    js_handler=COUNT.replace("INDEX", str(index)),
                )
                charts.append(chart)


def _whole(chart: Any, picture: Any) -> dict[str, Any]:
    option: dict[str, Any] = json.loads(json.dumps(chart.option))
    for series in option["series"]:
        points = chart.drawing(picture).series.get(series["id"])
        if points is not None:
            series["data"] = [[float(x), None if np.isnan(y) else float(y)] for x, y in zip(*points, strict=True)]
    return option


def _wait() -> None:
    for _ in range(100):
        try:
            urllib.request.urlopen(f"http://127.0.0.1:{PORT}/", timeout=5).read()
            return
        except OSError:
            time.sleep(0.2)
    raise SystemExit("the studio did not start")


if __name__ == "__main__":
    _serve() if sys.argv[1:] == ["serve"] else main()
