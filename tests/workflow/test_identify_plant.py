"""Identification of plants by what they do: against the modes that they have."""

from __future__ import annotations

import numpy as np
import pytest

from preshape import design
from preshape.errors import InputError
from preshape.plant import (
    FlexibleBody,
    FunctionPlant,
    ModalPlant,
    SampledPlant,
    SimulatorPlant,
    linear_mace,
    load_plant,
)
from preshape.workflow import identify_plant, simulate_plant


@pytest.mark.parametrize("excitation", ["pulse", "noise", "chirp"])
def test_every_excitation_finds_the_modes_of_the_gantry(excitation: str) -> None:
    gantry = load_plant("examples/data/machine.toml")
    found = identify_plant(gantry, 0.002, 3.0, excitation=excitation)
    assert found.clear and found.method == "ring-down" and len(found.modes) == 3
    for one, mode in zip(sorted(found.modes, key=lambda m: m.mode.frequency), gantry.modes(), strict=True):
        assert one.mode.frequency == pytest.approx(mode.frequency, rel=1e-7)
        assert one.mode.damping == pytest.approx(mode.damping, rel=1e-5)


def test_a_body_that_coasts_does_not_disturb() -> None:
    plant = SampledPlant(FlexibleBody(2.0, [(1.0, 0.02), (3.0, 0.01)], [1.0, 0.4]), "force", "N")
    found = identify_plant(plant, 0.02, 30.0)
    assert sorted(round(m.mode.frequency, 6) for m in found.modes) == [1.0, 3.0]


def test_modes_without_damping_are_found_as_such_and_a_wide_pulse_spares_the_fast_ones() -> None:
    plant = linear_mace()
    found = identify_plant(plant, 2e-4, 2.0, width=0.02, maximum=2)
    assert found.clear and "without damping" in found.trouble[-1]
    first, second = (one.mode for one in found.modes)
    assert first.damping == second.damping == 0.0
    assert first.frequency == pytest.approx(plant.modes()[0].frequency, rel=1e-3)
    assert second.frequency == pytest.approx(plant.modes()[1].frequency, rel=1e-3)


def test_a_softening_spring_is_found_at_the_amplitude_of_the_experiment() -> None:
    """A pendulum: its frequency falls with the amplitude as 1 - a^2 / 16, and the answer with it."""

    def swing(t: float, x: np.ndarray, u: np.ndarray) -> list[float]:
        return [x[1], -np.sin(x[0]) - 0.002 * x[1] + u[0]]

    plant = FunctionPlant(swing, [0.0, 0.0], {"angle": 0})
    small = identify_plant(plant, 0.1, 60.0, amplitude=0.01).modes[0].mode
    large = identify_plant(plant, 0.1, 60.0, amplitude=8.0).modes[0].mode
    assert small.omega == pytest.approx(1.0, abs=1e-5)
    assert large.omega == pytest.approx(1.0 - 0.8**2 / 16.0, abs=5e-3)


def test_a_bare_simulator_is_identified_shaped_and_simulated() -> None:
    def machine(u: np.ndarray, dt: float) -> dict[str, np.ndarray]:
        return {"tip": ModalPlant([(2.0, 0.03), (5.3, 0.02)]).response(u[0], dt).output}

    plant = SimulatorPlant(machine, inputs={"command": "m"}, outputs={"tip": "m"})
    found = identify_plant(plant, 0.01, 10.0)
    known = plant.with_modes([one.mode for one in found.modes])
    shaper = design.mesh(known.modes(), dt=0.01)
    assert simulate_plant(known, [1.0], 0.01, shaper).remaining("tip") < 1e-5


def test_one_input_of_several_is_shaken_and_one_output_looked_at() -> None:
    gantry = load_plant("examples/data/machine.toml")
    assert len(identify_plant(gantry, 0.002, 3.0, input="position", outputs=["tool"]).modes) == 3
    told: list[float] = []
    identify_plant(gantry, 0.002, 3.0, progress=told.append)
    assert told[-1] == 1.0


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        ({"duration": 0.02}, r"leave 9 samples of free vibration: give a longer duration"),
        ({"excitation": "hammer"}, "excitation is 'hammer': give 'pulse', 'noise' or 'chirp'"),
        ({"amplitude": 0.0}, "amplitude is 0"),
        ({"width": -1.0}, "width is -1 s"),
        ({"input": "torque"}, "input is 'torque': this plant has position"),
        ({"outputs": ["tip"]}, "output is 'tip': this plant has carriage, tool"),
        ({"dt": -1.0}, "dt is -1 s"),
    ],
)
def test_what_is_no_experiment_is_refused(changed: dict, sentence: str) -> None:
    asked: dict = {"plant": load_plant("examples/data/machine.toml"), "dt": 0.002, "duration": 3.0}
    with pytest.raises(InputError, match=sentence):
        identify_plant(**(asked | changed))


def test_a_plant_that_stands_still_is_said_to() -> None:
    still = SimulatorPlant(lambda u, dt: {"x": 0.0 * u[0]}, inputs={"u": ""}, outputs={"x": ""})
    with pytest.raises(InputError, match="nothing vibrates in x after the pulse at 'u'"):
        identify_plant(still, 0.01, 3.0)
