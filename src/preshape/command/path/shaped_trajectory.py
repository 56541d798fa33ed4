"""All axes of a trajectory of ruckig through their shapers: exact, delayed alike."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from preshape.command.path.shaped_path import DELAYS, one_an_axis
from preshape.errors import InputError
from preshape.profile import Profile
from preshape.shaper import Shaper

__all__ = ["shaped_trajectory"]


def shaped_trajectory(
    trajectory: Any, shapers: Shaper | Sequence[Shaper], *, delays: str = "equal"
) -> tuple[Profile, ...]:
    """Shape every degree of freedom of a trajectory of ruckig: its steps of jerk, no samples.

    Parameters
    ----------
    trajectory : ruckig.Trajectory
        Calculated, from rest; ``pip install preshape[motion]`` brings ruckig.
    shapers : Shaper, or sequence of Shaper
        One for all degrees of freedom, or one each.
    delays : {"equal", "own"}
        As of :func:`shaped_path`: "equal" holds all back to the longest delay, so that ruckig's synchronised straight
        lines stay straight at constant speed.

    Returns
    -------
    tuple of Profile
        One a degree of freedom, relative to where it starts, in ruckig's unit; ``profile.sample(dt)`` are set points.

    Raises
    ------
    InputError
        If it is no such trajectory, starts while moving, or has another number of axes than shapers.
    """
    if delays not in DELAYS:
        raise InputError(f'delays is {delays!r}: it is "equal" or "own".')
    count = getattr(trajectory, "degrees_of_freedom", None)
    if not isinstance(count, int):
        raise InputError(f"{type(trajectory).__name__} is no trajectory: give a ruckig.Trajectory after calculate().")
    each = one_an_axis(shapers, count)
    longest = max(one.centroid for one in each)
    profiles = [Profile.from_ruckig(trajectory, axis).shaped(one) for axis, one in enumerate(each)]
    if delays == "own":
        return tuple(profiles)
    return tuple(profile.delayed(max(0.0, longest - one.centroid)) for profile, one in zip(profiles, each, strict=True))
