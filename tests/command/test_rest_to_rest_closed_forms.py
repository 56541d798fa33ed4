"""Closed-form rest-to-rest commands: exact by independent simulation of the two masses; Robertson's numbers."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.command.matrix_exponentials import equations_of, equations_of_two_masses, final_state, largest

from preshape.command.rest_to_rest import RestToRest, bang_bang, deflection_limiting, on_off
from preshape.plant import FlexibleBody, FloatingOscillator

UNIT = {"first_mass": 1.0, "second_mass": 1.0, "stiffness": 1.0, "maximum_force": 1.0}
GENERAL = {"first_mass": 2.0, "second_mass": 0.5, "stiffness": 3.0, "maximum_force": 4.0}
ALPHA = 0.5
PERIOD = math.sqrt(2.0) * math.pi

factors = st.floats(0.05, 20.0)
plants = st.fixed_dictionaries(
    {"first_mass": factors, "second_mass": factors, "stiffness": factors, "maximum_force": factors}
)


def oscillator(plant: dict[str, float]) -> FloatingOscillator:
    return FloatingOscillator(plant["first_mass"], plant["second_mass"], plant["stiffness"])


def made(command: Callable[..., RestToRest], plant: dict[str, float], distance: float, **settings: Any) -> RestToRest:
    return command(oscillator(plant), distance, maximum_force=plant["maximum_force"], **settings)


def static_of(plant: dict[str, float]) -> float:
    inverse = 1.0 / plant["first_mass"] + 1.0 / plant["second_mass"]
    return plant["maximum_force"] / (plant["first_mass"] * plant["stiffness"] * inverse)


def period_of(plant: dict[str, float]) -> float:
    inverse = 1.0 / plant["first_mass"] + 1.0 / plant["second_mass"]
    return 2.0 * math.pi / math.sqrt(plant["stiffness"] * inverse)


def acceleration_of(plant: dict[str, float]) -> float:
    return plant["maximum_force"] / (plant["first_mass"] + plant["second_mass"])


def assert_at_rest(move: RestToRest, plant: dict[str, float], distance: float) -> None:
    """By the equations of the centre and of the deflection: positions of both masses lose digits in long moves."""
    a, b, _ = equations_of(oscillator(plant).flexible_body)
    centre, speed, deflection, rate = final_state(a, b, move)
    static, omega = static_of(plant), 2.0 * math.pi / period_of(plant)
    assert abs(centre - distance) < 1e-11 * abs(distance) and abs(speed) * move.duration < 1e-11 * abs(distance)
    assert max(abs(deflection), abs(rate) / omega) < 1e-11 * static
    assert np.abs(move.levels).max() <= plant["maximum_force"]
    assert move.residuals.max() < 1e-12


def peak_of(move: RestToRest, plant: dict[str, float]) -> float:
    """By the equation of the deflection itself: as a difference of two positions it would be rounding."""
    a, b, rows = equations_of(oscillator(plant).flexible_body)
    return largest(a, b, rows[0], move)


def test_the_deflection_is_the_difference_of_the_masses() -> None:
    move = made(on_off, GENERAL, 5.0)
    a, b, rows = equations_of_two_masses(2.0, 0.5, 3.0)
    assert final_state(a, b, move) == pytest.approx([5.0, 5.0, 0.0, 0.0], abs=1e-11)
    assert largest(a, b, rows[0], move) == pytest.approx(peak_of(move, GENERAL), rel=1e-9)


@pytest.mark.parametrize(("distance", "duration"), [(5.0, 7.8055), (10.0, 10.4252), (20.0, 14.1301)])
def test_on_off_of_robertsons_plant(distance: float, duration: float) -> None:
    move = made(on_off, UNIT, distance)
    assert move.duration == pytest.approx(duration, abs=5e-5)
    assert_at_rest(move, UNIT, distance)
    assert peak_of(move, UNIT) == pytest.approx(0.5, abs=1e-9)
    assert move.peak_deflections[0] == pytest.approx(0.5, abs=1e-12)


@pytest.mark.parametrize(
    ("distance", "fastest", "lean"),
    [(5.0, 9.2625, 9.3785), (10.0, 12.6428, 12.7613), (15.0, 15.2372, 15.3567), (20.0, 17.4245, 17.5447)],
)
def test_deflection_limiting_of_robertsons_plant(distance: float, fastest: float, lean: float) -> None:
    for fuel_lean, duration in ((False, fastest), (True, lean)):
        move = made(deflection_limiting, UNIT, distance, deflection_limit=0.3, fuel_lean=fuel_lean)
        assert move.duration == pytest.approx(duration, abs=5.1e-5)
        assert_at_rest(move, UNIT, distance)
        assert peak_of(move, UNIT) == pytest.approx(0.3, abs=1e-9)
        assert move.peak_deflections[0] == pytest.approx(0.3, abs=1e-12)


def test_switches_and_levels_of_the_limited_command_over_ten_units() -> None:
    move = made(deflection_limiting, UNIT, 10.0, deflection_limit=0.3)
    times = [0.0, 0.6468, 1.0132, 5.6881, 6.3214, 6.9547, 11.6296, 11.9960, 12.6428]
    assert move.switch_times == pytest.approx(times, abs=5.1e-5)
    assert move.levels == pytest.approx([1.0, -1.0, 0.6, -1.0, 1.0, -0.6, 1.0, -1.0], abs=1e-12)
    assert move.force(np.array([0.3, 3.0, 7.0, 20.0])) == pytest.approx([1.0, 0.6, -0.6, 0.0], abs=1e-12)


@pytest.mark.parametrize("fuel_lean", [False, True])
def test_a_general_plant_keeps_its_limit(fuel_lean: bool) -> None:
    move = made(deflection_limiting, GENERAL, 10.0, deflection_limit=0.2, fuel_lean=fuel_lean)
    assert_at_rest(move, GENERAL, 10.0)
    assert peak_of(move, GENERAL) == pytest.approx(0.2, abs=1e-9)


def test_fuel_lean_uses_less_force_over_time() -> None:
    fuel = [
        float(np.diff(move.switch_times) @ np.abs(move.levels))
        for move in (
            made(deflection_limiting, UNIT, 10.0, deflection_limit=0.3, fuel_lean=lean) for lean in (False, True)
        )
    ]
    assert fuel[1] < fuel[0]


@pytest.mark.parametrize("distance", [5.0, 10.0, 15.0, 20.0])
def test_bang_bang_leaves_what_its_formula_says(distance: float) -> None:
    move = made(bang_bang, UNIT, distance)
    half = math.sqrt(distance / ALPHA)
    assert move.residuals[0] == pytest.approx(4.0 * math.sin(0.5 * math.sqrt(2.0) * half) ** 2, abs=1e-12)
    assert move.peak_deflections[0] == pytest.approx(peak_of(move, UNIT), abs=1e-9)
    a, b, _ = equations_of_two_masses(1.0, 1.0, 1.0)
    x1, x2, v1, v2 = final_state(a, b, move)
    assert 0.5 * (x1 + x2) == pytest.approx(distance, abs=1e-9) and v1 + v2 == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("periods", [1, 2, 3])
def test_bang_bang_leaves_nothing_over_robertsons_distances(periods: int) -> None:
    move = made(bang_bang, UNIT, math.pi**2 * periods**2)
    assert move.residuals[0] < 1e-13
    assert move.peak_deflections[0] > 0.9  # and still bends far during the move


@settings(max_examples=30)
@given(plants, st.floats(1.0, 50.0), st.sampled_from([1.0, -1.0]))
def test_on_off_is_exact_for_any_plant(plant: dict[str, float], part: float, sign: float) -> None:
    distance = sign * part * acceleration_of(plant) * (period_of(plant) / 3.0) ** 2
    move = made(on_off, plant, distance)
    assert_at_rest(move, plant, distance)
    assert peak_of(move, plant) == pytest.approx(static_of(plant), rel=1e-9)
    assert set(np.abs(move.levels)) <= {0.0, plant["maximum_force"]}


@settings(max_examples=40)
@given(plants, st.floats(0.003, 1.0), st.floats(0.0, 6.0), st.booleans(), st.sampled_from([1.0, -1.0]))
def test_deflection_limiting_is_exact_for_any_plant(
    plant: dict[str, float], part: float, periods: float, lean: bool, sign: float
) -> None:
    limit = part * static_of(plant)
    # far enough to reach any limit
    distance = sign * acceleration_of(plant) * (1.05 * period_of(plant) * (1.0 + periods)) ** 2
    move = made(deflection_limiting, plant, distance, deflection_limit=limit, fuel_lean=lean)
    assert_at_rest(move, plant, distance)
    assert peak_of(move, plant) == pytest.approx(limit, rel=1e-9)


@given(plants)
def test_the_shortest_moves_are_accepted_and_shorter_ones_refused(plant: dict[str, float]) -> None:
    shortest = acceleration_of(plant) * (period_of(plant) / 3.0) ** 2
    assert_at_rest(made(on_off, plant, shortest), plant, shortest)
    with pytest.raises(ValueError, match="too short"):
        made(on_off, plant, shortest * (1.0 - 1e-9))


def test_the_shortest_limited_move_is_the_one_without_a_hold() -> None:
    with pytest.raises(ValueError, match="the shortest is 0.356107 m"):
        made(deflection_limiting, UNIT, 0.35, deflection_limit=0.3)
    move = made(deflection_limiting, UNIT, 0.3561075, deflection_limit=0.3)
    assert_at_rest(move, UNIT, 0.3561075)


def test_a_limit_of_the_static_deflection_is_an_on_off_command_shorter_than_the_closed_one() -> None:
    move = made(deflection_limiting, UNIT, 10.0, deflection_limit=0.5)
    assert_at_rest(move, UNIT, 10.0)
    assert set(np.abs(move.levels)) == {1.0}
    assert move.duration == pytest.approx(10.3781, abs=5e-5) and move.duration < made(on_off, UNIT, 10.0).duration


def test_samples_keep_the_area_of_the_force() -> None:
    move = made(deflection_limiting, UNIT, 10.0, deflection_limit=0.3)
    command = move.sample(0.01, rest=0.5)
    assert command.values[0] == 0.0 and command.values[-1] == 0.0 and command.duration == move.duration
    assert abs(command.values.sum()) * 0.01 < 1e-12  # the body stops
    assert np.abs(command.values).max() <= 1.0
    middle = np.abs(command.times - 3.0) < 1.0
    assert command.values[middle] == pytest.approx(0.6, abs=1e-12)
    # the sampled force, held between samples, vibrates by no more than its docstring says
    steps = np.diff(command.values, append=0.0)
    left = abs(np.sum(steps * np.exp(1j * math.sqrt(2.0) * command.times)))
    assert left < 9 * (math.sqrt(2.0) * 0.01) ** 2 / 12.0


def test_the_result_reads_well() -> None:
    text = str(made(deflection_limiting, UNIT, 10.0, deflection_limit=0.3))
    assert text.startswith("deflection-limiting: 10 m in 12.6428 s, exact") and "deflection at most 0.3 m" in text


def test_closed_forms_say_what_plants_they_are_for() -> None:
    damped, two = FloatingOscillator(1.0, 1.0, 1.0, 0.1), FlexibleBody(2.0, [(0.2, 0.0), (0.5, 0.0)], [1.0, 0.3])
    with pytest.raises(ValueError, match="for an undamped mode and this one has a damping ratio of 0.0707"):
        on_off(damped, 10.0, maximum_force=1.0)
    with pytest.raises(ValueError, match="for one mode and this plant has 2; time_optimal takes any number"):
        deflection_limiting(two, 10.0, maximum_force=1.0, deflection_limit=0.1)
    with pytest.raises(ValueError, match="needs a body that is free to move"):
        bang_bang((0.2, 0.0), 10.0, maximum_force=1.0)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="nothing needs to be limited; use on_off"):
        made(deflection_limiting, UNIT, 10.0, deflection_limit=0.51)


def test_the_plant_itself_says_the_same_of_a_command() -> None:
    move = made(deflection_limiting, GENERAL, -10.0, deflection_limit=0.2)
    motion = oscillator(GENERAL).motion(move.force)
    assert motion.peak("deflection").value == pytest.approx(0.2, rel=1e-12)
    assert motion("centre", move.duration + 1.0) == pytest.approx(-10.0, rel=1e-12)
    assert motion("second_position", move.duration + 1.0) == pytest.approx(-10.0, rel=1e-12)
