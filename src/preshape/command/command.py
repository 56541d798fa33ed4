"""Command: what every kind of command returns, samples on a uniform grid that begins at rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.profile import Profile

__all__ = ["Command"]


@dataclass(frozen=True, eq=False, slots=True)
class Command:
    """A sampled command, from rest to rest.

    The arrays are made read-only. Times run from 0 in steps of `dt`; the first sample is 0, so that a shaper or a
    plant that assumes rest before the first sample assumes rightly.

    Parameters
    ----------
    dt : float
        Sample interval [s], above zero.
    values : array_like of float, shape (sample,)
        The command at the samples, in the unit that `quantity` names; the first is 0.
    quantity : str
        What is commanded, with its unit, such as ``"position [m]"``.
    duration : float
        Time from 0 to the last change of the command [s], in closed form: not rounded to the grid.
    velocity, acceleration : array_like of float, shape (sample,), optional
        First and second derivative of `values` with respect to time [unit/s, unit/s^2], for moves. Where the
        acceleration jumps, the sample holds the value after the jump.
    profile : Profile, optional
        The command between the samples too, where it is a piecewise polynomial: shaped and simulated exactly.

    Raises
    ------
    InputError
        If `dt` is not above zero, or an array is not one finite number a sample, or the first value is not 0.

    Examples
    --------
    >>> from preshape.command import trapezoid
    >>> move = trapezoid(0.1, maximum_speed=0.2, maximum_acceleration=2.0, dt=0.001)
    >>> round(move.duration, 12), float(move.values[-1])
    (0.6, 0.1)
    """

    dt: float
    values: NDArray[np.float64]
    quantity: str
    duration: float
    velocity: NDArray[np.float64] | None = None
    acceleration: NDArray[np.float64] | None = None
    profile: Profile | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "dt", positive("dt", self.dt, "s"))
        for name in ("values", "velocity", "acceleration"):
            given = getattr(self, name)
            if given is None and name != "values":
                continue
            array = np.array(given, dtype=float)
            if array.ndim != 1 or array.size == 0:
                raise InputError(
                    f"{name} has shape {array.shape}: a command is one row of at least one sample; give a 1-D array."
                )
            if name != "values" and array.shape != self.values.shape:
                raise InputError(
                    f"{name} has {array.size} samples and values has {self.values.size}: give as many of each."
                )
            if not np.isfinite(array).all():
                raise InputError(
                    f"{name} holds NaN or infinity at sample {int(np.argmin(np.isfinite(array)))}: give finite numbers."
                )
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        if self.values[0] != 0.0:
            raise InputError(
                f"the first value is {self.values[0]:g}: a command starts from rest at 0; put a sample of 0 in front."
            )

    @property
    def times(self) -> NDArray[np.float64]:
        """Times of the samples [s], shape (sample,)."""
        return np.arange(self.values.size, dtype=float) * self.dt
