"""`preshape verify`, run as a user runs it: the screen, files, exit codes."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from tests.workflow.recordings import klipper_text, recording

import preshape
from preshape.cli.main import main
from preshape.workflow import verify

SHAPER = preshape.design.zvd((46.0, 0.06))


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as stop:
        main(["verify", *arguments])
    captured = capsys.readouterr()
    return int(stop.value.code or 0), captured.out, captured.err


@pytest.fixture
def files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    monkeypatch.chdir(tmp_path)
    Path("before.csv").write_text(klipper_text(recording(seed=1)[0]))
    Path("after.csv").write_text(klipper_text(recording(SHAPER, seed=2)[0]))
    SHAPER.save("shaper.json")
    return ["--before", "before.csv", "--after", "after.csv"]


def test_the_screen_says_the_verdict_first_then_each_mode(files: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run(capsys, *files, "--shaper", "shaper.json")
    assert code == 0 and err == ""
    assert out.startswith("With the shaper 1") and "as predicted: 42 Hz, 78" in out
    (row,) = [line for line in out.splitlines() if line.startswith("78")]
    assert row.endswith("as predicted") and " 6" in row
    assert "total" in out and "Stops: before.csv 0.400" in out


def test_numbers_as_json_are_those_of_python(files: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run(capsys, *files, "--stop", "0.4003:0.4222", "--json", "-")
    assert code == 0 and err == ""
    expected = verify("before.csv", "after.csv", stop=(0.4003, 0.4222))
    assert json.loads(out) == json.loads(json.dumps(expected.to_dict()))
    assert expected.modes[0].predicted is None and expected.modes[0].verdict == "reduced"


@pytest.mark.parametrize(("kind", "head"), [("svg", b"<svg"), ("png", b"\x89PNG")])
def test_the_figure_is_drawn(files: list[str], kind: str, head: bytes, capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(
        capsys, *files, "--shaper", "shaper.json", "--figure", f"figure.{kind}", "--json", "numbers.json"
    )
    assert code == 0 and f"Figure: figure.{kind}" in out and "Numbers: numbers.json" in out
    first = Path(f"figure.{kind}").read_bytes()
    assert first.startswith(head)
    if kind == "svg":
        assert all(word in first for word in (b"without the shaper", b"predicted", b"What rings after the stop"))


def test_a_figure_without_any_mode_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = str(tmp_path / "still.csv")
    Path(name).write_text("time,x [g]\n" + "".join(f"{k / 1000:.3f},{(k * 7919 % 97) / 97:.4f}\n" for k in range(200)))
    figure = str(tmp_path / "figure.svg")
    code, out, _ = run(capsys, "--before", name, "--after", name, "--stop", "0", "--figure", figure)
    assert code == 0 and "no mode was found" in out
    assert b"no mode could be compared" in Path(figure).read_bytes()


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([], "give a recording without the shaper"),
        (["--before", "before.csv"], "give a recording without the shaper"),
        (["--before", "missing.csv", "--after", "after.csv"], "missing.csv"),
        (["--before", "before.csv", "--after", "after.csv", "--stop", "soon"], "is no time"),
        (["--before", "before.csv", "--after", "after.csv", "--figure", "f.gif"], "names no kind of figure"),
        (["--recipe", "klipper"], "needs --distance"),
        (["--recipe", "klipper", "--before", "before.csv"], "give either"),
    ],
)
def test_the_users_errors_are_one_sentence(
    files: list[str], arguments: list[str], said: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = run(capsys, *arguments)
    assert code == 2 and out == "" and said in err and err.count("\n") == 1


def test_a_recipe_is_printed_or_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    wishes = ["--recipe", "rrf", "--axis", "y", "--distance", "100", "--speed", "200", "--acceleration", "5000"]
    code, printed, _ = run(capsys, *wishes)
    assert code == 0 and printed.count("M956 ") == 6
    file = tmp_path / "verify.g"
    code, out, _ = run(capsys, *wishes, "--out", str(file))
    assert code == 0 and out == f"Recipe: {file}\n" and file.read_text() == printed
