"""`preshape design --family mesh`: the servo period is needed, and the shaper is the one that Python makes."""

from __future__ import annotations

import json

import pytest

from preshape import Shaper, design
from preshape.cli.main import main

TWO = ["--mode", "1", "--mode", "10"]


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as stop:
        main(["design", "--family", "mesh", *arguments])
    captured = capsys.readouterr()
    return int(stop.value.code or 0), captured.out, captured.err


@pytest.mark.parametrize(
    ("options", "wishes"),
    [
        (["--dt", "0.005"], {"dt": 0.005}),
        (["--dt", "0.005", "--duration", "1.1"], {"dt": 0.005, "duration": 1.1}),
        (["--dt", "0.01", "--cost", "second_derivative"], {"dt": 0.01, "cost": "second_derivative"}),
        (["--dt", "0.01", "--order", "0"], {"dt": 0.01, "order": 0}),
        (["--dt", "0.05", "--fewest", "--at-most", "8"], {"dt": 0.05, "fewest": True, "at_most": 8}),
    ],
)
def test_it_makes_what_python_makes(
    options: list[str], wishes: dict[str, object], capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, _ = run(capsys, *TWO, *options, "--json", "-")
    assert code == 0
    made, expected = Shaper.from_dict(json.loads(out)), design.mesh([(1.0, 0.0), (10.0, 0.0)], **wishes)
    assert made == expected and made.design == expected.design


def test_the_screen_says_what_is_proved(capsys: pytest.CaptureFixture[str]) -> None:
    code, out, _ = run(capsys, *TWO, "--dt", "0.005")
    assert code == 0 and "1.055 s (optimal)" in out
    assert "proved: no positive shaper on this grid is shorter" in out


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ([], "--family mesh needs --dt"),
        (["--dt", "0.005", "--tolerance", "0.05"], "does not take --tolerance"),
        (["--dt", "0.005", "--duration", "1"], "at least 1.055 s"),
        (["--dt", "0.2"], "at most 0.05 s"),
    ],
)
def test_wrong_asks_exit_with_two_and_a_sentence(
    options: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = run(capsys, *TWO, *options)
    assert code == 2 and out == "" and sentence in err and err.count("\n") == 1
