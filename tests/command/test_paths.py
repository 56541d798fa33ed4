"""Shaped paths: straight lines, corners and circles in closed form, and distances against all segments one by one."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from preshape import Profile, Shaper, design
from preshape.command import trapezoid
from preshape.command.known import acceleration_error, advanced
from preshape.command.path import contour_error, shaped_path
from preshape.errors import InputError
from preshape.vibration.transform import transform

DT = 0.001
X, Y = design.zvd((8.0, 0.0)), design.zvd((13.0, 0.0))
COMMON = design.direct([(8.0, 0.0), (13.0, 0.0)])
ANGLE = math.radians(30.0)
DIRECTION = np.array([math.cos(ANGLE), math.sin(ANGLE)])


def line() -> NDArray[np.float64]:
    way = trapezoid(0.2, maximum_speed=0.25, maximum_acceleration=3.0, dt=DT).values
    return np.outer(DIRECTION, way)


def off_the_line(path: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.asarray(path[0] * DIRECTION[1] - path[1] * DIRECTION[0])


def test_a_common_shaper_keeps_a_slanted_line_straight() -> None:
    found = shaped_path(line(), COMMON, DT)
    assert found.contour_error().bound < 1e-15
    assert np.abs(off_the_line(found.shaped)).max() < 1e-15


def test_own_shapers_leave_the_line_by_the_difference_of_their_delays() -> None:
    found = shaped_path(line(), [X, Y], DT, delays="own")
    expected = 0.25 * DIRECTION[0] * DIRECTION[1] * (X.centroid - Y.centroid)
    cruising = (found.times > 0.3) & (found.times < 0.75)
    np.testing.assert_allclose(np.abs(off_the_line(found.shaped))[cruising], expected, rtol=1e-9)
    assert found.contour_error().largest >= expected
    assert found.delays == (X.centroid, Y.centroid)


def test_equal_delays_leave_it_only_where_the_speed_changes_and_by_a_closed_form() -> None:
    """Nothing at constant speed; at the acceleration a half the difference of the second central moments, times a."""
    found = shaped_path(line(), [X, Y], DT)
    away = np.abs(off_the_line(found.shaped))
    cruising = (found.times > 0.3) & (found.times < 0.75)
    assert away[cruising].max() < 1e-15
    bound = 3.0 * DIRECTION[0] * DIRECTION[1] * (acceleration_error(X) - acceleration_error(Y))
    error = found.contour_error()
    assert 0.1 * bound < error.largest <= bound * (1.0 + 1e-9)
    assert error.bound <= bound * (1.0 + 1e-6) and error.rms < error.largest
    own = shaped_path(line(), [X, Y], DT, delays="own").contour_error()
    assert error.largest < 0.25 * own.largest


def test_a_long_acceleration_reaches_the_closed_form() -> None:
    """A parabola along the line: exact profiles, no samples."""
    parabola = Profile.steps([0.0], [1.0], order=2)
    x, y = (advanced(parabola, one).shaped for one in (X, Y))
    late = np.linspace(0.5, 3.0, 20)
    ahead = DIRECTION[1] * DIRECTION[0] * (x(late) - y(late))  # type: ignore[operator]
    expected = DIRECTION[0] * DIRECTION[1] * (acceleration_error(X) - acceleration_error(Y))
    np.testing.assert_allclose(ahead, expected, atol=1e-13)


@given(st.floats(1.0, 40.0), st.floats(1.0, 40.0), st.floats(0.0, 0.3))
def test_held_back_shapers_do_what_equal_delays_do(first: float, second: float, damping: float) -> None:
    pair = [design.zvd((first, damping)), design.ei((second, damping))]
    here = shaped_path(line(), pair, DT)
    held = shaped_path(line(), design.synchronised(pair), DT, delays="own")
    length = min(here.shaped.shape[1], held.shaped.shape[1])
    np.testing.assert_allclose(here.shaped[:, :length], held.shaped[:, :length], atol=1e-15)
    assert here.delays == pytest.approx(held.delays, rel=1e-12)


@pytest.mark.parametrize("delays", ["equal", "own"])
def test_an_advanced_path_is_the_same_curve_earlier(delays: str) -> None:
    plain = shaped_path(line(), [X, Y], DT, delays=delays)
    ahead = shaped_path(line(), [X, Y], DT, delays=delays, advance=True)
    assert plain.start == 0.0 and -X.centroid - DT < ahead.start <= -X.centroid
    assert ahead.delays == pytest.approx([late - X.centroid for late in plain.delays], abs=1e-15)
    cruise = np.array([0.3, 0.45, 0.6])
    command = [np.interp(cruise, np.arange(line().shape[1]) * DT, row) for row in line()]
    for row, wanted, late in zip(ahead.shaped, command, ahead.delays, strict=True):
        speed = (row[600] - row[500]) / 0.1
        np.testing.assert_allclose(np.interp(cruise, ahead.times, row), wanted - speed * late, atol=1e-12)
    assert ahead.contour_error().largest == pytest.approx(plain.contour_error().largest, rel=1e-2)


@pytest.mark.parametrize("shaper", [X, COMMON, design.um_zv((8.0, 0.02)), design.sd_zv((8.0, 0.0), 0.3, "box")])
def test_a_circle_shrinks_to_the_transform(shaper: Shaper) -> None:
    """Radius R |S(i w)|: of the polygon between the samples, whose sides lie inside the circle by their sag."""
    radius, omega, dt = 0.05, 2.0 * math.pi * 1.25, 0.0005
    t = np.arange(round(6.0 * 2.0 * math.pi / omega / dt)) * dt
    circle = radius * np.stack([np.cos(omega * t), np.sin(omega * t)])
    found = shaped_path(circle, shaper, dt)
    last = found.shaped[:, round(shaper.duration / dt) + 2 : t.size]
    size = abs(complex(transform(shaper, np.array([1j * omega]))[0]))
    sag = radius * (1.0 - math.cos(0.5 * omega * dt))
    loss = 2.0 * sag if not shaper.boxes else 40.0 * sag
    np.testing.assert_allclose(np.hypot(*last), radius * size, rtol=0.0, atol=loss)
    error = contour_error(circle, last)
    assert error.largest == pytest.approx(radius * abs(1.0 - size), abs=3.0 * loss)
    assert error.largest <= error.bound <= 1.001 * error.largest
    if shaper is X:  # to second order in w: half the second central moment times the centripetal acceleration
        assert radius * (1.0 - size) == pytest.approx(radius * omega**2 * acceleration_error(X), rel=0.02)


def test_a_corner_is_cut_by_a_quarter_of_the_way_in_the_delay() -> None:
    """Two equal impulses T apart cut a right angle at the speed v straight: from v T/2 before to v T/2 after it."""
    shaper, speed = Shaper([0.0, 0.1], [0.5, 0.5]), 0.2
    ramp = speed * np.arange(401) * DT
    path = np.stack([np.append(ramp, np.full(400, ramp[-1])), np.append(np.zeros(400), ramp)])
    shaped = shaped_path(path, shaper, DT).shaped
    error = contour_error(path, shaped)
    assert error.largest == pytest.approx(speed * 0.1 / 4.0, rel=1e-12)
    np.testing.assert_allclose(error.place, [ramp[-1] - 0.005, 0.005], atol=1e-15)
    missed = contour_error(shaped, path)
    assert missed.largest == pytest.approx(math.sqrt(2.0) * speed * 0.1 / 4.0, rel=1e-12)
    np.testing.assert_allclose(missed.place, [ramp[-1], 0.0], atol=1e-15)


def one_by_one(curve: NDArray[np.float64], point: NDArray[np.float64]) -> float:
    """The distance to a polyline, (axis, time), by every segment."""
    found = math.inf
    for a, b in zip(curve.T[:-1], curve.T[1:], strict=True):
        square = float((b - a) @ (b - a))
        share = min(max(float((point - a) @ (b - a)) / square, 0.0), 1.0) if square else 0.0
        found = min(found, float(np.linalg.norm(point - a - share * (b - a))))
    return found


@pytest.mark.parametrize("axes", [1, 2, 3, 4])
@pytest.mark.parametrize("seed", range(6))
def test_the_distance_is_the_smallest_of_all_segments_and_the_bound_holds_between_samples(axes: int, seed: int) -> None:
    """Segments of very different lengths, some of none, paths that cross and leave the curve altogether."""
    generator = np.random.default_rng(seed)
    steps = generator.normal(size=(axes, 60)) * 10.0 ** generator.uniform(-4.0, 1.0, 60)
    steps[:, generator.integers(0, 60, 10)] = 0.0
    curve = np.cumsum(steps, axis=1)
    path = curve[:, ::2] + generator.normal(size=(axes, 30)) * 10.0 ** generator.uniform(-6.0, 1.0, 30)
    found = contour_error(curve, path)
    expected = [one_by_one(curve, point) for point in path.T]
    np.testing.assert_allclose(found.distances, expected, rtol=1e-9, atol=1e-12)
    assert found.largest == found.distances[found.index] == found.distances.max()
    np.testing.assert_array_equal(found.place, path[:, found.index])
    parts = np.linspace(0.0, 1.0, 12)
    between = (path[:, :-1, None] * (1.0 - parts) + path[:, 1:, None] * parts).reshape(axes, -1)
    assert max(one_by_one(curve, point) for point in between.T) <= found.bound * (1.0 + 1e-9) + 1e-12


def test_the_mean_is_along_the_path_not_over_its_samples() -> None:
    curve = [[0.0, 10.0], [0.0, 0.0]]
    waits = np.array([[0.0, 5.0, *[5.0] * 50, 10.0], [0.0, 1.0, *[1.0] * 50, 0.0]])
    assert contour_error(curve, waits).rms == pytest.approx(math.sqrt(1.0 / 3.0), rel=1e-12)


def test_one_axis_and_many_samples() -> None:
    there_and_back = np.concatenate([np.linspace(0.0, 1.0, 50_000), np.linspace(1.0, 0.0, 50_000)])
    assert shaped_path([there_and_back], X, DT).contour_error().largest < 1e-15


def test_a_point_to_which_all_segments_are_equally_near() -> None:
    """And one beside it, whose nearest place is one among many nearly as near."""
    angle = np.linspace(0.0, 2.0 * math.pi, 5_001)
    arc = 3.0 * np.stack([np.cos(angle), np.sin(angle)])
    path = np.concatenate([np.zeros((2, 200)), np.outer([1e-9, 0.0], np.ones(200))], axis=1)
    found = contour_error(arc, path)
    np.testing.assert_allclose(found.distances[:200], 3.0 * math.cos(math.pi / 5_000), rtol=1e-12)
    assert found.distances[200:] == pytest.approx(3.0 - 1e-9, abs=1e-6)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (lambda: shaped_path([0.0, 1.0], X, DT), "one row an axis"),
        (lambda: shaped_path([[]], X, DT), "one row an axis"),
        (lambda: shaped_path([[0.0, 1.0], [0.0]], X, DT), "same length"),
        (lambda: shaped_path([[0.0, 1.0], [0.0, math.nan]], X, DT), "row 2 at sample 1"),
        (lambda: shaped_path([[0.0, 1.0]], [X, Y], DT), "2 shapers were given for 1 axes"),
        (lambda: shaped_path([[0.0, 1.0]], "zvd", DT), "no shaper"),  # type: ignore[arg-type]
        (lambda: shaped_path([[0.0, 1.0]], X, 0.0), "above 0"),
        (lambda: shaped_path([[0.0, 1.0]], X, DT, delays="none"), '"equal" or "own"'),
        (lambda: contour_error([[0.0, 1.0]], [[0.0, 1.0], [0.0, 1.0]]), "1 and 2 axes"),
        (lambda: contour_error([[1.0, 1.0]], [[0.0, 1.0]]), "commanded path rests"),
        (lambda: contour_error([[0.0, 1.0]], [[0.0, 0.0]]), "the path rests"),
        (lambda: contour_error([[0.0, math.inf]], [[0.0, 0.0]]), "infinity"),
    ],
)
def test_wrong_input_gets_a_sentence(wrong: object, words: str) -> None:
    with pytest.raises(InputError, match=words):
        wrong()  # type: ignore[operator]
