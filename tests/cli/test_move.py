"""`preshape move`: the command on the screen, in a file that a controller plays, in a figure; the user's errors."""

import csv
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner, Result

from preshape.cli.main import main, preshape
from preshape.command import rest_to_rest
from preshape.errors import InputError
from preshape.plant import FloatingOscillator
from preshape.profile import Profile

PLANT = ["--two-masses", "1:1:1", "--distance", "10", "--force", "1"]


def run(*arguments: str) -> Result:
    return CliRunner().invoke(preshape, ["move", *arguments], catch_exceptions=False)


def test_the_switch_times_are_on_the_screen() -> None:
    shown = run(*PLANT, "--limit", "0.3").output
    assert "time-optimal: 10 m in 12.6428 s, optimal" in shown and "deflection at most 0.3 m" in shown
    assert run(*PLANT, "--limit", "0.3", "--command", "deflection-limiting").output.count("+0.6") == 1
    assert "10 m in 10.4252 s" in run(*PLANT, "--command", "on-off").output
    assert "1.00085" in run(*PLANT, "--command", "bang-bang").output  # and bends twice as far as need be


def test_the_file_played_back_moves_the_plant(tmp_path: Path) -> None:
    """What a zero-order hold makes of the file, on the plant itself."""
    out = tmp_path / "force.csv"
    assert f"Force: {out}" in run(*PLANT, "--limit", "0.3", "--out", str(out), "--dt", "0.01").output
    rows = list(csv.reader(out.read_text().splitlines()))
    assert rows[0] == ["time [s]", "force [N]"]
    times, force = np.array(rows[1:], dtype=float).T
    played = Profile.steps(times, np.diff(force, prepend=0.0))
    motion = FloatingOscillator(1.0, 1.0, 1.0).motion(played)
    assert motion.peak("deflection").value == pytest.approx(0.3, rel=1e-3)
    assert motion.residual("deflection") < 1e-4
    assert float(motion("centre", motion.end_time)) == pytest.approx(10.0, rel=1e-3)


def test_any_modes_and_a_figure(tmp_path: Path) -> None:
    figure = tmp_path / "move.svg"
    several = ["--mass", "2", "--mode", "0.2", "--mode", "0.5:0.01", "--gain", "1", "--gain", "0.7"]
    result = run(*several, "--distance", "-10", "--force", "1", "--figure", str(figure))
    assert "-10 m in 9.00098 s" in result.output
    assert figure.read_text().startswith("<svg")


@pytest.mark.parametrize(("suffix", "signature"), [(".png", b"\x89PNG\r\n\x1a\n"), (".pdf", b"%PDF-")])
def test_the_figure_is_of_the_kind_that_its_name_says(suffix: str, signature: bytes, tmp_path: Path) -> None:
    figure = tmp_path / f"move{suffix}"
    result = run(*PLANT, "--command", "bang-bang", "--figure", str(figure))
    assert f"Figure: {figure}" in result.output
    assert figure.read_bytes().startswith(signature)


def test_a_kind_of_figure_that_there_is_not_is_refused_before_anything_is_computed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def computed(*_: object, **__: object) -> None:
        raise AssertionError("the command was computed, and then could not be drawn")

    monkeypatch.setattr(rest_to_rest, "time_optimal", computed)
    figure = tmp_path / "move.gif"
    with pytest.raises(SystemExit) as ended:
        main(["move", *PLANT, "--figure", str(figure)])
    assert ended.value.code == 2 and "end it in .svg, .png or .pdf" in capsys.readouterr().err
    assert not figure.exists()


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--distance", "1", "--force", "1"], "name the plant once"),
        ([*PLANT, "--mass", "2"], "name the plant once"),
        ([*PLANT, "--gain", "2"], "go with --mass"),
        ([*PLANT, "--out", "force.csv"], "--out and --dt go together"),
        ([*PLANT, "--command", "on-off", "--limit", "0.3"], "--limit does not go with --command on-off"),
        ([*PLANT, "--command", "bang-bang", "--band", "1:2"], "--band does not go with --command bang-bang"),
        ([*PLANT, "--fuel-lean"], "--fuel-lean does not go with --command time-optimal"),
        ([*PLANT, "--tolerance", "0.1"], "--tolerance does not go with"),
        ([*PLANT, "--command", "deflection-limiting"], "takes one --limit"),
        ([*PLANT, "--command", "deflection-limiting", "--limit", "0.6"], "nothing needs to be limited"),
        ([*PLANT, "--limit", "0.3", "--on-off"], "only a proportional actuator can"),
        ([*PLANT[:3], "0.1", *PLANT[4:], "--command", "on-off"], "too short for the on-off command"),
        (["--mass", "2", "--mode", "0.2", "--distance", "1", "--force", "1"], "0 gains for 1 modes"),
    ],
)
def test_wrong_wishes_get_a_sentence(arguments: list[str], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        run(*arguments)


@pytest.mark.parametrize("plant", ["1:1", "1:x:1", "1:-1:1", "1:1:1:9"])
def test_wrong_plants_are_refused_by_the_option(plant: str) -> None:
    result = run("--two-masses", plant, *PLANT[2:])
    assert result.exit_code == 2 and "--two-masses" in result.output
