"""`preshape simulate`: what it prints and writes, and what it says of wrong files."""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path

import numpy as np
import pytest

from preshape import Shaper, design
from preshape.cli.main import main
from preshape.plant import load_plant

DATA = Path(__file__).parents[2] / "examples" / "data"
MACHINE, MOVE = str(DATA / "machine.toml"), str(DATA / "move.csv")


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as stop:
        main(["simulate", *arguments])
    captured = capsys.readouterr()
    return int(stop.value.code or 0), captured.out, captured.err


@pytest.fixture
def shaper(tmp_path: Path) -> str:
    return str(design.mesh(load_plant(MACHINE).modes(), dt=1e-3).save(tmp_path / "shaper.json"))


def test_it_shows_and_writes_both_motions(shaper: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out, figure = tmp_path / "motion.csv", tmp_path / "motion.png"
    code, text, err = run(
        capsys, MACHINE, "--shaper", shaper, "--command", MOVE, "--out", str(out), "--figure", str(figure)
    )
    assert code == 0 and err == "", "no bar where there is no terminal"
    assert "tool      unshaped" in text and "0.04911 m" in text and "not yet" in text
    assert figure.read_bytes().startswith(b"\x89PNG")
    with open(out) as stream:
        rows = list(csv.reader(stream))
    assert rows[0][:4] == ["time [s]", "position unshaped [m]", "carriage unshaped [m]", "tool unshaped [m]"]
    table = np.array(rows[1:], dtype=float)
    gantry = load_plant(MACHINE)
    unshaped = gantry.simulate(table[:, 1], 1e-3).outputs["tool"]
    shaped = gantry.simulate(Shaper.load(shaper).shape(table[:250, 1], 1e-3), 1e-3).outputs["tool"]
    np.testing.assert_array_equal(table[:, 3], unshaped)
    np.testing.assert_array_equal(table[: shaped.size, 6], shaped)


def test_a_finer_step_and_named_modes_and_a_plant_by_name(
    shaper: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code, text, _ = run(capsys, MACHINE, "--shaper", shaper, "--command", MOVE, "--dt", "0.0005", "--mode", "8.7:0.02")
    assert code == 0 and "at 0.5 ms" in text and "8.7 Hz, damping 0.02" in text
    pulse = tmp_path / "pulse.csv"
    pulse.write_text("torque\n0.1\n0.1\n0\n")
    zv = str(design.zv((9.8, 0.0)).save(tmp_path / "zv.json"))
    code, text, _ = run(
        capsys, "mace-linear", "--shaper", zv, "--command", str(pulse), "--sample-rate", "2000", "--rest", "0.5"
    )
    assert code == 0 and "payload" in text


def _by_name(name: str, rows: int, tmp_path: Path) -> list[str]:
    """Arguments that move the first input of a plant that comes along by 0.01, at once."""
    plant = load_plant(name)
    move = tmp_path / "move.csv"
    row = ",".join(["0.01"] + ["0"] * (len(plant.inputs) - 1))
    move.write_text(f"time,{','.join(plant.inputs)}\n" + "".join(f"{0.002 * k},{row}\n" for k in range(rows)))
    zv = design.zv(plant.modes()[0]).save(tmp_path / "zv.json")
    return [name, "--shaper", str(zv), "--command", str(move)]


@pytest.mark.parametrize(("name", "output"), [("mace", "left sensor"), ("shuttle-arm", "end point y")])
def test_the_test_beds_are_simulated_by_name(
    name: str, output: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if name == "mace":
        pytest.importorskip("exudyn", exc_type=ImportError)
    code, text, err = run(capsys, *_by_name(name, 20, tmp_path))
    assert code == 0 and err == "" and output in text


def test_a_test_bed_whose_package_is_missing_says_what_to_install(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "exudyn", None)
    code, out, err = run(capsys, *_by_name("mace", 20, tmp_path))
    assert code == 2 and out == "" and err.count("\n") == 1 and "pip install 'preshape[plants]'" in err


def test_columns_are_told_by_their_names(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data = {
        "schema": "preshape/plant/1",
        "state_space": {
            "A": [[0, 1], [-40, -0.1]], "B": [[0, 0], [1, 0]], "C": [[1, 0]],
            "inputs": [{"name": "push"}, {"name": "idle"}], "outputs": [{"name": "x"}],
        },
    }  # fmt: skip
    plant, turned = tmp_path / "two.json", tmp_path / "two.csv"
    plant.write_text(json.dumps(data))
    turned.write_text("time,idle,push\n0,5,0\n0.01,5,0\n0.02,5,0\n")
    zv = str(design.zv((1.0, 0.0)).save(tmp_path / "zv.json"))
    out = tmp_path / "out.csv"
    code, _, err = run(capsys, str(plant), "--shaper", zv, "--command", str(turned), "--out", str(out))
    assert code == 0, err
    assert not np.loadtxt(out, delimiter=",", skiprows=1)[:, [1, 3]].any()


def test_what_ran_until_it_diverged_is_kept(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data = {
        "schema": "preshape/plant/1",
        "state_space": {
            "A": [[300.0]], "B": [[1.0]], "C": [[1.0]], "inputs": [{"name": "u"}], "outputs": [{"name": "x"}],
        },
    }  # fmt: skip
    plant, step, out = tmp_path / "wrong.json", tmp_path / "step.csv", tmp_path / "out.csv"
    plant.write_text(json.dumps(data))
    step.write_text("time,u\n0,1\n0.01,1\n")
    zv = str(design.zv((1.0, 0.0)).save(tmp_path / "zv.json"))
    wanted = ["--shaper", zv, "--command", str(step), "--out", str(out)]
    code, _, err = run(capsys, str(plant), *wanted)
    assert code == 2 and "the plant is unstable: a motion grows as exp(300 t)" in err and not out.exists()
    code, _, err = run(capsys, str(plant), *wanted, "--mode", "1")
    assert code == 2 and "diverged at 2.39 s" in err and "Until then" in err
    assert np.loadtxt(out, delimiter=",", skiprows=1).shape == (239, 3)


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        ({"plant": "mace-cubic"}, "cannot read mace-cubic: No such file"),
        ({"command": "nothing.csv"}, "nothing.csv: there is no such file"),
        ({"shaper": "nothing.json"}, "cannot read nothing.json"),
        ({"shaper": "truncated.json"}, "truncated.json is not JSON"),
        ({"command": "two.csv"}, "two.csv has 2 column(s) besides the time, and the plant 1 input(s)"),
        ({"command": "nan.csv"}, "nan.csv: line 3 holds 'nan'"),
        ({"command": "empty.csv"}, "empty.csv: the file is empty"),
        ({"dt": "0.0003"}, "a sample every 0.001 s, which the simulation's step of 0.0003 s does not fit"),
        ({"dt": "0.002"}, "which the simulation's step of 0.002 s does not fit"),
        ({"dt": "0"}, "dt is 0 s"),
        ({"shaper": "grid.json"}, "impulses lie on a grid of 0.0035 s, and the simulation's step of 0.001 s"),
        ({"figure": "motion.gif"}, "motion.gif names no kind of figure"),
        ({"out": "move.csv"}, "move.csv is what is read from: choose another name"),
        ({"out": "nowhere/out.csv"}, "cannot write nowhere/out.csv"),
        ({"rest": "0.01"}, "rest is 0.01 s, and the slowest mode"),
    ],
)
def test_wrong_files_are_the_users_error_in_one_sentence(
    changed: dict, sentence: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("move.csv").write_text(Path(MOVE).read_text())
    design.zv((8.7, 0.02)).save("zv.json")
    design.mesh((8.7, 0.02), dt=0.0035).save("grid.json")
    Path("truncated.json").write_text(Path("zv.json").read_text()[:100])
    Path("two.csv").write_text("time,a,b\n0,1,1\n0.001,1,1\n")
    Path("nan.csv").write_text("time,a\n0,1\n0.001,nan\n")
    Path("empty.csv").write_text("")
    asked = {"plant": MACHINE, "command": "move.csv", "shaper": "zv.json"} | changed
    plant = asked.pop("plant")
    code, _, err = run(capsys, plant, *(word for key, value in asked.items() for word in (f"--{key}", value)))
    assert code == 2 and sentence in err and err.count("\n") == 1
    assert Path("move.csv").read_text() == Path(MOVE).read_text()
    assert not list(tmp_path.glob(".*.part"))


def test_an_interrupted_run_leaves_the_old_file(
    shaper: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    out = tmp_path / "out.csv"
    out.write_text("old")

    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("preshape.files.os.fsync", interrupted)  # half of the new file is there
    code, _, err = run(capsys, MACHINE, "--shaper", shaper, "--command", MOVE, "--out", str(out))
    assert code == 130 and "no file was left half written" in err and out.read_text() == "old"
    assert not list(tmp_path.glob(".*.part"))


def test_the_bar_shows_on_a_terminal_only(monkeypatch: pytest.MonkeyPatch) -> None:
    import io

    from rich.console import Console

    from preshape.cli import simulation_screen

    for terminal in (True, False):
        stream = io.StringIO()
        made = Console(file=stream, force_terminal=terminal, width=80)
        monkeypatch.setattr(simulation_screen, "console", lambda stderr=False, made=made: made)
        with simulation_screen.progress_bar("Simulating") as tell:
            tell(0.5)
        assert ("Simulating" in stream.getvalue()) is terminal
