"""The fastest time scale of a known move at which the shaped move keeps limits of speed, acceleration and jerk.

The shaper stays as it is, for the machine's modes do not follow the command; only the command is slowed or hastened. A
positive shaper averages, so the move may go faster than the limits allow it unshaped; negative impulses can ask for
slower. What the shaped peaks do when the command is hastened is not monotone: they fall at once where a copy of a pulse
no longer overlaps the next one. So the fast side is searched, from where no move can keep the limits.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import NDArray

from preshape.command.shape import Limits
from preshape.errors import InputError
from preshape.profile import Profile
from preshape.shaper import Shaper

__all__ = ["FastestWithin", "fastest_within"]

ORDERS: Mapping[str, int] = MappingProxyType({"speed": 1, "acceleration": 2, "jerk": 3})

STRIDE = 1.002
"""Ratio of two time scales that are looked at. A range of scales narrower than this, faster than the one found, with
peaks within the limits and beyond them on both sides, may be missed."""

NEAR = 1e-15
"""Relative precision of the time scale."""

STEP_LIKE = 1e-3
"""A command shorter than this part of the shaper is a step for it: no limit binds if none does there."""

SLOWEST = 1e12
"""Time scale, relative to that of the unshaped command, at which even the slowest search ends."""


@dataclass(frozen=True, eq=False, slots=True)
class FastestWithin:
    """The fastest time scale of a move whose shaped version keeps the limits.

    Parameters
    ----------
    command : Profile
        The unshaped move at this time scale [unit]; it may exceed the limits.
    shaped : Profile
        What the machine is given [unit].
    shaper : Shaper
        What shapes.
    time_scale : float
        Duration of `command` over that of the command that was given [-].
    peaks : mapping of str to float
        Largest magnitudes of the shaped move's ``speed``, ``acceleration`` and ``jerk``, those that are limited
        [unit/s, unit/s^2, unit/s^3]; exact, of the polynomials.
    limits : mapping of str to float
        The limits, in the same units.
    binding : str
        Which of them would be exceeded by any faster move just beside this one.
    saturating_duration : float
        Duration of the shaped move when the *unshaped* one is scaled to the limits [s]; infinite when it cannot keep
        them at any time scale.
    """

    command: Profile
    shaped: Profile
    shaper: Shaper
    time_scale: float
    peaks: Mapping[str, float]
    limits: Mapping[str, float]
    binding: str
    saturating_duration: float

    @property
    def duration(self) -> float:
        """Of the shaped move [s]."""
        return self.shaped.duration

    @property
    def saved(self) -> float:
        """Time saved against shaping the command that keeps the limits unshaped [s]; below 0 for what negative
        impulses cost, since that one then exceeds the limits when it is shaped."""
        return self.saturating_duration - self.duration

    @property
    def used(self) -> float:
        """How much of the binding limit is used [-]: 1, but where the peaks jump with the time scale."""
        return self.peaks[self.binding] / self.limits[self.binding]


def fastest_within(
    command: Profile,
    shaper: Shaper,
    *,
    maximum_speed: float | None = None,
    maximum_acceleration: float | None = None,
    maximum_jerk: float | None = None,
) -> FastestWithin:
    """Make a move that is known in advance as fast as the limits allow once it is shaped.

    Parameters
    ----------
    command : Profile
        A position that ends at rest [unit]; its form and distance stay, its duration is found.
    shaper : Shaper
        Any shaper; it is not scaled.
    maximum_speed, maximum_acceleration, maximum_jerk : float, optional
        Limits of the shaped move [unit/s, unit/s^2, unit/s^3], at least one.

    Returns
    -------
    FastestWithin

    Raises
    ------
    InputError
        If no limit is given or one is not above 0, the command rests or does not end at rest, a limit cannot be kept at
        any speed (the shaped command jumps there), or none binds however fast the command is.

    Notes
    -----
    After Singer & Seering, section 2.4, who rescale the size of a shaped input to the actuator's limit; of a move of
    given distance it is the time that is free. Shaped peaks may jump with the time scale, so scales 0.2 % apart are
    looked at from the fast side, and the first that keeps the limits is refined by bisection; a narrower range of
    faster ones may be missed.

    Examples
    --------
    >>> import preshape
    >>> from preshape.command import trapezoid
    >>> move = trapezoid(0.03, maximum_speed=0.5, maximum_acceleration=5.0, dt=0.001).profile
    >>> found = fastest_within(move, preshape.design.zvd((4.0, 0.02)), maximum_speed=0.5, maximum_acceleration=5.0)
    >>> found.binding, round(found.used, 9), found.saved > 0.0
    ('acceleration', 1.0, True)
    """
    given = Limits(maximum_speed, maximum_acceleration, maximum_jerk)
    limits = {name: limit for name in ORDERS if (limit := getattr(given, name)) is not None}
    if not limits:
        raise InputError("no limit was given: give maximum_speed, maximum_acceleration or maximum_jerk.")
    _check(command, shaper, limits)
    slow = _slow_enough(command, shaper, limits)
    fast = _too_fast(command, shaper, limits)
    previous, found = None, slow
    for scale in _between(fast, slow):
        if _keeps(command, shaper, limits, scale):
            found = scale
            break
        previous = scale
    if previous is None:
        raise InputError(
            "even a command as short as a step keeps the limits behind this shaper, so none of them binds: command the "
            "step, or give lower limits."
        )
    while found - previous > NEAR * found and previous < (middle := 0.5 * (previous + found)) < found:
        previous, found = (previous, middle) if _keeps(command, shaper, limits, middle) else (middle, found)
    beyond = _peaks(_scaled(command, previous).shaped(shaper), limits)
    binding = max(limits, key=lambda name: beyond[name] / limits[name])
    own = _peaks(command, limits)
    saturating = max((own[name] / limits[name]) ** (1.0 / ORDERS[name]) for name in limits)
    scaled = _scaled(command, found)
    shaped = scaled.shaped(shaper)
    return FastestWithin(
        scaled,
        shaped,
        shaper,
        found,
        MappingProxyType(_peaks(shaped, limits)),
        MappingProxyType(limits),
        binding,
        saturating * command.duration + shaped.duration - scaled.duration,
    )


def _check(command: Profile, shaper: Shaper, limits: Mapping[str, float]) -> None:
    if not isinstance(command, Profile):
        raise InputError("the command must be a Profile of the position: commands of preshape.command have one.")
    if not command.ends_at_rest:
        raise InputError("the command still moves after its last step, so it has no duration: end it at rest.")
    if command.duration == 0.0:
        raise InputError("the command rests or is a step, which no time scale changes: give a move that takes time.")
    for name, peak in _peaks(command.shaped(shaper), limits).items():
        if math.isinf(peak):
            raise InputError(
                f"the shaped command has an infinite {name} at any time scale, so no limit of it can be kept: give a "
                "smoother command, or leave the limit out."
            )


def _scaled(command: Profile, scale: float) -> Profile:
    """The same command `scale` times as long, begun at the same time."""
    start = command.start_time
    return Profile(start + scale * (command.times - start), command.jumps / scale**command.orders, command.orders)


def _peaks(shaped: Profile, limits: Mapping[str, float]) -> dict[str, float]:
    return {name: shaped.peak(ORDERS[name]).value for name in limits}


def _keeps(command: Profile, shaper: Shaper, limits: Mapping[str, float], scale: float) -> bool:
    shaped = _scaled(command, scale).shaped(shaper)
    return all(shaped.peak(ORDERS[name]).value <= limit for name, limit in limits.items())


def _slow_enough(command: Profile, shaper: Shaper, limits: Mapping[str, float]) -> float:
    """A time scale that keeps the limits: where the peaks, times what the shaper amplifies at most, do."""
    own = _peaks(command, limits)
    scales = [(shaper.magnitude * own[name] / limit) ** (1.0 / ORDERS[name]) for name, limit in limits.items()]
    scale = max((one for one in scales if math.isfinite(one)), default=1.0) or 1.0
    most = SLOWEST * scale
    while not _keeps(command, shaper, limits, scale):
        scale *= STRIDE if max(scales) < math.inf else 2.0
        if scale > most:
            raise InputError("the limits are kept at no time scale: raise them.")
    return scale


def _too_fast(command: Profile, shaper: Shaper, limits: Mapping[str, float]) -> float:
    """A time scale below which none keeps the limits.

    Until the second impulse sets in, the shaped command is the first impulse's copy; after the last but one has ended,
    the last one's. What a copy reaches there it reaches at every faster scale too.
    """
    starts, _ = command.segments()
    looks = np.union1d(starts, 0.5 * (starts[1:] + starts[:-1]))[:-1]
    since, left = looks - command.start_time, command.end_time - looks
    alone = [(abs(float(shaper.amplitudes[0])), since, _gap(shaper.times, [box.start for box in shaper.boxes]))]
    backwards = shaper.duration - shaper.times[::-1]
    if backwards[0] == 0.0:
        after = [shaper.duration - box.end for box in shaper.boxes]
        alone.append((abs(float(shaper.amplitudes[-1])), left, _gap(backwards, after)))
    fast = STEP_LIKE * shaper.duration / command.duration
    for name, limit in limits.items():
        sizes = np.abs(command(looks, ORDERS[name]))
        for amplitude, away, gap in alone:
            reaches = np.where(away > 0.0, gap / np.where(away > 0.0, away, 1.0), math.inf)
            scale = np.minimum(reaches, (amplitude * sizes / limit) ** (1.0 / ORDERS[name]))
            fast = max(fast, float(scale.max(initial=0.0)))
    return fast


def _gap(times: NDArray[np.float64], edges: list[float]) -> float:
    """From the first impulse to the next part [s]."""
    return min([*times[1:2].tolist(), *edges], default=math.inf)


def _between(fast: float, slow: float) -> Iterator[float]:
    """Time scales from just below `fast` to `slow`."""
    count = max(2, math.ceil(math.log(max(slow / fast, 1.0) * STRIDE) / math.log(STRIDE)) + 1)
    yield from np.geomspace(fast / STRIDE, slow, count).tolist()
