"""What the command line says about shapers with negative impulses."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from preshape import Shaper, design
from preshape.cli.main import preshape


def output(*arguments: str) -> str:
    result = CliRunner().invoke(preshape, arguments, catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.output


def warnings(text: str) -> list[str]:
    return [line for line in text.splitlines() if "check unmodelled modes" in line]


def test_a_shaper_with_negative_impulses_warns_in_one_line_and_a_positive_one_does_not() -> None:
    (line,) = warnings(output("design", "--family", "um_zv", "--mode", "10"))
    assert line == "! negative impulses excite up to 3 x at 30 Hz (searched 10 - 100 Hz): check unmodelled modes"
    assert warnings(output("design", "--family", "zv", "--mode", "10")) == []


def test_what_lies_between_the_modes_is_searched_too_and_a_shaper_on_a_grid_anew() -> None:
    (line,) = warnings(output("design", "--family", "ps_zv", "--mode", "2", "--mode", "9:0.1", "--dt", "0.001"))
    assert "(searched 2 - 90 Hz)" in line


def test_a_given_shaper_without_modes_gets_the_bound(tmp_path: Path) -> None:
    path = Shaper([0.0, 0.1, 0.3], [1.0, -0.75, 0.75]).save(tmp_path / "given.json")
    (line,) = warnings(output("analyze", str(path), "--mode", "4"))
    assert "up to 2.5 x" in line


def test_the_specified_amplitude_is_an_option_also_of_a_convolved_one() -> None:
    data = json.loads(
        output("design", "--family", "sna_zv", "--mode", "12:0.1", "--negative-amplitude", "0.5", "--json", "-")
    )
    assert Shaper.from_dict(data) == design.sna_zv((12.0, 0.1), 0.5)
    modes = ["--mode", "5", "--mode", "12"]
    line = ["design", "--family", "convolved", "--base", "sna_zv", *modes, "--negative-amplitude", "0.5", "--json", "-"]
    assert Shaper.from_dict(json.loads(output(*line))) == design.sna_zv([(5.0, 0.0), (12.0, 0.0)], 0.5)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["--family", "sna_zv"], "--family sna_zv needs --negative-amplitude: give a number."),
        (["--family", "convolved", "--base", "sna_zv"], "--base sna_zv needs --negative-amplitude"),
        (["--family", "convolved", "--base", "zvdk"], "--base zvdk needs --order"),
        (["--family", "zv", "--negative-amplitude", "1"], "zv does not take --negative-amplitude"),
        (["--family", "sna_zv", "--negative-amplitude", "-1"], "above 0 and up to 100"),
    ],
)
def test_a_wish_that_does_not_fit_is_refused(
    arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    from preshape.cli import main

    with pytest.raises(SystemExit) as left:
        main(["design", *arguments, "--mode", "10"])
    assert left.value.code == 2
    assert sentence in capsys.readouterr().err
