"""`preshape compare`, run as a user runs it: the screen, files, exit codes."""

from __future__ import annotations

import importlib
import json
from pathlib import Path

import pytest

from preshape.cli.main import main
from preshape.workflow import compare

MOVE = ["compare", "--mode", "1.2:0.01", "--distance", "0.5", "--maximum-speed", "1", "--maximum-acceleration", "5"]


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as stop:
        main(list(arguments))
    captured = capsys.readouterr()
    return int(stop.value.code or 0), captured.out, captured.err


def test_the_screen_says_the_point_first_and_what_is_left_out(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run(capsys, *MOVE)
    assert code == 0 and err == ""
    lines = out.splitlines()
    assert lines[0] == "0.5 m within 1 m/s, 5 m/s², carrying 1.2 Hz, damping 0.01"
    assert lines[1].startswith("First to settle: trapezoid + ZV, 1.117 s; with frequencies off by ±10 %")
    assert lines[2].startswith("First within 1.76 mm wherever the frequencies are within ±10 %: band-limited pulse")
    assert "Left out" in out and "posicast: it is a position in two steps" in out
    rows = [line for line in lines if line.startswith("trapezoid + ZV ")]
    assert rows[0].split()[3:6] == ["1.117", "1.117", "0"]


def test_numbers_as_json_are_those_of_python(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run(capsys, *MOVE, "--json", "-")
    assert code == 0 and err == ""
    data = json.loads(out)
    expected = compare((1.2, 0.01), 0.5, maximum_speed=1.0, maximum_acceleration=5.0)
    assert data == json.loads(json.dumps(expected.to_dict()))
    file = tmp_path / "comparison.json"
    code, out, _ = run(capsys, *MOVE, "--json", str(file))
    assert code == 0 and json.loads(file.read_text()) == data and f"Numbers: {file}" in out


@pytest.mark.parametrize(("kind", "head"), [("svg", b"<svg"), ("png", b"\x89PNG"), ("pdf", b"%PDF")])
def test_the_figure_is_of_the_kind_that_its_name_says(
    kind: str, head: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / f"figure.{kind}"
    code, out, _ = run(capsys, *MOVE, "--out", str(file))
    assert code == 0 and f"Figure: {file}" in out
    first = file.read_bytes()
    assert first.startswith(head)
    if kind == "svg":
        run(capsys, *MOVE, "--out", str(file))
        assert file.read_bytes() == first
        assert b"band-limited pulse" in first


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["compare"], "Missing option"),
        (["compare", "--distance", "0.5", "--maximum-acceleration", "5"], "no mode was given"),
        ([*MOVE, "--maximum-speed", "0"], "maximum_speed is 0 m/s"),
        ([*MOVE, "--distance", "0"], "distance is 0 m"),
        ([*MOVE, "--distance", "far"], "not a valid float"),
        ([*MOVE, "--maximum-jerk", "-1"], "maximum_jerk is -1"),
        ([*MOVE, "--mode", "0"], "above 0 Hz"),
        ([*MOVE, "--gain", "1", "--gain", "2"], "gains have shape"),
        ([*MOVE, "--tolerance", "2"], "outside (0, 1)"),
        ([*MOVE, "--frequency-error", "0.7"], "below 0.5"),
        ([*MOVE, "--out", "figure.gif"], "end it in .svg, .png or .pdf"),
        ([*MOVE, "--out", "/nowhere/figure.svg"], "cannot write"),
        ([*MOVE, "--json", "/nowhere/x.json"], "cannot write"),
    ],
)
def test_wrong_input_is_one_sentence_and_exit_code_2(
    arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = run(capsys, *arguments)
    assert code == 2 and sentence in err and out == "" and "Traceback" not in err


def test_an_interruption_leaves_no_file(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(importlib.import_module("preshape.report"), "comparison_figure", interrupted)
    code, _, err = run(capsys, *MOVE, "--out", str(tmp_path / "figure.svg"), "--json", str(tmp_path / "x.json"))
    assert code == 130 and "Interrupted" in err and list(tmp_path.iterdir()) == []


def test_units_gains_and_window_reach_the_comparison(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(
        capsys, "compare", "--mode", "1.2:0.01", "--mode", "3.4", "--gain", "1", "--gain", "-0.5", "--distance", "500",
        "--maximum-acceleration", "5000", "--unit", "mm", "--within", "0.1", "--frequency-error", "0.05", "--json", "-",
    )  # fmt: skip
    data = json.loads(out)
    assert code == 0 and data["unit"] == "mm" and data["within"] == 0.1 and data["gains"] == [1.0, -0.5]
    assert data["frequency_ratios"][0] == pytest.approx(0.9) and data["maximum_speed"] is None


def test_help_shows_an_example(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, "compare", "--help")
    assert code == 0 and "preshape compare --mode 1.2:0.01" in out
    code, out, _ = run(capsys, "--help")
    assert code == 0 and "compare" in out
