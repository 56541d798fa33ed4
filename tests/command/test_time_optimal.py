"""time_optimal against what is known otherwise: printed numbers, closed forms, and plain linear programmes."""

import math

import numpy as np
import pytest
from tests.command.matrix_exponentials import equations_of, final_state, largest
from tests.command.programmes import deflections_by_steps, farthest_distance

from preshape import Band
from preshape.command.rest_to_rest import RestToRest, bang_bang, deflection_limiting, on_off, time_optimal
from preshape.command.rest_to_rest.shortest import Problem, shortest_move
from preshape.plant import FlexibleBody, FloatingOscillator

UNIT = FloatingOscillator(1.0, 1.0, 1.0)
TWO = FlexibleBody(2.0, [(0.2, 0.0), (0.5, 0.01)], [1.0, -0.3])
FOUR = FlexibleBody(1.0, [(0.4, 0.0), (0.9, 0.02), (1.7, 0.0), (2.6, 0.05)], [1.0, 2.0, -0.5, 3.0])


def assert_right(move: RestToRest, distance: float, limits: tuple[float, ...] = ()) -> None:
    """At rest on the target, and nothing beyond what is allowed, by matrix exponentials."""
    a, b, rows = equations_of(move.body)
    state = final_state(a, b, move)
    assert state[0] == pytest.approx(distance, rel=1e-10)
    assert abs(state[1]) * move.duration < 1e-9 * abs(distance)
    for number, (mode, static) in enumerate(
        zip(move.body.modes, move.body.static_deflections(move.maximum_force), strict=True)
    ):
        deflection, speed = state[2 + 2 * number : 4 + 2 * number]
        assert max(abs(deflection), abs(speed) / mode.omega) < 1e-10 * abs(static)
    assert np.abs(move.levels).max() <= move.maximum_force
    for row, limit, peak in zip(rows, limits, move.peak_deflections, strict=False):
        assert largest(a, b, row, move) == pytest.approx(peak, rel=1e-7) and peak <= limit * (1.0 + 1e-9)


def problem_of(plant: FloatingOscillator, distance: float, force: float, limit: float) -> Problem:
    body = plant.flexible_body
    rows = body.static_deflections(force)[:, None] / limit
    return Problem(distance * body.mass / force, -np.conj([mode.pole for mode in body.modes]), rows)


@pytest.mark.parametrize(("distance", "duration"), [(5.0, 9.2625), (10.0, 12.6428), (15.0, 15.2372), (20.0, 17.4245)])
def test_limited_moves_of_robertsons_plant(distance: float, duration: float) -> None:
    move = time_optimal(UNIT, distance, maximum_force=1.0, deflection_limits=0.3)
    assert move.status == "optimal" and move.gap is not None and move.gap < 1e-12
    assert move.duration == pytest.approx(duration, abs=5.1e-5)
    assert_right(move, distance, (0.3,))


@pytest.mark.parametrize(("distance", "duration"), [(5.0, 7.761), (10.0, 10.379), (20.0, 14.082)])
def test_moves_within_the_static_deflection(distance: float, duration: float) -> None:
    """The literature's on-off command is within 0.05 s of these; on its grid of 240 levels a programme found them."""
    move = time_optimal(UNIT, distance, maximum_force=1.0, deflection_limits=0.5, on_off=True)
    assert move.status == "optimal"
    assert move.duration == pytest.approx(duration, abs=1e-3)
    assert set(np.abs(move.levels)) == {1.0}
    assert_right(move, distance, (0.5,))
    closed = on_off(UNIT, distance, maximum_force=1.0)
    assert move.lower_bound is not None
    assert move.lower_bound < closed.duration < move.lower_bound + 0.05


@pytest.mark.parametrize("periods", [1, 2])
def test_bang_bang_where_it_leaves_nothing(periods: int) -> None:
    """Robertson's distances, where the fastest move of a rigid body is a fastest move of the oscillator too."""
    distance = math.pi**2 * periods**2
    move = time_optimal(UNIT, distance, maximum_force=1.0)
    assert move.status == "optimal"
    assert move.duration == pytest.approx(bang_bang(UNIT, distance, maximum_force=1.0).duration, rel=1e-9)


def test_closed_form_is_what_the_search_finds_and_proves_where_it_does_not_know_it() -> None:
    """time_optimal begins with the closed form; the engine behind it finds the same command without."""
    random = np.random.default_rng(20261125)
    for _ in range(8):
        m1, m2, k, force = 10.0 ** random.uniform(-1.0, 1.0, 4)
        plant = FloatingOscillator(m1, m2, k)
        limit = plant.static_deflection(force) * random.uniform(0.1, 0.99)
        distance = force / (m1 + m2) * (random.uniform(1.05, 4.0) / plant.mode.frequency) ** 2
        closed = deflection_limiting(plant, distance, maximum_force=force, deflection_limit=limit)
        found = shortest_move(problem_of(plant, distance, force, limit))
        assert found is not None and found.structure is not None
        assert found.gap < 1e-9
        assert found.duration == pytest.approx(closed.duration, rel=1e-9)
        assert found.motion.times == pytest.approx(closed.switch_times, abs=1e-6 * closed.duration)
        move = time_optimal(plant, distance, maximum_force=force, deflection_limits=limit)
        assert move.status == "optimal" and move.duration == pytest.approx(closed.duration, rel=1e-9)


@pytest.mark.parametrize("damping", [0.02, 0.2, 0.6])
def test_damping_is_followed_from_the_closed_form_and_proved(damping: float) -> None:
    plant = UNIT.retuned(damping_ratio=damping)
    move = time_optimal(plant, 10.0, maximum_force=1.0, deflection_limits=0.3)
    assert move.status == "optimal"
    assert_right(move, 10.0, (0.3,))
    found = shortest_move(problem_of(plant, 10.0, 1.0, 0.3))
    assert found is not None and found.duration == pytest.approx(move.duration, rel=1e-8)


def test_a_limit_of_a_thousandth_of_the_static_deflection() -> None:
    move = time_optimal(UNIT, 2.0, maximum_force=1.0, deflection_limits=5e-4)
    assert move.status == "optimal"
    assert_right(move, 2.0, (5e-4,))


def test_a_thousand_periods_are_no_hurdle_where_the_closed_form_begins() -> None:
    move = time_optimal(UNIT, 1e6, maximum_force=1.0, deflection_limits=0.3)
    assert move.status == "optimal" and move.duration > 800.0 * 2.0 * math.pi / UNIT.mode.omega
    assert_right(move, 1e6, (0.3,))


def test_a_limit_that_is_never_reached_changes_nothing() -> None:
    free = time_optimal(UNIT, 10.0, maximum_force=1.0)
    loose = time_optimal(UNIT, 10.0, maximum_force=1.0, deflection_limits=5.0)
    assert loose.status == "optimal" and loose.duration == pytest.approx(free.duration, rel=1e-12)
    assert_right(free, 10.0)


def test_backwards_is_the_mirror_of_forwards() -> None:
    there = time_optimal(TWO, 3.0, maximum_force=2.0, deflection_limits=[0.5, None])
    back = time_optimal(TWO, -3.0, maximum_force=2.0, deflection_limits=[0.5, None])
    assert back.switch_times == pytest.approx(there.switch_times) and back.levels == pytest.approx(-there.levels)
    assert_right(back, -3.0, (0.5,))


@pytest.mark.parametrize("distance", [1e-6, 1e-3, 1.0, 100.0])
@pytest.mark.parametrize("body", [TWO, FOUR], ids=["two modes", "four modes"])
def test_several_modes_without_limits(body: FlexibleBody, distance: float) -> None:
    move = time_optimal(body, distance, maximum_force=1.0)
    assert move.status == "optimal"
    assert_right(move, distance)


def test_switches_too_close_for_the_grid_are_where_p_is_zero() -> None:
    """Modes an octave apart: of the twelve arcs the levels on the grid show six."""
    body = FlexibleBody(1.0, [(f, 0.0) for f in (1.0, 2.0, 4.0, 8.0, 16.0)], [1.0] * 5)
    move = time_optimal(body, 2.25, maximum_force=1.0)
    assert move.status == "optimal" and move.levels.size == 12
    assert np.diff(move.switch_times).min() < 0.25 / 16.0  # closer than a quarter of the fastest period
    assert_right(move, 2.25)


def assert_not_beaten(move: RestToRest, distance: float, **asked: object) -> None:
    """No programme gets as far in less than the bound, and a little later than the move it does."""
    assert move.lower_bound is not None
    early, late = 0.999 * move.lower_bound, 1.01 * move.duration
    assert farthest_distance(move.body, move.maximum_force, early, **asked) < distance  # type: ignore[arg-type]
    assert farthest_distance(move.body, move.maximum_force, late, **asked) > distance  # type: ignore[arg-type]


@pytest.mark.parametrize("limits", [(0.3, 0.02), (0.3, np.inf), (np.inf, 0.02), (0.8, 0.05)])
def test_two_limited_modes_against_a_linear_programme(limits: tuple[float, float]) -> None:
    move = time_optimal(TWO, 5.0, maximum_force=1.0, deflection_limits=limits)
    assert move.gap is not None and move.gap < 1e-3
    assert_right(move, 5.0, limits)
    assert_not_beaten(move, 5.0, limits=limits)


def test_a_sum_of_two_modes_against_a_linear_programme() -> None:
    """Its force varies while it holds the sum on its limit: a staircase, and the bound says how good it is."""
    weights = np.array([[1.0, 4.0]])
    move = time_optimal(TWO, 1.0, maximum_force=1.0, deflection_limits=0.25, outputs=weights)
    assert move.status == "feasible" and move.gap is not None and move.gap < 1e-4
    assert move.peak_deflections.shape == (1,) and move.peak_deflections[0] <= 0.25
    assert move.residuals.max() < 1e-12 and np.abs(move.levels).max() <= 1.0
    area, moment = move.force.integral(), move.force.integral().integral()
    assert float(area(move.duration)) == pytest.approx(0.0, abs=1e-11)
    assert float(moment(move.duration)) == pytest.approx(TWO.mass * 1.0, rel=1e-11)
    shown = weights[0] @ deflections_by_steps(move, np.linspace(0.0, 1.2 * move.duration, 4001))
    assert np.abs(shown).max() == pytest.approx(move.peak_deflections[0], rel=1e-4)
    assert_not_beaten(move, 1.0, weights=weights, limits=(0.25,))


def test_vibration_is_tolerated_in_a_band_and_not_more() -> None:
    band = Band(0.18, 0.26)
    move = time_optimal(UNIT, 10.0, maximum_force=1.0, bands=band, tolerance=0.1)
    assert move.status == "optimal"
    assert_right(move, 10.0)
    leads = move.duration - move.switch_times
    steps = np.diff(move.levels, prepend=0.0, append=0.0)
    waves = np.exp(2j * np.pi * np.multiply.outer(np.linspace(0.18, 0.26, 4001), leads)) @ steps
    assert np.abs(waves).max() == pytest.approx(0.1, rel=1e-5)
    assert_not_beaten(move, 10.0, bands=[band], tolerance=0.1)


def test_the_same_from_a_body_as_from_the_oscillator() -> None:
    body = time_optimal(UNIT.flexible_body, 10.0, maximum_force=1.0, deflection_limits=0.3)
    assert body.duration == time_optimal(UNIT, 10.0, maximum_force=1.0, deflection_limits=[0.3]).duration
    text = str(body)
    assert text.startswith("time-optimal: 10 m in 12.6428 s, optimal, at most") and "deflection at most 0.3 m" in text
