"""Trapezoid and S-curve: limits kept, distance covered exactly, in no more time than the limits ask for."""

import math
from fractions import Fraction

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from preshape.command import Command, s_curve, trapezoid
from preshape.errors import InputError

ROUNDING = 4 * np.finfo(float).eps
"""Relative error of a sampled polynomial: a few roundings."""

limits = st.floats(0.1, 10.0)
spread = st.floats(1e-3, 1e3)  # of the distance: from moves too short for any limit to moves that are nearly all cruise


def shortest_time(distance: float, speed: float, acceleration: float, jerk: float = math.inf) -> float:
    """Least duration under the limits, by inverting numerically the greatest distance that a duration allows."""
    lag = acceleration / jerk

    def reached(time: float) -> float:  # greatest speed from rest, ending at no acceleration
        return 0.25 * jerk * time**2 if time < 2 * lag else acceleration * (time - lag)

    def farthest(duration: float) -> float:
        if reached(0.5 * duration) <= speed:
            return 0.5 * duration * reached(0.5 * duration)
        ramp = float(brentq(lambda time: reached(time) - speed, 0.0, 0.5 * duration, xtol=1e-300, rtol=1e-14))
        return speed * (duration - ramp)

    top = 2.0 * (distance / speed + speed / acceleration + lag)
    return float(brentq(lambda t: farthest(t) - distance, 0.0, top, xtol=1e-300, rtol=1e-14))


def assert_rest_to_rest(move: Command, distance: float) -> None:
    assert move.velocity is not None and move.acceleration is not None
    assert move.values[0] == 0.0 and move.velocity[0] == 0.0
    assert move.values[-1] == distance and move.velocity[-1] == 0.0 and move.acceleration[-1] == 0.0
    assert move.values.shape == move.velocity.shape == move.acceleration.shape == move.times.shape
    assert (move.values.size - 2) * move.dt < move.duration <= move.times[-1] * (1 + 1e-9)
    steps = np.diff(move.values) * np.sign(distance)
    assert steps.min() >= -ROUNDING * abs(distance)  # never backwards
    assert np.abs(move.values).max() <= abs(distance)  # never beyond


def assert_difference_within(move: Command, order: int, limit: float) -> None:
    """A difference quotient of the position is an average of its derivative, so it keeps the derivative's limit."""
    quotient = np.abs(np.diff(move.values, order)) / move.dt**order
    rounding = 2**order * ROUNDING * abs(move.values[-1]) / move.dt**order
    assert quotient.max() <= limit * (1 + ROUNDING) + rounding
    assert rounding < 1e-6 * limit  # or the line above says nothing


@settings(deadline=None)
@given(limits, limits, spread, st.sampled_from([-1.0, 1.0]))
def test_trapezoid_keeps_its_limits_and_takes_the_least_time(
    speed: float, acceleration: float, ratio: float, sign: float
) -> None:
    distance = sign * ratio * speed**2 / acceleration
    expected = shortest_time(abs(distance), speed, acceleration)
    move = trapezoid(distance, maximum_speed=speed, maximum_acceleration=acceleration, dt=expected / 97.3)
    assert move.duration == pytest.approx(expected, rel=1e-12)
    assert_rest_to_rest(move, distance)
    assert move.velocity is not None and move.acceleration is not None
    assert np.abs(move.velocity).max() <= speed * (1 + ROUNDING)
    assert np.abs(move.acceleration).max() <= acceleration
    assert_difference_within(move, 1, speed)
    if ratio < 100:  # beyond, the ramp is shorter than a sample and the quotient only rounding
        assert_difference_within(move, 2, acceleration)


@settings(deadline=None)
@given(limits, limits, st.floats(1e-2, 1e2), spread, st.sampled_from([-1.0, 1.0]))
def test_s_curve_keeps_its_limits_and_takes_the_least_time(
    speed: float, acceleration: float, jerkiness: float, ratio: float, sign: float
) -> None:
    jerk = jerkiness * acceleration**2 / speed  # below 1 the acceleration limit is never reached
    distance = sign * ratio * speed**2 / acceleration
    expected = shortest_time(abs(distance), speed, acceleration, jerk)
    move = s_curve(
        distance,
        maximum_speed=speed,
        maximum_acceleration=acceleration,
        maximum_jerk=jerk,
        dt=expected / 97.3,
    )
    assert move.duration == pytest.approx(expected, rel=1e-11)
    assert_rest_to_rest(move, distance)
    assert move.velocity is not None and move.acceleration is not None
    assert np.abs(move.velocity).max() <= speed * (1 + ROUNDING)
    assert np.abs(move.acceleration).max() <= acceleration * (1 + ROUNDING)
    assert np.abs(np.diff(move.acceleration)).max() <= jerk * move.dt * (1 + 1e-9)
    assert_difference_within(move, 1, speed)
    if ratio < 100:
        assert_difference_within(move, 2, acceleration)
        assert_difference_within(move, 3, jerk)


@pytest.mark.parametrize(
    ("distance", "speed", "acceleration", "jerk", "duration"),
    [
        (2.0, 9.0, 9.0, 1.0, 4.0),  # jerk alone: d = 2 j t^3
        (6.0, 9.0, 1.0, 1.0, 6.0),  # acceleration limit, no cruise: 1 + 1 + 1 s up to 2 m/s, and down
        (5.0, 1.0, 9.0, 1.0, 7.0),  # speed limit, no constant acceleration: 2 s up, 3 s at 1 m/s, 2 s down
        (10.0, 2.0, 1.0, 1.0, 8.0),  # all seven: 3 s up, 2 s at 2 m/s, 3 s down
        (2.0, 1.0, 1.0, 1.0, 4.0),  # every limit just reached
        (6.0, 2.0, 1.0, 1.0, 6.0),  # speed just reached, with constant acceleration
    ],
)
def test_s_curve_duration_in_each_regime(
    distance: float, speed: float, acceleration: float, jerk: float, duration: float
) -> None:
    move = s_curve(distance, maximum_speed=speed, maximum_acceleration=acceleration, maximum_jerk=jerk, dt=0.01)
    assert move.duration == pytest.approx(duration, rel=4e-16)


@pytest.mark.parametrize(
    ("distance", "duration"), [(1.0, 2.0), (4.0, 4.0), (6.0, 5.0)], ids=["triangle", "just reached", "cruise"]
)
def test_trapezoid_duration_in_each_regime(distance: float, duration: float) -> None:
    move = trapezoid(distance, maximum_speed=2.0, maximum_acceleration=1.0, dt=0.01)
    assert move.duration == pytest.approx(duration, rel=4e-16)


def test_s_curve_samples_are_the_polynomials_of_seven_integrated_segments() -> None:
    # In rational arithmetic, from the jerk upwards, sample by sample: no formula in common with the code.
    dt = Fraction(1, 8)
    jerks = [1] * 8 + [0] * 8 + [-1] * 8 + [0] * 16 + [-1] * 8 + [0] * 8 + [1] * 8
    x = v = a = Fraction(0)
    expected = [(x, v, a)]
    for j in jerks:
        x, v, a = x + v * dt + a * dt**2 / 2 + j * dt**3 / 6, v + a * dt + j * dt**2 / 2, a + j * dt
        expected.append((x, v, a))
    move = s_curve(10.0, maximum_speed=2.0, maximum_acceleration=1.0, maximum_jerk=1.0, dt=float(dt))
    np.testing.assert_allclose(
        np.array([move.values, move.velocity, move.acceleration]).T,
        np.array(expected, dtype=float),
        rtol=0,
        atol=1e-14,
    )


def test_trapezoid_samples_are_the_polynomials_and_hold_the_acceleration_after_a_jump() -> None:
    dt = Fraction(1, 10)  # not a binary fraction: the switching times fall on samples only up to rounding
    x = v = Fraction(0)
    expected = []
    for a in [3] * 10 + [0] * 5 + [-3] * 10:
        expected.append((x, v, Fraction(a)))
        x, v = x + v * dt + a * dt**2 / 2, v + a * dt
    expected += [(x, v, Fraction(0))] * 4
    move = trapezoid(4.5, maximum_speed=3.0, maximum_acceleration=3.0, dt=0.1, rest=0.3)
    np.testing.assert_allclose(
        np.array([move.values, move.velocity, move.acceleration]).T,
        np.array(expected, dtype=float),
        rtol=0,
        atol=1e-14,
    )


def test_a_jerk_phase_shorter_than_rounding_of_the_time_still_starts_from_rest() -> None:
    # The jerk phase lasts 1e-16 of the move, less than times can be told apart.
    move = s_curve(1.0, maximum_speed=10.0, maximum_acceleration=1.0, maximum_jerk=1e16, dt=0.05)
    same = trapezoid(1.0, maximum_speed=10.0, maximum_acceleration=1.0, dt=0.05)
    assert_rest_to_rest(move, 1.0)
    np.testing.assert_allclose(move.values, same.values, rtol=0, atol=1e-15)
    assert np.abs(move.acceleration).max() <= 1.0


def test_a_move_shorter_than_a_sample_is_a_step_of_its_distance() -> None:
    move = trapezoid(1e-12, maximum_speed=1.0, maximum_acceleration=1e9, dt=1.0)
    np.testing.assert_array_equal(move.values, [0.0, 1e-12])


def test_a_move_backwards_mirrors_the_move_forwards() -> None:
    there = s_curve(0.3, maximum_speed=0.5, maximum_acceleration=5.0, maximum_jerk=80.0, dt=1e-3)
    back = s_curve(-0.3, maximum_speed=0.5, maximum_acceleration=5.0, maximum_jerk=80.0, dt=1e-3)
    np.testing.assert_array_equal(back.values, -there.values)
    assert back.velocity is not None and there.velocity is not None
    np.testing.assert_array_equal(back.velocity, -there.velocity)


def test_rest_keeps_the_end_position() -> None:
    move = trapezoid(0.2, maximum_speed=0.5, maximum_acceleration=5.0, dt=0.01, rest=0.25)
    short = trapezoid(0.2, maximum_speed=0.5, maximum_acceleration=5.0, dt=0.01)
    assert move.values.size == short.values.size + 25
    assert move.duration == short.duration
    assert (move.values[-26:] == 0.2).all()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"distance": 0.0}, "distance is 0 m"),
        ({"distance": math.nan}, "distance is nan"),
        ({"distance": "far"}, "distance must be a number"),
        ({"maximum_speed": 0.0}, "maximum_speed is 0 m/s: give a value above 0"),
        ({"maximum_speed": math.inf}, "maximum_speed is inf"),
        ({"maximum_acceleration": -1.0}, "maximum_acceleration is -1"),
        ({"maximum_jerk": math.nan}, "maximum_jerk is nan"),
        ({"dt": 0.0}, "dt is 0 s"),
        ({"dt": -1e-3}, "dt is -0.001 s"),
        ({"dt": math.nan}, "dt is nan"),
        ({"dt": True}, "dt must be a number"),
        ({"dt": 1e-12}, "more than the 20,000,000"),
        ({"maximum_speed": 1e-300}, "more than the 20,000,000"),
        ({"rest": -0.1}, "rest is -0.1 s: give 0 s or more"),
        ({"rest": math.inf}, "rest is inf"),
    ],
)
def test_wrong_input_is_answered_with_value_and_remedy(change: dict[str, float], words: str) -> None:
    good = {
        "distance": 0.1,
        "maximum_speed": 0.5,
        "maximum_acceleration": 5.0,
        "maximum_jerk": 100.0,
        "dt": 1e-3,
    }
    with pytest.raises(InputError, match=words):
        s_curve(**(good | change))
    if "maximum_jerk" not in change:
        del good["maximum_jerk"]
        with pytest.raises(InputError, match=words):
            trapezoid(**(good | change))
