"""Deflection while moving and its sensitivity: Robertson's commands and shapers, recomputed, and scaling laws."""

import math

import numpy as np
import pytest
from tests.plant.robertson_commands import limited, on_off

from preshape import Shaper
from preshape.errors import InputError
from preshape.plant import (
    FloatingOscillator,
    ModalPlant,
    PositionedMass,
    deflection_sensitivity,
    transient_deflection,
)
from preshape.profile import Profile
from preshape.vibration import residual_vibration

RATIOS = [0.90, 0.95, 0.98, 1.0, 1.02, 1.05, 1.10]


@pytest.mark.parametrize("distance", [1.2, 5.0, 10.0, 20.0, 60.0])
def test_on_off_and_limited_commands_keep_their_deflection_exactly(distance: float) -> None:
    plant = FloatingOscillator(1.0, 1.0, 1.0)
    for command, expected in [(on_off(distance), 0.5), (limited(distance, 0.6), 0.3), (limited(distance, 0.2), 0.1)]:
        assert transient_deflection(plant, command).value == pytest.approx(expected, rel=1e-13)
        assert plant.motion(command).residual("deflection") < 1e-13
        assert plant.motion(command)("second_position", 1e3) == pytest.approx(distance, rel=1e-11)


@pytest.mark.parametrize(
    ("distance", "expected"),
    [
        (5.0, [1.627, 1.258, 1.092, 1.0, 0.992, 0.976, 0.952]),
        (10.0, [1.623, 1.327, 1.133, 1.0, 1.056, 1.147, 1.299]),
        (15.0, [None, None, 1.156, 1.0, 1.063, 1.135, 1.184]),
        (20.0, [None, None, 1.116, 1.0, 1.014, 1.007, 0.991]),
    ],
)
def test_deflection_over_frequency_error_figure_12(distance: float, expected: list[float | None]) -> None:
    plant = FloatingOscillator(1.0, 1.0, 1.0)
    found = deflection_sensitivity(plant, limited(distance, 0.6), frequency_ratios=RATIOS, limit=0.3)
    for value, known in zip(found.relative[0], expected, strict=True):
        assert known is None or round(float(value), 3) == known


SD = {
    0.4: Shaper.normalised([0.0, 0.31010, 0.64994], [0.4, 0.308301, 0.291699]),
    0.3: Shaper.normalised([0.0, 0.43335, 0.88205], [0.3, 0.481226, 0.218774]),
}
"""Specified-deflection shapers for 1 Hz, z = 0.1, to the printed digits."""


def trapezoid() -> Profile:
    return Profile.steps([0.0, 1.5, 3.5, 5.0], 2.0 / 1.5 * np.array([1.0, -1.0, -1.0, 1.0]), order=1)


@pytest.mark.parametrize(
    ("ratio", "frequency_ratios", "expected"),
    [
        (0.4, [0.9, 1 / 1.1, 0.95, 1.0, 1.1, 1.2, 1.4, 1.6], [1.264, 1.238, 1.126, 1.0, 0.909, 0.833, 0.746, 0.762]),
        (0.3, [0.9, 1 / 1.1, 0.95, 1.1, 1.4, 1.6], [1.313, 1.279, 1.158, 0.963, 0.830, 1.071]),
    ],
)
def test_deflection_of_shaped_trapezoids_figure_17(
    ratio: float, frequency_ratios: list[float], expected: list[float]
) -> None:
    plant = PositionedMass((1.0, 0.1))
    limit = ratio * plant.ramp_deflection(2.0 / 1.5)
    found = deflection_sensitivity(plant, trapezoid(), SD[ratio], frequency_ratios=frequency_ratios, limit=limit)
    # The shapers carry six digits, the expected numbers four.
    np.testing.assert_allclose(found.relative[0], expected, rtol=0, atol=6e-4)
    assert found.peak == pytest.approx(found.relative * limit)


@pytest.mark.parametrize(
    ("ratio", "dampings", "expected"),
    [
        (0.4, [0.0, 0.02, 0.05, 0.08, 0.12, 0.2], [2.23, 1.69, 1.28, 1.08, 0.97, 0.88]),
        (0.3, [0.0, 0.05, 0.08, 0.2], [1.52, 1.11, 1.03, 1.03]),
    ],
)
def test_deflection_over_damping_error_figure_18(ratio: float, dampings: list[float], expected: list[float]) -> None:
    plant = PositionedMass((1.0, 0.1))
    limit = ratio * plant.ramp_deflection(2.0 / 1.5)
    found = deflection_sensitivity(plant, trapezoid(), SD[ratio], damping_ratios=dampings, limit=limit)
    assert found.relative.shape == (len(dampings), 1)
    np.testing.assert_allclose(found.relative[:, 0], expected, rtol=0, atol=6e-3)


def test_while_the_residual_stays_small() -> None:
    for ratio, expected in [(0.4, [0.0984, 0.1088]), (0.3, [0.0504, 0.0567])]:
        np.testing.assert_allclose(residual_vibration(SD[ratio], [1 / 1.1, 0.9], 0.1), expected, rtol=0, atol=1e-4)


def test_sensitivity_is_the_plant_itself_made_anew() -> None:
    command = on_off(7.0)
    plant = FloatingOscillator(1.0, 1.0, 1.0)
    found = deflection_sensitivity(plant, command, frequency_ratios=[0.8, 1.3], damping_ratios=[0.0, 0.1])
    for i, z in enumerate((0.0, 0.1)):
        for j, ratio in enumerate((0.8, 1.3)):
            k = ratio**2
            other = FloatingOscillator(1.0, 1.0, k, z * 2 * math.sqrt(k / 2))
            assert found.peak[i, j] == pytest.approx(transient_deflection(other, command).value, rel=1e-12)
    assert found.limit == pytest.approx(0.5, rel=1e-13)


def test_any_modal_plant_can_be_asked() -> None:
    plant = ModalPlant([(1.0, 0.02), (2.7, 0.01)], [1.0, -0.5], drive="acceleration")
    command = Profile.steps([0.0, 0.5, 1.0], [1.0, -2.0, 1.0])
    found = deflection_sensitivity(plant, command, frequency_ratios=[0.5, 1.0], output="output")
    # Time and frequency scale together: half the frequency, a command of twice the duration, four times the deflection.
    slow = Profile.steps([0.0, 1.0, 2.0], [1.0, -2.0, 1.0])
    assert plant.retuned(0.5).motion(slow).peak("output").value == pytest.approx(4 * found.limit, rel=1e-12)
    assert found.relative[0, 1] == pytest.approx(1.0, rel=1e-14)


def test_wrong_input_is_named() -> None:
    plant, command = PositionedMass((1.0, 0.1)), trapezoid()
    with pytest.raises(InputError, match="a list of ratios is empty"):
        deflection_sensitivity(plant, command, frequency_ratios=[])
    with pytest.raises(InputError, match="limit is 0"):
        deflection_sensitivity(plant, command, limit=0.0)
    with pytest.raises(InputError, match="frequency_ratio is -1"):
        deflection_sensitivity(plant, command, frequency_ratios=[-1.0])


@pytest.mark.parametrize(("ratio", "z"), [(0.3, 0.0), (0.3, 0.1), (0.1, 0.05), (0.45, 0.1)])
def test_a_shaper_with_a_box_holds_the_deflection_on_the_limit(ratio: float, z: float) -> None:
    # Impulse, constant density, impulse: the deflection rises to the limit, stays there, and comes back.
    plant = PositionedMass((1.0, z))
    mode, k = plant.mode, plant.mode.decay_per_half_period
    density = mode.omega * ratio * math.exp(-z * math.acos(z) / math.sqrt(1 - z**2))
    hold = (1 - (1 + k) * ratio) / density
    rise, end = math.acos(z) / mode.omega_d, math.pi / mode.omega_d + hold
    shaper = Shaper([0.0, end], [ratio, k * ratio], boxes=[(rise, rise + hold, density)])
    for command in (Profile.steps([0.0], [1.0], order=1), Profile.steps([0.0, 3.0], [1.0, -1.0], order=1)):
        limit = ratio * plant.ramp_deflection(1.0)
        assert transient_deflection(plant, command, shaper).value == pytest.approx(limit, rel=1e-12)
        motion = plant.motion(command.shaped(shaper))
        assert motion.residual("deflection") < 1e-15
        held = motion("deflection", np.linspace(rise, rise + hold, 11))
        np.testing.assert_allclose(held, limit, rtol=1e-12)
