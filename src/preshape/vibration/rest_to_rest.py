"""What a rest-to-rest command leaves, relative to one impulse or to the bang-bang command of the same move.

A shaper is measured against one impulse. A command that must also cover a distance may be measured against the fastest
one that does, bang-bang; but for some distances bang-bang leaves nothing, and then the relative measure has no value.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.kernel import driven_phasors
from preshape.vibration.residual import checked_frequency_and_damping

if TYPE_CHECKING:
    from preshape.profile import Profile

__all__ = [
    "LEAVES_NOTHING",
    "Reference",
    "amplitude_left",
    "bang_bang_of_the_same_move",
    "checked_reference",
    "command_vibration",
    "maximum_force_of",
]

LEAVES_NOTHING = 1e-9
"""Bang-bang that leaves less than this of what one impulse leaves counts as leaving nothing."""

MOVING = 1e-9
"""A command leaves its mass moving when the final speed, times the duration, is more than this part of the distance."""

Reference = Literal["impulse", "bang-bang"]


def command_vibration(
    command: Profile,
    frequency: ArrayLike,
    damping: ArrayLike = 0.0,
    *,
    relative_to: Reference = "impulse",
    maximum_force: float | None = None,
) -> NDArray[np.float64]:
    """The vibration that a command leaves at its end, for modes it drives.

    Parameters
    ----------
    command : Profile
        The force (or acceleration of the base); for a move at rest to rest its double integral ends at the distance.
    frequency : array_like
        Undamped natural frequencies [Hz], above 0.
    damping : array_like
        Damping ratios [-] in [0, 1), broadcast against `frequency`.
    relative_to : {"impulse", "bang-bang"}
        ``"impulse"``: amplitude relative to what one step by `maximum_force` leaves at its own instant, so that the
        steps of an on-off command count as the impulses of a shaper do in V (Robertson, eq. 1). ``"bang-bang"``:
        relative to what bang-bang over the same distance leaves at its end; NaN where that is nothing.
    maximum_force : float, optional
        What the actuator can do [unit of the command]; the command's highest level unless given, for steps of level.

    Returns
    -------
    ndarray
        Of the broadcast shape [-].

    Raises
    ------
    InputError
        If a frequency or damping ratio is out of range, the command does not end at rest at 0, or `maximum_force` is
        needed.

    References
    ----------
    Robertson, eq. 1 and figures 8 and 9.

    Examples
    --------
    >>> from preshape.profile import Profile
    >>> command = Profile.steps([0.0, 1.0, 2.0], [3.0, -6.0, 3.0])
    >>> command_vibration(command, [0.25, 0.5, 1.0]).round(12).tolist()
    [2.0, 4.0, 0.0]
    """
    f, z = np.broadcast_arrays(*checked_frequency_and_damping(frequency, damping))
    force = maximum_force_of(command, maximum_force)
    value = amplitude_left(command, f, z) / force
    if checked_reference(relative_to) == "impulse":
        return value
    reference = amplitude_left(bang_bang_of_the_same_move(command, force), f, z) / force
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray(np.where(reference > LEAVES_NOTHING, value / reference, np.nan))


def bang_bang_of_the_same_move(command: Profile, maximum_force: float | None = None) -> Profile:
    """Bang-bang that moves a free mass as far as a rest-to-rest force does.

    Parameters
    ----------
    command : Profile
        The force, from rest to rest.
    maximum_force : float, optional
        As for :func:`command_vibration`.

    Raises
    ------
    InputError
        If the command moves nothing, or leaves the mass moving.

    References
    ----------
    Robertson, eq. 5: switched at sqrt(distance / acceleration).

    Examples
    --------
    >>> from preshape.profile import Profile
    >>> coasting = Profile.steps([0.0, 1.0, 3.0, 4.0], [1.0, -1.0, -1.0, 1.0])
    >>> (bang_bang_of_the_same_move(coasting).times**2).round(12).tolist()
    [0.0, 3.0, 12.0]
    """
    from preshape.profile import Profile

    force = maximum_force_of(command, maximum_force)
    starts, taylor = _pieces(command)
    duration = float(starts[-1] - starts[0])
    impulse, reach = _moments(starts, taylor)
    if abs(impulse) * duration > MOVING * force * duration**2:
        raise InputError(
            "the command leaves the mass moving, so it is not a rest-to-rest move: its integral over time must be 0."
        )
    if abs(reach) <= MOVING * force * duration**2:
        raise InputError("the command ends where it began: there is no bang-bang command of the same move.")
    switch = math.sqrt(abs(reach) / force)
    return Profile.steps([0.0, switch, 2.0 * switch], math.copysign(force, reach) * np.array([1.0, -2.0, 1.0]))


def amplitude_left(command: Profile, f: NDArray[np.float64], z: NDArray[np.float64]) -> NDArray[np.float64]:
    """Amplitude after the command over that after a unit step of level, \\|s q + F\\|: no division by a small pole.

    Parameters
    ----------
    command : Profile
        Any that ends at rest.
    f, z : ndarray
        Natural frequencies [Hz] and damping ratios [-], checked, broadcast against each other.
    """
    shape = np.broadcast_shapes(f.shape, z.shape)
    poles = np.ravel(np.broadcast_to(2.0 * np.pi * f * (-z + 1j * np.sqrt(1.0 - z**2)), shape))
    starts, taylor = _pieces(command)
    end = driven_phasors(poles, starts, taylor).at_start[:, -1]
    return np.asarray(np.abs(poles * end + taylor[-1, 0])).reshape(shape)


def _pieces(command: Profile) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Starts and derivatives of the command's segments, if it ends at a constant level."""
    starts, taylor = command.segments()
    if starts.size == 0:
        raise InputError("the command has no steps, so it excites nothing: give one that moves.")
    if taylor[-1, 1:].any():
        raise InputError("the command still changes after its last step: there is no vibration left at an end.")
    return starts, taylor


def _moments(starts: NDArray[np.float64], taylor: NDArray[np.float64]) -> tuple[float, float]:
    """Integral and double integral of the command at its end."""
    impulse = reach = 0.0
    for gap, row in zip(np.diff(starts), taylor[:-1], strict=True):
        powers = [gap ** (n + 1) / math.factorial(n + 1) for n in range(row.size + 1)]
        reach += impulse * gap + sum(float(c) * p for c, p in zip(row, powers[1:], strict=True))
        impulse += sum(float(c) * p for c, p in zip(row, powers[:-1], strict=True))
    return impulse, reach


def maximum_force_of(command: Profile, given: float | None) -> float:
    """The force `given` [unit of the command], or the highest level of the staircase `command`."""
    if given is not None:
        return positive("maximum_force", given, "units of the command")
    _, taylor = _pieces(command)
    if taylor[:, 1:].any():
        raise InputError("the command is no staircase: give maximum_force, what the actuator can do at most.")
    highest = float(np.abs(taylor[:, 0]).max())
    if highest == 0.0:
        raise InputError("the command is 0 throughout, so it excites nothing: give one that moves.")
    return highest


def checked_reference(relative_to: str) -> str:
    """`relative_to`, if it is a reference."""
    if relative_to not in ("impulse", "bang-bang"):
        raise InputError(f"relative_to is {relative_to!r}: give 'impulse' or 'bang-bang'.")
    return relative_to
