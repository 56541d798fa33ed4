"""From a dropped file to the exported text; handles, links, tabs, and a server that goes away."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page, expect
from tests.studio.browser.conftest import EXAMPLES, OpenPage, Server, dropped, field, number, ready, state

from preshape.mode import Mode
from preshape.workflow.workbench import (
    AskedDesign,
    Workbench,
    measured,
    packaged,
    shaper_named,
    to_text,
    view_of,
)

GANTRY = EXAMPLES / "gantry_x.csv"

BENCH = Workbench((Mode(20.0, 0.02), Mode(33.0, 0.01)), (AskedDesign("A", "zvd"), AskedDesign("B", "direct")))


def test_a_dropped_file_becomes_an_exported_text(open_page: OpenPage) -> None:
    page = open_page()
    dropped(page, (GANTRY.name, GANTRY.read_bytes()))
    found = measured(GANTRY.read_bytes(), GANTRY.name)
    expect(page.locator("#drop")).to_contain_text("Found")
    expect(field(page, "mode.1.frequency")).to_be_visible()
    modes = sorted((one.mode for one in found.modes), key=lambda mode: mode.frequency)
    assert state(page).modes == tuple(modes)
    assert [round(mode.frequency, 1) for mode in modes] == [47.3, 78.6]  # what is true of this file

    field(page, "design.A.family").select_option("direct")
    expect(number(page, "Shortest there is")).to_have_text("proved")
    field(page, "export.target").select_option("st")
    field(page, "export.rate").fill("2000")
    package = packaged(shaper_named(state(page), "A"), "st", rate=2000.0)
    for index, file in enumerate(package.files):
        expect(page.locator(f"#export-text-{index}")).to_have_text(file.text)
    with page.expect_download() as download:
        page.click("#download")
    assert Path(download.value.path()).read_bytes() == package.content
    assert download.value.suggested_filename == package.name


def test_what_is_drawn_is_what_the_library_computes(open_page: OpenPage) -> None:
    page = open_page(f"?s={to_text(BENCH)}")
    view = view_of(BENCH)
    for name, design in zip("AB", view.designs, strict=True):
        assert design.drawn is not None
        for chart, series, x, y in (
            ("sensitivity", name, view.frequencies, 100.0 * design.drawn.vibration),
            ("step", name, view.step_times, design.drawn.step.position),
            ("impulses", name, design.drawn.shaper.times, design.drawn.shaper.amplitudes),
        ):
            drawn = _points(page, chart, series)
            np.testing.assert_allclose(drawn[:, 1], y, rtol=1e-6, atol=1e-6)
            factor = drawn[-1, 0] / x[-1]
            assert factor == pytest.approx(1.0) or factor == pytest.approx(1e3)  # seconds or milliseconds


def test_a_dragged_handle_changes_the_mode_and_the_shaper(open_page: OpenPage) -> None:
    page = open_page(f"?s={to_text(BENCH)}")
    handle = page.locator(".handle").nth(0)
    before = number(page, "Duration").inner_text()
    box = handle.bounding_box()
    assert box is not None
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    for step in range(1, 11):
        page.mouse.move(x + 3 * step, y)
    page.mouse.up()
    expect(page.locator(".handle.held")).to_have_count(0)
    frequency = float(handle.get_attribute("aria-valuenow") or "nan")
    expect(field(page, "mode.0.frequency")).to_have_value(f"{frequency:.6g}")
    assert 20.0 < frequency < 33.0
    expect(number(page, "Left at mode 1")).to_have_text("0")
    expect(number(page, "Duration")).not_to_have_text(before)
    expect(number(page, f"Left at mode 1, {frequency:.4g} Hz")).to_be_visible()
    assert state(page).modes[0].frequency == frequency
    assert view_of(state(page)).designs[0].drawn.modes[0].residual < 1e-9  # type: ignore[union-attr]
    # The whole drag is one step.
    page.keyboard.press("Control+z")
    expect(field(page, "mode.0.frequency")).to_have_value("20")
    page.keyboard.press("Control+Shift+z")
    expect(field(page, "mode.0.frequency")).to_have_value(f"{frequency:.6g}")


def test_of_a_burst_of_keys_the_last_is_shown(open_page: OpenPage) -> None:
    page = open_page(f"?s={to_text(BENCH)}")
    field(page, "mode.0.frequency").focus()
    for _ in range(30):
        page.keyboard.press("ArrowUp")
    expect(number(page, "Left at mode 1, 23 Hz")).to_have_text("0")
    assert state(page).modes[0].frequency == 23.0
    drawn = view_of(state(page)).designs[1].drawn
    assert drawn is not None
    np.testing.assert_allclose(_points(page, "impulses", "B")[:, 1], drawn.shaper.amplitudes, rtol=1e-6)
    assert int(page.locator("#chart-sensitivity").get_attribute("data-draws") or 0) <= 31


def test_a_reload_and_another_tab_show_the_same_and_go_their_own_ways(open_page: OpenPage) -> None:
    first = open_page()
    field(first, "mode.0.frequency").fill("23.5")
    expect(number(first, "Left at mode 1, 23.5 Hz")).to_be_visible()
    first.reload()
    ready(first)
    expect(field(first, "mode.0.frequency")).to_have_value("23.5")
    second = first.context.new_page()
    second.goto(first.url)
    ready(second)
    expect(field(second, "mode.0.frequency")).to_have_value("23.5")
    field(second, "mode.0.frequency").fill("31")
    expect(number(second, "Left at mode 1, 31 Hz")).to_be_visible()
    assert state(first).modes[0].frequency == 23.5
    expect(number(first, "Left at mode 1, 23.5 Hz")).to_be_visible()


def test_a_link_copied_is_the_state(open_page: OpenPage) -> None:
    page = open_page(f"?s={to_text(BENCH)}", permissions=["clipboard-read", "clipboard-write"])
    page.click("#copy-link")
    expect(page.locator("#saying")).to_have_text("Link copied")
    link = page.evaluate("navigator.clipboard.readText()")
    assert link == page.url
    assert state(page) == BENCH


def test_a_measurement_is_shown_again_after_a_reload(open_page: OpenPage) -> None:
    page = open_page()
    content = (EXAMPLES / "ring_down.csv").read_bytes()
    dropped(page, ("ring_down.csv", content))
    expect(page.locator("#drop")).to_contain_text("ring_down.csv")
    expect(page.locator("#forget")).to_be_visible()
    page.reload()
    ready(page)
    expect(page.locator("#drop")).to_contain_text("ring_down.csv")
    page.click("#forget")
    expect(page.locator("#drop")).not_to_contain_text("ring_down.csv")


def test_the_report_comes_as_html_and_pdf(open_page: OpenPage) -> None:
    page = open_page(f"?s={to_text(BENCH)}")
    with page.expect_download() as html:
        page.click("#report-html")
    text = Path(html.value.path()).read_text()
    assert text.startswith("<!doctype html>")
    assert f"{shaper_named(BENCH, 'A').duration * 1e3:.3g}" in text
    with page.expect_download() as pdf:
        page.click("#report-pdf")
    assert Path(pdf.value.path()).read_bytes().startswith(b"%PDF")


def test_a_server_that_goes_away_takes_nothing_with_it(open_page: OpenPage) -> None:
    server = Server()
    try:
        page = open_page(address=server.address)
        field(page, "mode.0.frequency").fill("17.25")
        expect(number(page, "Left at mode 1, 17.25 Hz")).to_be_visible()
    finally:
        server.stop()
    expect(page.locator("#popup")).to_be_visible()
    expect(page.locator("#popup")).to_contain_text("Connection lost")
    expect(number(page, "Left at mode 1, 17.25 Hz")).to_be_visible()
    again = Server(server.port or 0)
    try:
        expect(page.locator("#popup")).to_be_hidden()
        ready(page)
        expect(field(page, "mode.0.frequency")).to_have_value("17.25")
        field(page, "mode.0.frequency").fill("18")
        expect(number(page, "Left at mode 1, 18 Hz")).to_be_visible()
        page.goto("about:blank")
    finally:
        again.stop()


def test_the_studio_opens_on_a_measurement(open_page: OpenPage) -> None:
    server = Server(0, str(GANTRY))
    try:
        page = open_page(address=server.address)
        expect(page.locator("#drop")).to_contain_text("gantry_x.csv")
        expect(field(page, "mode.1.frequency")).to_have_value("78.5967")
        page.goto("about:blank")
    finally:
        server.stop()


def _points(page: Page, chart: str, series: str) -> np.ndarray:
    found = page.evaluate(
        """([chart, series]) => {
          const id = JSON.parse(document.getElementById('first-charts').textContent)[chart];
          return getElement(id).chart.getOption().series.find(one => one.id === series).data;
        }""",
        [chart, series],
    )
    return np.array(found, dtype=float)
