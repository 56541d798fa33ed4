"""`preshape campaign`: what a user sees, and the exit codes."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from preshape.cli.main import main

DATA = Path(__file__).parents[2] / "examples" / "data"

SMALL = """
schema = "preshape/campaign/1"
machine.plant = "pendulum"
shaper.family = "zvd"
[map.axes.length]
low = {low}
high = 4.0
count = 5
"""


def ran(capsys: pytest.CaptureFixture[str], *arguments: str) -> tuple[int, str, str]:
    with pytest.raises(SystemExit) as left:
        main(["campaign", *arguments])
    text = capsys.readouterr()
    return int(left.value.code or 0), text.out, text.err


def test_the_screen_names_points_numbers_and_files(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("small.toml").write_text(SMALL.format(low=1.0))
    code, out, err = ran(capsys, "small.toml", "--workers", "0")
    assert (code, err) == (0, "")
    assert "Design map: 5 of 5 points done" in out
    assert re.search(r"duration of the shaper +2\.006 to 4\.013 s", out)
    written = re.findall(r"Written: (.+)", out)
    assert written == ["campaign-small/results.parquet", "campaign-small/figure.svg"]
    assert all((tmp_path / name).stat().st_size > 1000 for name in written)
    code, out, _ = ran(capsys, "small.toml", "--workers", "0")
    assert code == 0 and "5 of them are from an earlier run." in out


def test_local_processes_give_what_this_process_gives(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, workers in (("here", "0"), ("there", "2")):
        code, out, err = ran(capsys, str(DATA / "crane-map.toml"), "--out", str(tmp_path / name), "--workers", workers)
        assert (code, err) == (0, ""), out
    one, other = ((tmp_path / name / "results.parquet").read_bytes() for name in ("here", "there"))
    assert one == other


def test_failed_points_are_shown_and_make_the_exit_code_1(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "small.toml").write_text(SMALL.format(low=-4.0))
    code, out, _ = ran(capsys, str(tmp_path / "small.toml"), "--out", str(tmp_path / "out"), "--workers", "0")
    assert code == 1
    assert "Design map: 2 of 5 points done, 3 failed" in out
    assert "! 1 failed: length is -4 m: give a value above 0 m." in out


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["missing.toml"], "cannot read missing.toml"),
        (["small.toml", "--workers", "-1"], "workers is -1: give a whole number from 0 to 1024"),
        (["small.toml", "--retries", "-1"], "retries is -1"),
        (["small.toml", "--workers", "2", "--scheduler", "tcp://127.0.0.1:9"], "give one of them"),
        (["small.toml", "--scheduler", "elsewhere"], "no Dask scheduler answers at elsewhere"),
        (["small.toml", "--workers", "many"], "'many' is not a valid integer"),
    ],
)
def test_wrong_input_is_one_sentence_and_2(
    arguments: list[str],
    sentence: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("small.toml").write_text(SMALL.format(low=1.0))
    code, out, err = ran(capsys, *arguments)
    assert (code, out) == (2, "")
    assert sentence in err and "Traceback" not in err


@pytest.mark.parametrize("package", ["distributed", "pyarrow"])
def test_without_the_extra_the_remedy_is_said(
    package: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    import importlib.util

    found = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name, *a: None if name == package else found(name, *a))
    monkeypatch.chdir(tmp_path)
    Path("small.toml").write_text(SMALL.format(low=1.0))
    code, _, err = ran(capsys, "small.toml")
    assert code == 2
    assert f"needs {package}, which is not installed: pip install 'preshape[campaign]'." in err


def test_importing_the_room_imports_no_dask() -> None:
    import subprocess

    line = "import preshape.campaign, sys; print({'distributed', 'dask', 'pyarrow'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", line], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "set()"
