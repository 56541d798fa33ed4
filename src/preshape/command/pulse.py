"""Pulse: from 0 to a level and back, both at once."""

from __future__ import annotations

import numpy as np

from preshape.checks import nonzero, not_negative, positive
from preshape.command.checks import sample_count, whole_samples
from preshape.command.command import Command
from preshape.profile import Profile

__all__ = ["pulse"]


def pulse(
    height: float = 1.0,
    *,
    width: float,
    dt: float,
    start: float | None = None,
    rest: float = 0.0,
    quantity: str = "position [m]",
) -> Command:
    """A rectangular pulse: `height` for `width`, then 0 again.

    Parameters
    ----------
    height : float
        The level of the pulse, in the unit that `quantity` names; not 0.
    width : float
        How long the level lasts [s], a whole number of samples and at least one. A width between samples would be
        another pulse after sampling, so it is refused rather than rounded.
    dt : float
        Sample interval [s].
    start : float, optional
        When it begins [s], a whole number of samples and at least one; `dt` unless given.
    rest : float
        How long at least the 0 after the pulse is kept in the samples [s].
    quantity : str
        What is commanded, with its unit.

    Returns
    -------
    Command
        `values` of shape (sample,); `duration` is `start` + `width`.

    Raises
    ------
    InputError
        If a value is out of range or not finite, or `start` or `width` is between samples.

    Examples
    --------
    >>> pulse(5.0, width=0.02, dt=0.01, rest=0.01, quantity="force [N]").values
    array([0., 5., 5., 0., 0.])
    """
    height = nonzero("height", height, quantity)
    dt = positive("dt", dt, "s")
    first = 1 if start is None else whole_samples("start", start, dt)
    wide = whole_samples("width", width, dt)
    held = sample_count(not_negative("rest", rest, "s"), dt)
    values = np.zeros(first + wide + 1 + held)
    values[first : first + wide] = height
    end = (first + wide) * dt
    profile = Profile.steps([first * dt, end], [height, -height])
    return Command(dt=dt, values=values, quantity=quantity, duration=end, profile=profile)
