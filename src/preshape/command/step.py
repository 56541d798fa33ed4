"""Step: from 0 to a level, at once."""

from __future__ import annotations

import numpy as np

from preshape.checks import nonzero, not_negative, positive
from preshape.command.checks import sample_count, whole_samples
from preshape.command.command import Command
from preshape.profile import Profile

__all__ = ["step"]


def step(
    height: float = 1.0,
    *,
    dt: float,
    start: float | None = None,
    rest: float = 0.0,
    quantity: str = "position [m]",
) -> Command:
    """A step from 0 to `height`.

    Parameters
    ----------
    height : float
        The level after the step, in the unit that `quantity` names; not 0, negative steps down.
    dt : float
        Sample interval [s].
    start : float, optional
        When it steps [s], a whole number of samples and at least one, so that the first sample is at rest; `dt` unless
        given.
    rest : float
        How long at least the level is kept in the samples [s].
    quantity : str
        What is commanded, with its unit.

    Returns
    -------
    Command
        `values` of shape (sample,); `duration` is `start`.

    Raises
    ------
    InputError
        If a value is out of range or not finite, or `start` is between samples.

    Examples
    --------
    >>> step(2.0, dt=0.01, rest=0.02).values
    array([0., 2., 2., 2.])
    """
    height = nonzero("height", height, quantity)
    dt = positive("dt", dt, "s")
    first = 1 if start is None else whole_samples("start", start, dt)
    held = sample_count(not_negative("rest", rest, "s"), dt)
    values = np.zeros(first + 1 + held)
    values[first:] = height
    return Command(
        dt=dt, values=values, quantity=quantity, duration=first * dt, profile=Profile.steps([first * dt], [height])
    )
