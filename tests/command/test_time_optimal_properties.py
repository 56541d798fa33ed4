"""What holds of every time-optimal move: exact ends, limits kept, bounds that nothing beats, scales."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.command.matrix_exponentials import equations_of, final_state, largest
from tests.command.programmes import farthest_distance

from preshape.command.rest_to_rest import RestToRest, bang_bang, deflection_limiting, on_off, time_optimal
from preshape.plant import FlexibleBody, FloatingOscillator

factors = st.floats(0.05, 20.0)
oscillators = st.builds(FloatingOscillator, factors, factors, factors)
dampings = st.one_of(st.just(0.0), st.floats(0.001, 0.5))
signs = st.sampled_from([1.0, -1.0])


@st.composite
def bodies(draw: st.DrawFn, most: int = 5) -> FlexibleBody:
    """Up to `most` modes, none nearer to its neighbour than 10 %, with gains of both signs and unequal sizes."""
    count = draw(st.integers(2, most))
    ratios = draw(st.lists(st.floats(1.1, 2.0), min_size=count - 1, max_size=count - 1))
    frequencies = draw(st.floats(0.3, 3.0)) * np.cumprod([1.0, *ratios])
    modes = [(float(frequency), draw(dampings) * 0.5) for frequency in frequencies]
    gains = [draw(signs) * 10.0 ** draw(st.floats(-1.5, 1.5)) for _ in range(count)]
    return FlexibleBody(draw(factors), modes, gains)


def rigid_distance(body: FlexibleBody, force: float, periods: float) -> float:
    """How far a rigid body gets in that many periods of the slowest mode [m]."""
    return force / body.mass * (0.5 * periods / min(mode.frequency for mode in body.modes)) ** 2


def assert_right(move: RestToRest, limits: tuple[float, ...] = ()) -> None:
    a, b, rows = equations_of(move.body)
    state = final_state(a, b, move)
    assert abs(state[0] - move.distance) < 3e-10 * abs(move.distance)
    assert abs(state[1]) * move.duration < 1e-9 * abs(move.distance)
    statics = np.abs(move.body.static_deflections(move.maximum_force))
    for number, (mode, static) in enumerate(zip(move.body.modes, statics, strict=True)):
        deflection, speed = state[2 + 2 * number : 4 + 2 * number]
        assert max(abs(deflection), abs(speed) / mode.omega) < 1e-9 * static
    assert np.abs(move.levels).max() <= move.maximum_force
    assert move.residuals.max() < 1e-12
    assert move.lower_bound is not None and move.lower_bound <= move.duration
    assert (move.status == "optimal") == (move.gap is not None and move.gap <= 1e-9)
    for row, limit, peak in zip(rows, limits, move.peak_deflections, strict=False):
        assert peak <= limit * (1.0 + 1e-9)
        if move.levels.size < 100:
            assert largest(a, b, row, move, samples=24) <= limit * (1.0 + 1e-8)


@settings(max_examples=25)
@given(oscillators, dampings, factors, st.floats(0.02, 12.0), st.floats(0.01, 2.5), signs)
def test_one_mode_is_always_proved(
    plant: FloatingOscillator, damping: float, force: float, periods: float, part: float, sign: float
) -> None:
    plant = plant.retuned(damping_ratio=damping)
    limit = part * plant.static_deflection(force)
    distance = sign * rigid_distance(plant.flexible_body, force, periods)
    move = time_optimal(plant, distance, maximum_force=force, deflection_limits=limit)
    assert move.status == "optimal"
    assert_right(move, (limit,))


@settings(max_examples=25)
@given(oscillators, factors, st.floats(1.2, 12.0), st.floats(0.01, 1.0))
def test_no_closed_form_beats_the_bound(plant: FloatingOscillator, force: float, periods: float, part: float) -> None:
    """Deflection-limiting commands are optimal themselves, others are longer than the bound of what they keep."""
    distance = rigid_distance(plant.flexible_body, force, 2.0 * periods)
    static = plant.static_deflection(force)
    bounds = [
        time_optimal(plant, distance, maximum_force=force, deflection_limits=limit).lower_bound
        for limit in (part * static, static, None)
    ]
    limited, within, free = (bound for bound in bounds if bound is not None)
    arguments: dict[str, Any] = {"maximum_force": force, "deflection_limit": part * static}
    closed = deflection_limiting(plant, distance, **arguments).duration
    assert limited * (1.0 - 1e-12) <= closed <= limited * (1.0 + 1e-9)
    assert limited < deflection_limiting(plant, distance, **arguments, fuel_lean=True).duration
    assert within < on_off(plant, distance, maximum_force=force).duration
    # a rigid body's move is faster than any that stops the mode too
    assert bang_bang(plant, distance, maximum_force=force).duration <= free * (1.0 + 1e-9)
    assert free <= within * (1.0 + 1e-9) and within <= limited * (1.0 + 1e-9)


@settings(max_examples=25)
@given(bodies(), factors, st.floats(0.05, 6.0), signs)
def test_several_modes_are_always_proved(body: FlexibleBody, force: float, periods: float, sign: float) -> None:
    move = time_optimal(body, sign * rigid_distance(body, force, periods), maximum_force=force)
    assert move.status == "optimal"
    assert_right(move)


@settings(max_examples=4)
@given(bodies(most=2), factors, st.floats(0.3, 3.0), st.lists(st.floats(0.3, 2.0), min_size=2, max_size=2))
def test_several_limited_modes_are_kept(body: FlexibleBody, force: float, periods: float, parts: list[float]) -> None:
    limits = tuple(np.array(parts) * np.abs(body.static_deflections(force)))
    move = time_optimal(body, rigid_distance(body, force, periods), maximum_force=force, deflection_limits=limits)
    assert move.gap is not None and move.gap < 0.02
    assert_right(move, limits)


@settings(max_examples=10)
@given(oscillators, dampings, st.floats(0.5, 6.0), st.floats(0.2, 2.5), factors, factors, factors)
def test_scales(
    plant: FloatingOscillator, damping: float, periods: float, part: float, time: float, mass: float, length: float
) -> None:
    """The same move in other units: times, masses and lengths scaled, and forces with them."""
    plant = plant.retuned(damping_ratio=damping)
    limit = part * plant.static_deflection(1.0)
    distance = rigid_distance(plant.flexible_body, 1.0, periods)
    move = time_optimal(plant, distance, maximum_force=1.0, deflection_limits=limit)
    scaled = FloatingOscillator(
        mass * plant.first_mass, mass * plant.second_mass, mass / time**2 * plant.stiffness, mass / time * plant.damping
    )
    force = mass * length / time**2
    other = time_optimal(scaled, length * distance, maximum_force=force, deflection_limits=length * limit)
    assert other.duration == pytest.approx(time * move.duration, rel=2e-9)
    assert other.peak_deflections == pytest.approx(length * move.peak_deflections, rel=1e-5)


@pytest.mark.slow
def test_many_bodies_with_limits_against_programmes() -> None:
    """Bodies of two to four modes; the programme's levels and samples are coarse, its answer is not exact."""
    random = np.random.default_rng(4)
    for _ in range(15):
        count = int(random.integers(2, 5))
        frequencies = 10.0 ** random.uniform(-0.5, 0.5) * np.cumprod(
            np.append(1.0, random.uniform(1.1, 2.0, count - 1))
        )
        modes = [(float(f), float(z)) for f, z in zip(frequencies, random.uniform(0.0, 0.1, count), strict=True)]
        body = FlexibleBody(random.uniform(0.5, 2.0), modes, list(random.choice([-1.0, 1.0], count)))
        limits = tuple(np.abs(body.static_deflections(1.0)) * 10.0 ** random.uniform(-0.7, 0.3, count))
        distance = rigid_distance(body, 1.0, random.uniform(0.3, 4.0))
        move = time_optimal(body, distance, maximum_force=1.0, deflection_limits=limits)
        assert_right(move, limits)
        assert move.gap is not None and move.gap < 0.05 and move.lower_bound is not None
        fine = max(300, int(40.0 * move.duration * frequencies[-1]))
        assert farthest_distance(body, 1.0, 0.998 * move.lower_bound, limits=limits, intervals=fine) < distance
        assert farthest_distance(body, 1.0, 1.02 * move.duration, limits=limits, intervals=fine) > distance
