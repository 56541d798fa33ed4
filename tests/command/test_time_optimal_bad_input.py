"""What time_optimal is given wrong gets one clear sentence, and what it cannot do it says."""

import math
from typing import Any

import numpy as np
import pytest

from preshape.command.rest_to_rest import deflection_limiting, on_off, time_optimal
from preshape.errors import InputError
from preshape.plant import FlexibleBody, FloatingOscillator

UNIT = FloatingOscillator(1.0, 1.0, 1.0)
TWO = FlexibleBody(2.0, [(0.2, 0.0), (0.5, 0.01)], [1.0, -0.3])


@pytest.mark.parametrize(
    ("asked", "answer"),
    [
        ({"distance": math.nan}, "distance is nan: give a finite number in m"),
        ({"distance": math.inf}, "distance is inf"),
        ({"distance": 0.0}, "distance is 0 m, which commands nothing"),
        ({"distance": "far"}, "distance must be a number in m, not 'far'"),
        ({"maximum_force": 0.0}, "maximum_force is 0 N: give a value above 0 N"),
        ({"maximum_force": -1.0}, "maximum_force is -1 N"),
        ({"deflection_limits": -0.1}, "deflection limit is -0.1 m: give a value above 0 m"),
        ({"deflection_limits": 0.0}, "deflection limit is 0 m"),
        ({"deflection_limits": math.nan}, "deflection limit is nan"),
        ({"deflection_limits": -math.inf}, "deflection limit is -inf"),
        ({"deflection_limits": "x"}, "deflection limit must be a number in m, not 'x'"),
        ({"deflection_limits": []}, "has 0 values where 1 belong"),
        ({"deflection_limits": [0.1, 0.2]}, "has 2 values where 1 belong: give one for each output, None for none"),
        ({"deflection_limits": 1e-300}, "too little to compute with; give 5.5e-07 m or more"),
        ({"bands": (0.3, 0.2)}, "the lower one first"),
        ({"bands": (0.2, math.nan)}, "a band's high is nan"),
        ({"bands": ()}, "no band was given"),
        ({"bands": (0.2, 0.3), "tolerance": 0.0}, r"tolerance 0.0 is outside \(0, 1\)"),
        ({"tolerance": math.nan}, r"tolerance nan is outside \(0, 1\)"),
        ({"plant": (0.2, 0.0)}, "needs a body that is free to move"),
        ({"plant": TWO, "deflection_limits": [0.1]}, "has 1 values where 2 belong"),
        ({"plant": TWO, "deflection_limits": np.array(0.1)}, "must be a number in m"),
        ({"plant": TWO, "outputs": [1.0, 2.0, 3.0]}, r"outputs have shape \(1, 3\): give \(output, 2\)"),
        ({"plant": TWO, "outputs": [[[1.0, 2.0]]]}, r"outputs have shape \(1, 1, 2\)"),
        ({"plant": TWO, "outputs": [[1.0, 2.0], [1.0]]}, "something that is not a number"),
        ({"plant": TWO, "outputs": [[1.0, 2.0], [0.0, 0.0]]}, "a row of zeros"),
        ({"plant": TWO, "outputs": [[1.0, math.nan]]}, "outputs hold NaN"),
        ({"plant": TWO, "outputs": [1.0, 2.0], "deflection_limits": [0.1, 0.2]}, "has 2 values where 1 belong"),
    ],
    ids=lambda value: str(value)[:60],
)
def test_one_clear_sentence(asked: dict[str, Any], answer: str) -> None:
    arguments: dict[str, Any] = {"plant": UNIT, "distance": 10.0, "maximum_force": 1.0, **asked}
    with pytest.raises(InputError, match=answer) as raised:
        time_optimal(arguments.pop("plant"), arguments.pop("distance"), **arguments)
    assert "\n" not in str(raised.value)


def test_a_move_that_sixteen_digits_do_not_resolve_is_refused_with_what_would_do() -> None:
    with pytest.raises(InputError, match="move farther or with less force, or use bang_bang, which leaves 4e-12 of"):
        time_optimal(UNIT, 1e-12, maximum_force=1.0)


def test_a_move_over_too_many_periods_is_refused() -> None:
    with pytest.raises(InputError, match="637 periods of the fastest mode, and no more than 250 are solved"):
        time_optimal(UNIT, 1e6, maximum_force=1.0)


def test_on_off_where_only_a_proportional_actuator_can() -> None:
    with pytest.raises(InputError, match="0.3 m with 0.6 N, and an on-off actuator gives 1 N or nothing") as raised:
        time_optimal(UNIT, 10.0, maximum_force=1.0, deflection_limits=0.3, on_off=True)
    assert "limit the deflection to the static 0.5 m or more" in str(raised.value)
    # and what it says would do does
    move = time_optimal(UNIT, 10.0, maximum_force=1.0, deflection_limits=0.5, on_off=True)
    assert set(np.abs(move.levels)) == {1.0} and move.peak_deflections[0] <= 0.5 * (1.0 + 1e-9)


def test_on_off_where_a_sum_of_modes_is_held() -> None:
    with pytest.raises(InputError, match="needs levels between nothing and the maximum force"):
        time_optimal(TWO, 1.0, maximum_force=1.0, deflection_limits=0.25, outputs=[1.0, 4.0], on_off=True)


@pytest.mark.parametrize("body", [UNIT, TWO], ids=["one mode", "two modes"])
def test_on_off_without_limits_is_what_is_optimal_anyway(body: FloatingOscillator | FlexibleBody) -> None:
    move = time_optimal(body, 10.0, maximum_force=2.0, on_off=True)
    assert move.status == "optimal" and set(np.abs(move.levels)) == {2.0}
    assert move.settings["on_off"] is True


def test_closed_forms_send_to_time_optimal_what_it_does() -> None:
    """Too short for them, and a limit that needs no limiting: the sentences name what does it, and it does."""
    with pytest.raises(InputError, match="too short for the on-off command.*time_optimal does shorter ones"):
        on_off(UNIT, 1.0, maximum_force=1.0)
    assert time_optimal(UNIT, 1.0, maximum_force=1.0, deflection_limits=0.5, on_off=True).status == "optimal"
    with pytest.raises(InputError, match="too short to hold.*time_optimal with the same limit does shorter ones"):
        deflection_limiting(UNIT, 0.2, maximum_force=1.0, deflection_limit=0.3)
    assert time_optimal(UNIT, 0.2, maximum_force=1.0, deflection_limits=0.3).status == "optimal"
    with pytest.raises(InputError, match="nothing needs to be limited.*time_optimal with this limit, which is faster"):
        deflection_limiting(UNIT, 10.0, maximum_force=1.0, deflection_limit=0.6)
    move = time_optimal(UNIT, 10.0, maximum_force=1.0, deflection_limits=0.6)
    assert move.duration < on_off(UNIT, 10.0, maximum_force=1.0).duration
