"""The page by keyboard, by screen reader, on a phone, in the dark and on paper."""

from __future__ import annotations

import re

import pytest
from axe_playwright_python.sync_playwright import Axe
from playwright.sync_api import expect
from tests.studio.browser.conftest import OpenPage, field, number, state

from preshape.mode import Mode
from preshape.workflow.workbench import AskedDesign, Workbench, to_text

BENCH = Workbench((Mode(20.0, 0.02), Mode(33.0, 0.01)), (AskedDesign("A", "zvd"), AskedDesign("B", "ei")))

NAMED = """
() => {
  const one = document.activeElement;
  if (one === document.body) return null;
  const style = getComputedStyle(one);
  const labelled = one.getAttribute('aria-labelledby');
  const name = one.getAttribute('aria-label') || one.labels?.[0]?.textContent || one.textContent
    || (labelled && document.getElementById(labelled)?.textContent);
  return { id: one.id, name: (name || '').trim(), outline: style.outlineStyle, width: parseFloat(style.outlineWidth) };
}
"""


def test_every_control_is_reached_by_tab_named_and_seen(open_page: OpenPage) -> None:
    page = open_page(f"?s={to_text(BENCH)}")
    expect(page.locator("#download")).to_be_visible()
    reached = []
    for _ in range(150):
        page.keyboard.press("Tab")
        found = page.evaluate(NAMED)
        if found is None or (reached and found == reached[0]):
            break
        reached.append(found)
    assert all(one["name"] for one in reached), [one for one in reached if not one["name"]]
    unseen = [one for one in reached if one["id"] != "measurement-file"]
    assert all(one["outline"] != "none" and one["width"] >= 2 for one in unseen)
    ids = {one["id"] for one in reached}
    assert {"undo", "copy-link", "f-mode-0-frequency", "add-mode", "tab-A", "f-design-A-family", "download"} <= ids


def test_a_shaper_is_chosen_by_keyboard_alone(open_page: OpenPage) -> None:
    page = open_page(f"?s={to_text(BENCH)}")

    def tab_to(identity: str) -> None:
        for _ in range(120):
            page.keyboard.press("Tab")
            if page.evaluate("document.activeElement.id") == identity:
                return
        raise AssertionError(f"{identity} is not reached")

    tab_to("f-mode-0-frequency")
    page.keyboard.press("ArrowUp")
    expect(field(page, "mode.0.frequency")).to_have_value("20.1")
    page.keyboard.press("Shift+ArrowUp")
    expect(field(page, "mode.0.frequency")).to_have_value("21.1")
    expect(number(page, "Left at mode 1, 21.1 Hz")).to_have_text("0")
    tab_to("add-mode")
    page.keyboard.press("Enter")
    expect(page.locator(".modes tbody tr")).to_have_count(3)
    tab_to("tab-A")
    page.keyboard.press("ArrowRight")
    expect(page.locator("#tab-B")).to_be_focused()
    expect(page.locator("#tab-B")).to_have_attribute("aria-selected", "true")
    tab_to("f-design-B-family")
    page.keyboard.type("Direct")
    expect(number(page, "Shortest there is", 2)).to_have_text("proved")
    assert state(page).designs[1].family == "direct"
    page.locator(".handle").nth(1).focus()
    page.keyboard.press("ArrowLeft")
    expect(field(page, "mode.1.frequency")).to_have_value("32.9")
    expect(page.locator(".handle").nth(1)).to_have_attribute("aria-valuetext", "32.9 hertz")


def test_charts_say_in_words_what_they_show(open_page: OpenPage) -> None:
    page = open_page(f"?s={to_text(BENCH)}")
    for name in ("spectrum", "sensitivity", "impulses", "move", "step", "deflection", "poles"):
        drawing = page.locator(f'#chart-{name} [role="img"]')
        assert len(drawing.get_attribute("aria-label") or "") > 30
    assert "design A leaves 0" in (page.locator('#chart-sensitivity [role="img"]').get_attribute("aria-label") or "")
    field(page, "mode.0.frequency").fill("21")
    expect(page.locator("#summary")).to_have_text(re.compile(r"Design A: 9 impulses in 0\.\d+ s, at most 0 % left"))
    page.locator("#chart-impulses summary").click()
    # Three impulses a mode, convolved; and those of B.
    expect(page.locator("#chart-impulses tbody tr")).to_have_count(18)


def test_a_phone_shows_one_column_and_nothing_sticks_out(open_page: OpenPage) -> None:
    page = open_page(f"?s={to_text(BENCH)}", viewport={"width": 390, "height": 844}, has_touch=True, is_mobile=True)
    assert page.evaluate("document.documentElement.scrollWidth") <= 390
    lefts = page.evaluate("[...document.querySelectorAll('.chart')].map(one => one.getBoundingClientRect().left)")
    assert len(set(lefts)) == 1
    page.locator("#chart-step").scroll_into_view_if_needed()
    expect(page.locator("#chart-step")).to_have_attribute("data-draws", "1")


def test_the_main_charts_are_seen_without_scrolling(open_page: OpenPage) -> None:
    page = open_page(f"?s={to_text(BENCH)}")
    for name in ("spectrum", "sensitivity", "impulses", "move", "step", "deflection"):
        box = page.locator(f"#chart-{name}").bounding_box()
        assert box is not None
        assert box["y"] + box["height"] <= 720


def test_dark_follows_the_system_and_the_button_overrules_it(open_page: OpenPage) -> None:
    page = open_page(color_scheme="dark")
    expect(page.locator("html")).to_have_attribute("data-theme", "dark")
    page.click("#theme")
    expect(page.locator("html")).to_have_attribute("data-theme", "light")
    page.reload()
    expect(page.locator("html")).to_have_attribute("data-theme", "light")
    page.click("#theme")
    expect(page.locator("html")).to_have_attribute("data-theme", "dark")
    page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    expect(page.locator("html")).to_have_attribute("data-theme", "light")
    page.evaluate("window.dispatchEvent(new Event('afterprint'))")
    expect(page.locator("html")).to_have_attribute("data-theme", "dark")


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_axe_finds_nothing(open_page: OpenPage, scheme: str) -> None:
    page = open_page(f"?s={to_text(BENCH)}", color_scheme=scheme, bypass_csp=True)
    page.click("#add-design")
    field(page, "mode.0.frequency").fill("-1")
    expect(page.locator("#download")).to_be_visible()
    found = Axe().run(page).response["violations"]
    assert [(one["id"], [node["html"] for node in one["nodes"]]) for one in found] == []
