"""Several axes of a ruckig trajectory in one call, beside ruckig's own positions."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from preshape import Shaper, design
from preshape.command.path import contour_error, shaped_trajectory
from preshape.errors import InputError
from preshape.plant import ModalPlant

MODES = ((38.0, 0.02), (61.0, 0.02))
SHAPERS = [design.zvd(mode) for mode in MODES]


def straight(start: tuple[float, float] = (1.0, -2.0)) -> Any:
    """A line of ruckig, both axes in phase."""
    ruckig = pytest.importorskip("ruckig")
    given = ruckig.InputParameter(2)
    given.current_position, given.target_position = list(start), [start[0] + 0.3, start[1] + 0.2]
    given.max_velocity, given.max_acceleration, given.max_jerk = [0.5] * 2, [5.0] * 2, [200.0] * 2
    given.synchronization = ruckig.Synchronization.Phase
    trajectory = ruckig.Trajectory(2)
    assert ruckig.Ruckig(2).calculate(given, trajectory) == ruckig.Result.Working
    return trajectory


def test_each_axis_is_ruckigs_own_motion_through_its_shaper() -> None:
    trajectory = straight()
    own = shaped_trajectory(trajectory, SHAPERS, delays="own")
    for t in np.linspace(0.0, own[0].end_time, 200):
        for axis, (profile, shaper) in enumerate(zip(own, SHAPERS, strict=True)):
            ways = [trajectory.at_time(max(0.0, t - late))[0][axis] for late in shaper.times]
            expected = shaper.amplitudes @ np.array(ways) - trajectory.at_time(0.0)[0][axis]
            assert profile(t) == pytest.approx(expected, abs=1e-12)


def test_nothing_vibrates_and_equal_delays_keep_the_line() -> None:
    trajectory = straight()
    errors = {}
    for delays in ("equal", "own"):
        profiles = shaped_trajectory(trajectory, SHAPERS, delays=delays)
        for profile, mode, goal in zip(profiles, MODES, (0.3, 0.2), strict=True):
            assert profile.final_value == pytest.approx(goal, rel=1e-9)
            assert ModalPlant(mode).motion(profile).residual_amplitudes[0] < 1e-12
        t = np.linspace(0.0, max(profile.end_time for profile in profiles), 2000)
        path = np.stack([profile(t) for profile in profiles])
        errors[delays] = contour_error([[0.0, 0.3], [0.0, 0.2]], path).largest
    assert errors["equal"] < 0.2 * errors["own"]


def test_one_shaper_serves_all_axes() -> None:
    profiles = shaped_trajectory(straight(), SHAPERS[0])
    assert len(profiles) == 2
    t = np.linspace(0.0, 1.0, 50)
    np.testing.assert_allclose(profiles[1](t) * 1.5, profiles[0](t), atol=1e-12)


def test_wrong_input_is_refused() -> None:
    with pytest.raises(InputError, match="no trajectory"):
        shaped_trajectory([1.0], SHAPERS)
    with pytest.raises(InputError, match="1 shapers were given for 2 axes"):
        shaped_trajectory(straight(), SHAPERS[:1])
    with pytest.raises(InputError, match="delays"):
        shaped_trajectory(straight(), Shaper([0.0], [1.0]), delays="none")
