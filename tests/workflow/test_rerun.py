"""A report reproduces itself, and notices when it was changed, cut, or blown up."""

from __future__ import annotations

import base64
import json
import re
import tracemalloc
import zlib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from preshape import Shaper, design
from preshape.cli.main import main
from preshape.errors import InputError
from preshape.report import as_html, read_record
from preshape.report.html import RECORD_TYPE
from preshape.workflow import calibrate, design_report, rerun, save_calibration
from preshape.workflow import record as recording

NAME = "<script>alert(1)<-script> #import 'x' \"q\" $1.csv"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A saved calibration of a swinging load, from a file whose name is a trap."""
    times = np.arange(0.0, 40.0, 0.05)
    wave = np.exp(-0.02 * 2 * np.pi * 0.3 * times) * np.cos(2 * np.pi * 0.3 * times)
    wave += 0.002 * np.random.default_rng(1).normal(size=times.size)
    place = tmp_path_factory.mktemp("report")
    source = place / NAME
    source.write_text("time,sway [m]\n" + "\n".join(f"{t:.2f},{x:.5f}" for t, x in zip(times, wave, strict=True)))
    save_calibration(calibrate(source, tolerance=0.04), place / "out", command_line="preshape calibrate ...")
    source.unlink()  # what follows may use nothing but the report
    return place / "out"


def changed(folder: Path, to: Path, change: Callable[[dict[str, Any]], None]) -> Path:
    """The page with its record changed, as a forger would."""
    page = (folder / "report.html").read_text()
    opening = f'<script type="{RECORD_TYPE}">'
    start = page.index(opening) + len(opening)
    end = page.index("</script>", start)
    record = json.loads(page[start:end])
    change(record)
    path = to / "changed.html"
    path.write_text(page[:start] + json.dumps(record).replace("<", "\\u003c") + page[end:])
    return path


@pytest.mark.parametrize("kind", ["html", "pdf"])
def test_a_calibration_comes_out_of_its_report_bit_for_bit(folder: Path, tmp_path: Path, kind: str) -> None:
    result = rerun(folder / f"report.{kind}", tmp_path / "again")
    assert result.identical and result.page is True and result.difference == (0.0, 0.0) and result.versions == ()
    assert Shaper.load(tmp_path / "again" / "shaper.json") == Shaper.load(folder / "shaper.json")
    assert (tmp_path / "again" / "calibration.svg").read_bytes() == (folder / "calibration.svg").read_bytes()
    (inside,) = (tmp_path / "again" / "inputs" / "1").iterdir()
    assert inside.name == NAME
    assert rerun(tmp_path / "again" / "report.html", tmp_path / "third").identical  # and so on


@pytest.mark.parametrize(
    ("kind", "options"),
    [
        ("html", ["--family", "direct", "--mode", "0.2", "--mode", "0.26:0.01"]),
        ("pdf", ["--family", "mesh", "--mode", "1:0.02", "--dt", "0.05"]),
        ("html", ["--family", "convolved", "--base", "ei", "--tolerance", "0.1", "--mode", "30:0.05", "--mode", "55"]),
        ("html", ["--family", "zvd", "--mode", "4", "--dt", "0.001"]),
        ("pdf", ["--family", "sd_zv", "--mode", "5", "--deflection-ratio", "0.4", "--form", "box"]),
        ("html", ["--family", "si", "--band", "0.9:1.1:0:0.02", "--tolerance", "0.05"]),
        ("html", ["--family", "ei", "--band", "4:6"]),
    ],
)
def test_a_design_comes_out_of_its_report_bit_for_bit(
    kind: str, options: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    report, saved = tmp_path / f"report.{kind}", tmp_path / "shaper.json"
    with pytest.raises(SystemExit) as stop:
        main(["design", *options, "--json", str(saved), "--report", str(report)])
    assert stop.value.code == 0
    assert read_record(report)[0].command_line.startswith(f"preshape design --family {options[1]} ")
    with pytest.raises(SystemExit) as stop:
        main(["rerun", str(report), "--out", str(tmp_path / "again")])
    out = capsys.readouterr().out
    assert stop.value.code == 0, out
    assert "identical to the last bit" in out and "byte for byte" in out
    assert Shaper.load(tmp_path / "again" / "shaper.json") == Shaper.load(saved)


def test_a_shaper_that_was_handed_over_is_given_back(tmp_path: Path) -> None:
    shaper = design.zvd((3.0, 0.01))
    (tmp_path / "report.html").write_text(as_html(design_report((3.0, 0.01), shaper)))
    result = rerun(tmp_path / "report.html", tmp_path / "again")
    assert result.identical and result.page is None
    assert Shaper.load(tmp_path / "again" / "shaper.json") == shaper


def shifted(record: dict[str, Any]) -> None:
    record["shaper"]["amplitudes"][0] += 1e-3
    record["shaper"]["amplitudes"][1] -= 1e-3


def test_a_changed_shaper_is_noticed_and_told_by_how_much(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = changed(folder, tmp_path, shifted)
    result = rerun(path, tmp_path / "again")
    assert not result.identical and result.difference == (0.0, pytest.approx(1e-3))
    with pytest.raises(SystemExit) as stop:
        main(["rerun", str(path), "--out", str(tmp_path / "again")])
    assert stop.value.code == 1 and "amplitudes by up to 0.001" in capsys.readouterr().out


def test_a_changed_text_of_the_page_is_noticed(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    page = (folder / "report.html").read_text()
    path = tmp_path / "changed.html"
    path.write_text(page.replace("<h1>Use ", "<h1>Never use ", 1))
    with pytest.raises(SystemExit) as stop:
        main(["rerun", str(path), "--out", str(tmp_path / "again")])
    out = capsys.readouterr().out
    assert stop.value.code == 1 and "identical to the last bit" in out and "it was changed" in out


def test_other_versions_are_named(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = changed(folder, tmp_path, lambda record: record["versions"].update(numpy="1.0"))
    with pytest.raises(SystemExit) as stop:
        main(["rerun", str(path), "--out", str(tmp_path / "again")])
    assert stop.value.code == 0
    out = capsys.readouterr().out
    assert f"numpy: 1.0 then, {np.__version__} now" in out and "cannot be told" in out


def packed(content: bytes) -> str:
    return base64.b64encode(zlib.compress(content, 9)).decode()


FORGERIES: dict[str, tuple[Callable[[dict[str, Any]], None], str]] = {
    "other bytes": (
        lambda r: r["inputs"][0].update(packed=packed(b"x" * r["inputs"][0]["size"])),
        "does not have the SHA-256",
    ),
    "more bytes": (lambda r: r["inputs"][0].update(packed=packed(b"x" * 10**6)), "does not have the .* bytes"),
    "fewer bytes": (lambda r: r["inputs"][0].update(packed=packed(b"x")), "does not have the .* bytes"),
    "no zlib": (lambda r: r["inputs"][0].update(packed="AAAA"), "damaged"),
    "no base64": (lambda r: r["inputs"][0].update(packed="%%%"), "damaged or was changed"),
    "huge size": (lambda r: r["inputs"][0].update(size=10**12), "was changed"),
    "negative size": (lambda r: r["inputs"][0].update(size=-1), "was changed"),
    "way out": (lambda r: r["inputs"][0].update(name="../../escaped.csv"), "was changed"),
    "absolute": (lambda r: r["inputs"][0].update(name="/etc/escaped.csv"), "was changed"),
    "dots": (lambda r: r["inputs"][0].update(name=".."), "was changed"),
    "no digest": (lambda r: r["inputs"][0].update(sha256="no"), "was changed"),
    "another job": (lambda r: r["job"].update(job="shell"), "damaged or was changed"),
    "another option": (lambda r: r["job"].update(command="rm -rf"), "damaged or was changed"),
    "text for a number": (lambda r: r["job"].update(tolerance="__import__('os')"), "damaged or was changed"),
    "tolerance": (lambda r: r["job"].update(tolerance=7.0), r"outside \(0, 1\)"),
    "no day": (lambda r: r.update(made="2026-02-31T00:00:00Z"), "record was changed"),
    "letters that move the screen": (lambda r: r["inputs"][0].update(name="\x1b[2J.csv"), "was changed"),
    "no date": (lambda r: r.update(made="today"), "record was changed"),
    "another schema": (lambda r: r.update(schema="preshape/report/9"), "preshape/report/9"),
    "no shaper": (lambda r: r.update(shaper={"times": [0.0]}), "schema None"),
}


@pytest.mark.parametrize("name", FORGERIES)
def test_a_forged_record_is_refused_before_anything_is_written(name: str, folder: Path, tmp_path: Path) -> None:
    change, sentence = FORGERIES[name]
    path = changed(folder, tmp_path, change)
    with pytest.raises(InputError, match=sentence):
        rerun(path, tmp_path / "again")
    assert not (tmp_path / "again").exists() and not (tmp_path.parent / "escaped.csv").exists()


def test_a_bomb_takes_no_more_memory_than_its_word_allows(folder: Path, tmp_path: Path) -> None:
    """200 MB of zeros are 200 kB in a page that says that they are a thousand bytes."""
    bomb = packed(bytes(200_000_000))
    path = changed(folder, tmp_path, lambda r: r["inputs"][0].update(packed=bomb, size=1000))
    tracemalloc.start()
    with pytest.raises(InputError, match="1000 bytes"):
        rerun(path, tmp_path / "again")
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 20_000_000


def test_a_bomb_in_the_attachment_of_a_pdf_is_not_unpacked(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("preshape.report.record_file.LARGEST_RECORD", 1_000)
    with pytest.raises(InputError, match="larger than any"):
        rerun(folder / "report.pdf", tmp_path / "again")


@pytest.mark.parametrize("kind", ["html", "pdf"])
def test_a_truncated_report_is_refused_wherever_it_ends(folder: Path, tmp_path: Path, kind: str) -> None:
    whole = (folder / f"report.{kind}").read_bytes()
    path = tmp_path / f"cut.{kind}"
    for part in (0.0, 0.001, 0.3, 0.9, 0.99, 1.0 - 12.0 / len(whole)):
        path.write_bytes(whole[: int(part * len(whole))])
        with pytest.raises(InputError, match="truncated|holds no record"):
            rerun(path, tmp_path / "again")
    assert not (tmp_path / "again").exists()


def test_what_is_no_report_is_refused(folder: Path, tmp_path: Path) -> None:
    (tmp_path / "page.html").write_text("<html><body>hello</body></html>")
    (tmp_path / "empty.html").write_bytes(b"")
    (tmp_path / "other.pdf").write_bytes(b"%PDF-1.7\n%%EOF\n")
    page = (folder / "report.html").read_bytes()
    (tmp_path / "double.html").write_bytes(page + page)
    for name in ("page.html", "empty.html", "other.pdf", "double.html", "missing.html", "."):
        with pytest.raises(InputError):
            rerun(tmp_path / name, tmp_path / "again")


def test_an_input_too_large_to_travel_is_named_beside_the_report(
    folder: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    original, _ = read_record(folder / "report.html")
    source = tmp_path / "long.csv"
    source.write_bytes(zlib.decompress(original.inputs[0].packed or b""))
    monkeypatch.setattr(recording, "LARGEST_PACKED", 100)
    saved = save_calibration(calibrate(source, tolerance=0.04), tmp_path / "out", pdf=False)
    assert saved.pdf is None
    page = saved.report.read_text()
    assert "too large to travel" in page and original.inputs[0].sha256 in page
    with pytest.raises(InputError, match="--input"):
        rerun(saved.report, tmp_path / "again")
    other = tmp_path / "other.csv"
    other.write_text("time,x\n")
    with pytest.raises(InputError, match="--input"):
        rerun(saved.report, tmp_path / "again", inputs=[other])
    assert rerun(saved.report, tmp_path / "again", inputs=[other, source]).identical


def test_files_of_one_name_stay_apart(folder: Path, tmp_path: Path) -> None:
    original, _ = read_record(folder / "report.html")
    content = zlib.decompress(original.inputs[0].packed or b"")
    for place in ("a", "b"):
        (tmp_path / place).mkdir()
        (tmp_path / place / "same.csv").write_bytes(content + (b"\n" if place == "b" else b""))
    saved = save_calibration(calibrate([tmp_path / "a" / "same.csv", tmp_path / "b" / "same.csv"]), tmp_path / "out")
    result = rerun(saved.report, tmp_path / "again")
    assert result.identical and result.page
    assert (tmp_path / "again" / "inputs" / "2" / "same.csv").read_bytes() == content + b"\n"


def test_names_that_no_page_can_show_are_shown_safely(folder: Path, tmp_path: Path) -> None:
    original, _ = read_record(folder / "report.html")
    source = tmp_path / "a\nb\u202e\udcff\\c.csv"
    source.write_bytes(zlib.decompress(original.inputs[0].packed or b""))
    saved = save_calibration(calibrate(source), tmp_path / "out")
    assert "a�b���c.csv" in re.sub(r"<script.*</script>", "", saved.report.read_text())
    result = rerun(saved.report, tmp_path / "again")
    assert result.identical and result.page
