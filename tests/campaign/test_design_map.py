"""Design maps and schedules over a workspace are what the designs of their points are, and the schedule loads."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pyarrow.parquet
import pytest
from tests.campaign.campaigns import SCHEMA, campaign, mode_map

from preshape import design
from preshape.campaign import run_campaign
from preshape.campaign.machines.pendulum import GRAVITY
from preshape.engine import is_proved_shortest
from preshape.errors import InputError
from preshape.plant import ShuttleArm
from preshape.stream import Schedule, load_schedule
from preshape.vibration import insensitivity, residual_vibration

CRANE: dict[str, Any] = {
    "schema": SCHEMA,
    "machine": {"plant": "pendulum", "damping": 0.01},
    "shaper": {"family": "zvd"},
    "map": {"axes": {"length": {"values": [1.0, 2.0, 5.0]}}, "tolerance": 0.05, "frequency_error": 0.1},
}

SCHEDULE: dict[str, Any] = {
    "schema": SCHEMA,
    "machine": {"plant": "shuttle-arm"},
    "shaper": {"family": "direct", "count": 3},
    "schedule": {
        "fixed": {"payload": 1000.0},
        "axes": {"elbow pitch": {"low": -1.6, "high": -0.8, "count": 5}, "wrist pitch": {"values": [-0.5, 0.0]}},
    },
}


def test_a_crane_over_its_rope(tmp_path: Path) -> None:
    run_campaign(campaign(CRANE), tmp_path, workers=0)
    for row in pyarrow.parquet.read_table(tmp_path / "results.parquet").to_pylist():
        mode = (math.sqrt(GRAVITY / row["length"]) / (2.0 * math.pi), 0.01)
        shaper = design.zvd(mode)
        assert row["slowest mode"] == pytest.approx(mode[0], rel=1e-15)
        assert row["duration"] == pytest.approx(1.0 / (mode[0] * math.sqrt(1.0 - 0.01**2)), rel=1e-12)
        assert row["insensitivity"] == insensitivity(shaper, mode, 0.05).value
        ends = residual_vibration(shaper, [0.9 * mode[0], 1.1 * mode[0]], 0.01).max()
        assert row["vibration off"] == pytest.approx(float(ends), rel=1e-12), "of ZVD the ends are the worst"
        assert row["proved shortest"] == 0.0 and row["impulses"] == 3.0


def test_two_axes_run_as_numpy_does(tmp_path: Path) -> None:
    data = campaign(SCHEDULE)
    kind = data.kind()
    assert kind.count == 10
    for point in range(10):
        k, j = np.unravel_index(point, (5, 2))
        row = kind.row(point)
        assert (row["elbow pitch"], row["wrist pitch"]) == (np.linspace(-1.6, -0.8, 5)[k], [-0.5, 0.0][j])


def test_the_schedule_that_is_written_is_used_as_it_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    run = run_campaign(campaign(SCHEDULE), tmp_path, workers=0)
    assert [path.name for path in run.files] == ["results.parquet", "figure.svg", "schedule.json"]
    schedule = load_schedule(tmp_path / "schedule.json")
    from preshape.plant.shuttle_arm import Payload

    arm = ShuttleArm(payload=Payload(1000.0))
    pose = [0.0, 0.0, -1.2, -0.5, 0.0, 0.0]
    for mode, right in zip(schedule.modes([-1.2, -0.5]), arm.modes(pose)[:3], strict=True):
        assert mode.frequency == pytest.approx(right.frequency, rel=1e-9)
    calls: list[object] = []
    cold = design.direct
    monkeypatch.setattr(
        "preshape.stream.schedule.direct", lambda *a, near=None, **k: calls.append(near) or cold(*a, near=near, **k)
    )
    shaper = schedule.shaper([-1.15, -0.45])
    assert calls and calls[0] is not None and len(calls) == 1, "the row beside is there: no cold design"
    assert is_proved_shortest(shaper)
    same = Schedule(
        {key: schedule.modes(key) for key in [(a, b) for a in np.linspace(-1.6, -0.8, 5) for b in (-0.5, 0)]}
    )
    assert shaper == same.shaper([-1.15, -0.45]), "what a schedule without shapers designs"


def test_how_far_interpolation_is_off_is_measured_halfway(tmp_path: Path) -> None:
    """Of a rope f goes as 1 / sqrt(length): halfway the geometric mean of two rows is off by a known amount."""
    data = {
        **CRANE, "shaper": {"family": "direct"}, "map": None, "schedule": {"axes": {"length": {"values": [2.0, 4.0]}}}
    }  # fmt: skip
    kind = campaign({key: value for key, value in data.items() if value is not None}).kind()
    expected = abs((1.0 / math.sqrt(math.sqrt(2.0 * 4.0))) * math.sqrt(3.0) - 1.0)
    assert kind.row(0)["frequency error between"] == pytest.approx(expected, rel=1e-12)
    assert math.isnan(float(kind.row(1)["frequency error between"])), "there is no next row"


def test_without_all_rows_there_is_no_schedule(tmp_path: Path) -> None:
    """The arm has less modes than are asked for: each row says so, and no half table is written."""
    run = run_campaign(campaign(SCHEDULE, ("shaper.count", 60)), tmp_path, workers=0)
    assert run.summary.failed == 10 and "shaper.count asks for 60" in run.summary.failures[0][0]
    assert not (tmp_path / "schedule.json").exists()


def test_a_schedule_file_that_was_tampered_with(tmp_path: Path) -> None:
    run_campaign(campaign(SCHEDULE), tmp_path, workers=0)
    data = json.loads((tmp_path / "schedule.json").read_text())
    wrong = tmp_path / "wrong.json"

    def refused(match: str) -> None:
        wrong.write_text(json.dumps(data))
        with pytest.raises(InputError, match=match):
            load_schedule(wrong)

    data["rows"][2]["modes"][0][0] *= 1.01
    refused("is not the direct one for the table's modes there")
    data["rows"].pop(2)
    refused("is no grid")
    data["order"] = 0
    refused("is no grid|another order")
    data["more"] = 1
    refused("unknown field `more`")
    data = {**data, "schema": "preshape/schedule/9"}
    del data["more"]
    refused("this version reads 'preshape/schedule/1'")
    with pytest.raises(InputError, match="cannot read"):
        load_schedule(tmp_path / "nothing.json")


def test_a_table_of_modes_is_interpolated_as_a_schedule_does() -> None:
    kind = campaign(mode_map(7)).kind()
    row = kind.row(3)
    assert row["s"] == pytest.approx(1.15)
    assert row["slowest mode"] == pytest.approx(0.2 * math.sqrt(1.3), rel=1e-12)
    assert row["proved shortest"] == 1.0
