"""The plant file: what it describes, and what is said of everything else that may stand in it."""

from __future__ import annotations

import json
import math
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from preshape.errors import InputError
from preshape.plant import FlexibleStructure, LinearPlant, SimulatedPlant, load_plant
from preshape.plant.plant_file import BUILT_IN, LARGEST_FILE

EXAMPLE = Path(__file__).parents[2] / "examples" / "data" / "machine.toml"
TAG = 'schema = "preshape/plant/1"\n'

MATRICES: dict[str, Any] = {
    "mass": [[2.0, 0.0], [0.0, 1.0]],
    "damping": 0.01,
    "stiffness": [[6.0, -6.0], [-6.0, 6.0]],
    "input": {"name": "force", "unit": "N", "coordinate": 0},
    "outputs": [{"name": "bend", "unit": "m", "weights": [-1.0, 1.0]}],
}
STATE_SPACE: dict[str, Any] = {
    "A": [[0.0, 1.0], [-9.0, -0.06]], "B": [[0.0], [1.0]], "C": [[1.0, 0.0]],
    "inputs": [{"name": "force", "unit": "N"}], "outputs": [{"name": "bend", "unit": "m"}],
}  # fmt: skip
MODAL: dict[str, Any] = {
    "modes": [{"frequency": 3.0 / (2.0 * math.pi), "damping": 0.01, "gain": 1.0}],
    "input": {"name": "force", "unit": "N"}, "outputs": [{"name": "bend", "unit": "m", "weights": [1.0]}],
}  # fmt: skip


def write(folder: Path, content: dict[str, Any] | str | bytes, name: str = "plant.json") -> Path:
    path = folder / name
    if isinstance(content, dict):
        content = json.dumps({"schema": "preshape/plant/1", **content})
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize(
    ("part", "kind"),
    [
        ({"matrices": MATRICES}, FlexibleStructure),
        ({"state_space": STATE_SPACE}, LinearPlant),
        ({"modal": MODAL}, FlexibleStructure),
    ],
)
def test_all_three_forms_describe_the_same_oscillator(part: dict, kind: type, tmp_path: Path) -> None:
    plant = load_plant(write(tmp_path, part))
    assert isinstance(plant, kind) and isinstance(plant, SimulatedPlant)
    assert dict(plant.inputs) == {"force": "N"} and dict(plant.outputs) == {"bend": "m"}
    assert plant.modes()[0].omega == pytest.approx(3.0) and plant.modes()[0].damping == pytest.approx(0.01)
    values = plant.simulate(np.ones(100), 0.01).outputs["bend"]
    scale = -0.5 if part.get("matrices") else 1.0  # b = -1 / 2 across the spring of two masses
    # The step response of w = 3 rad/s, z = 0.01 at the last sample, in closed form.
    decay, damped, last = 0.03, 3.0 * math.sqrt(1.0 - 0.01**2), 0.99
    swing = math.cos(damped * last) + decay / damped * math.sin(damped * last)
    assert values[-1] / scale == pytest.approx((1.0 - math.exp(-decay * last) * swing) / 9.0, rel=1e-12)


def test_toml_and_the_example_and_what_comes_along(tmp_path: Path) -> None:
    text = TAG + "[modal]\nmodes = [{frequency = 2}]\ninput = {name = 'u'}\noutputs = [{name = 'y', weights = [1]}]"
    assert load_plant(write(tmp_path, text, "plant.toml")).modes()[0].frequency == 2.0
    assert len(load_plant(EXAMPLE).modes()) == 3
    for name in BUILT_IN:
        assert isinstance(load_plant(name), SimulatedPlant)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        ({}, "describes 0 plants: give one of matrices, state_space and modal"),
        ({"matrices": MATRICES, "modal": MODAL}, "describes 2 plants"),
        ({"schema": "preshape/plant/9", "modal": MODAL}, "its schema is 'preshape/plant/9': write 'preshape/plant/1'"),
        ({"matrices": MATRICES | {"dampin": 0.1}}, r"unknown field `dampin`.*matrices"),
        ({"matrices": MATRICES | {"mass": "heavy"}}, r"Expected `array`.*matrices\.mass"),
        ({"matrices": MATRICES | {"mass": [[1.0, 2.0], [2.0, 1.0]]}}, "mass is not positive definite"),
        ({"matrices": MATRICES | {"mass": [[1.0], [2.0, 1.0]]}}, "mass is not a matrix of numbers"),
        ({"matrices": MATRICES | {"input": {"name": "u"}}}, "'u' needs a place: give one of coordinate"),
        ({"matrices": MATRICES | {"input": {"name": "u", "coordinate": 7}}}, "the coordinate of input is 7"),
        ({"matrices": MATRICES | {"outputs": MATRICES["outputs"] * 2}}, "two outputs are named 'bend'"),
        ({"matrices": {k: v for k, v in MATRICES.items() if k != "stiffness"}}, "missing required field `stiffness`"),
        ({"state_space": STATE_SPACE | {"B": [[1.0]]}}, r"B has shape \(1, 1\)"),
        ({"state_space": STATE_SPACE | {"inputs": []}}, "0 inputs are named"),
        ({"modal": MODAL | {"modes": []}}, "no mode was given"),
        ({"modal": MODAL | {"outputs": [{"name": "y", "weights": [1.0, 2.0]}]}}, "output 'y' has 2 value"),
        ("", "is empty"),
        ("  \n", "is empty"),
        ('{"schema": "preshape/plant/1", "mod', "is not JSON .*truncated"),
        ("[" * 100_000, "is not JSON"),
        (b"\xff\xfe\x00", "is not JSON"),
        ('{"schema": "preshape/plant/1", "modal": {"modes": [{"frequency": NaN}]}}', "is not JSON"),
        ("[1, 2]", "not a preshape/plant/1 file: Expected `object`"),
    ],
)
def test_bad_files_are_refused_in_one_sentence_that_names_the_file(
    content: dict | str | bytes, sentence: str, tmp_path: Path
) -> None:
    with pytest.raises(InputError, match=sentence) as stop:
        load_plant(write(tmp_path, content))
    assert "plant.json" in str(stop.value) and "\n" not in str(stop.value)


def test_bad_toml_is_refused(tmp_path: Path) -> None:
    for content in ("schema = ", TAG + "[modal", "a = " + "[" * 5000, b"\xff"):
        with pytest.raises(InputError, match="is not TOML"):
            load_plant(write(tmp_path, content, "plant.toml"))
    nan = TAG + "[modal]\nmodes = [{frequency = nan}]\ninput = {name = 'u'}\noutputs = [{name = 'y', weights = [1]}]"
    with pytest.raises(InputError, match="frequency nan Hz is not a natural frequency"):
        load_plant(write(tmp_path, nan, "plant.toml"))


def test_what_is_no_file_of_a_sensible_size_is_refused_unread(tmp_path: Path) -> None:
    huge = tmp_path / "huge.json"
    with open(huge, "wb") as stream:
        stream.truncate(LARGEST_FILE + 1)
    with pytest.raises(InputError, match="a plant file at most 100 MB"):
        load_plant(huge)
    with pytest.raises(InputError, match="is not a regular file"):
        load_plant(tmp_path)
    os.mkfifo(tmp_path / "pipe.json")
    with pytest.raises(InputError, match="is not a regular file"):
        load_plant(tmp_path / "pipe.json")
    with pytest.raises(InputError, match=r"cannot read .*No such file.*or one of mace-linear"):
        load_plant(tmp_path / "nothing.json")
    with pytest.raises(InputError, match=r"end it in \.json or \.toml"):
        load_plant(write(tmp_path, "x", "plant.yaml"))
    with pytest.raises(InputError, match="cannot read"):
        load_plant("a\0b.json")


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(cut=st.integers(0, 400), flip=st.binary(min_size=1, max_size=3))
def test_any_damage_is_read_or_refused_in_a_sentence(cut: int, flip: bytes, tmp_path: Path) -> None:
    whole = json.dumps({"schema": "preshape/plant/1", "matrices": MATRICES}).encode()
    for content in (whole[:cut], whole[:cut] + flip + whole[cut + len(flip) :]):
        try:
            load_plant(write(tmp_path, content))
        except InputError as problem:
            assert "plant.json" in str(problem)


def test_a_payload_is_mass_on_a_coordinate() -> None:
    from preshape.plant.plant_file import plant_of, read_plant_data

    data = read_plant_data(Path(__file__).parents[2] / "examples" / "data" / "machine.toml")
    heavier = {**data, "matrices": {**data["matrices"]}}
    heavier["matrices"]["mass"] = [[8.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 1.2 + 0.4]]
    assert plant_of(data, {2: 0.4}).modes() == plant_of(heavier).modes()
    assert plant_of(data, {2: 0.0}).modes() == plant_of(data).modes(), "and what was read stays as it was"
    with pytest.raises(InputError, match="payload's coordinate is 3: give a whole number from 0 to 2"):
        plant_of(data, {3: 0.4})
    with pytest.raises(InputError, match="the payload is -1 kg: give 0 kg or more"):
        plant_of(data, {2: -1.0})
    modal = {
        "schema": data["schema"],
        "modal": {
            "modes": [{"frequency": 1.0}],
            "input": {"name": "force"},
            "outputs": [{"name": "tip", "weights": [1.0]}],
        },
    }
    with pytest.raises(InputError, match="has no matrices, so no mass can be put on a coordinate"):
        plant_of(modal, {0: 1.0})
