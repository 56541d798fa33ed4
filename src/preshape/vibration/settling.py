"""Settling: residual vibration and speed in one number.

A long shaper leaves little and is late; a short one is early and leaves more. What a user waits for is the time until
the vibration is small enough: the shaper's duration, plus what damping needs to take the residual below the tolerance.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import tolerance_of
from preshape.errors import InputError
from preshape.shaper import Shaper
from preshape.vibration.residual import checked_frequency_and_damping, residual_vibration

__all__ = ["Settling", "settling"]


@dataclass(frozen=True, eq=False)
class Settling:
    """How long a shaped and an unshaped command vibrate; arrays of one shape, one value for each actual mode.

    Parameters
    ----------
    residual : ndarray
        V right after the last impulse [-].
    time : ndarray
        From the first impulse until the amplitude stays at or below the tolerance [s]; infinite when it never does.
    unshaped_time : ndarray
        The same for one impulse [s].
    """

    residual: NDArray[np.float64]
    time: NDArray[np.float64]
    unshaped_time: NDArray[np.float64]

    @property
    def relative(self) -> NDArray[np.float64]:
        """Shaped over unshaped time [-]: below 1 the shaper pays; 0 where only the shaped command settles at all, NaN
        where neither does."""
        with np.errstate(invalid="ignore", divide="ignore"):
            return np.asarray(self.time / self.unshaped_time)


def settling(shaper: Shaper, frequency: ArrayLike, damping: ArrayLike = 0.0, *, tolerance: float = 0.05) -> Settling:
    """Settling time of a mode after a shaped command, for the mode as it may really be.

    An amplitude is at its tolerance when it is `tolerance` times what one unit impulse leaves at its own instant. So::

      time = t_N + max(0, ln(V / tolerance)) / (z w),    unshaped time = ln(1 / tolerance) / (z w),

    t_N the shaper's duration: before it the command itself still moves. It is the envelope that is meant; the time that
    a given output needs, by its own oscillation, is ``plant.motion(command).settling_time(output, within)``.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    frequency : array_like
        Actual undamped natural frequencies [Hz], above 0.
    damping : array_like
        Actual damping ratios [-] in [0, 1), broadcast against `frequency`.
    tolerance : float
        Amplitude at which the mode counts as settled [-], between 0 and 1.

    Returns
    -------
    Settling

    Raises
    ------
    InputError
        If a frequency, damping ratio or the tolerance is out of range.

    References
    ----------
    The idea, to judge residual vibration and settling time together: Kozak, Singhose & Ebert-Uphoff (2006), as quoted
    by Robertson, section I. The definition is ours.

    Examples
    --------
    A shaper made for 1 Hz, when the mode is where it should be and when it is 10 % away:

    >>> import preshape
    >>> found = settling(preshape.design.zv((1.0, 0.02)), [1.0, 1.1], 0.02)
    >>> found.time.round(3).tolist(), found.unshaped_time.round(3).tolist()
    ([0.5, 8.5], [23.839, 21.672])
    """
    tolerance_of(tolerance)
    f, z = np.broadcast_arrays(*checked_frequency_and_damping(frequency, damping))
    if (f == 0.0).any():
        raise InputError("a frequency is 0 Hz, where nothing vibrates: give natural frequencies above 0 Hz.")
    residual = np.asarray(residual_vibration(shaper, f, z))
    decay = 2.0 * np.pi * f * z
    with np.errstate(divide="ignore", invalid="ignore"):
        more = np.where(residual > tolerance, np.log(residual / tolerance) / decay, 0.0)
        unshaped = np.log(1.0 / tolerance) / decay
    return Settling(residual, shaper.duration + more, unshaped)
