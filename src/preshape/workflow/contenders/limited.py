"""The limits of a comparison, what a command uses of them, and how one that breaks a limit is slowed to keep it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.command import s_curve, trapezoid
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.plant import Output, exact_motion
from preshape.profile import Profile
from preshape.vibration import command_vibration

__all__ = ["Filtered", "Limited", "Move", "kept", "peaks_of", "stretched"]

KEPT = 1e-10
"""A limit exceeded by less than this part of it is kept: rounding and interpolation."""

JERK_KEPT = 1e-6
"""The same for the jerk, which of a smooth command is the slope of pieces that interpolate its acceleration."""

SLOWEST, NEAR = 64.0, 1e-5
"""How much a command may be slowed to keep the limits, and how near to the least that does it."""

NO_LIMIT = 10.0
"""Where there is no speed limit, bang-bang's speed times this: no move between rest and rest comes near."""

SAMPLES = 200
"""Samples of a move; only its exact profile is used."""

LOOKS = 4
"""Looks at speed and jerk in each piece of a command, of which a smooth one has hundreds."""


@dataclass(frozen=True)
class Filtered:
    """The origin of a filtered command.

    Parameters
    ----------
    base : Profile
        The acceleration before the filter [unit/s^2].
    transfer : callable
        The filter's transfer function, of complex frequencies [1/s].
    """

    base: Profile
    transfer: Callable[[NDArray[np.complex128]], NDArray[np.complex128]]


@dataclass(frozen=True)
class Move:
    """A command of the comparison, before it is measured.

    Parameters
    ----------
    acceleration : Profile
        Of the carriage [unit/s^2].
    move_time : float
        When it ends [s].
    exact : bool
        Whether the profile is the command, or interpolates it.
    note : str
        What must be known about it.
    filtered : Filtered, optional
        Where it comes from, for a command behind a filter.
    """

    acceleration: Profile
    move_time: float
    exact: bool = True
    note: str = ""
    filtered: Filtered | None = None

    def amplitude_left(self, frequencies: NDArray[np.float64], damping: float) -> NDArray[np.float64]:
        """Amplitude of the free deflection of modes at `move_time` [unit], by their frequencies [Hz] and damping [-].

        Behind a filter it is what the base leaves, times the size of the filter's transfer function at the mode's pole:
        in closed form, for the filter's own motion, which dies out with the profile, is no part of it.
        """
        omega, root = 2.0 * np.pi * frequencies, math.sqrt(1.0 - damping**2)
        source = self.acceleration if self.filtered is None else self.filtered.base
        # A unit step of acceleration leaves 1 / (w w_d), of which this is a multiple.
        left = command_vibration(source, frequencies, damping, maximum_force=1.0) / (omega**2 * root)
        if self.filtered is None:
            return left
        poles = np.asarray(omega * complex(-damping, root), dtype=np.complex128)
        passed = np.abs(self.filtered.transfer(poles))
        return np.asarray(left * passed * np.exp(-damping * omega * (self.move_time - source.end_time)))


@dataclass(frozen=True)
class Limited:
    """The move that is asked for.

    Parameters
    ----------
    distance : float
        Where it ends [unit].
    acceleration : float
        Limit [unit/s^2].
    speed, jerk : float or None
        Limits [unit/s, unit/s^3]; None is none.
    """

    distance: float
    acceleration: float
    speed: float | None = None
    jerk: float | None = None

    @property
    def top_speed(self) -> float:
        """The speed limit, or what none reaches [unit/s]."""
        free = NO_LIMIT * math.sqrt(abs(self.distance) * self.acceleration)
        return free if self.speed is None else self.speed

    @property
    def dt(self) -> float:
        """A sample interval that suits the move [s]."""
        return self.rigid_time / SAMPLES

    @property
    def rigid_time(self) -> float:
        """About how long a move takes [s]."""
        return abs(self.distance) / self.top_speed + 2.0 * math.sqrt(abs(self.distance) / self.acceleration)

    def step_leaves(self, mode: Mode) -> float:
        """Vibration that a step leaves of a mode without damping: of acceleration, speed or way, the least [unit].

        a / w^2, v / w and d: a move whose ramps are short against the period is no worse than a step of the next kind.
        """
        return min(self.acceleration / mode.omega**2, self.top_speed / mode.omega, abs(self.distance))

    def trapezoid(self, slower: float = 1.0) -> Profile:
        """The acceleration of the fastest move within speed and acceleration limit, slowed in time by a factor."""

        def move(duration: float | None) -> Profile:
            command = trapezoid(
                self.distance,
                maximum_speed=self.top_speed,
                maximum_acceleration=self.acceleration,
                duration=duration,
                dt=self.dt,
            )
            return acceleration_of(command.profile)

        fastest = move(None)
        return fastest if slower == 1.0 else move(slower * fastest.end_time)

    def s_curve(self, jerk: float, slower: float = 1.0) -> Profile:
        """The same within a jerk limit too."""

        def move(duration: float | None) -> Profile:
            command = s_curve(
                self.distance,
                maximum_speed=self.top_speed,
                maximum_acceleration=self.acceleration,
                maximum_jerk=jerk,
                duration=duration,
                dt=self.dt,
            )
            return acceleration_of(command.profile)

        fastest = move(None)
        return fastest if slower == 1.0 else move(slower * fastest.end_time)

    def base(self, slower: float = 1.0) -> Profile:
        """What shapers and filters are given: the fastest move within all the limits."""
        return self.trapezoid(slower) if self.jerk is None else self.s_curve(self.jerk, slower)


def acceleration_of(position: Profile | None) -> Profile:
    """The second derivative of a command that has an exact profile."""
    assert position is not None
    return position.derivative().derivative()


def peaks_of(acceleration: Profile, limited: Limited) -> tuple[float, float, float]:
    """Largest speed, acceleration and jerk of a move; a speed or jerk that has no limit is left at 0.

    The acceleration is exact. So is the speed, at steps and where the acceleration, as straight as it is there, is 0;
    jerk is constant but for pieces of a smooth command, and looked at in each.
    """
    times = _looks(acceleration)
    speed = jerk = 0.0
    if limited.speed is not None:
        slope = acceleration(times, derivative=1)
        turns = times - acceleration(times) / np.where(slope == 0.0, np.inf, slope)
        beside = np.clip(turns, np.append(times[:1], times[:-1]), np.append(times[1:], times[-1:]))
        speed = float(np.abs(acceleration.integral()(np.concatenate([times, beside]))).max())
    if limited.jerk is not None:
        jerk = float(np.abs(acceleration(times[:-1], derivative=1)).max())
    largest = exact_motion(None, acceleration, outputs={"command": Output(command=1.0)}).peak("command").value
    return speed, largest, jerk


def _looks(command: Profile) -> NDArray[np.float64]:
    """Times in every piece of a command, its ends included [s]."""
    starts, _ = command.segments()
    parts = np.linspace(0.0, 1.0, LOOKS, endpoint=False)
    return np.append((starts[:-1, None] + np.diff(starts)[:, None] * parts).ravel(), starts[-1])


def kept(acceleration: Profile, limited: Limited) -> bool:
    """Whether a move keeps all limits."""
    return not _broken(acceleration, limited)


def _broken(acceleration: Profile, limited: Limited) -> list[str]:
    """The limits that a move breaks, in words with the values."""
    speed, peak, jerk = peaks_of(acceleration, limited)
    held = (
        ("speed", speed, limited.speed, KEPT),
        ("acceleration", peak, limited.acceleration, KEPT),
        ("jerk", jerk, limited.jerk, JERK_KEPT),
    )
    return [
        f"{name} {found:.3g} where {limit:g} is allowed"
        for name, found, limit, slack in held
        if limit is not None and not found <= limit * (1.0 + slack)
    ]


def stretched(build: Callable[[float], Profile], limited: Limited) -> tuple[Profile, float]:
    """A move that keeps the limits, slowed no more than it takes.

    Parameters
    ----------
    build : callable
        The acceleration when slowed in time by a factor from 1.
    limited : Limited
        The limits.

    Returns
    -------
    acceleration : Profile
    slower : float
        The factor, 1 when nothing had to be slowed.

    Raises
    ------
    InputError
        If a limit is still broken when the move is slowed by `SLOWEST`.
    """
    found = build(1.0)
    if kept(found, limited):
        return found, 1.0
    low, high = 1.0, 1.0 + 1e-3
    while broken := _broken(found := build(high), limited):
        if high >= SLOWEST:
            raise InputError(
                f"it cannot be slowed enough to keep the limits: {high:.0f} times slower it still reaches "
                f"{' and '.join(broken)}; allow more, or take what amplifies the move less."
            )
        low, high = high, min(SLOWEST, 1.0 + 2.0 * (high - 1.0))
    while high - low > NEAR:
        middle = 0.5 * (low + high)
        trial = build(middle)
        if kept(trial, limited):
            high, found = middle, trial
        else:
            low = middle
    return found, high
