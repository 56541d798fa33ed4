"""`preshape export`: what the terminal says, files, and refusals with exit code 2."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner
from tests.tools import needed, succeeded

from preshape import Shaper, design
from preshape.cli.main import preshape as command_line
from preshape.export import TARGETS, Target

SHAPER = design.zvd([(8.7, 0.024), (31.0, 0.01)])


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    SHAPER.save("shaper.json")
    design.um_zvd((8.7, 0.024)).save("signed.json")
    Shaper([0.0, 0.0101], [0.5, 0.5]).save("given.json")
    return tmp_path


def said(line: str) -> str:
    done = CliRunner().invoke(command_line, ["export", *line.split()], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return done.output


def test_the_screen_says_what_was_written_what_it_costs_and_what_comes_next() -> None:
    text = said("c shaper.json --rate 1000 --out fw --name gantry_x --precision single")
    for name in ("preshape_kernel.h", "preshape_kernel.c", "gantry_x.h", "gantry_x.c", "gantry_x_selftest.c"):
        assert f"fw/{name}" in text and (Path("fw") / name).exists()
    assert (
        "17 taps every 1 ms, single precision; latency 148 samples = 148 ms" in text and "ring takes 1024 bytes" in text
    )
    placed = design.on_grid(SHAPER, 0.001, "exact")
    for mode, each in zip(SHAPER.design.modes or (), placed.design.settings["samples_per_period"], strict=True):
        assert f"{mode}" in text and f"{each:.4g}" in text
    needed("gcc")
    line = next(line.strip() for line in text.splitlines() if line.strip().startswith("gcc "))
    succeeded("sh", "-c", f"{line} && ./gantry_x_selftest", cwd=Path("fw"))


def test_every_target_of_the_list_can_be_exported() -> None:
    listed = " ".join(said("--list").split())
    design.zvd((41.0, 0.05)).save("small.json")
    for target in TARGETS.values():
        assert f"{target.name} {target.summary}" in listed
        for version in target.versions:
            assert version in listed
            given = "shaper.json --rate 1000" if isinstance(target, Target) else "small.json"
            text = said(f"{target.name} {given} --out {target.name} --target-version {version}")
            assert f"target {target.name} ({version})" in text


def test_a_setting_is_shown_with_what_it_leaves_and_what_the_shaper_would() -> None:
    design.direct([(40.0, 0.05), (63.0, 0.04)], order=0).save("two.json")
    text = " ".join(said("klipper two.json --axis x --out a --name bed").split())
    assert "a/bed.cfg" in text and "nearest setting is mzv(n=5,t=1.1) at 40.80 Hz" in text
    assert "It executes mzv: 5 impulses" in text and "target klipper (2026-03), x" in text
    assert "40 Hz, damping 0.05 0.99 %" in text
    assert "shaper_freq_x: 40.80" in Path("a/bed.cfg").read_text()
    assert "damping_ratio: keep these lines" in text
    assert "not say its modes" in said("rrf given.json --out b")


def test_what_a_user_should_know_is_said() -> None:
    assert "some taps are negative" in said("c signed.json --rate 1000 --out a")
    assert "negative" not in said("c shaper.json --rate 1000 --out b")
    assert "its modes" in said("linuxcnc given.json --rate 1000 --out c")
    assert "halcompile --install shaper.comp" in said("linuxcnc shaper.json --rate 1000 --out d")


def test_an_fmu_without_a_binary_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "sources only" not in said("fmu shaper.json --rate 1000 --out a")
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("CC", raising=False)
    assert "sources only" in said("fmu shaper.json --rate 1000 --out b")


def test_the_method_of_the_grid_is_taken() -> None:
    text = said("c shaper.json --rate 100 --out a --grid linear")
    left = design.on_grid(SHAPER, 0.01, "linear").design.settings["residuals"]
    assert all(f"{100.0 * value:.2g} %" in text for value in left)


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("d shaper.json --rate 1000 --out a", "target 'd' is not known"),
        ("c none.json --rate 1000 --out a", "cannot read none.json"),
        ("c shaper.json --rate 0 --out a", "--rate is 0 Hz"),
        ("c shaper.json --rate nan --out a", "--rate is nan"),
        ("c shaper.json --out a", "target c works on samples of one axis: say the sample rate"),
        ("c shaper.json --rate 1000 --axis x --out a", "leave the axis out"),
        ("rrf shaper.json --rate 1000 --out a", "target rrf has no sample grid: leave the sample rate"),
        ("rrf shaper.json --out a", "9 impulses and target rrf (3.6) holds 5"),
        ("klipper given.json --out a", "export it to klipper-plugin, which takes impulses"),
        ("c shaper.json --rate 1000", "Missing option '--out'"),
        ("c --rate 1000 --out a", "Missing argument 'SHAPER.json'"),
        ("c shaper.json --rate 1000 --out a --name Ö", "cannot be used"),
        ("c shaper.json --rate 1000 --out a --precision half", "precision 'half'"),
        ("linuxcnc shaper.json --rate 1000 --out a --target-version 3", "version '3' is not known"),
        ("c shaper.json --rate 40 --out a", "sample at least every"),
        ("c shaper.json --rate 1000 --out a --grid best", "method 'best' is not known"),
        ("c given.json --rate 1000 --out a --grid exact", "needs the modes"),
        ("c shaper.json --rate 1000 --out shaper.json", "is a file"),
    ],
)
def test_errors_are_one_sentence_with_exit_code_2(line: str, sentence: str, here: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "preshape", "export", *line.split()], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2 and sentence in done.stderr and "Traceback" not in done.stderr, done.stderr
    assert not (here / "a").exists()


def test_a_changed_file_is_kept_and_force_replaces_it() -> None:
    said("c shaper.json --rate 1000 --out fw")
    said("c shaper.json --rate 2000 --out fw")
    Path("fw/shaper.c").write_text("mine")
    done = CliRunner().invoke(command_line, "export c shaper.json --rate 1000 --out fw".split())
    assert done.exit_code == 1 and "nothing was written" in str(done.exception)  # main turns it into 2, see above
    assert Path("fw/shaper.c").read_text() == "mine"
    said("c shaper.json --rate 1000 --out fw --force")
    assert Path("fw/shaper.c").read_text() != "mine"


@pytest.mark.parametrize("width", [80, 120])
def test_the_list_fits_the_terminal_and_names_every_version(width: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Two columns that do not touch: names on the left, everything else to the right of the longest."""
    monkeypatch.setattr("preshape.cli.screens.FULL_WIDTH", width)
    lines = [line.rstrip() for line in said("--list").split("\n\n")[0].splitlines()]
    indent = max(map(len, TARGETS)) + 2
    assert max(map(len, lines)) <= width
    assert [line[:indent].strip() for line in lines if not line.startswith(" ")] == list(TARGETS)
    assert all(line[indent - 2 : indent] == "  " and line[indent] != " " for line in lines)
    whole = " ".join(line[indent:] if line.startswith(" ") else line for line in lines)
    for target in TARGETS.values():
        for version in target.versions:
            assert str(target.limits_of(version)) in whole and version in whole
