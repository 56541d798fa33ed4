"""The steps of jerk, or of acceleration, in a trajectory that ruckig has calculated."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError

__all__ = ["ruckig_steps"]

ROUNDING = 1e-9
"""A step of the acceleration below this part of its largest value is ruckig's rounding."""


def ruckig_steps(trajectory: Any, axis: int) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.intp]]:
    """Times [s], jumps and orders of one axis of a trajectory: 3 where jerk steps, 2 where acceleration does.

    Parameters
    ----------
    trajectory : ruckig.Trajectory
        Calculated.
    axis : int
        Degree of freedom, from 0.

    Raises
    ------
    InputError
        If it is no such trajectory, has no such axis, or does not begin at rest.
    """
    try:
        sections = [section[axis] for section in trajectory.profiles]
        begins = [0.0, *trajectory.intermediate_durations]
        rows = np.concatenate([_stretches(section, begin) for section, begin in zip(sections, begins, strict=False)])
        moving = bool(sections[0].v[0]) or (bool(sections[0].a[0]) and bool(np.any(sections[0].j)))
        beyond = any(section.brake.duration or section.accel.duration for section in sections)
    except (AttributeError, IndexError, TypeError, ValueError) as error:
        raise InputError(
            f"no axis {axis!r} of a calculated ruckig trajectory here ({error}): give a ruckig.Trajectory after "
            "calculate(), and its axis, counted from 0."
        ) from None
    if moving or beyond:
        raise InputError(
            "the trajectory does not begin at rest within its limits: shaping must know what was commanded before, so "
            "plan the whole move from rest."
        )
    times, jerks, accelerations = rows.T
    carried = np.concatenate([[0.0], accelerations[:-1] + jerks[:-1] * np.diff(times)])
    kicks = accelerations - carried
    kicked = np.abs(kicks) > ROUNDING * np.abs(accelerations).max(initial=0.0)
    steps = np.diff(jerks, prepend=0.0)
    stepped = steps != 0.0
    return (
        np.concatenate([times[stepped], times[kicked]]),
        np.concatenate([steps[stepped], kicks[kicked]]),
        np.concatenate([np.full(int(stepped.sum()), 3), np.full(int(kicked.sum()), 2)]).astype(np.intp),
    )


def _stretches(section: Any, begin: float) -> NDArray[np.float64]:
    """Time [s], jerk and acceleration at the start of every stretch of constant jerk that lasts, and at the end."""
    durations = np.array(section.t, dtype=float)
    times = begin + np.concatenate([[0.0], np.cumsum(durations)])
    rows = np.column_stack([times, [*section.j, 0.0], section.a])
    return np.asarray(rows[np.append(durations > 0.0, True)])
