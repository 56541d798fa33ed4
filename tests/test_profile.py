"""Profiles against rational arithmetic, quadrature, sampled shaping and a plant."""

from __future__ import annotations

import math
from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad

from preshape import Shaper, design
from preshape.command import bang_bang, cycloidal, period_matched, posicast, pulse, s_curve, step, trapezoid
from preshape.errors import InputError
from preshape.plant import ModalPlant, Output, exact_motion
from preshape.profile import Profile

step_rows = st.lists(
    st.tuples(st.integers(0, 40).map(lambda k: k / 8), st.integers(-16, 16).map(lambda k: k / 4), st.integers(0, 3)),
    min_size=1,
    max_size=10,
)
DT = 0.125


def profile_of(rows: list[tuple[float, float, int]]) -> Profile:
    return Profile(*zip(*rows, strict=True))


def exact_value(rows: list[tuple[float, float, int]], t: float, derivative: int = 0) -> float:
    """The defining sum in rational arithmetic."""
    total = Fraction(0)
    for time, jump, order in rows:
        since, power = Fraction(t) - Fraction(time), order - derivative
        if since >= 0 and power >= 0:
            total += Fraction(jump) * since**power / math.factorial(power)
    return float(total)


@given(step_rows, st.lists(st.floats(-1.0, 9.0), min_size=1, max_size=6), st.integers(0, 3))
def test_value_is_the_defining_sum(rows: list[tuple[float, float, int]], looks: list[float], derivative: int) -> None:
    profile = profile_of(rows)
    expected = [exact_value(rows, t, derivative) for t in looks]
    size = sum(abs(jump) * 9.0**order for _, jump, order in rows) + 1.0
    np.testing.assert_allclose(profile(looks, derivative), expected, rtol=0.0, atol=1e-14 * size)


@given(step_rows)
def test_integral_and_derivative_undo_each_other_and_quadrature_agrees(
    rows: list[tuple[float, float, int]],
) -> None:
    profile = profile_of(rows)
    integral = profile.integral()
    again = integral.derivative()
    for name in ("times", "jumps", "orders"):
        np.testing.assert_array_equal(getattr(again, name), getattr(profile, name))
    looks = np.array([0.3, 2.7, 6.1])
    np.testing.assert_allclose(integral(looks, 1), profile(looks), rtol=1e-13, atol=1e-12)
    for t in looks:
        knots = [0.0, *(k for k in np.unique(profile.times) if 0.0 < k < t)]
        area = sum(quad(profile, a, b)[0] for a, b in zip(knots, [*knots[1:], t], strict=True))
        assert float(integral(t)) == pytest.approx(area, rel=1e-10, abs=1e-9)


@given(step_rows, st.lists(st.floats(0.1, 1.0), min_size=1, max_size=5), st.integers(1, 12))
def test_shaping_is_exact_on_and_off_the_grid(
    rows: list[tuple[float, float, int]], weights: list[float], stride: int
) -> None:
    """Sampled shaping is exact where impulses and samples share a grid; the sum over impulses is, anywhere."""
    profile = profile_of(rows)
    shaper = Shaper.normalised(stride * DT * np.arange(len(weights)), weights)
    shaped = shaper.shape(profile)
    assert shaped.end_time <= profile.end_time + shaper.duration + 1e-12
    samples = shaper.shape(profile.sample(DT, rest=1.0), DT)
    ticks = np.arange(profile.sample(DT, rest=1.0).size) * DT
    size = np.abs(samples).max() + 1.0
    np.testing.assert_allclose(shaped(ticks), samples[: ticks.size], rtol=0.0, atol=1e-12 * size)
    looks = np.linspace(-0.5, 8.0, 23)
    by_evaluation = shaper.shape_function(profile)
    np.testing.assert_allclose(shaped(looks), by_evaluation(looks), rtol=0.0, atol=1e-12 * size)


@given(step_rows, st.floats(0.1, 0.9), st.floats(0.05, 3.0))
def test_a_box_averages(rows: list[tuple[float, float, int]], share: float, width: float) -> None:
    profile = profile_of(rows)
    shaper = Shaper([0.0, 1.0], [0.5 * (1 - share)] * 2, boxes=[(0.25, 0.25 + width, share / width)])
    looks = np.linspace(0.0, 9.0, 19)
    expected = shaper.shape_function(profile, profile.integral())(looks)
    size = np.abs(profile.integral()(looks)).max() / width + np.abs(expected).max() + 1.0
    np.testing.assert_allclose(profile.shaped(shaper)(looks), expected, rtol=0.0, atol=1e-12 * size)


def test_sampled_shaping_with_a_box_is_exact_for_ramps_on_the_grid() -> None:
    ramps = Profile.steps([0.0, 0.5, 1.25], [1.0, -3.0, 2.0], order=1)
    shaper = Shaper([0.0, 0.75], [0.3, 0.2], boxes=[(0.13, 0.47, 0.5 / 0.34)])
    samples = shaper.shape(ramps.sample(DT), DT)
    np.testing.assert_allclose(ramps.shaped(shaper)(np.arange(samples.size) * DT), samples, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize("damping", [0.0, 0.05])
def test_the_plant_is_at_rest_after_a_shaped_move(damping: float) -> None:
    plant = ModalPlant((3.0, damping))
    for shaper in (design.zv((3.0, damping)), design.zvd((3.0, damping)), design.sd_zv((3.0, damping), 0.3, "box")):
        for move in (
            trapezoid(0.3, maximum_speed=0.5, maximum_acceleration=5.0, dt=0.001),
            s_curve(0.3, maximum_speed=0.5, maximum_acceleration=5.0, maximum_jerk=50.0, dt=0.001),
            pulse(2.0, width=0.1, dt=0.01),
        ):
            assert move.profile is not None
            shaped = shaper.shape(move.profile)
            assert plant.motion(move.profile).residual("output") > 1e-4
            assert plant.motion(shaped).residual("output") < 1e-12
            assert float(shaped(1e3)) == pytest.approx(float(move.values[-1]), abs=1e-14)


@pytest.mark.parametrize(
    "command",
    [
        step(2.0, dt=0.01, start=0.05),
        pulse(-3.0, width=0.2, dt=0.01),
        bang_bang(-0.4, maximum_acceleration=2.0, dt=0.001),
        trapezoid(0.3, maximum_speed=0.5, maximum_acceleration=5.0, dt=0.001),
        trapezoid(-0.01, maximum_speed=0.5, maximum_acceleration=5.0, dt=0.001),
        s_curve(0.3, maximum_speed=0.5, maximum_acceleration=5.0, maximum_jerk=100.0, dt=0.001),
        s_curve(-0.04, maximum_speed=0.5, maximum_acceleration=5.0, maximum_jerk=100.0, dt=0.001),
        s_curve(0.002, maximum_speed=0.5, maximum_acceleration=5.0, maximum_jerk=100.0, dt=0.001),
        period_matched(1.0, (2.0, 0.0), maximum_speed=0.5, maximum_acceleration=1.2, dt=0.001),
    ],
)
def test_commands_have_the_profile_of_their_samples(command: object) -> None:
    profile, duration = command.profile, command.duration  # type: ignore[attr-defined]
    assert profile.end_time == pytest.approx(duration, rel=1e-14)
    looks = command.times  # type: ignore[attr-defined]
    clear = np.abs(looks[:, np.newaxis] - profile.times).min(axis=1) > 1e-9 * duration
    for order, name in enumerate(("values", "velocity", "acceleration")):
        samples = getattr(command, name)
        if samples is not None:
            scale = np.abs(samples).max()
            np.testing.assert_allclose(profile(looks, order)[clear], samples[clear], rtol=0.0, atol=1e-12 * scale)
    assert profile.final_value == pytest.approx(float(command.values[-1]), abs=1e-14)  # type: ignore[attr-defined]


def test_posicast_between_the_samples_is_a_zv_shaped_step() -> None:
    profile = posicast(2.0, (2.0, 0.1), dt=0.01).profile
    assert profile is not None
    zv = design.zv((2.0, 0.1))
    np.testing.assert_allclose(profile.times, 0.01 + zv.times, rtol=1e-14)
    np.testing.assert_allclose(profile.jumps, 2.0 * zv.amplitudes, rtol=1e-14)


def test_a_smooth_command_has_none() -> None:
    assert cycloidal(0.1, duration=0.5, dt=0.01).profile is None


def test_a_move_shaped_by_many_impulses_ends_exactly_where_it_should() -> None:
    move = s_curve(0.3, maximum_speed=0.5, maximum_acceleration=5.0, maximum_jerk=100.0, dt=0.001)
    shaper = design.zvd([(1.0, 0.02), (2.7, 0.05), (4.1, 0.0)])
    assert move.profile is not None
    shaped = move.profile.shaped(shaper)
    assert len(shaped) == 8 * 27
    assert shaped.ends_at_rest
    assert abs(shaped.final_value - 0.3) < 1e-14
    assert abs(float(shaped(1e6)) - 0.3) < 1e-14


def test_coincident_steps_are_one_and_cancelled_ones_none() -> None:
    assert 0.1 + 0.2 != 0.3
    assert len(Profile.steps([0.1 + 0.2, 0.3], [1.0, 1.0])) == 1
    assert len(Profile.steps([0.1 + 0.2, 0.3], [1.0, -1.0])) == 0
    assert len(Profile([0.5, 0.5], [1.0, 1.0], [0, 1])) == 2
    assert Profile.steps([2.0, 1.0], [3.0, 4.0]).times.tolist() == [1.0, 2.0]
    zvd = Profile.steps([0.0], [1.0]).shaped(design.zv((10.0, 0.0))).shaped(design.zv((10.0, 0.0)))
    np.testing.assert_allclose(zvd.jumps, [0.25, 0.5, 0.25])


def test_small_things() -> None:
    nothing = Profile([], [], [])
    assert nothing.final_value == 0.0 and nothing.duration == 0.0 and nothing([0.0, 1.0]).tolist() == [0.0, 0.0]
    ramp = Profile.steps([1.0], [2.0], order=1)
    assert not ramp.ends_at_rest and ramp.delayed(1.0)(3.0) == 2.0 and ramp.scaled(-0.5)(3.0) == -2.0
    both = ramp + Profile.steps([2.0], [-2.0], order=1)
    assert (both.start_time, both.end_time, both.duration, both.final_value) == (1.0, 2.0, 1.0, 2.0)
    assert both.sample(0.5).tolist() == [0.0, 0.0, 0.0, 1.0, 2.0]
    assert both.sample(0.4).size == 6
    assert "2 steps of order 1" in repr(both)
    with pytest.raises(ValueError, match="read-only"):
        both.times[0] = 3.0
    assert both(np.zeros((2, 3))).shape == (2, 3)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda: Profile([0.0], [1.0, 2.0], [0, 0]), "1 times, 2 jumps and 2 orders"),
        (lambda: Profile([0.0], [1.0], [7]), "outside 0 to 6"),
        (lambda: Profile([0.0], [1.0], [0.5]), "not whole"),
        (lambda: Profile([math.nan], [1.0], [0]), "NaN or infinity at step 1"),
        (lambda: Profile([[0.0]], [1.0], [0]), "flat list"),
        (lambda: Profile("soon", [1.0], [0]), "must be numbers"),
        (lambda: Profile.steps([0.0], [1.0], order=-1), "whole number from 0 to 6"),
        (lambda: Profile.steps([0.5], [1.0]).derivative(), "steps at 0.5 s"),
        (lambda: Profile.steps([0.0], [1.0], order=6).integral(), "outside 0 to 6"),
        (lambda: Profile.steps([0.0], [1.0], order=1).final_value, "no final value"),
        (lambda: Profile.steps([-1.0], [1.0]).sample(0.1), "before the samples"),
        (lambda: Profile.steps([1.0], [1.0]).sample(1e-9), "larger dt"),
        (lambda: Profile.steps([0.0], [1.0])(math.inf), "finite times"),
        (lambda: design.zv((1.0, 0.0)).shape(Profile.steps([0.0], [1.0]), 0.1), "leave dt out"),
        (lambda: design.zv((1.0, 0.0)).shape(math.sin, 0.1), "shape_function"),
        (lambda: design.zv((1.0, 0.0)).shape([0.0, 1.0]), "need their dt"),
        (lambda: Profile.from_ruckig(object()), "ruckig.Trajectory"),
    ],
)
def test_wrong_input_gets_a_sentence(wrong: object, words: str) -> None:
    with pytest.raises(InputError, match=words):
        wrong()  # type: ignore[operator]


def trajectory(jerk: list[float], durations: list[float], acceleration: list[float], speed: float = 0.0) -> object:
    """What ruckig 0.19 hands over, without ruckig: of a velocity of 1 m/s under 5 m/s^2 and 100 m/s^3."""
    none = SimpleNamespace(duration=0.0)
    one = SimpleNamespace(t=durations, j=jerk, a=acceleration, v=[speed] + [0.0] * 7, brake=none, accel=none)
    return SimpleNamespace(profiles=[[one]], intermediate_durations=[sum(durations)])


def test_steps_of_jerk_and_of_acceleration_are_read() -> None:
    jerked = trajectory([100.0, 0.0, -100.0, 0.0, 0.0, 0.0, 0.0], [0.05, 0.15, 0.05, 0, 0, 0, 0], [0, 5, 5] + [0.0] * 5)
    speed = Profile.from_ruckig(jerked).derivative()
    assert speed.final_value == pytest.approx(1.0, abs=1e-15)
    assert speed.orders.tolist() == [2] * 4
    jumping = trajectory([0.0] * 7, [0.1, 0.5, 0.1, 0, 0, 0, 0], [5.0, 0.0, -5.0] + [0.0] * 5)
    assert Profile.from_ruckig(jumping).final_value == pytest.approx(0.3, abs=1e-15)
    moving = trajectory([0.0] * 7, [0.1, 0.5, 0.1, 0, 0, 0, 0], [5.0, 0.0, -5.0] + [0.0] * 5, speed=0.1)
    with pytest.raises(InputError, match="does not begin at rest"):
        Profile.from_ruckig(moving)
    with pytest.raises(InputError, match="no axis 1"):
        Profile.from_ruckig(jumping, axis=1)


def test_a_ruckig_trajectory_becomes_its_exact_profile() -> None:
    ruckig = pytest.importorskip("ruckig")
    asked = ruckig.InputParameter(2)
    asked.current_position, asked.target_position = [0.5, 0.0], [0.8, -1.0]
    asked.max_velocity, asked.max_acceleration, asked.max_jerk = [0.5, 1.0], [5.0, 5.0], [100.0, 50.0]
    planned = ruckig.Trajectory(2)
    ruckig.Ruckig(2).calculate(asked, planned)
    for axis in range(2):
        profile = Profile.from_ruckig(planned, axis)
        assert profile.end_time == pytest.approx(planned.duration, rel=1e-12)
        for t in np.linspace(0.0, 1.1 * planned.duration, 57):
            position, velocity, acceleration = (state[axis] for state in planned.at_time(t))
            assert float(profile(t)) == pytest.approx(position - asked.current_position[axis], abs=1e-12)
            assert float(profile(t, 1)) == pytest.approx(velocity, abs=1e-12)
            assert float(profile(t, 2)) == pytest.approx(acceleration, abs=1e-9)
        shaper = design.zvd((2.0, 0.05))
        assert ModalPlant((2.0, 0.05)).motion(profile.shaped(shaper)).residual("output") < 1e-12
        assert profile.shaped(shaper).final_value == pytest.approx(profile.final_value, abs=1e-13)


def test_ramps_short_against_the_whole_end_at_rest() -> None:
    """Times are rounded by a part of the whole; what short ramps make of that is not a command that moves on."""
    ruckig = pytest.importorskip("ruckig")
    generator = np.random.default_rng(1)
    for _ in range(400):
        distance, speed, acceleration, jerk = 10.0 ** generator.uniform(-2.0, 2.0, 4)
        asked = ruckig.InputParameter(1)
        asked.target_position = [distance]
        asked.max_velocity, asked.max_acceleration, asked.max_jerk = [speed], [acceleration], [jerk]
        trajectory = ruckig.Trajectory(1)
        ruckig.Ruckig(1).calculate(asked, trajectory)
        assert Profile.from_ruckig(trajectory).final_value == pytest.approx(distance, rel=1e-8)


def test_a_command_that_moves_on_slowly_is_told_from_rounding() -> None:
    slow = Profile.steps([0.0, 1.0], [1.0, -1.0 + 1e-9], order=1)
    assert not slow.ends_at_rest
    late = Profile([0.0, 1.0, 1000.0, 1001.0], [1.0, -1.0, -1.0, 1.0 + 1e-9], [3, 3, 3, 3])
    assert not late.ends_at_rest


@given(step_rows)
def test_nothing_exceeds_the_peak_and_something_reaches_it(rows: list[tuple[float, float, int]]) -> None:
    """Against dense samples, which it may exceed only by what they can miss."""
    moving = profile_of(rows)
    end = moving.end_time + 1.0
    profile = moving + Profile([end] * 4, [-float(moving(end, n)) for n in range(4)], range(4))
    found = profile.peak()
    looks = np.linspace(0.0, end, 4001)
    looks = np.union1d(looks, np.concatenate([moving.times, np.append(moving.times, end) - 1e-12]))
    sampled = float(np.abs(profile(looks)).max())
    bend, slope = (float(np.abs(profile(looks, n)).max()) for n in (2, 1))
    assert sampled <= found.value * (1.0 + 1e-12)
    assert found.value <= sampled * (1.0 + 1e-12) + bend * (end / 4000.0) ** 2 / 8.0 + 2e-12 * slope
    assert profile.integral().peak(1).value == pytest.approx(found.value, rel=1e-12)
    if (profile.orders == 0).any():
        assert profile.peak(1).value == profile.integral().peak(2).value == math.inf


def test_the_peak_lies_between_samples_and_agrees_with_the_one_of_a_motion() -> None:
    generator = np.random.default_rng(3)
    for _ in range(40):
        count = int(generator.integers(2, 9))
        times, orders = np.sort(generator.uniform(0.0, 2.0, count)), generator.integers(2, 7, count)
        raw = Profile(times, generator.normal(size=count), orders)
        rest = Profile([2.5] * 7, [-float(raw(2.5, n)) for n in range(7)], range(7))
        found = (raw + rest).peak()
        looks = np.linspace(0.0, 2.5, 20001)
        assert found.value == pytest.approx(np.abs(raw(looks)).max(), rel=1e-6)
        assert abs(float((raw + rest)(found.time))) == pytest.approx(found.value, rel=1e-12) or found.time == 2.5
        motion = exact_motion(None, raw + rest, outputs={"command": Output(command=1.0)}).peak("command")
        assert found.value == pytest.approx(motion.value, rel=1e-12)


def test_peaks_of_commands_in_closed_form() -> None:
    move = s_curve(0.3, maximum_speed=0.5, maximum_acceleration=5.0, maximum_jerk=100.0, dt=0.001).profile
    assert move is not None
    assert [move.peak(k).value for k in (1, 2, 3)] == pytest.approx([0.5, 5.0, 100.0], rel=1e-12)
    assert move.peak(4).value == math.inf and Profile([], [], []).peak().value == 0.0
    assert Profile.steps([1.0], [1.0], order=1).peak().value == math.inf
    assert Profile.steps([1.0], [1.0], order=1).peak(1).value == 1.0
    assert Profile.steps([0.0, 1.0], [-3.0, 1.0]).peak() == Profile.steps([0.0], [3.0]).peak()
