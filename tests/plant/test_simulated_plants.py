"""The laws of every plant that is simulated."""

from __future__ import annotations

import numpy as np
import pytest
from tests.plant.simulated_plants import PLANTS

from preshape.errors import InputError
from preshape.mode import Modes
from preshape.plant import SimulatedPlant

EACH = pytest.mark.parametrize("name", PLANTS)
STEADY = pytest.mark.parametrize("name", [name for name, one in PLANTS.items() if one.static])
LINEAR = pytest.mark.parametrize("name", [name for name, one in PLANTS.items() if one.linear])
STAYS = pytest.mark.parametrize("name", [name for name, one in PLANTS.items() if one.stays])


def random_command(plant: SimulatedPlant, count: int, seed: int = 1) -> np.ndarray:
    return np.random.default_rng(seed).normal(size=(len(plant.inputs), count)) * 0.1


def close(found: dict, wanted: dict, tolerance: float) -> None:
    assert list(found) == list(wanted)
    for name, values in wanted.items():
        scale = max(float(np.abs(values).max(initial=0.0)), 1e-300)
        np.testing.assert_allclose(found[name], values, rtol=0, atol=tolerance * scale, err_msg=name)


@EACH
def test_it_offers_what_the_protocol_asks(name: str) -> None:
    plant = PLANTS[name].make()
    assert isinstance(plant, SimulatedPlant)
    assert isinstance(plant.modes(), Modes) and plant.modes() == plant.modes(None)
    assert plant.inputs and plant.outputs
    command = random_command(plant, 7)
    found = plant.simulate(command, PLANTS[name].dt)
    np.testing.assert_array_equal(found.times, PLANTS[name].dt * np.arange(7))
    np.testing.assert_array_equal(found.command, command)
    assert dict(found.units) == dict(plant.outputs) and list(found.outputs) == list(plant.outputs)
    assert all(values.shape == (7,) for values in found.outputs.values())


@EACH
def test_nothing_in_nothing_out(name: str) -> None:
    plant = PLANTS[name].make()
    found = plant.simulate(np.zeros((len(plant.inputs), 200)), PLANTS[name].dt)
    assert all(not values.any() for values in found.outputs.values())


@LINEAR
def test_outputs_add_up_as_commands_do(name: str) -> None:
    one = PLANTS[name]
    plant = one.make()
    first, second = random_command(plant, 300, 1), random_command(plant, 300, 2)
    both = plant.simulate(2.0 * first - 3.0 * second, one.dt).outputs
    apart = plant.simulate(first, one.dt).outputs, plant.simulate(second, one.dt).outputs
    close(dict(both), {key: 2.0 * apart[0][key] - 3.0 * apart[1][key] for key in both}, 10.0 * one.tolerance)


@EACH
def test_what_comes_later_changes_nothing_before(name: str) -> None:
    one = PLANTS[name]
    plant = one.make()
    command = random_command(plant, 200)
    whole, begun = plant.simulate(command, one.dt).outputs, plant.simulate(command[:, :77], one.dt).outputs
    close(dict(begun), {key: values[:77] for key, values in whole.items()}, one.tolerance)


@STAYS
def test_a_later_command_has_a_later_effect(name: str) -> None:
    one = PLANTS[name]
    plant = one.make()
    command = random_command(plant, 150)
    late = np.concatenate([np.zeros((len(plant.inputs), 41)), command], axis=1)
    now, then = plant.simulate(command, one.dt).outputs, plant.simulate(late, one.dt).outputs
    close({key: values[41:] for key, values in then.items()}, dict(now), 100.0 * one.tolerance)


@STEADY
def test_a_step_settles_at_its_static_value(name: str) -> None:
    one = PLANTS[name]
    plant = one.make()
    command = np.zeros((len(plant.inputs), 4000))
    command[0] = 1.0
    found = plant.simulate(command, one.dt)
    for key, value in one.static.items():
        scale = max(float(np.abs(found.outputs[key]).max()), 1e-300)
        assert abs(found.outputs[key][-1] - value) < 1e-5 * scale, key


@EACH
@pytest.mark.parametrize(
    ("command", "dt"), [([np.nan, 0.0], 0.01), ([], 0.01), ([[0.0, 1.0]] * 3, 0.01), (["x"], 0.01), ([0.0, 1.0], 0.0)]
)
def test_a_wrong_command_is_refused_in_a_sentence(name: str, command: list, dt: float) -> None:
    with pytest.raises(InputError, match=r"give|is [\d-]"):
        PLANTS[name].make().simulate(command, dt)
