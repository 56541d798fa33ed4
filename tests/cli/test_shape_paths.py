"""preshape shape with a shaper for each column: delays, advance, contour error and its figure."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from preshape import design
from preshape.cli.main import main
from preshape.command import trapezoid
from preshape.command.path import contour_error

DT = 0.001
X, Y = design.zvd((38.0, 0.05)), design.zvd((61.0, 0.05))
WAY = trapezoid(40.0, maximum_speed=100.0, maximum_acceleration=3000.0, dt=DT).values


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as stop:
        main(list(arguments))
    captured = capsys.readouterr()
    return int(stop.value.code or 0), captured.out, captured.err


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A line of 40 mm at 30 degrees from (5, 7), a shaper for each axis."""
    monkeypatch.chdir(tmp_path)
    X.save("x.json")
    Y.save("y.json")
    x, y = 5.0 + WAY * np.cos(np.pi / 6.0), 7.0 + WAY * np.sin(np.pi / 6.0)
    rows = "\n".join(
        f"{0.001 * i:.3f},{a!r},{b!r}" for i, (a, b) in enumerate(zip(x.tolist(), y.tolist(), strict=True))
    )
    (tmp_path / "part.csv").write_text(f"time,x [mm],y [mm]\n{rows}\n")
    return tmp_path


def table(name: str) -> NDArray[np.float64]:
    return np.loadtxt(name, delimiter=",", skiprows=1).T


def test_all_columns_wait_for_the_slowest_unless_told_otherwise(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    both = ("shape", "x.json", "part.csv", "--column", "y=y.json")
    code, text, _ = run(capsys, *both, "--out", "equal.csv")
    assert code == 0 and f"x {1e3 * X.centroid:.4g} ms, y {1e3 * X.centroid:.4g} ms" in text
    code, text, _ = run(capsys, *both, "--own-delays", "--out", "own.csv")
    assert code == 0 and f"x {1e3 * X.centroid:.4g} ms, y {1e3 * Y.centroid:.4g} ms" in text
    _, x, y = table("own.csv")
    command = table("part.csv")
    np.testing.assert_allclose(x, X.shape(command[1], DT, initial=5.0), atol=1e-9)
    short = Y.shape(command[2], DT, initial=7.0)
    np.testing.assert_allclose(y[: short.size], short, atol=1e-9)
    errors = [contour_error(command[1:], table(name)[1:]).largest for name in ("equal.csv", "own.csv")]
    assert errors[0] < 0.25 * errors[1]


def test_the_contour_error_is_said_and_drawn(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    both = ("shape", "x.json", "part.csv", "--column", "y=y.json")
    code, text, _ = run(capsys, *both, "--contour", "--figure", "part.svg", "--out", "o.csv")
    assert code == 0 and (folder / "part.svg").read_text().startswith("<svg")
    found = contour_error(table("part.csv")[1:], table("o.csv")[1:])
    assert f"at most {found.largest:.3g} mm, at x " in text and f"RMS {found.rms:.3g} mm" in text
    code, text, _ = run(capsys, "shape", "x.json", "part.csv", "--contour", "--out", "one.csv")
    largest = float(text.split("at the samples at most ")[1].split()[0].rstrip(","))
    assert code == 0 and largest < 1e-12


def test_an_advanced_command_is_on_time_and_begins_before_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code, text, _ = run(
        capsys, "shape", "x.json", "part.csv", "--column", "y=y.json", "--advance", "--out", "early.csv"
    )
    assert code == 0 and "x 0 ms, y 0 ms" in text and "begins 13 ms before" in text
    t, x, y = table("early.csv")
    time, commanded_x, commanded_y = table("part.csv")
    assert t[0] == pytest.approx(-0.013)
    cruise = np.linspace(0.1, 0.3, 7)
    np.testing.assert_allclose(np.interp(cruise, t, x), np.interp(cruise, time, commanded_x), atol=1e-9)
    np.testing.assert_allclose(np.interp(cruise, t, y), np.interp(cruise, time, commanded_y), atol=1e-9)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--column", "z=y.json"], "no single column 'z': its columns are x, y"),
        (["--column", "y"], "not NAME=FILE"),
        (["--column", "y="], "not NAME=FILE"),
        (["--column", "y=y.json", "--column", "y=x.json"], "two shapers"),
        (["--column", "y=nothing.json"], "cannot read"),
        (["--figure", "part.bmp"], ".svg, .png or .pdf"),
    ],
)
def test_wrong_input_is_one_sentence_and_nothing_is_written(
    folder: Path, arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, _, err = run(capsys, "shape", "x.json", "part.csv", *arguments, "--out", "o.csv")
    assert code == 2 and sentence in err and "Traceback" not in err
    assert not (folder / "o.csv").exists()


def test_one_column_has_no_curve_to_draw_and_a_rest_no_contour(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "one.csv").write_text("time,x [mm]\n" + "\n".join(f"{0.001 * i:.3f},{i}" for i in range(50)))
    code, _, err = run(capsys, "shape", "x.json", "one.csv", "--figure", "o.svg", "--out", "o.csv")
    assert code == 2 and "one axis" in err
    (folder / "rest.csv").write_text("time,x,y\n" + "\n".join(f"{0.001 * i:.3f},1,2" for i in range(50)))
    code, _, err = run(capsys, "shape", "x.json", "rest.csv", "--contour", "--out", "o.csv")
    assert code == 2 and "rests at one place" in err
