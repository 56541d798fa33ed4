"""A shaped command that is known in advance, begun ahead of time so that it is not late.

At constant speed a shaper delays by its centroid. Who knows the command can begin by that much earlier: then a ramp is
followed without error, and a constant acceleration a is run ahead of by a/2 times the shaper's second central moment.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import not_negative, positive
from preshape.errors import InputError
from preshape.profile import Profile
from preshape.shaper import Shaper
from preshape.shaper_command import samples_shaped, taps_of

__all__ = ["Advanced", "acceleration_error", "advanced", "late_samples", "samples_ahead"]

WHOLE = 1e-9
"""A time this near a sample, in samples, is on it."""


@dataclass(frozen=True, eq=False, slots=True)
class Advanced:
    """A shaped command that begins ahead of the command.

    Parameters
    ----------
    shaped : Profile, or ndarray of shape (..., time)
        Of the command's kind and unit.
    start : float
        Time of its first step or sample, in the command's time [s]: below 0 where it begins before the command.
    advance : float
        By how much it is ahead of what the shaper alone gives [s].
    speed_error : float
        Time by which it is late at constant speed [s]: 0 unless another advance than the centroid was asked for.
    acceleration_error : float
        Half the shaper's second central moment [s^2]: times a constant acceleration it is how far the command is run
        ahead of, in the command's unit.
    """

    shaped: Profile | NDArray[np.float64]
    start: float
    advance: float
    speed_error: float
    acceleration_error: float


def acceleration_error(shaper: Shaper) -> float:
    """Half the second central moment of a shaper [s^2]: times an acceleration, the error of a parabola.

    Examples
    --------
    >>> acceleration_error(Shaper([0.0, 0.5], [0.5, 0.5])) == 0.5 * 0.25**2
    True
    """
    centre = shaper.centroid
    impulses = float(shaper.amplitudes @ (shaper.times - centre) ** 2)
    boxes = [(b.density, b.start - centre, b.end - centre) for b in shaper.boxes]
    return 0.5 * (impulses + sum(density * (end**3 - start**3) / 3.0 for density, start, end in boxes))


@overload
def advanced(command: Profile, shaper: Shaper, *, by: float | None = ...) -> Advanced: ...


@overload
def advanced(
    command: ArrayLike, shaper: Shaper, dt: float, *, by: float | None = ..., initial: ArrayLike = ...
) -> Advanced: ...


def advanced(
    command: Profile | ArrayLike,
    shaper: Shaper,
    dt: float | None = None,
    *,
    by: float | None = None,
    initial: ArrayLike = 0.0,
) -> Advanced:
    """Shape a command that is known in advance, and begin it by the shaper's centroid earlier.

    Parameters
    ----------
    command : Profile, or array_like of shape (..., time)
        Any unit; the first sample is at time 0, the last one is held afterwards.
    shaper : Shaper
        Any shaper.
    dt : float, optional
        Sample time [s], for samples.
    by : float, optional
        Another advance [s], 0 or more; the centroid unless given.
    initial : array_like
        For samples: what was commanded before the first one [unit].

    Returns
    -------
    Advanced
        A Profile is exact. Samples count as joined by straight lines, the shaped ones lie on the command's grid, and
        the part of the advance that is no whole number of samples is in the shaper's weights: each impulse is split
        linearly once, at its advanced place, so a ramp is followed exactly too.

    Raises
    ------
    InputError
        As :meth:`preshape.Shaper.shape`, and if the advance is negative or not finite.

    Examples
    --------
    >>> ramp = Profile.steps([0.0], [2.0], order=1)
    >>> found = advanced(ramp, Shaper([0.0, 0.5], [0.25, 0.75]))
    >>> found.start, bool(abs(found.shaped(3.0) - ramp(3.0)) < 1e-15)
    (-0.375, True)
    """
    ahead = shaper.centroid if by is None else not_negative("the advance", by, "s")
    late, bend = shaper.centroid - ahead, acceleration_error(shaper)
    if isinstance(command, Profile):
        exact = shaper.shape(command)
        moved = Profile(exact.times - ahead, exact.jumps, exact.orders)
        return Advanced(moved, moved.start_time, ahead, late, bend)
    if dt is None:
        raise InputError("samples need their dt: advanced(samples, shaper, dt).")
    dt = positive("dt", dt, "s")
    early = samples_ahead(ahead, dt)
    shaped = late_samples(command, shaper, dt, early * dt - ahead, initial)
    return Advanced(shaped, -early * dt, ahead, late, bend)


def samples_ahead(time: float, dt: float) -> int:
    """The whole number of samples that covers a time [s] to begin ahead by."""
    return max(0, math.ceil(time / dt - WHOLE))


def late_samples(command: ArrayLike, shaper: Shaper, dt: float, late: float, initial: ArrayLike) -> NDArray[np.float64]:
    """Samples, shape (..., time), shaped and made `late` [s], at least 0, in one go: each impulse is split once."""
    late = max(late, 0.0)
    boxes = [box._replace(start=box.start + late, end=box.end + late) for box in shaper.boxes]
    return samples_shaped(command, taps_of(shaper.times + late, shaper.amplitudes, boxes, dt), -1, initial)
