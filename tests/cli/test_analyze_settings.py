"""`preshape analyze --as`: what a machine does with the settings that it has."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from preshape import Shaper
from preshape.cli.main import preshape as command_line

GANTRY = Path(__file__).resolve().parents[2] / "examples" / "data" / "gantry_x.csv"


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    Path("config.g").write_text('M593 P"mzv" F50 S0.1 ; ringing\n')
    Path("printer.cfg").write_text("[input_shaper]\nshaper_type: ei\nshaper_freq_x: 47\nshaper_freq_y: 50\n")
    Path("custom.cfg").write_text("[preshape_shaper]\namplitudes_x: 0.5,0.5\ntimes_x: 0,0.01\n")
    Shaper([0.0, 0.01], [0.5, 0.5]).save("given.json")
    return tmp_path


def said(line: str) -> str:
    done = CliRunner().invoke(command_line, ["analyze", *line.split()], catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return " ".join(done.output.split())


def test_a_duet_with_mzv_leaves_a_sixth() -> None:
    assert "50 Hz, damping 0.1 16.2 none" in said("config.g --as rrf")
    assert "50 Hz, damping 0.1 16.2 none" in said("config.g --as rrf --target-version 3.5")
    assert "16.2" not in said("config.g --as rrf --target-version later")


def test_other_modes_and_a_measurement() -> None:
    text = said(f"printer.cfg --as klipper --axis x --mode 79:0.03 --spectrum {GANTRY}")
    assert "ei: 3 impulses" in text and "79 Hz, damping 0.03" in text
    assert "gantry_x.csv" in text and "by Klipper's measure" in text
    assert "gantry_x.csv" in said(f"custom.cfg --as klipper-plugin --spectrum {GANTRY}")
    assert "gantry_x.csv" in said(f"given.json --spectrum {GANTRY}")


@pytest.mark.parametrize(
    ("line", "sentence"),
    [
        ("printer.cfg --as klipper", "the shapers of x and y differ: say which axis, such as x"),
        ("printer.cfg --as c", "0 of 1 files are named *.h"),
        ("given.json --axis x", "belong to settings: say whose they are with --as"),
        ("given.json --target-version 3.5", "belong to settings"),
        ("config.g", "is not JSON"),
        ("config.g --as rrf --axis x", "one shaper for all axes"),
        ("custom.cfg --as klipper-plugin", "name them with --mode"),
        ("config.g --as rrf --spectrum none.csv", "none.csv"),
    ],
)
def test_errors_are_one_sentence_with_exit_code_2(line: str, sentence: str) -> None:
    done = subprocess.run(
        [sys.executable, "-m", "preshape", "analyze", *line.split()], capture_output=True, text=True, check=False
    )
    assert done.returncode == 2 and sentence in done.stderr and "Traceback" not in done.stderr, done.stderr
