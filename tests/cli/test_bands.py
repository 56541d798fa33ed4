"""`preshape design --family si --band ...`: what Python makes, what the screen says, a sentence for wrong asks."""

from __future__ import annotations

import json

import pytest

from preshape import Band, Shaper, design
from preshape.cli.main import main

TWO = ["--band", "0.9:1.1", "--band", "2.7:3.3:0.01:0.03"]
BANDS = [Band(0.9, 1.1), Band(2.7, 3.3, 0.01, 0.03)]


def run(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as stop:
        main(["design", *arguments])
    captured = capsys.readouterr()
    return int(stop.value.code or 0), captured.out, captured.err


@pytest.mark.parametrize(
    ("options", "wishes"),
    [
        ([], {}),
        (["--tolerance", "0.1"], {"tolerance": 0.1}),
        (["--dt", "0.05"], {"dt": 0.05}),
        (["--at-most", "5"], {"at_most": 5}),
        (["--at-most", "8", "--dt", "0.05", "--tolerance", "0.06"], {"at_most": 8, "dt": 0.05, "tolerance": 0.06}),
    ],
)
def test_it_makes_what_python_makes(
    options: list[str], wishes: dict[str, float], capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, _ = run(capsys, "--family", "si", *TWO, *options, "--json", "-")
    assert code == 0
    made, expected = Shaper.from_dict(json.loads(out)), design.specified_insensitivity(BANDS, **wishes)
    assert made == expected and made.design == expected.design


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ([], "proved shortest: no positive shaper with these constraints is shorter (certificate checked)"),
        (["--dt", "0.05"], "proved: no shaper on this grid within these limits is shorter"),
        (["--at-most", "5"], "not proved shortest: a shorter one could save at most"),
    ],
)
def test_the_screen_says_what_is_kept_where_and_what_is_proved(
    options: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, _ = run(capsys, "--family", "si", "--band", "0.9:1.1", "--band", "2.7:3.3", *options)
    assert code == 0 and sentence in out
    if not options:
        assert "si: 6 impulses in 1.00322 s (optimal)" in out
        assert "0.9 to 1.1 Hz, damping 0; 2.7 to 3.3 Hz, damping 0: 5 %" in " ".join(out.split())


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (["--family", "si"], "--family si needs --band"),
        (["--family", "si", "--mode", "1", *TWO], "without --mode"),
        (["--family", "si", "--mode", "1"], "without --mode"),
        (["--family", "zvd", "--mode", "1", *TWO], "--band goes with --family ei or si"),
        (["--family", "ei", *TWO], "use --family si for several bands"),
        (["--family", "ei", "--band", "8:12:0.1"], "its damping ratio in --damping"),
        (["--family", "si", *TWO, "--order", "1"], "does not take --order: it takes --at-most, --dt, --tolerance"),
        (["--family", "si", *TWO, "--dt", "0.3"], "coarser than half a period of 3.3 Hz: give dt below 0.151515 s"),
        (["--family", "si", *TWO, "--dt", "0"], "dt is 0 s"),
        (["--family", "si", *TWO, "--tolerance", "1"], "tolerance 1.0 is outside (0, 1)"),
        (["--family", "si", *TWO, "--tolerance", "1e-7"], "too little for the conic solver"),
        (["--family", "si", *TWO, "--at-most", "2"], "no shaper with at most 2 impulses was found"),
        (["--family", "si", *TWO, "--at-most", "2", "--dt", "0.05"], "no shaper with at most 2 impulses was found"),
        (["--family", "si", "--band", "0.01:100"], "too wide"),
    ],
)
def test_wrong_asks_exit_with_two_and_a_sentence(
    options: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = run(capsys, *options)
    assert code == 2 and out == "" and sentence in err and err.count("\n") == 1


@pytest.mark.parametrize(
    ("band", "sentence"),
    [
        ("0:1", "needs no shaper"),
        ("12:8", "the lower one first"),
        ("8", "is not LOW:HIGH"),
        ("8:12:0.1:0.2:0.3", "is not LOW:HIGH"),
        ("a:b", "is not LOW:HIGH"),
        ("8:12:1.5", "outside [0, 1)"),
        ("nan:2", "give a finite number"),
    ],
)
def test_a_band_that_is_none_is_refused_with_the_way_to_write_it(
    band: str, sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    code, out, err = run(capsys, "--family", "si", "--band", band)
    assert code == 2 and out == "" and sentence in " ".join(err.split())
