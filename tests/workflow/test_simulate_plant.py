"""Unshaped beside shaped: residuals against closed forms and theory, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape import Shaper, design
from preshape.errors import InputError
from preshape.plant import (
    Diverged,
    FlexibleStructure,
    FunctionPlant,
    LinearPlant,
    Output,
    SimulatorPlant,
    linear_mace,
    linear_mace_torque,
    load_plant,
    torque_pulses,
)
from preshape.vibration import residual_vibration
from preshape.workflow import simulate_plant

DT = 0.01


def oscillators(modes: list[tuple[float, float]], rigid: float = 0.0) -> FlexibleStructure:
    """Modes that each settle on the command, and a free body."""
    gains = [(2.0 * math.pi * f) ** 2 for f, _ in modes]
    weights = tuple(1.0 / len(modes) for _ in modes)
    return FlexibleStructure(modes, gains, {"x": Output(weights, rigid=rigid, unit="m")}, input="u", unit="m")


@given(st.floats(0.3, 3.0), st.floats(0.0, 0.2), st.integers(0, 10**6))
def test_what_remains_of_a_step_is_the_residual_vibration_of_the_theory(
    frequency: float, damping: float, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    delays = np.cumsum(rng.integers(1, 40, 3))
    weights = rng.uniform(0.1, 1.0, 4)
    shaper = Shaper(np.concatenate([[0], delays]) * DT, weights / weights.sum())
    plant = oscillators([(frequency, damping)])
    result = simulate_plant(plant, [1.0], DT, shaper)
    before, after = result.motions["x"]
    mode = plant.modes()[0]
    # Amplitude of the oscillation right after a step of height 1: 1 / sqrt(1 - z^2); V is that of the theory.
    assert before.residual == pytest.approx(1.0 / math.sqrt(1.0 - damping**2), rel=1e-9)
    wanted = float(residual_vibration(shaper, frequency, damping))
    assert result.remaining("x") == pytest.approx(wanted, abs=1e-9)
    assert result.command_end == 0.0 and result.shaped_end == pytest.approx(delays[-1] * DT)
    assert before.peak == pytest.approx(1.0 + mode.decay_per_half_period, rel=0.02)
    assert before.unexplained < 1e-12 and result.notes == ()


@pytest.mark.parametrize("last", [0.0, 0.3])
def test_modes_are_told_from_a_body_that_coasts_or_is_pushed(last: float) -> None:
    modes = [(1.0, 0.01), (1.7, 0.0), (4.0, 0.05)]
    command = np.concatenate([np.random.default_rng(3).normal(size=50), [last]])
    with_body = simulate_plant(oscillators(modes, rigid=3.0), command, DT, Shaper([0.0], [1.0])).motions["x"][0]
    without = simulate_plant(oscillators(modes), command, DT, Shaper([0.0], [1.0])).motions["x"][0]
    np.testing.assert_allclose(with_body.amplitudes, without.amplitudes, rtol=1e-6)
    assert with_body.settling_time == math.inf, "it drives on"
    assert with_body.trend.size == (3 if last else 2)
    if last:
        assert with_body.trend[2] == pytest.approx(0.5 * 3.0 * last, rel=1e-6)


def test_the_slew_of_linear_mace_leaves_what_hyde_says() -> None:
    """Amplitudes as the exact motion has them, 1.2 mm peak to peak; three modes shaped leave the other nine."""
    plant = linear_mace()
    dt = 1e-4
    pulses = torque_pulses(linear_mace_torque())
    torque = pulses((np.arange(10_001) + 0.5) * dt)
    shaper = design.mesh(list(plant.modes())[:3], dt=dt)
    result = simulate_plant(plant, torque, dt, shaper, rest=1.0)
    before, after = result.motions["left"]
    exact = np.abs(plant.weights("left") * plant.motion(pulses).residual_amplitudes)
    np.testing.assert_allclose(before.amplitudes, exact, atol=1e-9 * exact.max())
    assert 0.6e-3 <= before.residual < 0.65e-3
    assert after.amplitudes[:3].max() < 1e-9 * before.amplitudes[0]
    assert 0.0 < after.residual < 0.02 * before.residual


def test_settling_is_when_it_is_within_for_good() -> None:
    plant = oscillators([(1.0, 0.1)])
    result = simulate_plant(plant, [1.0], 1e-3, design.zv(plant.modes()), rest=12.0)
    before, after = result.motions["x"]
    # The envelope exp(-z w t) / sqrt(1 - z^2) is at 2 % after 6.2 s; the last crossing is within half a period before.
    assert 5.7 < before.settling_time < 6.25 and before.within == pytest.approx(0.02, rel=1e-2)
    assert after.settling_time <= design.zv(plant.modes()).duration + 1e-3
    short = simulate_plant(plant, [1.0], 1e-3, design.zv(plant.modes()), rest=3.0).motions["x"]
    assert short[0].settling_time == math.inf and short[1].settling_time == after.settling_time


def test_modes_too_fast_for_the_samples_are_left_open() -> None:
    plant = oscillators([(1.0, 0.02), (60.0, 0.001)])
    found = simulate_plant(plant, [1.0], DT, Shaper([0.0], [1.0])).motions["x"][0]
    assert found.amplitudes[0] == pytest.approx(0.5, rel=5e-2) and math.isnan(found.amplitudes[1])
    assert found.unexplained > 0.1


def test_a_shaper_off_the_samples_costs_what_the_note_says() -> None:
    plant = oscillators([(5.0, 0.0)])
    shaper = design.zv((5.0, 0.0))  # impulses at 0 and 0.1 s
    assert simulate_plant(plant, [1.0], 0.01, shaper).notes == ()
    coarse = simulate_plant(plant, [1.0], 0.03, shaper)
    assert len(coarse.notes) == 1 and "split onto both, which alone leaves" in coarse.notes[0]
    said = float(coarse.notes[0].split("leaves ")[1].split(" %")[0]) / 100.0
    assert coarse.remaining("x") == pytest.approx(said, rel=0.05)


def test_a_shaper_for_another_grid_is_refused() -> None:
    plant = oscillators([(5.0, 0.01)])
    shaper = design.mesh((5.0, 0.01), dt=0.004)
    with pytest.raises(
        InputError, match=r"grid of 0.004 s, and the simulation's step of 0.003 s does not fit: give 0.004"
    ):
        simulate_plant(plant, [1.0], 0.003, shaper)
    assert simulate_plant(plant, [1.0], 0.002, shaper).remaining("x") < 1e-9


def test_progress_runs_from_nothing_to_all_over_both_simulations() -> None:
    told: list[float] = []
    command = np.ones(20_000)
    plant = LinearPlant([[0.0, 1.0], [-40.0, -0.1]], [0.0, 1.0], [1.0, 0.0])
    simulate_plant(plant, command, DT, design.zv(plant.modes()), progress=told.append)
    assert told == sorted(told) and told[-1] == 1.0 and 0.5 in told and len(told) > 4


def test_several_inputs_are_each_shaped() -> None:
    a = np.array([[0.0, 1.0], [-40.0, -0.4]])
    plant = LinearPlant(a, [[0.0, 0.0], [1.0, -0.5]], [1.0, 0.0], inputs={"a": "N", "b": "N"}, outputs={"x": "m"})
    shaper = design.mesh(plant.modes(), dt=DT)
    result = simulate_plant(plant, [[1.0, 1.0, 0.0], [0.0, 1.0, 1.0]], DT, shaper)
    assert result.remaining("x") < 1e-9 and result.shaped.command.shape == result.unshaped.command.shape
    assert set(result.inputs) == {"a", "b"} and result.dt == pytest.approx(DT)


def test_a_plant_that_runs_away_says_when_and_keeps_the_rest() -> None:
    runaway = FunctionPlant(lambda t, x, u: [x[1], 30.0 * x[1] - 900.0 * x[0] + u[0]], [0.0, 0.0], {"x": 0})
    with pytest.raises(InputError, match="the plant is unstable"):
        simulate_plant(runaway, [1.0], DT, design.zv((5.0, 0.0)))
    with pytest.raises(Diverged, match=r"diverged at 2\.\d+ s: the state has run away") as stop:
        simulate_plant(runaway, [1.0], DT, design.zv((5.0, 0.0)), modes=(5.0, 0.0), rest=9.0)
    assert 150 < stop.value.partial.times.size < 300


@pytest.mark.parametrize(
    ("changed", "sentence"),
    [
        ({"rest": 0.1}, r"rest is 0.1 s, and the slowest mode has a period of 1 s: give at least 2 s"),
        ({"dt": 0.0}, "dt is 0 s"),
        ({"command": [math.nan]}, "the command holds NaN"),
        ({"command": [[1.0], [1.0]]}, "give one row of samples for each"),
        ({"tolerance": 2.0}, "tolerance 2.0 is outside"),
        ({"dt": 1e-7}, "would take .* samples of 1e-07 s: give a larger dt"),
        ({"plant": SimulatorPlant(lambda u, dt: {"x": u[0]}, inputs={"u": ""}, outputs={"x": ""})}, "identify_plant"),
        ({"plant": LinearPlant([[-1.0]], [1.0], [1.0])}, "nothing vibrates"),
    ],
)
def test_what_cannot_be_simulated_is_refused(changed: dict, sentence: str) -> None:
    asked: dict = {"plant": oscillators([(1.0, 0.01)]), "command": [1.0], "dt": DT, "shaper": design.zv((1.0, 0.01))}
    with pytest.raises(InputError, match=sentence):
        simulate_plant(**(asked | changed))


def test_the_example_machine_is_brought_to_rest() -> None:
    gantry = load_plant("examples/data/machine.toml")
    result = simulate_plant(gantry, np.minimum(np.arange(250) * 1e-3, 0.2), 1e-3, design.mesh(gantry.modes(), dt=1e-3))
    assert result.remaining("tool") < 1e-9 and result.remaining("carriage") < 1e-9


def test_a_command_that_the_arm_does_not_notice_is_said_and_has_no_share() -> None:
    """Its joints look every 80 ms: a pulse of 20 ms is over before, and rounding over rounding is no share."""
    from preshape.plant import ShuttleArm

    pulse = np.zeros((6, 3))
    pulse[0, 0] = 0.01
    result = simulate_plant(ShuttleArm(), pulse, 0.02, design.zv((0.91, 0.029)), rest=3.0)
    assert any(note.startswith("nothing moves") for note in result.notes)
    assert all(np.isnan(result.remaining(name)) for name in result.motions)
    longer = simulate_plant(ShuttleArm(), np.repeat(pulse[:, :1], 50, axis=1), 0.02, design.zv((0.91, 0.029)), rest=3.0)
    assert not any(note.startswith("nothing moves") for note in longer.notes)
    assert longer.remaining("shoulder yaw angle") < 1.0
