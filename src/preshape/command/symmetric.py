"""Moves that decelerate as they accelerated: exact samples from the accelerating half alone.

Such a move is antisymmetric about its middle, x(T - t) = D - x(t). Evaluating the first half and mirroring it makes the
end position exact, keeps the last samples from overshooting by rounding, and halves the algebra of every kind of move.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from preshape.checks import not_negative, positive
from preshape.command.checks import sample_count
from preshape.command.command import Command
from preshape.errors import InputError
from preshape.profile import Profile

__all__ = ["SAME_DURATION", "Segment", "asked_duration", "slowed", "symmetric_move"]

Number = TypeVar("Number", float, NDArray[np.float64])

SAME_DURATION = 1e-12
"""A duration asked for that is shorter than the shortest move by this fraction only is the shortest: rounding."""

KNOT_SLACK = 1e-12
"""A sample this near a switching time, relative to the move's duration, is on it (and takes the value after it)."""

SAME_TIME = 16.0 * np.finfo(float).eps
"""Times of a profile this near, relative to the move's duration, may be taken for one."""


@dataclass(frozen=True, slots=True)
class Segment:
    """A stretch of constant jerk: its duration [s], acceleration at its start [unit/s^2] and jerk [unit/s^3]."""

    duration: float
    acceleration: float
    jerk: float = 0.0


def asked_duration(duration: float, shortest: float) -> float:
    """The duration asked for [s], if the limits allow it; a move that is only shorter by rounding is the shortest."""
    asked = positive("duration", duration, "s")
    if asked < shortest * (1.0 - SAME_DURATION):
        raise InputError(f"a duration of {asked:g} s breaks a limit: this move takes at least {shortest:.6g} s.")
    return max(asked, shortest)


def slowed(half: Sequence[Segment], duration: float | None) -> list[Segment]:
    """The same move slowed in time until the whole of it takes `duration` [s]; as it is when that is None.

    Slowed by c, its speed falls by c, its acceleration by c^2 and its jerk by c^3, so it keeps whatever limit it kept.
    """
    if duration is None:
        return list(half)
    shortest = 2.0 * sum(segment.duration for segment in half)
    c = asked_duration(duration, shortest) / shortest
    return [replace(s, duration=c * s.duration, acceleration=s.acceleration / c**2, jerk=s.jerk / c**3) for s in half]


def symmetric_move(distance: float, half: Sequence[Segment], *, dt: float, rest: float, quantity: str) -> Command:
    """Sample the move whose first half, from rest to the middle of the way, is `half`.

    Parameters
    ----------
    distance : float
        Where the move ends; its sign is the direction.
    half : sequence of Segment
        From the start to the middle of the move, for the distance taken as positive; together they must cover
        |distance| / 2. Segments of no duration are allowed.
    dt, rest : float
        Sample interval and least time at rest in the samples after the move [s].
    quantity : str
        What is commanded, with its unit.
    """
    dt = positive("dt", dt, "s")
    held = sample_count(not_negative("rest", rest, "s"), dt)
    knots = np.concatenate([[0.0], np.cumsum([segment.duration for segment in half])])
    duration = 2.0 * float(knots[-1])
    times = np.arange(max(1, sample_count(duration, dt)) + 1 + held) * dt

    slack = KNOT_SLACK * duration
    late = times > 0.5 * duration - slack
    ended = times > duration - slack
    # Time since the start or, in the second half, left to the end.
    phase = np.where(late, np.maximum(duration - times, 0.0), times)
    position, velocity, _ = _states(half, knots, phase, np.searchsorted(knots, phase, side="right"))
    # Only the acceleration jumps, so only it asks on which side of a switching time a sample is.
    before = np.searchsorted(knots, phase - slack, side="left")
    after = np.searchsorted(knots, phase + slack, side="right")
    _, _, acceleration = _states(half, knots, phase, np.where(late, before, after))

    size, sign = abs(distance), float(np.sign(distance))
    position = np.where(late, size - position, position)
    acceleration = np.where(late, -acceleration, acceleration)
    position[ended], velocity[ended], acceleration[ended] = size, 0.0, 0.0
    return Command(
        dt=dt,
        values=sign * position,
        quantity=quantity,
        duration=duration,
        velocity=sign * velocity,
        acceleration=sign * acceleration,
        profile=_profile(sign, half, knots),
    )


def _profile(sign: float, half: Sequence[Segment], knots: NDArray[np.float64]) -> Profile:
    """The whole move by its steps of acceleration and jerk; the second half is -a(T - t) and j(T - t) of the first."""
    duration = 2.0 * float(knots[-1])
    # A stretch shorter than the rounding of times is left out: what it changes is then a step of the acceleration.
    least = SAME_TIME * duration
    lasting = [
        (float(start), segment) for start, segment in zip(knots[:-1], half, strict=True) if segment.duration > least
    ]
    stretches = [(start, segment.acceleration, segment.jerk) for start, segment in lasting]
    for start, segment in reversed(lasting):
        end = segment.acceleration + segment.jerk * segment.duration
        stretches.append((duration - start - segment.duration, -end, segment.jerk))
    times, accelerations, jerks = np.array([*stretches, (duration, 0.0, 0.0)]).T
    carried = np.concatenate([[0.0], accelerations[:-1] + jerks[:-1] * np.diff(times)])
    kicks = accelerations - carried
    kicks[np.abs(kicks) <= KNOT_SLACK * np.abs(accelerations).max()] = 0.0
    steps = np.concatenate([kicks, np.diff(jerks, prepend=0.0)])
    return Profile(np.tile(times, 2), sign * steps, np.repeat([2, 3], times.size))


def _states(
    half: Sequence[Segment], knots: NDArray[np.float64], phase: NDArray[np.float64], index: NDArray[np.intp]
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Position, velocity and acceleration at `phase`, each in the segment that `index` counts from 1.

    By the polynomial of the segment, not by quadrature. A phase outside it, by rounding, counts as its nearer end.
    """
    rows = []
    position, velocity = 0.0, 0.0
    for segment in half:
        rows.append((position, velocity, segment.acceleration, segment.jerk))
        position, velocity, _ = _polynomial(*rows[-1], segment.duration)
    index = np.clip(index - 1, 0, len(half) - 1)
    x, v, a, j = np.array(rows)[index].T
    durations = np.array([segment.duration for segment in half])
    return _polynomial(x, v, a, j, np.clip(phase - knots[index], 0.0, durations[index]))


def _polynomial(x: Number, v: Number, a: Number, j: Number, t: Number) -> tuple[Number, Number, Number]:
    """Position, velocity and acceleration `t` after the state x, v, a under the jerk j."""
    return x + t * (v + t * (a / 2.0 + t * j / 6.0)), v + t * (a + t * j / 2.0), a + t * j
