"""Posicast (Smith 1957): a step in two parts, the second when the first has overshot to the target."""

from __future__ import annotations

import math

import numpy as np

from preshape.checks import nonzero, not_negative, positive
from preshape.command.checks import sample_count
from preshape.command.command import Command
from preshape.mode import ModesLike, one_mode
from preshape.profile import Profile

__all__ = ["posicast"]


def posicast(
    height: float, mode: ModesLike, *, dt: float, rest: float = 0.0, quantity: str = "position [m]"
) -> Command:
    """A step of 1 / (1 + K) of the height at once, the rest half a damped period later: a ZV-shaped step.

    Parameters
    ----------
    height : float
        The level after the step [m]; 0 is refused.
    mode : Mode or (frequency [Hz], damping)
        What it leaves at rest; K is its decay over half a damped period.
    dt : float
        Sample interval [s]; the second part comes at the sample nearest to half a period.
    rest : float
        How long at least the level is kept in the samples [s].
    quantity : str
        What is commanded, with its unit.

    References
    ----------
    O. J. M. Smith, as quoted by Singer & Seering, section 2.4.

    Examples
    --------
    >>> posicast(1.0, (1.0, 0.0), dt=0.25).values.tolist()
    [0.0, 0.5, 0.5, 1.0]
    """
    size, dt = nonzero("height", height, "m"), positive("dt", dt, "s")
    target = one_mode(mode)
    half = target.damped_period / 2.0
    second = 1 + max(1, math.floor(half / dt + 0.5))
    count = second + 1 + sample_count(not_negative("rest", rest, "s"), dt)
    values = np.zeros(count)
    values[1:] = size / (1.0 + target.decay_per_half_period)
    values[second:] = size
    profile = Profile.steps([dt, dt + half], [values[1], size - values[1]])
    return Command(dt=dt, values=values, quantity=quantity, duration=dt + half, profile=profile)
