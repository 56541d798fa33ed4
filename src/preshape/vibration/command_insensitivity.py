"""How far a mode may be from where a rest-to-rest command expects it, relative to one impulse or to bang-bang."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import NDArray

from preshape.checks import tolerance_of
from preshape.mode import ModesLike, one_mode
from preshape.vibration.band_edge import SAMPLES_PER_RIPPLE, TOUCHING
from preshape.vibration.insensitivity import HIGHEST_RATIO
from preshape.vibration.rest_to_rest import (
    LEAVES_NOTHING,
    Reference,
    amplitude_left,
    bang_bang_of_the_same_move,
    checked_reference,
    maximum_force_of,
)

if TYPE_CHECKING:
    from preshape.profile import Profile

__all__ = ["CommandInsensitivity", "command_insensitivity"]

NEAR_EDGE = 0.02
"""A hump of V whose sample is within this part of the tolerance is followed to its top; between samples it rises less
(pi^2 / 2 over SAMPLES_PER_RIPPLE squared: half a percent)."""

FIRST_FREQUENCY = 1e-6
"""Where a band is followed down to, relative to the mode's frequency; one still open there begins at 0 Hz."""


@dataclass(frozen=True)
class CommandInsensitivity:
    """The contiguous band of natural frequencies around a mode in which a command's vibration is tolerated.

    Parameters
    ----------
    low, high : float
        Edges of the band [Hz]; both the mode's frequency when more is left there, NaN when undefined.
    value : float
        (high - low) / mode frequency [-]; infinite if the band has no upper end, NaN when undefined.
    status : {"measured", "undefined"}
        "undefined": relative to bang-bang, which leaves nothing at the mode.
    """

    low: float
    high: float
    value: float
    status: Literal["measured", "undefined"]


def command_insensitivity(
    command: Profile,
    mode: ModesLike,
    tolerance: float = 0.05,
    *,
    relative_to: Reference = "impulse",
    maximum_force: float | None = None,
) -> CommandInsensitivity:
    """The band of natural frequency around `mode` in which a command leaves at most `tolerance`, at its damping ratio.

    Parameters
    ----------
    command : Profile
        The force, as made for the mode.
    mode : Mode or (frequency, damping)
        The centre; frequency [Hz].
    tolerance : float
        Vibration allowed [-], between 0 and 1, relative to the reference at the same actual frequency.
    relative_to, maximum_force
        As for :func:`command_vibration`.

    Returns
    -------
    CommandInsensitivity
        With status "undefined" where bang-bang leaves nothing at the mode.

    Raises
    ------
    InputError
        As for :func:`command_vibration`.

    References
    ----------
    Robertson, section II.A.

    Examples
    --------
    >>> from preshape.profile import Profile
    >>> bang_bang = Profile.steps([0.0, 1.0, 2.0], [0.5, -1.0, 0.5])
    >>> round(command_insensitivity(bang_bang, (1.0, 0.0)).value, 4)
    0.0713
    >>> command_insensitivity(bang_bang, (1.0, 0.0), relative_to="bang-bang").status
    'undefined'
    """
    centre = one_mode(mode)
    tolerance_of(tolerance)
    force = maximum_force_of(command, maximum_force)
    reference = None
    if checked_reference(relative_to) == "bang-bang":
        reference = bang_bang_of_the_same_move(command, force)
    f, z = centre.frequency, centre.damping

    def excess(frequencies: NDArray[np.float64]) -> NDArray[np.float64]:
        """What is left above the tolerance, relative to the tolerance of one impulse."""
        allowed = np.ones_like(frequencies)
        if reference is not None:
            allowed = amplitude_left(reference, frequencies, np.asarray(z)) / force
        return amplitude_left(command, frequencies, np.asarray(z)) / (tolerance * force) - allowed * (1.0 + TOUCHING)

    if reference is not None and amplitude_left(reference, np.array([f]), np.asarray(z))[0] <= LEAVES_NOTHING * force:
        return CommandInsensitivity(math.nan, math.nan, math.nan, "undefined")
    if excess(np.array([f]))[0] > 0.0:
        return CommandInsensitivity(f, f, 0.0, "measured")
    longest = max(float(c.times[-1] - c.times[0]) for c in (command, reference) if c is not None)
    step = min(1.0 / (longest * SAMPLES_PER_RIPPLE), f / SAMPLES_PER_RIPPLE) if longest > 0.0 else f
    low = _first_above(excess, f, FIRST_FREQUENCY * f, step)
    high = _first_above(excess, f, HIGHEST_RATIO * f, step)
    low, high = 0.0 if low is None else low, math.inf if high is None else high
    return CommandInsensitivity(low, high, (high - low) / f, "measured")


def _first_above(
    excess: Callable[[NDArray[np.float64]], NDArray[np.float64]], start: float, stop: float, step: float
) -> float | None:
    """Where `excess`, at most 0 at `start`, first rises above 0 on the way to `stop`; None when it does not."""
    from scipy.optimize import brentq, minimize_scalar

    def one(f: float) -> float:
        return float(excess(np.array([f]))[0])

    grid = np.linspace(start, stop, int(np.ceil(abs(stop - start) / step)) + 2)
    values = excess(grid)
    top = (values[1:-1] >= values[:-2]) & (values[1:-1] >= values[2:]) & (values[1:-1] > -NEAR_EDGE)
    for k in np.flatnonzero(np.concatenate([[False], top, [False]]) | (values > 0.0)):
        if values[k] > 0.0:
            return float(brentq(one, grid[k - 1], grid[k], xtol=1e-15 * start, rtol=8.9e-16))
        beside = (float(grid[k - 1]), float(grid[k + 1]))
        ends = (min(beside), max(beside))
        hump = float(minimize_scalar(lambda f: -one(f), bounds=ends, method="bounded").x)
        if one(hump) > 0.0:
            return float(brentq(one, grid[k - 1], hump, xtol=1e-15 * start, rtol=8.9e-16))
    return None
