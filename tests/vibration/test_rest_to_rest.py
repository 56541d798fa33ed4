"""What rest-to-rest commands leave, against impulses and bang-bang: Robertson's section II, shapers as commands."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.plant.robertson_commands import limited, on_off

from preshape import Mode, Shaper, design
from preshape.errors import InputError
from preshape.plant import FloatingOscillator, exact_motion
from preshape.profile import Profile
from preshape.vibration import (
    bang_bang_of_the_same_move,
    command_insensitivity,
    command_vibration,
    insensitivity,
    residual_vibration,
)

PLANT = FloatingOscillator(1.0, 1.0, 1.0)
UM_ZV_BAND = 0.0551
"""5 % insensitivity of the undamped unity-magnitude shaper that on-off commands are made with."""


def by_definition(command: Profile, mode: Mode, force: float) -> float:
    """Amplitude after the command over amplitude after one step, both by the exact motion."""
    step = exact_motion(mode, Profile.steps([0.0], [force]))
    return float(exact_motion(mode, command).residual_amplitudes[0] / step.residual_amplitudes[0])


@given(
    st.lists(st.tuples(st.floats(0.01, 1.0), st.floats(0.01, 3.0)), min_size=1, max_size=6),
    st.floats(0.05, 6.0),
    st.floats(0.0, 0.8),
)
def test_a_staircase_is_a_sequence_of_impulses(rows: list[tuple[float, float]], f: float, z: float) -> None:
    gaps, jumps = zip(*rows, strict=True)
    times = np.cumsum(gaps) - gaps[0]
    command = Profile.steps(times, jumps)
    shaper = Shaper.normalised(times, jumps)
    left = command_vibration(command, f, z, maximum_force=2.0)
    expected = float(residual_vibration(shaper, f, z)) * sum(jumps) / 2.0
    assert float(left) == pytest.approx(expected, rel=1e-10, abs=1e-12)
    assert float(left) == pytest.approx(by_definition(command, Mode(f, z), 2.0), rel=1e-9, abs=1e-12)


@given(st.integers(1, 3), st.floats(0.05, 6.0), st.floats(0.0, 0.8))
def test_smooth_commands_by_definition(order: int, f: float, z: float) -> None:
    command = Profile.steps([0.0, 0.3, 0.7, 1.0, 1.4], [1.0, -2.0, 1.0, 1.0, -1.0], order)
    closing = [-float(command(1.4, k)) for k in range(1, order + 1)]
    command = command + Profile(np.full(order, 1.4), closing, np.arange(1, order + 1))
    left = command_vibration(command, f, z, maximum_force=0.5)
    assert float(left) == pytest.approx(by_definition(command, Mode(f, z), 0.5), rel=1e-9, abs=1e-12)


def test_vibration_relative_to_bang_bang() -> None:
    # The bang-bang factor of an on-off command cancels: what is left is its shaper's, |1 - e + e^2|.
    f = np.linspace(0.15, 0.3, 7)
    phase = np.exp(2j * math.pi * f / PLANT.mode.frequency / 6)
    expected = np.abs(1 - phase + phase**2)
    for distance in (3.0, 5.0, 17.0):
        found = command_vibration(on_off(distance), f, relative_to="bang-bang")
        np.testing.assert_allclose(found, expected, rtol=1e-9)
    exact = bang_bang_of_the_same_move(on_off(5.0))
    np.testing.assert_allclose(exact.times, [0.0, math.sqrt(10.0), 2 * math.sqrt(10.0)], rtol=1e-12)
    # Where bang-bang leaves nothing there is no value, and it is said so in the data.
    missing = command_vibration(limited(math.pi**2, 0.6), [0.2, PLANT.mode.frequency], relative_to="bang-bang")
    assert np.isfinite(missing[0]) and np.isnan(missing[1])


@pytest.mark.parametrize(
    ("distance", "on_off_impulse", "limited_impulse", "limited_bang_bang"),
    [
        (5.0, 0.0223, 0.2476, 0.3037),
        (10.0, 0.1786, 0.0349, None),
        (15.0, 0.0322, 0.0242, 0.0476),
        (20.0, 0.0146, 0.1698, 0.2292),
    ],
)
def test_insensitivity_of_the_benchmark_moves(
    distance: float, on_off_impulse: float, limited_impulse: float, limited_bang_bang: float | None
) -> None:
    a, b = on_off(distance), limited(distance, 0.6)
    assert round(command_insensitivity(a, PLANT.mode).value, 4) == on_off_impulse
    assert round(command_insensitivity(b, PLANT.mode).value, 4) == limited_impulse
    relative = command_insensitivity(a, PLANT.mode, relative_to="bang-bang")
    assert (round(relative.value, 4), relative.status) == (UM_ZV_BAND, "measured")
    if limited_bang_bang is not None:
        assert round(command_insensitivity(b, PLANT.mode, relative_to="bang-bang").value, 4) == limited_bang_bang


def test_edges_are_where_the_tolerance_is_reached() -> None:
    mode = Mode(PLANT.mode.frequency, 0.03)
    for tolerance in (0.02, 0.1, 0.4):
        for command in (on_off(5.0), limited(20.0, 0.6)):
            found = command_insensitivity(command, mode, tolerance)
            if found.value > 0.0:
                edges = command_vibration(command, [found.low, found.high], 0.03)
                np.testing.assert_allclose(edges, tolerance, rtol=1e-7)
                inside = command_vibration(command, np.linspace(found.low, found.high, 5001), 0.03)
                assert inside.max() <= tolerance * (1 + 1e-7)


@pytest.mark.parametrize("family", ["zv", "zvd", "ei"])
def test_a_shaped_step_has_the_insensitivity_of_its_shaper(family: str) -> None:
    # EI touches the tolerance between its zeros: the band must not end there.
    mode = Mode(1.3, 0.0)
    shaper = getattr(design, family)(mode)
    command = Profile.steps(shaper.times, shaper.amplitudes)
    found, known = command_insensitivity(command, mode), insensitivity(shaper, mode, 0.05)
    assert (found.low, found.high) == pytest.approx((known.low, known.high), rel=1e-9)


def test_undefined_is_an_answer() -> None:
    for n in (1, 2):
        found = command_insensitivity(limited((n * math.pi) ** 2, 0.6), PLANT.mode, relative_to="bang-bang")
        assert found.status == "undefined"
        assert math.isnan(found.low) and math.isnan(found.high) and math.isnan(found.value)
    exceeded = command_insensitivity(on_off(5.0), (0.3, 0.0))
    assert (exceeded.value, exceeded.low, exceeded.status) == (0.0, 0.3, "measured")


def test_a_smooth_command_is_insensitive_without_end() -> None:
    # A slow triangle of force excites nothing fast.
    slow = Profile.steps([0.0, 50.0, 100.0], [0.02, -0.04, 0.02], order=1)
    found = command_insensitivity(slow, (1.0, 0.0), maximum_force=1.0)
    assert found.high == found.value == math.inf
    assert 0.0 < found.low < 1.0


@pytest.mark.parametrize(
    ("call", "sentence"),
    [
        (lambda c: command_vibration(c, 1.0, relative_to="zv"), "relative_to is 'zv'"),
        (lambda c: command_vibration(Profile([], [], []), 1.0), "no steps"),
        (lambda c: command_vibration(Profile.steps([0.0], [1.0], 1), 1.0, maximum_force=1.0), "still changes"),
        (lambda c: command_vibration(Profile.steps([0.0, 1.0], [1.0, -1.0], 1), 1.0), "give maximum_force"),
        (lambda c: command_vibration(c, 1.0, maximum_force=-2.0), "maximum_force is -2"),
        (lambda c: bang_bang_of_the_same_move(Profile.steps([0.0, 1.0], [1.0, -1.0])), "leaves the mass moving"),
        (
            lambda c: bang_bang_of_the_same_move(
                Profile.steps([0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0], [1, -2, 1, 0, -1, 2, -1])
            ),
            "ends where it began",
        ),
        (lambda c: command_insensitivity(c, (1.0, 0.0), 1.5), "tolerance 1.5"),
    ],
)
def test_wrong_input_is_named(call: object, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        call(on_off(5.0))  # type: ignore[operator]
