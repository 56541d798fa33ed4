"""Wrong campaign files: one sentence that names what came and what is allowed; nothing is evaluated."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.campaign.campaigns import campaign, mode_map, robustness

from preshape.campaign import campaign_of, read_campaign
from preshape.errors import InputError

MODE_MAP, ROBUSTNESS = mode_map(3), robustness(3)

WRONG: list[tuple[dict[str, Any], str, Any, str]] = [
    (ROBUSTNESS, "schema", "preshape/campaign/2", "its schema is 'preshape/campaign/2': write schema = "),
    (ROBUSTNESS, "schema", None, "its schema is None"),
    (ROBUSTNESS, "robustnes", {}, "unknown field `robustnes`"),
    (ROBUSTNESS, "robustness", None, r"describes 0 campaigns: give one of \[robustness\], \[map\], \[schedule\]"),
    (ROBUSTNESS, "map", MODE_MAP["map"], "describes 2 campaigns"),
    (ROBUSTNESS, "robustness.points", 0, "Expected `int` >= 1 - at `.*points`"),
    (ROBUSTNESS, "robustness.points", 10**9, "Expected `int` <= 10000000"),
    (ROBUSTNESS, "robustness.points", 3.5, "Expected `int`, got `float`"),
    (ROBUSTNESS, "robustness.seed", -1, "Expected `int` >= 0"),
    (ROBUSTNESS, "robustness.scatter", {"stiffness": 0.1}, "scatter names 'stiffness'.*it has frequency, damping"),
    (ROBUSTNESS, "robustness.scatter", {"frequency": -0.1}, "scatter of frequency is -0.1: give a part from 0 to 1"),
    (
        ROBUSTNESS,
        "robustness.scatter",
        {"frequency": float("nan")},
        "scatter.frequency holds nan: give finite",
    ),
    (ROBUSTNESS, "robustness.scatter", {}, "nothing varies"),
    (ROBUSTNESS, "robustness.ranges", {"payload": [0, 1]}, "ranges names 'payload'.*it has none"),
    (ROBUSTNESS, "robustness.output", "tool", "output is 'tool': this plant has position"),
    (ROBUSTNESS, "robustness.tolerance", 5.0, r"tolerance 5.0 is outside \(0, 1\)"),
    (ROBUSTNESS, "robustness.move.dt", 0.0, "move.dt is 0 s: give a value above 0 s"),
    (ROBUSTNESS, "robustness.move.dt", 1e-9, "samples of 1e-09 s: give a larger dt"),
    (ROBUSTNESS, "robustness.move.input", "torque", "input is 'torque': this plant has position"),
    (ROBUSTNESS, "robustness.move.values", [1.0, 2.0], "1 times and 2 values"),
    (ROBUSTNESS, "robustness.move.values", [0.0], "values are all 0: nothing moves"),
    (ROBUSTNESS, "robustness.move.times", [-1.0], "times do not increase from 0 s on"),
    (ROBUSTNESS, "robustness.move.times", [float("inf")], "robustness.move.times holds inf: give finite"),
    (ROBUSTNESS, "robustness.move.between", "curved", "Invalid enum value 'curved'"),
    (ROBUSTNESS, "machine.modes", [[-1.0, 0.0]], "frequency -1 Hz is not a natural frequency"),
    (ROBUSTNESS, "machine.modes", [[1.0, 1.5]], "damping ratio 1.5 is outside"),
    (ROBUSTNESS, "machine.modes", [[1.0, 0.0]] * 101, "Expected `array` of length <= 100"),
    (ROBUSTNESS, "machine.modes", None, r"\[machine\] describes 0 machines"),
    (ROBUSTNESS, "machine.plant", "pendulum", r"\[machine\] describes 2 machines"),
    (
        ROBUSTNESS,
        "machine",
        {"plant": "crane"},
        "machine.plant is 'crane': give a plant file, .toml or .json",
    ),
    (ROBUSTNESS, "machine", {"plant": "missing.toml"}, "cannot read missing.toml"),
    (ROBUSTNESS, "machine", {"plant": {"modal": {}}}, "not a preshape/plant/1 file"),
    (ROBUSTNESS, "machine", {"plant": "mace-linear", "damping": 0.1}, "machine.damping is a pendulum's"),
    (
        ROBUSTNESS,
        "machine",
        {"plant": "mace-linear", "payload_at": 1},
        "payload_at is a coordinate of matrices",
    ),
    (ROBUSTNESS, "machine.parameters", {"length": "m"}, "machine.parameters name the numbers of a table"),
    (ROBUSTNESS, "shaper", {}, r"\[shaper\] needs one of family and file"),
    (ROBUSTNESS, "shaper.family", "zvx", "shaper.family is 'zvx': choose one of zv, zvd"),
    (ROBUSTNESS, "shaper.humps", 2, "shaper.family zvd takes no humps: leave it out"),
    (ROBUSTNESS, "shaper", {"family": "si"}, "shaper.family si needs width"),
    (ROBUSTNESS, "shaper", {"family": "si", "width": 3.0}, "shaper.width is 3: give a part"),
    (ROBUSTNESS, "shaper", {"file": "missing.json"}, "cannot read missing.json"),
    (ROBUSTNESS, "shaper", {"file": 3}, "shaper.file is 3"),
    (ROBUSTNESS, "shaper.count", 4, "has 1 mode.* here, and shaper.count asks for 4"),
    (MODE_MAP, "map.axes", {}, "grid has 0 axes: give one to six"),
    (MODE_MAP, "map.axes", {"x": {"values": [1.0]}}, "axis 'x' is no parameter of the machine: it has s"),
    (MODE_MAP, "map.axes.s.values", [1.0], "'s' needs values, or low, high and count: give one of the two"),
    (MODE_MAP, "map.axes.s", {"low": 1.0, "high": 1.2}, "'s' needs values, or low, high and count"),
    (MODE_MAP, "map.axes.s", {"values": [1.2, 1.1]}, "values of the axis 's' do not increase"),
    (MODE_MAP, "map.axes.s", {"low": 0.0, "high": float("inf"), "count": 3}, "map.axes.s.high holds inf"),
    (MODE_MAP, "map.frequency_error", 1.5, "Expected `float` < 1.0"),
    (MODE_MAP, "map.fixed", {"s": 1.0}, "fixed.s is no parameter of the machine that is free"),
    (MODE_MAP, "machine.table", [{"at": [1.0, 2.0], "modes": [[1.0, 0.0]]}], "2 number.* and 1 parameter"),
    (MODE_MAP, "machine.table", [{"at": [1.0], "modes": [[1.0, 0.0]]}] * 2, "names a configuration twice"),
]


@pytest.mark.parametrize(("data", "name", "value", "sentence"), WRONG, ids=[f"{w[1]}-{k}" for k, w in enumerate(WRONG)])
def test_what_is_wrong_is_said(data: dict[str, Any], name: str, value: Any, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence) as caught:
        campaign(data, (name, value))
    assert "\n" not in str(caught.value) and str(caught.value).endswith(".")


def test_a_schedule_wants_direct_shapers_and_not_too_many_rows() -> None:
    data = {**MODE_MAP, "schedule": {"axes": {"s": {"low": 1.0, "high": 1.3, "count": 3}}}}
    del data["map"]
    with pytest.raises(InputError, match='give shaper.family = "direct"'):
        campaign(data, ("shaper", {"family": "zvd"}))
    with pytest.raises(InputError, match="has 90000 rows: give at most 50000"):
        campaign(data, ("schedule.axes.s.count", 90000))


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "its schema is None"),
        (b"schema = ", "is not TOML"),
        (b"\xff\xfe", "is not TOML"),
        (b"a = " + b"[" * 100_000, "is not TOML|its schema"),
        (b"#" * 10_000_001, "has 10 MB and a campaign file at most 10 MB"),
    ],
)
def test_files_that_are_none(content: bytes, sentence: str, tmp_path: Path) -> None:
    (tmp_path / "file.toml").write_bytes(content)
    with pytest.raises(InputError, match=sentence) as caught:
        read_campaign(tmp_path / "file.toml")
    assert "file.toml" in str(caught.value)
    with pytest.raises(InputError, match="cannot read .*give a campaign file"):
        read_campaign(tmp_path / "missing.toml")
    with pytest.raises(InputError, match="is not a regular file"):
        read_campaign(tmp_path)


TREES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=8,
)


@given(
    st.sampled_from([MODE_MAP, ROBUSTNESS]),
    st.sampled_from(
        ["machine", "machine.modes", "shaper", "shaper.order", "map.axes", "robustness.move", "robustness"]
    ),
    TREES,
)
def test_whatever_stands_there_is_refused_in_a_sentence_or_taken(data: dict[str, Any], name: str, value: Any) -> None:
    try:
        campaign(data, (name, value))
    except InputError:
        return


def test_a_campaign_rebuilt_from_its_inputs_is_the_same() -> None:
    import msgspec

    first = campaign(ROBUSTNESS)
    again = campaign_of({"schema": ROBUSTNESS["schema"], **msgspec.json.decode(first.inputs)})
    assert (again.inputs, again.digest) == (first.inputs, first.digest)


def test_the_order_of_tables_in_the_file_does_not_matter() -> None:
    turned = {key: ROBUSTNESS[key] for key in reversed(ROBUSTNESS)}
    scatter = ("robustness.scatter", {"damping": 0.1, "frequency": 0.1})
    other = ("robustness.scatter", {"frequency": 0.1, "damping": 0.1})
    assert campaign(turned, scatter) == campaign(ROBUSTNESS, other)
    assert campaign(turned, scatter).kind().row(1) == campaign(ROBUSTNESS, other).kind().row(1)
