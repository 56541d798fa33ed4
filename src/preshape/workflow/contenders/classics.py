"""The classical commands for a comparison: sharp and smooth ones, within the limits."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from preshape.band import Band
from preshape.command import bang_bang, period_matched
from preshape.command.band_limited import band_limited_shape
from preshape.command.cycloidal import CYCLOIDAL_SHAPE
from preshape.command.ramped_sinusoid import ramped_sinusoid_shape
from preshape.command.shape import Limits, MoveShape, shortest_of
from preshape.command.versine import VERSINE_SHAPE
from preshape.command.versine_force import VERSINE_FORCE_SHAPE
from preshape.errors import InputError
from preshape.mode import Mode, Modes
from preshape.profile import Profile
from preshape.report import Kind
from preshape.workflow.contenders.limited import Limited, Move, acceleration_of, stretched
from preshape.workflow.contenders.piecewise import interpolated

__all__ = ["classic_moves"]

SPARED = 0.1
"""The band-limited pulse spares the first mode's frequency and this part of it either way."""

SAME = 1e-9
"""Durations this near, relatively, are one."""


def classic_moves(modes: Modes, limited: Limited) -> list[tuple[str, Kind, Callable[[], Move]]]:
    """Names, kinds and makers of the classical commands; those that spare one mode spare the first.

    Parameters
    ----------
    modes : Modes
        What vibrates.
    limited : Limited
        The distance and the limits.
    """
    first = modes[0]
    band = Band((1.0 - SPARED) * first.frequency, (1.0 + SPARED) * first.frequency)
    only = "" if len(modes) == 1 else "spares the first mode only"

    def of_shape(shape: MoveShape) -> Callable[[], Move]:
        return lambda: _of_form(limited, lambda _: shape, "")

    return [
        ("bang-bang", "unshaped", lambda: _bang_bang(limited)),
        ("trapezoid", "unshaped", lambda: _trapezoid(limited)),
        ("S-curve", "smooth", lambda: _s_curve(limited, first)),
        ("cycloidal", "smooth", of_shape(CYCLOIDAL_SHAPE)),
        ("versine", "smooth", of_shape(VERSINE_SHAPE)),
        ("versine force", "smooth", of_shape(VERSINE_FORCE_SHAPE)),
        ("ramped sinusoid", "smooth", lambda: _of_form(limited, lambda t: ramped_sinusoid_shape(first, t), only)),
        ("band-limited pulse", "smooth", lambda: _of_form(limited, lambda t: band_limited_shape(band, t), only)),
        ("period-matched", "smooth", lambda: _period_matched(limited, first, only)),
    ]


def _no_jerk_limit(limited: Limited) -> None:
    if limited.jerk is not None:
        raise InputError("its acceleration jumps, so no jerk limit can be kept.")


def _bang_bang(limited: Limited) -> Move:
    _no_jerk_limit(limited)
    command = bang_bang(
        limited.distance, maximum_speed=limited.speed, maximum_acceleration=limited.acceleration, dt=limited.dt
    )
    acceleration = acceleration_of(command.profile)
    same = acceleration.end_time <= limited.trapezoid().end_time * (1.0 + SAME)
    return Move(acceleration, command.duration, note="here the same as the trapezoid" if same else "")


def _trapezoid(limited: Limited) -> Move:
    _no_jerk_limit(limited)
    acceleration = limited.trapezoid()
    return Move(acceleration, acceleration.end_time)


def _s_curve(limited: Limited, first: Mode) -> Move:
    """At the jerk limit; without one, with the highest jerk whose ramps last a period, which spares that mode."""
    period, jerk, note = first.damped_period, limited.jerk, ""
    if jerk is None:
        # A ramp lasts a / j, sqrt(v / j) or cbrt(d / 2 j), by which limit the move reaches.
        size = abs(limited.distance)
        jerk = min(limited.acceleration / period, limited.top_speed / period**2, 0.5 * size / period**3)
        note = "jerk such that its ramps last a period of the first mode"
    acceleration = limited.s_curve(jerk)
    return Move(acceleration, acceleration.end_time, note=note)


def _period_matched(limited: Limited, first: Mode, note: str) -> Move:
    _no_jerk_limit(limited)
    command = period_matched(
        limited.distance,
        first,
        maximum_speed=limited.top_speed,
        maximum_acceleration=limited.acceleration,
        dt=limited.dt,
    )
    return Move(acceleration_of(command.profile), command.duration, note=note)


def _of_form(limited: Limited, form: Callable[[float], MoveShape], note: str) -> Move:
    """The shortest move of a form, which may depend on the duration, within the limits."""
    limits = Limits(limited.speed, limited.acceleration, limited.jerk)
    try:
        shortest = shortest_of(form, limited.distance, limits)
    except InputError as error:
        if "jumps in acceleration" in str(error):
            _no_jerk_limit(limited)
        raise

    def build(slower: float) -> Profile:
        duration = slower * shortest
        shape = form(duration)
        size = limited.distance / duration**2
        return interpolated(
            lambda t: size * shape.acceleration(np.asarray(t) / duration), [0.0, 0.5 * duration, duration]
        )

    # A form's peak is known from samples only, so it may be a little above the limit.
    acceleration, slower = stretched(build, limited)
    return Move(acceleration, slower * shortest, exact=False, note=note)
