"""A shaped command that is known in advance, rescaled so that its largest value is the actuator's limit."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.profile import Profile
from preshape.shaper import Shaper

__all__ = ["Rescaled", "rescaled"]


@dataclass(frozen=True, eq=False, slots=True)
class Rescaled:
    """A shaped command at the limit.

    Parameters
    ----------
    shaped : Profile, or ndarray of shape (..., time)
        Shaped and rescaled, of the command's kind and unit.
    factor : float
        What command and shaped command are multiplied by [-]; the distance or speed gained grows with it.
    limit : float
        The largest magnitude of `shaped` [unit].
    unshaped_peak, shaped_peak : float
        Largest magnitudes of the command, and of the command shaped but not rescaled [unit].
    """

    shaped: Profile | NDArray[np.float64]
    factor: float
    limit: float
    unshaped_peak: float
    shaped_peak: float

    @property
    def gain(self) -> float:
        """How much more the command does than it would if it were scaled to the limit before shaping [-].

        At least 1 for a positive shaper; below 1 where negative impulses take the command beyond its own peak.
        """
        return self.unshaped_peak / self.shaped_peak


@overload
def rescaled(command: Profile, shaper: Shaper, limit: float) -> Rescaled: ...


@overload
def rescaled(command: ArrayLike, shaper: Shaper, limit: float, dt: float, *, initial: ArrayLike = ...) -> Rescaled: ...


def rescaled(
    command: Profile | ArrayLike, shaper: Shaper, limit: float, dt: float | None = None, *, initial: ArrayLike = 0.0
) -> Rescaled:
    """Shape a command that is known as a whole, and scale the result so that it reaches the actuator's limit.

    A positive shaper averages: a command at the limit comes out below it, and what the actuator could do more is lost.
    For a force, torque or acceleration, whose size is free. A move of a given distance is made faster instead:
    :func:`fastest_within`.

    Parameters
    ----------
    command : Profile, or array_like of shape (..., time)
        What the actuator is asked for, any unit.
    shaper : Shaper
        Any shaper.
    limit : float
        Largest magnitude that the actuator can give [unit], above 0.
    dt : float, optional
        Sample time [s], for samples.
    initial : array_like
        For samples: what was commanded before the first one [unit].

    Returns
    -------
    Rescaled
        Of a Profile the peak is that of the polynomials, not of samples.

    Raises
    ------
    InputError
        If the shaped command is zero throughout, grows for ever, or as :meth:`preshape.Shaper.shape`.

    References
    ----------
    Singer & Seering, section 2.4: "the convolved motor input can be rescaled so that the maximum value of the function
    is the actuator limit of the system".

    Examples
    --------
    >>> pulses = Profile.steps([0.0, 0.3, 0.6], [5.0, -10.0, 5.0])
    >>> found = rescaled(pulses, Shaper([0.0, 0.4], [0.5, 0.5]), limit=5.0)
    >>> round(found.factor, 12), found.shaped.peak().value
    (2.0, 5.0)
    """
    limit = positive("limit", limit, "of the command's unit")
    if isinstance(command, Profile):
        exact = shaper.shape(command)
        unshaped_peak, shaped_peak = command.peak().value, exact.peak().value
        factor = _factor(limit, shaped_peak)
        return Rescaled(exact.scaled(factor), factor, limit, unshaped_peak, shaped_peak)
    if dt is None:
        raise InputError("samples need their dt: rescaled(samples, shaper, limit, dt).")
    shaped = shaper.shape(command, dt, initial=initial)
    unshaped_peak, shaped_peak = float(np.abs(np.asarray(command, dtype=float)).max()), float(np.abs(shaped).max())
    factor = _factor(limit, shaped_peak)
    return Rescaled(factor * shaped, factor, limit, unshaped_peak, shaped_peak)


def _factor(limit: float, peak: float) -> float:
    if peak == 0.0:
        raise InputError("the command rests at 0, so no factor takes it to the limit: give one that moves.")
    if math.isinf(peak):
        raise InputError("the command grows for ever, so nothing keeps it below a limit: end it at rest.")
    return limit / peak
