"""A duration longer than the shortest: the same move slowed, or a longer cruise; a shorter one is refused."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape.command import (
    Command,
    band_limited,
    bang_bang,
    cycloidal,
    period_matched,
    ramped_sinusoid,
    s_curve,
    trapezoid,
    versine,
    versine_force,
)
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.plant import ModalPlant

LIMITS = {"maximum_speed": 0.8, "maximum_acceleration": 3.0}
MODE = Mode(1.0, 0.0)

CLASSICS: dict[str, Callable[..., Command]] = {
    "bang_bang": bang_bang,
    "trapezoid": trapezoid,
    "s_curve": lambda distance, **wishes: s_curve(distance, maximum_jerk=20.0, **wishes),
    "cycloidal": cycloidal,
    "versine": versine,
    "versine_force": versine_force,
    "ramped_sinusoid": lambda distance, **wishes: ramped_sinusoid(distance, MODE, **wishes),
    "band_limited": lambda distance, **wishes: band_limited(distance, (0.9, 1.1), **wishes),
    "period_matched": lambda distance, **wishes: period_matched(distance, MODE, **wishes),
}
"""Every classic that is a move: distance, limits and duration."""


@pytest.mark.parametrize("name", CLASSICS)
def test_every_classic_takes_distance_limits_and_duration(name: str) -> None:
    build = CLASSICS[name]
    shortest = build(0.5, **LIMITS, dt=0.001)
    assert build(0.5, **LIMITS, duration=shortest.duration, dt=0.001).duration == pytest.approx(shortest.duration)
    slow = build(0.5, **LIMITS, duration=1.5 * shortest.duration, dt=0.001)
    assert slow.duration == pytest.approx(1.5 * shortest.duration, rel=1e-12)
    assert slow.values[-1] == pytest.approx(0.5, rel=1e-12)
    assert slow.velocity is not None and np.abs(slow.velocity).max() <= 0.8 * (1.0 + 1e-9)
    assert slow.acceleration is not None and np.abs(slow.acceleration).max() <= 3.0 * (1.0 + 1e-9)
    with pytest.raises(InputError, match="breaks a limit: this move takes at least"):
        build(0.5, **LIMITS, duration=0.7 * shortest.duration, dt=0.001)
    with pytest.raises(InputError, match="duration is 0 s"):
        build(0.5, **LIMITS, duration=0.0, dt=0.001)


@given(st.floats(0.01, 10.0), st.floats(1.0, 20.0), st.sampled_from(["trapezoid", "s_curve"]))
def test_a_slower_move_is_the_same_move_in_slow_motion(distance: float, slower: float, name: str) -> None:
    build = CLASSICS[name]
    fast = build(distance, **LIMITS, dt=1.0)
    slow = build(distance, **LIMITS, duration=slower * fast.duration, dt=1.0)
    assert fast.profile is not None and slow.profile is not None
    times = np.linspace(0.0, 1.0, 101) * fast.duration
    np.testing.assert_allclose(slow.profile(slower * times), fast.profile(times), rtol=0.0, atol=1e-12 * distance)
    np.testing.assert_allclose(
        slow.profile(slower * times, 1) * slower, fast.profile(times, 1), rtol=0.0, atol=1e-11 * 0.8
    )


def test_a_slower_period_matched_move_still_spares_its_mode() -> None:
    for duration in (3.0, 3.1, 3.77, 6.2):
        move = period_matched(1.0, MODE, **LIMITS, duration=duration, dt=0.01)
        assert move.duration == pytest.approx(duration) and move.profile is not None
        plant = ModalPlant(MODE, drive="acceleration")
        assert plant.motion(move.profile.derivative().derivative()).residual("output") < 1e-13


@given(st.floats(0.01, 10.0), st.floats(0.1, 10.0), st.floats(-12.0, 2.0), st.floats(-3.0, 12.0))
def test_profiles_end_at_rest_however_short_the_ramps(
    distance: float, speed: float, shortness: float, jerkiness: float
) -> None:
    """Times round by 1e-16 of the move, and its ramps may be hardly longer than that."""
    acceleration = 10.0**-shortness * speed**2 / distance  # a ramp lasts 10^shortness of the cruise
    jerk = 10.0**jerkiness * acceleration**2 / speed
    limits = {"maximum_speed": speed, "maximum_acceleration": acceleration}
    dt = distance / speed
    for move in (trapezoid(distance, **limits, dt=dt), s_curve(distance, **limits, maximum_jerk=jerk, dt=dt)):
        assert move.profile is not None and move.profile.ends_at_rest
        # A ramp's end is rounded by a part of the ramp, and so is the speed that it leads to.
        rounding = 4e-15 * move.duration / np.diff(move.profile.segments()[0]).min()
        assert move.profile.final_value == pytest.approx(distance, rel=max(1e-12, rounding))
        assert move.profile.derivative().derivative().ends_at_rest
