"""The closed form of the S-curve against ruckig, which finds the time-optimal jerk-limited move in its own way."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from preshape.command import s_curve
from preshape.profile import Profile

ruckig = pytest.importorskip("ruckig")


def by_ruckig(distance: float, speed: float, acceleration: float, jerk: float) -> Profile:
    given = ruckig.InputParameter(1)
    given.current_position, given.target_position = [0.0], [distance]
    given.max_velocity, given.max_acceleration, given.max_jerk = [speed], [acceleration], [jerk]
    trajectory = ruckig.Trajectory(1)
    assert ruckig.Ruckig(1).calculate(given, trajectory) == ruckig.Result.Working
    return Profile.from_ruckig(trajectory)


@settings(max_examples=300)
@given(
    st.floats(0.05, 20.0),
    st.floats(0.05, 50.0),
    st.floats(1e-2, 1e2),  # below 1 the acceleration limit is never reached
    st.floats(1e-3, 1e2),  # from moves too short for any limit to moves that are nearly all cruise
    st.sampled_from([-1.0, 1.0]),
)
def test_duration_and_profile_are_those_of_ruckig(
    speed: float, acceleration: float, jerkiness: float, ratio: float, sign: float
) -> None:
    jerk = jerkiness * acceleration**2 / speed
    distance = sign * ratio * speed**2 / acceleration
    move = s_curve(
        distance, maximum_speed=speed, maximum_acceleration=acceleration, maximum_jerk=jerk, dt=abs(distance) / speed
    )
    assert move.profile is not None
    expected = by_ruckig(distance, speed, acceleration, jerk)
    assert move.duration == pytest.approx(expected.duration, rel=1e-9)
    # Ours comes to rest exactly even where a ramp is a thousandth of the move and times round by a part of 1e-12 of it.
    assert move.profile.final_value == pytest.approx(distance, rel=1e-11)
    times = np.linspace(-0.1, 1.1, 241) * move.duration
    for derivative, size in ((0, abs(distance)), (1, speed), (2, acceleration)):
        np.testing.assert_allclose(
            move.profile(times, derivative), expected(times, derivative), rtol=0.0, atol=1e-9 * size
        )
