"""A recipe is what the firmware takes: starts and stops in pairs, moves that come back, files with their own names."""

from __future__ import annotations

import re

import numpy as np
import pytest

import preshape
from preshape.errors import InputError
from preshape.export import TARGETS, render
from preshape.export.gcode import commands
from preshape.workflow import recipe

MOVE = {"axis": "y", "distance": 100.0, "speed": 200.0, "acceleration": 5000.0}


def moved(text: str) -> float:
    return sum(float(one) for one in re.findall(r"^G1 Y([-\d.]+)", text, flags=re.MULTILINE))


def test_klipper_records_each_move_between_two_calls() -> None:
    text = recipe("klipper", **MOVE, repeats=2)
    calls = re.findall(r"^ACCELEROMETER_MEASURE(?: NAME=(\S+))?$", text, flags=re.MULTILINE)
    assert calls == ["", "before_y_1", "", "before_y_2", "", "after_y_1", "", "after_y_2"]
    assert all(re.fullmatch(r"[A-Za-z0-9_-]+", name) for name in calls if name)  # what Klipper takes
    assert moved(text) == 0.0 and text.index("G91") < text.index("G1 Y")
    off, on = text.index("SET_INPUT_SHAPER SHAPER_FREQ_Y=0"), text.index("SHAPER_TYPE_Y=")
    assert off < text.index("before_y_1") < on < text.index("after_y_1")


def test_rrf_records_long_enough_and_never_too_long_a_name() -> None:
    text = recipe("rrf", **MOVE, repeats=2)
    assert [words["P"] for words in commands(text, "M593")] == ["none", "zvd"]
    recordings = commands(text, "M956")
    assert [words["F"] for words in recordings] == [f"{k}_y_{n}.csv" for k in ("before", "after") for n in (1, 2)]
    lasts = 0.3 + (100.0 / 200.0 + 200.0 / 5000.0) + 0.5  # quiet, the move, and enough after it
    assert all(float(words["S"]) / 1344.0 > lasts and words["A"] == "0" for words in recordings)
    assert moved(text) == 0.0


@pytest.mark.parametrize("shaper", [preshape.design.zvd((40.0, 0.05)), preshape.design.mzv((52.0, 0.08))])
def test_the_shaped_lines_do_what_an_export_would(shaper: preshape.Shaper) -> None:
    text = recipe("rrf", **MOVE, shaper=shaper)
    lines = [line for line in text.splitlines() if line.startswith("M593") and "none" not in line]
    exported = render(shaper, "rrf")
    assert TARGETS["rrf"].execute("\n".join(lines)) == exported.target.execute(exported.files)
    line = next(line for line in recipe("klipper", **MOVE, shaper=shaper).splitlines() if "SHAPER_TYPE_Y" in line)
    words = dict(word.lower().split("=") for word in line.split()[1:])
    settings = "[input_shaper]\n" + "\n".join(f"{name}: {value}" for name, value in words.items())
    exported = render(shaper, "klipper", axis="y")
    assert TARGETS["klipper"].execute(settings) == exported.target.execute(exported.files)
    assert "PUT YOUR SHAPER" not in text + line


def test_a_table_holds_the_move_and_what_the_shaper_makes_of_it() -> None:
    shaper = preshape.design.zvd((40.0, 0.05))
    lines = recipe("csv", **MOVE, shaper=shaper).splitlines()
    assert lines[0] == "time [s],unshaped [mm],shaped [mm]"
    times, unshaped, shaped = np.array([line.split(",") for line in lines[1:]], dtype=float).T
    assert np.allclose(np.diff(times), 0.001)
    assert unshaped[0] == shaped[0] == 0.0 and unshaped[-1] == shaped[-1] == pytest.approx(100.0)
    assert np.abs(np.diff(unshaped, 2)).max() <= 5000.0 * 0.001**2 * 1.001
    expected = sum(
        a * np.interp(times - t, times, unshaped) for t, a in zip(shaper.times, shaper.amplitudes, strict=True)
    )
    assert shaped == pytest.approx(expected, abs=2e-3)
    assert recipe("csv", **MOVE).splitlines()[0] == "time [s],unshaped [mm]"


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"target": "marlin"}, "one of klipper, rrf, csv"),
        ({"axis": "e"}, "it is x, y or z"),
        ({"speed": 0.0}, "speed 0 is out of range"),
        ({"distance": float("nan")}, "distance nan is out of range"),
        ({"repeats": 0}, "give 1 to 20"),
        ({"target": "csv", "speed": 0.5}, "a table holds 100 s"),
    ],
)
def test_wrong_wishes(wrong: dict[str, object], said: str) -> None:
    wishes: dict[str, object] = {"target": "klipper", **MOVE, **wrong}
    with pytest.raises(InputError, match=said):
        recipe(str(wishes.pop("target")), **wishes)  # type: ignore[arg-type]
