"""What cannot be is refused where it was given, and nothing else changes."""

from __future__ import annotations

import base64
import json
import zlib

import pytest
from playwright.sync_api import expect
from tests.studio.browser.conftest import OpenPage, dropped, field, number, state, trouble

from preshape.mode import Mode
from preshape.workflow.workbench import MOST_MODES, AskedDesign, Workbench, to_plain, to_text

EI = Workbench((Mode(20.0, 0.02),), (AskedDesign("A", "ei"),))


@pytest.mark.parametrize(
    ("name", "text", "said"),
    [
        ("mode.0.frequency", "-3", "-3 Hz"),
        ("mode.0.frequency", "fast", "'fast' is not a number"),
        ("mode.0.frequency", "", "is missing"),
        ("mode.0.frequency", "1e9", "1e+09 Hz"),
        ("mode.0.damping", "1.5", "1.5"),
        ("move.speed", "0", "0"),
        ("move.distance", "nan", "nan"),
        ("controller.most_impulses", "1", "1"),
        ("design.A.option.tolerance", "-0.1", "-0.1"),
        ("export.rate", "often", "'often' is not a number"),
    ],
)
def test_a_wrong_number_is_told_beside_its_field(open_page: OpenPage, name: str, text: str, said: str) -> None:
    page = open_page(f"?s={to_text(EI)}")
    if name.startswith("controller"):
        page.locator("#trial-controller > summary").click()
    if name == "export.rate":
        field(page, "export.target").select_option("st")
    before = page.locator("#numbers").inner_text()
    good = field(page, name).input_value()
    field(page, name).fill(text)
    expect(trouble(page, name)).to_contain_text(said)
    expect(field(page, name)).to_have_attribute("aria-invalid", "true")
    assert page.locator("#numbers").inner_text() == before
    assert state(page) == EI
    field(page, name).fill(good)
    expect(trouble(page, name)).to_be_empty()
    expect(field(page, name)).to_have_attribute("aria-invalid", "false")


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("empty.csv", b""),
        ("noise.bin", bytes(range(256)) * 40),
        ("letter.txt", b"Dear machine,\nplease do not shake.\n" * 30),
        ("one.csv", b"time,x\n0.0,1.0\n"),
        ("<img src=x onerror=alert(1)>.csv", b"nothing"),
    ],
)
def test_a_file_that_is_no_measurement_is_told_in_the_drop_zone(open_page: OpenPage, name: str, content: bytes) -> None:
    page = open_page(f"?s={to_text(EI)}")
    before = page.locator("#numbers").inner_text()
    dropped(page, (name, content))
    expect(page.locator("#drop-trouble")).to_contain_text(name)
    assert page.locator("#drop img").count() == 0
    assert page.locator("#numbers").inner_text() == before
    assert state(page) == EI


def test_two_files_at_once_are_told_apart(open_page: OpenPage) -> None:
    page = open_page()
    dropped(page, ("a.csv", b"1"), ("b.csv", b"2"))
    expect(page.locator("#drop-trouble")).to_contain_text("2 files")


def test_a_file_too_large_is_not_even_sent(open_page: OpenPage) -> None:
    page = open_page()
    page.evaluate("document.getElementById('drop').dataset.most = '1000'")
    dropped(page, ("long.csv", b"0.0\n" * 1000))
    expect(page.locator("#drop-trouble")).to_contain_text("long.csv has 0.0 MB")


def test_broken_links_are_told_and_the_page_works(open_page: OpenPage) -> None:
    many = {**to_plain(EI), "modes": [[10.0, 0.01]] * 1_000_000}
    for text in ("rubbish!", _packed(many), _packed({**to_plain(EI), "modes": [[-1.0, 0.0]]}), "A" * 9000):
        page = open_page(f"?s={text}")
        expect(page.locator(".banner")).to_contain_text("The page shows its first state instead.")
        field(page, "mode.0.frequency").fill("12")
        expect(number(page, "Left at mode 1, 12 Hz")).to_be_visible()


def test_a_design_without_a_solution_says_why_and_the_others_go_on(open_page: OpenPage) -> None:
    bench = Workbench((Mode(20.0, 0.02), Mode(33.3, 0.01)), (AskedDesign("A", "sd_zv"), AskedDesign("B", "zvd")))
    page = open_page(f"?s={to_text(bench)}")
    expect(number(page, "What is wrong")).not_to_be_empty()
    expect(trouble(page, "design.A")).not_to_be_empty()
    expect(number(page, "Left at mode 1", 2)).to_have_text("0")


def test_modes_and_designs_have_a_last_one_and_a_first(open_page: OpenPage) -> None:
    page = open_page(f"?s={to_text(EI)}")
    expect(page.locator("#delete-0")).to_have_attribute("aria-disabled", "true")
    for count in range(2, MOST_MODES + 1):
        page.click("#add-mode")
        expect(page.locator(".modes tbody tr")).to_have_count(count)
        if count == 3:
            break
    for count in range(2, 5):
        page.click("#add-design")
        expect(page.locator('.tabs [role="tab"]')).to_have_count(count)
    expect(page.locator("#add-design")).to_have_attribute("aria-disabled", "true")
    expect(page.locator("#numbers thead th")).to_have_count(5)
    page.click("#remove-design")
    expect(page.locator("#numbers thead th")).to_have_count(4)
    page.keyboard.press("Control+z")
    expect(page.locator("#numbers thead th")).to_have_count(5)


def _packed(data: object) -> str:
    return base64.urlsafe_b64encode(zlib.compress(json.dumps(data).encode(), 9)).rstrip(b"=").decode()
