"""Every paper is recomputed, every difference explained, every figure drawn; a wrong value turns the exit code to 1."""

from __future__ import annotations

import re
from html.parser import HTMLParser
from importlib.util import find_spec, module_from_spec, spec_from_file_location
from pathlib import Path
from xml.etree import ElementTree

import pytest

from preshape import Shaper, design
from preshape.cli.main import main
from preshape.papers import (
    PAPERS,
    Because,
    Paper,
    Reproduction,
    Row,
    beyond,
    claim,
    number,
    paper_list,
    papers_named,
    reproduction_page,
    save_reproductions,
)
from preshape.papers.reproduction import VERDICTS
from preshape.report import as_svg

NAMES = [paper.name for paper in PAPERS]
HYDE_5, HYDE_6 = (29, ["6.1", "6.2-sweep", "6.2-mace"]) if find_spec("exudyn") else (6, ["6.2-sweep"])
VOID = {"meta", "img", "br"}


@pytest.fixture(scope="module")
def reproductions() -> dict[str, Reproduction]:
    return {paper.name: paper.reproduce() for paper in PAPERS}


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as stop:
        main(["reproduce", *arguments])
    captured = capsys.readouterr()
    return int(stop.value.code or 0), captured.out, captured.err


def test_the_list_holds_the_five_papers() -> None:
    assert NAMES == ["hyde", "singer", "singh", "slides", "robertson"]
    assert papers_named() == list(PAPERS)
    assert [paper.name for paper in papers_named(["singh", "hyde", "singh"])] == ["hyde", "singh"]


@pytest.mark.parametrize("name", NAMES)
def test_every_difference_is_explained(name: str, reproductions: dict[str, Reproduction]) -> None:
    done = reproductions[name]
    unexplained = [(row.source, row.what, row.printed, row.computed) for row in done.rows if not row.explained]
    assert unexplained == []
    assert done.explained
    for row in done.rows:
        assert row.verdict in VERDICTS
        assert row.source and row.what and row.printed and row.computed
        assert "nan" not in row.computed and "inf" not in row.computed.split()
    assert sum(done.count(verdict) for verdict in VERDICTS) == len(done.rows)


PRINTED_NUMBER = re.compile(r"\d+(?:\.(\d+))?(?:e([-+]\d+))?")


def same_but_for_rounding(ours: str, theirs: str) -> bool:
    """The same words, and numbers that differ by one in their last digit at most: another processor may round it so."""
    if PRINTED_NUMBER.sub("#", ours) != PRINTED_NUMBER.sub("#", theirs):
        return False
    return all(
        abs(float(a.group()) - float(b.group())) <= 1.001 * 10.0 ** (int(b.group(2) or 0) - len(b.group(1) or ""))
        for a, b in zip(PRINTED_NUMBER.finditer(ours), PRINTED_NUMBER.finditer(theirs), strict=True)
    )


@pytest.mark.skipif(not find_spec("exudyn"), reason="the tables have the rows of the non-linear MACE")
@pytest.mark.parametrize("name", NAMES)
def test_the_theory_pages_show_these_very_rows(name: str, reproductions: dict[str, Reproduction]) -> None:
    docs = Path(__file__).resolve().parents[2] / "docs"
    spec = spec_from_file_location("make_numbers", docs / "figures" / "make_numbers.py")
    assert spec is not None and spec.loader is not None
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    shown = (docs / "theory" / "numbers" / f"{name}.md").read_text().splitlines()
    now = module.tables(reproductions[name]).splitlines()
    different = [pair for pair in zip(now, shown, strict=True) if not same_but_for_rounding(*pair)]
    assert different == [], "run `make figures`"
    assert f"{{include}} numbers/{name}.md" in (docs / "theory" / f"{name}.md").read_text()


def test_a_number_that_has_changed_is_seen() -> None:
    assert same_but_for_rounding("| 1.35 mm, 2.0e-03 |", "| 1.36 mm, 2.1e-03 |")
    assert not same_but_for_rounding("| 1.35 mm |", "| 1.37 mm |")
    assert not same_but_for_rounding("| 2.0e-03 |", "| 2.2e-03 |")
    assert not same_but_for_rounding("| 1.35 mm |", "| 1.35 s |")


@pytest.mark.parametrize("name", NAMES)
def test_no_statement_is_made_twice(name: str, reproductions: dict[str, Reproduction]) -> None:
    statements = [(row.source, row.what) for row in reproductions[name].rows]
    assert len(set(statements)) == len(statements)


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("hyde", [*(f"{c}.{i}" for c, last in ((2, 15), (3, 19), (5, HYDE_5)) for i in range(1, last + 1)), *HYDE_6]),
        ("singer", [*(str(i) for i in range(1, 11)), "12", "12-moves"]),
        ("singh", [str(i) for i in range(1, 16)]),
        ("slides", [str(i) for i in range(1, 12)]),
        ("robertson", ["2", *(str(i) for i in range(5, 19))]),
    ],
)
def test_every_figure_is_drawn_with_units_and_nothing_cut_off(
    name: str, expected: list[str], reproductions: dict[str, Reproduction]
) -> None:
    figures = reproductions[name].figures
    assert [figure.number for figure in figures] == expected
    for figure in figures:
        drawing = figure.draw()
        assert ElementTree.fromstring(as_svg(drawing)).tag.endswith("svg")
        drawing.draw_without_rendering()
        lowest = [axes for axes in drawing.axes if axes.get_xlabel()]
        assert lowest and all(re.search(r"\[(Hz|s|m|-|%)\]", axes.get_xlabel()) for axes in lowest), figure.number
        for axes in drawing.axes:
            assert axes.get_ylabel() or not axes.get_yticks().size
            assert axes.get_title(loc="left")
            for text in filter(lambda t: t.get_text(), [axes.xaxis.label, axes.yaxis.label, *axes.texts]):
                box = text.get_window_extent()
                assert box.x0 >= -1 and box.x1 <= drawing.bbox.width + 1, (figure.number, text.get_text())
                assert box.y0 >= -1 and box.y1 <= drawing.bbox.height + 1, (figure.number, text.get_text())
            title = axes.get_title(loc="left")
            assert len(title) < 72, title


@pytest.mark.parametrize(
    ("broken", "paper"),
    [
        ("zvd", "singer"),  # a wrong closed form
        ("direct", "hyde"),  # a direct solution that is not the shortest
        ("antiperiod", "singh"),
    ],
)
def test_a_regression_in_the_library_is_a_difference_that_nothing_explains(
    broken: str, paper: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    direct, antiperiod = design.direct, design.antiperiod
    wrong = {
        "zvd": lambda modes: design.zv(modes),
        "direct": lambda modes, order=1: Shaper(*_stretched(direct(modes, order))),
        "antiperiod": lambda modes, impulses="exact": Shaper(*_stretched(antiperiod(modes, impulses=impulses))),
    }
    monkeypatch.setattr(design, broken, wrong[broken])
    assert not papers_named([paper])[0].reproduce().explained


def _stretched(shaper: Shaper) -> tuple[object, object]:
    return 1.001 * shaper.times, shaper.amplitudes


def test_a_number_is_compared_at_the_printed_digits() -> None:
    assert number("s", "w", "12.76 s", 12.7649).verdict == "reproduced"
    assert number("s", "w", "12.76 s", 12.7551).verdict == "reproduced"
    assert number("s", "w", "12.76 s", 12.7653).verdict == "differs"
    assert number("s", "w", "about 20 %", 20.4).verdict == "reproduced"
    assert number("s", "w", "about 20 %", 19.4, within=1.0).verdict == "reproduced"
    assert number("s", "w", "-3", -2.4).verdict == "differs"
    assert number("s", "w", "1.1 s", 1.10001, "s").computed == "1.100 s"


def test_a_reason_that_the_numbers_do_not_bear_out_explains_nothing() -> None:
    kept = number("s", "w", "2", 3.0, because=Because("known", True))
    lost = number("s", "w", "2", 3.0, because=Because("known", False))
    assert (kept.verdict, kept.explanation, kept.explained) == ("differs", "known", True)
    assert (lost.verdict, lost.explanation, lost.explained) == ("differs", "", False)
    assert not claim("s", "w", "p", "c", False).explained
    assert claim("s", "w", "p", "c", True, because=Because("known", True)).explanation == ""
    assert beyond("s", "w", "c", True).verdict == "beyond the paper"
    assert not beyond("s", "w", "c", False, note="a note is no reason").explained
    assert not Row("s", "w", "p", "c", "differs", "  ").explained


def test_one_paper_on_the_terminal(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, _ = run(capsys, "singer")
    assert code == 0
    assert "printed" in out and "computed" in out and "verdict" in out
    assert "every difference explained" in out
    assert "--out" in out
    assert list(tmp_path.iterdir()) == []


def test_the_table_is_readable_at_eighty_columns(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("preshape.cli.screens.FULL_WIDTH", 80)
    _, out, _ = run(capsys, "singh")
    assert max(len(line.rstrip()) for line in out.splitlines()) <= 80
    assert "fig. 11-13" in out and "beyond the" in out


def test_figures_and_page_in_a_folder(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    code, out, _ = run(capsys, "slides", "--out")
    assert code == 0 and "reproduction-slides" in out
    folder = tmp_path / "reproduction-slides"
    assert sorted(path.name for path in folder.iterdir()) == sorted(
        ["index.html", *(f"slides-{i}.svg" for i in range(1, 12))]
    )
    code, out, _ = run(capsys, "slides", "--out", "elsewhere")
    assert code == 0
    for path in folder.iterdir():
        assert path.read_bytes() == (tmp_path / "elsewhere" / path.name).read_bytes(), "the same every time"


def test_an_unknown_paper_is_one_sentence_that_lists_them(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run(capsys, "singer", "newton")
    assert code == 2 and out == ""
    assert err.count("\n") == 1 and "'newton'" in err
    assert all(name in err for name in NAMES)


def test_a_folder_that_cannot_be_made_is_refused(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    (tmp_path / "taken").write_text("a file")
    code, _, err = run(capsys, "slides", "--out", str(tmp_path / "taken"))
    assert code == 2 and "--out" in err
    assert (tmp_path / "taken").read_text() == "a file"


def test_a_wrong_row_turns_the_exit_code_to_1(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    rows = [claim("(1)", "right", "1", "1", True), number("(2)", "deliberately wrong", "2.00 s", 2.5, "s")]
    wrong = Paper("wrong", "<b>A paper & more</b>", lambda: (rows, []))
    monkeypatch.setattr(paper_list, "PAPERS", (wrong,))
    code, out, err = run(capsys, "--out", str(tmp_path / "out"))
    assert code == 1
    assert "NOT EXPLAINED" in out and "1 difference" in err
    assert "unexplained" in (tmp_path / "out" / "index.html").read_text()
    rows[1] = number("(2)", "wrong", "2.00 s", 2.5, "s", because=Because("a misprint", True))
    code, out, _ = run(capsys)
    assert code == 0 and "a misprint" in out


class Balanced(HTMLParser):
    """Fails when tags are not closed in order; keeps what images show."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.images: list[str | None] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        if tag == "img":
            self.images.append(dict(attrs)["src"])
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        if tag not in VOID:
            assert self.open.pop() == tag


def test_the_page_is_well_formed_and_shows_the_files_beside_it(
    reproductions: dict[str, Reproduction], tmp_path: Path
) -> None:
    page = save_reproductions([reproductions["slides"]], tmp_path)
    parser = Balanced()
    parser.feed(page.read_text())
    parser.close()
    assert parser.open == []
    assert len(parser.images) == len(reproductions["slides"].figures)
    assert all(name and (tmp_path / name).is_file() for name in parser.images)


def test_the_page_escapes_what_papers_say() -> None:
    row = Row("<i>", "a < b & c", '"p"', "<script>", "differs", "because <b>")
    page = reproduction_page([Reproduction("x", "<T>", (row,), ())], "<1>")
    assert "<script>" not in page and "<T>" not in page and "<b>" not in page and "<1>" not in page
    assert "a &lt; b &amp; c" in page
