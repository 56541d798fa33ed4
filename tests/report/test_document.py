"""Both renderers say all that a document says, whatever stands in it, and need nothing from outside."""

from __future__ import annotations

import json
import re
import zlib
from functools import cache
from html.parser import HTMLParser
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.report.pdf_text import pdf_pages

import preshape
from preshape import Modes, design
from preshape.errors import InputError
from preshape.export import paste_ready
from preshape.plant import from_matrices
from preshape.report import (
    Document,
    GivenJob,
    Heading,
    Paragraph,
    Picture,
    Record,
    Table,
    TextTable,
    Verbatim,
    as_html,
    as_pdf,
    as_svg,
    printable,
    report_format,
)
from preshape.report.figures import new_figure, tidy
from preshape.workflow import design_report, simulate_plant
from preshape.workflow.simulate import simulate_move

EVIL = (
    '<script>alert("x")</script>',
    '#import "@preview/cetz:0.2.0"',
    '"); #panic("out")',
    "$x^2$ *bold* _it_ `raw` \\u{41} @label <label> // comment /* c */",
    "</script><img src=x onerror=alert(1)>",
    '" onload="alert(1)',
    "]]></svg>&amp;&#60;",
)
VOID = {"meta", "br", "path", "use", "image", "rect"}


@cache
def drawn() -> str:
    figure = new_figure(3.0, 2.0)
    tidy(figure.add_subplot(), "x [s]", "y [m]", "title")
    return as_svg(figure)


def with_text(text: str) -> Document:
    """A document in which a text stands everywhere."""
    record = Record(
        job=GivenJob(), command_line=text, made="2026-01-02T03:04:05Z", versions={"preshape": text}, inputs=(),
        shaper=design.zv((1.0, 0.0)).to_dict(),
    )  # fmt: skip
    table = Table(TextTable(((text,), ("number [m]",)), ((text, "1"),)), ("chosen",))
    parts = (Heading(text), Paragraph(text, "lead"), Paragraph(text, "warning"), table, Verbatim(text))
    return Document(text, text, (*parts, Picture(drawn(), text)), text, record)


class Page(HTMLParser):
    """Collects tags, attributes and text, and fails when tags are not closed in order."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str, str | None]] = []
        self.text: list[str] = []
        self.data = ""
        self.feed(page)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += [(tag, name, value) for name, value in attrs]
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in VOID:
            assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        if self.open and self.open[-1] == "script":
            self.data += data
        else:
            self.text.append(data)


@pytest.mark.parametrize("text", EVIL)
def test_no_text_becomes_markup_of_a_page(text: str) -> None:
    plain, page = Page(as_html(with_text("plain"))), Page(as_html(with_text(text)))
    assert page.tags == plain.tags and len(page.attributes) == len(plain.attributes)
    assert page.text.count(text) == plain.text.count("plain") >= 7
    assert json.loads(page.data)["command_line"] == text


@pytest.mark.parametrize("text", EVIL)
def test_no_text_becomes_markup_of_a_sheet(text: str) -> None:
    bare = re.sub(r"\s", "", text)
    found = "".join(pdf_pages(as_pdf(with_text(text))))
    assert found.count(bare) == "".join(pdf_pages(as_pdf(with_text("plain")))).count("plain") >= 7


@given(st.text(max_size=60))
def test_any_text_at_all_can_stand_on_a_page(text: str) -> None:
    page = Page(as_html(with_text(text)))
    assert json.loads(page.data)["versions"] == {"preshape": text}


def test_what_cannot_be_shown_is_replaced() -> None:
    assert printable("a\x00b\u202ec\udcffd\ne\tf\x1b[2J") == "a�b�c�d\ne\tf�[2J"
    assert printable("naïve 漢字 1 µm²") == "naïve 漢字 1 µm²"


@pytest.fixture(scope="module")
def report() -> Document:
    modes = [(47.3, 0.05), (79.0, 0.02)]
    shaper = design.direct(modes)
    return design_report(modes, shaper, exports=[*paste_ready(shaper), ("my own", "PLC 1\n  PLC 2")])


def test_a_page_loads_nothing_and_runs_nothing(report: Document) -> None:
    page = Page(as_html(report))
    assert set(page.tags) & {"link", "iframe", "img", "object", "embed", "base", "form", "a"} == set()
    assert page.tags.count("script") == 1
    assert [value for tag, name, value in page.attributes if tag == "script" and name == "type"] == [
        "application/vnd.preshape.report+json"
    ]
    for tag, name, value in page.attributes:
        if name in ("src", "href", "xlink:href", "action", "data"):
            assert tag in ("use", "image") and str(value).startswith("#"), (tag, name, value)
        assert not name.startswith("on")
        assert not re.search(r"url\((?!#)", str(value))
    assert not re.search(r"@import|url\((?!#)", as_html(report))


def test_page_and_sheets_hold_modes_shaper_and_settings(report: Document) -> None:
    page, sheets = "".join(Page(as_html(report)).text), pdf_pages(as_pdf(report))
    assert len(sheets) >= 2
    together = "".join(sheets)
    shaper = report.record.found()
    for text in ("47.3 Hz, damping 0.05", "79 Hz, damping 0.02", "PLC 2", f"{shaper.amplitudes[1]:.6f}", "Robustness"):
        assert text in page and text.replace(" ", "") in together
    for one in paste_ready(shaper):
        assert one.text in page and re.sub(r"\s", "", one.text) in together


def test_the_same_document_gives_the_same_files(report: Document) -> None:
    assert as_html(report) == as_html(report)
    assert as_pdf(report) == as_pdf(report)


def test_the_sheets_are_dated_by_the_record_and_draw_vectors(report: Document) -> None:
    pdf = as_pdf(report)
    assert report.record.made.translate({ord(one): None for one in "-T:Z"}).encode() in pdf
    assert b"/Subtype/Image" not in pdf  # no figure became pixels
    assert b"/Type/EmbeddedFile" in pdf


def test_the_date_can_be_set_from_outside(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    shaper = design.zv((2.0, 0.0))
    assert design_report((2.0, 0.0), shaper).record.made == "1970-01-02T00:00:00Z"
    for wrong in ("yesterday", "-1", "1e3", "9" * 30):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", wrong)
        with pytest.raises(InputError, match="SOURCE_DATE_EPOCH"):
            design_report((2.0, 0.0), shaper)


def test_without_typst_the_refusal_says_what_to_install(report: Document, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("preshape.report.pdf.find_spec", lambda name: None)
    for call in (lambda: as_pdf(report), lambda: report_format("report.pdf")):
        with pytest.raises(InputError, match=r"preshape\[pdf\]"):
            call()
    assert report_format("report.html") == "html"
    with pytest.raises(InputError, match="html or .pdf"):
        report_format("report.doc")


@given(
    st.lists(st.tuples(st.floats(1.0, 100.0), st.floats(0.0, 0.3)), min_size=1, max_size=3, unique_by=lambda m: m[0]),
    st.sampled_from(["zv", "zvd", "mzv", "um_zv"]),
)
def test_formula_and_simulation_of_the_move_agree(modes: list[tuple[float, float]], family: str) -> None:
    """Two roads: the residual vibration from the impulses alone, and the exact motion of the modes under the move."""
    wanted = Modes(modes)
    move = simulate_move(design.FAMILIES[family](modes[:1]), wanted, [1.0] * len(wanted))
    moved = ~np.isnan(move.simulated)
    assert moved.any()
    assert np.abs(move.simulated - move.predicted)[moved].max() < 1e-9


def test_a_report_says_when_formula_and_simulation_do_not_agree(monkeypatch: pytest.MonkeyPatch) -> None:
    shaper = design.zv((2.0, 0.0))
    agreed = as_html(design_report((2.0, 0.0), shaper))
    monkeypatch.setattr("preshape.workflow.simulate.residual_vibration", lambda *_: np.full((1, 3), 0.25))
    assert "The two agree" in agreed and "trust neither" not in agreed
    assert "trust neither" in as_html(design_report((2.0, 0.0), shaper))


def test_a_simulated_machine_is_shown_with_its_numbers() -> None:
    plant = from_matrices([[1.0]], 0.0, [[400.0]], input=[400.0], outputs={"load": 0}, input_name="position")
    shaper = design.zv(plant.modes())
    result = simulate_plant(plant, [1.0], 0.001, shaper)
    page = "".join(
        Page(as_html(design_report(plant.modes(), shaper, simulation=result, remarks=["Mind the gap."]))).text
    )
    assert "The machine, simulated" in page and "Mind the gap." in page
    assert f"{result.motions['load'][0].residual:.3g}" in page


def test_a_machine_of_many_modes_has_a_report_too() -> None:
    """Convolved, ZVD for twenty modes would have 3^20 impulses: nothing is designed only to be compared with."""
    modes = [(1.0 + 0.7 * k, 0.01) for k in range(20)]
    page = "".join(Page(as_html(design_report(modes, design.zvd(modes[0])))).text)
    assert all(f"{frequency:.4g} Hz, damping 0.01" in page for frequency, _ in modes)
    assert "Shapers for these modes" not in page


def test_negative_impulses_and_boxes_are_drawn_inside_the_figure() -> None:
    from preshape.report.panels import impulses_panel

    for shaper in (design.um_zv((5.0, 0.0)), design.sd_zv((5.0, 0.0), deflection_ratio=0.4, form="box")):
        axes = new_figure(4.0, 3.0).add_subplot()
        impulses_panel(axes, shaper)
        low, high = axes.get_ylim()
        sizes: list[Any] = [*shaper.amplitudes, *[box.mass for box in shaper.boxes]]
        assert low <= min(sizes) and high > max(sizes)


def test_packed_inputs_are_real_compression() -> None:
    from preshape.workflow.record import recorded_files

    (one,) = recorded_files([preshape.__file__])
    assert one.packed is not None and len(zlib.decompress(one.packed)) == one.size > len(one.packed)
