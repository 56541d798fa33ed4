"""The command line, run as a user runs it: exit codes, one sentence an error, JSON and nothing else."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from preshape import Shaper, design
from preshape.cli.main import main
from preshape.vibration import total_insensitivity


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as stop:
        main(list(arguments))
    captured = capsys.readouterr()
    return int(stop.value.code or 0), captured.out, captured.err


def test_json_on_standard_output_is_one_object_and_nothing_else(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, err = run(capsys, "design", "--family", "direct", "--mode", "0.20", "--mode", "0.26:0.0", "--json", "-")
    assert code == 0 and err == ""
    data = json.loads(out)
    assert {"schema", "times", "amplitudes", "duration", "design"} <= data.keys()
    assert Shaper.from_dict(data) == design.direct([(0.20, 0.0), (0.26, 0.0)])


@pytest.mark.parametrize(
    ("arguments", "expected"),
    [
        (["--family", "zv", "--mode", "10"], design.zv((10.0, 0.0))),
        (["--family", "zvdk", "--order", "3", "--mode", "10:0.1"], design.zvdk((10.0, 0.1), 3)),
        (["--family", "ei", "--tolerance", "0.1", "--mode", "10"], design.ei((10.0, 0.0), 0.1)),
        (["--family", "k_hump_ei", "--humps", "4", "--mode", "10"], design.k_hump_ei((10.0, 0.0), 4)),
        (["--family", "ei", "--band", "8:12"], design.ei_for_band(8.0, 12.0)),
        (
            ["--family", "convolved", "--base", "mzv", "--mode", "1", "--mode", "3"],
            design.convolved([(1, 0), (3, 0)], "mzv"),
        ),
        (["--family", "direct", "--order", "0", "--mode", "1", "--mode", "3.3"], design.direct([(1, 0), (3.3, 0)], 0)),
        (["--family", "zvd", "--mode", "40", "--dt", "0.001"], design.on_grid(design.zvd((40.0, 0.0)), 0.001)),
    ],
)
def test_design_makes_what_python_makes(
    arguments: list[str], expected: Shaper, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, _ = run(capsys, "design", *arguments, "--json", str(tmp_path / "shaper.json"))
    assert code == 0
    assert "time [s]" in out and "amplitude [-]" in out
    assert Shaper.load(tmp_path / "shaper.json") == expected


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["design", "--family", "zv"], "no mode was given"),
        (["design", "--family", "zv", "--mode", "0"], "above 0 Hz"),
        (["design", "--family", "zv", "--mode", "-3"], "above 0 Hz"),
        (["design", "--family", "zv", "--mode", "nan"], "finite value"),
        (["design", "--family", "zv", "--mode", "10:1"], "outside [0, 1)"),
        (["design", "--family", "zv", "--mode", "ten"], "not FREQUENCY[:DAMPING]"),
        (["design", "--family", "zv", "--mode", "10", "--mode", "10"], "given twice"),
        (["design", "--family", "zx", "--mode", "10"], "is not one of"),
        (["design", "--family", "ei", "--mode", "10", "--tolerance", "0"], "outside (0, 1)"),
        (["design", "--family", "ei", "--mode", "10", "--tolerance", "1.5"], "outside (0, 1)"),
        (["design", "--family", "zv", "--mode", "10", "--tolerance", "0.1"], "does not take --tolerance"),
        (["design", "--family", "zvdk", "--mode", "10"], "needs --order"),
        (["design", "--family", "zv", "--band", "8:12"], "--band goes with --family ei"),
        (["design", "--family", "ei", "--band", "8"], "not LOW:HIGH"),
        (["design", "--family", "ei", "--band", "12:8"], "no band of natural frequencies"),
        (["design", "--family", "zv", "--mode", "10", "--dt", "0"], "sample time"),
        (["design", "--family", "zv", "--mode", "10", "--json", "/nowhere/x.json"], "cannot write"),
        (["analyze", "nothing.json"], "cannot read"),
        (["shape", "nothing.json", "c.csv", "--out", "o.csv"], "cannot read"),
        (["calibrate", "nothing.csv"], "nothing.csv"),
        (["calibrate"], "FILE"),
        (["nonsense"], "nonsense"),
    ],
)
def test_wrong_input_is_one_sentence_and_exit_code_2(
    arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = run(capsys, *arguments)
    assert code == 2
    assert sentence in err
    assert out == ""
    assert "Traceback" not in err


def test_our_own_fault_is_exit_code_1(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(*_: object, **__: object) -> None:
        raise RuntimeError("bug")

    monkeypatch.setattr(design, "designed", broken)
    code, _, err = run(capsys, "design", "--family", "zv", "--mode", "10", "--dt", "0.001")
    assert code == 1
    assert "fault of preshape" in err and "RuntimeError: bug" in err


def test_an_interruption_says_so(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(design, "designed", interrupted)
    code, _, err = run(capsys, "design", "--family", "zv", "--mode", "10", "--dt", "0.001")
    assert code == 130 and "Interrupted" in err and "Traceback" not in err


def test_analyze_shows_the_measures_of_a_shaper_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = design.zvd((10.0, 0.0)).save(tmp_path / "zvd.json")
    code, out, _ = run(capsys, "analyze", str(path))
    assert code == 0
    assert "0.2871" in out and "8.564 - 11.44" in out
    assert f"{total_insensitivity(design.zvd((10.0, 0.0)), (10.0, 0.0)):.4f}" in out
    code, out, _ = run(capsys, "analyze", str(path), "--mode", "12:0.1", "--tolerance", "0.2")
    assert code == 0 and "12 Hz, damping 0.1" in out
    given = tmp_path / "given.json"
    Shaper([0.0, 1.0], [0.5, 0.5]).save(given)
    code, _, err = run(capsys, "analyze", str(given))
    assert code == 2 and "--mode F:Z" in err


def test_analyze_does_not_believe_a_certificate_that_does_not_hold(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = design.direct([(1.0, 0.0), (2.3, 0.0)]).to_dict()
    path = tmp_path / "direct.json"
    path.write_text(json.dumps(data))
    assert "proved shortest" in run(capsys, "analyze", str(path))[1]
    data["design"]["certificate"]["coefficients"][0][0] += 0.1
    path.write_text(json.dumps(data))
    out = run(capsys, "analyze", str(path))[1]
    assert "proved shortest" not in out and "does not hold" in out


def test_shape_shapes_every_column_from_rest_at_the_first_row(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shaper = design.zv((10.0, 0.0))
    shaper.save(tmp_path / "zv.json")
    x, y = 100.0 + np.linspace(0.0, 5.0, 40), np.sin(np.arange(40) / 9.0)
    rows = "\n".join(f"{0.01 * i:.2f},{a!r},{b!r}" for i, (a, b) in enumerate(zip(x.tolist(), y.tolist(), strict=True)))
    (tmp_path / "command.csv").write_text(f"time,x [mm],y [mm]\n{rows}\n")
    out = tmp_path / "shaped.csv"
    code, text, _ = run(capsys, "shape", str(tmp_path / "zv.json"), str(tmp_path / "command.csv"), "--out", str(out))
    assert code == 0 and "40 samples became 45" in text
    assert out.read_text().splitlines()[0] == "time [s],x [mm],y [mm]"
    table = np.loadtxt(out, delimiter=",", skiprows=1)
    np.testing.assert_allclose(table[:, 0], 0.01 * np.arange(45), atol=1e-9)
    np.testing.assert_allclose(table[:, 1], shaper.shape(x, 0.01, initial=x[0]), atol=1e-9)
    np.testing.assert_allclose(table[:, 2], shaper.shape(y, 0.01, initial=y[0]), atol=1e-9)
    code, _, err = run(capsys, "shape", str(tmp_path / "zv.json"), str(out), "--out", str(out))
    assert code == 2 and "is the command itself" in err


def test_a_closed_pipe_is_no_error() -> None:
    finished = subprocess.run(
        f"{sys.executable} -m preshape design --family zv --mode 10 --json - | head -c 1",
        shell=True, capture_output=True, text=True, check=True,
    )  # fmt: skip
    assert "Traceback" not in finished.stderr


def test_help_names_every_command(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, "--help")
    assert code == 0
    for name in ("calibrate", "design", "analyze", "shape"):
        assert name in out
        code, text, _ = run(capsys, name, "--help")
        assert code == 0 and "Usage" in text
    code, out, _ = run(capsys, "--version")
    assert code == 0 and out.startswith("preshape ")


def test_importing_preshape_loads_nothing_heavy() -> None:
    code = "import sys, preshape; print([m for m in ('scipy', 'matplotlib', 'rich', 'click') if m in sys.modules])"
    assert (
        subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.strip() == "[]"
    )
