"""The moves that `compare` compares: each an acceleration of the carriage within the limits, or a reason why not."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial

from preshape.command.rest_to_rest import deflection_limiting, on_off, time_optimal
from preshape.command.rest_to_rest.rest_to_rest import RestToRest
from preshape.errors import InputError
from preshape.mode import Mode, Modes
from preshape.plant import FlexibleBody
from preshape.profile import Profile
from preshape.report import Kind
from preshape.shaper import Shaper
from preshape.workflow.contenders.classics import classic_moves
from preshape.workflow.contenders.filtered import filtered_moves
from preshape.workflow.contenders.limited import Limited, Move, kept, peaks_of, stretched

__all__ = ["Entry", "entries"]

HALF = 0.5
"""Part of the static deflection under full acceleration that the deflection-limiting command may use; SD-ZV keeps the
same part of what ZV has."""


@dataclass(frozen=True)
class Entry:
    """A command that may be in the comparison.

    Parameters
    ----------
    name : str
        What it is called.
    kind : str
        As of :class:`preshape.report.Contender`.
    make : callable
        Makes the Move, or raises InputError with the reason why there is none.
    """

    name: str
    kind: Kind
    make: Callable[[], Move]


def entries(modes: Modes, limited: Limited, shapers: Mapping[str, Shaper] | None, negligible: float) -> list[Entry]:
    """All that there are.

    Parameters
    ----------
    modes : Modes
        What vibrates; commands that spare one mode spare the first.
    limited : Limited
        The distance and the limits.
    shapers : mapping of str to Shaper, or None
        What shapes the base move; ZV, ZVD, EI, the shortest and SD-ZV when None.
    negligible : float
        A filter's command has ended when less than this is left of the way [unit].
    """
    base = "trapezoid" if limited.jerk is None else "S-curve"
    listed = [Entry(name, kind, make) for name, kind, make in classic_moves(modes, limited)]
    listed += [Entry(name, "filtered", make) for name, make in filtered_moves(modes, limited, base, negligible)]
    listed.append(Entry("posicast", "shaped", _posicast(base)))
    designs = _designs(modes) if shapers is None else [(name, partial(_given, one)) for name, one in shapers.items()]
    listed += [Entry(f"{base} + {name}", "shaped", _shaped(limited, make)) for name, make in designs]
    listed += [
        Entry("time-optimal", "rest-to-rest", _rest_to_rest(limited, lambda: _time_optimal(modes, limited))),
        Entry("deflection-limiting", "rest-to-rest", _rest_to_rest(limited, lambda: _limiting(modes, limited))),
        Entry("on-off", "rest-to-rest", _rest_to_rest(limited, lambda: _on_off(modes, limited))),
    ]
    return listed


def _designs(modes: Modes) -> list[tuple[str, Callable[[], Shaper]]]:
    """The shapers that are compared unless others are given; several modes: one each convolved, but for the direct."""
    from preshape import design

    ratio = HALF * min(1.0 / (1.0 + mode.decay_per_half_period) for mode in modes)
    return [
        ("ZV", lambda: design.zv(modes)),
        ("ZVD", lambda: design.zvd(modes)),
        ("EI", lambda: design.ei(modes)),
        ("direct", lambda: design.direct(modes)),
        ("SD-ZV", lambda: design.sd_zv(modes, ratio)),
    ]


def _given(shaper: Shaper) -> Shaper:
    if not isinstance(shaper, Shaper):
        raise InputError(f"this is {shaper!r}: give a Shaper, such as design.zv(modes) returns.")
    return shaper


def _shaped(limited: Limited, design: Callable[[], Shaper]) -> Callable[[], Move]:
    """The base move through a shaper; slowed if negative impulses would break a limit."""

    def make() -> Move:
        shaper = design()

        def build(slower: float) -> Profile:
            return limited.base(slower).shaped(shaper)

        acceleration, slower = stretched(build, limited)
        return Move(acceleration, acceleration.end_time, note=_slowed(slower, "base"))

    return make


def _slowed(slower: float, what: str) -> str:
    return "" if slower == 1.0 else f"{what} slowed {100.0 * (slower - 1.0):.2g} % to keep the limits"


def _posicast(base: str) -> Callable[[], Move]:
    def make() -> Move:
        raise InputError(
            f"it is a position in two steps, which no acceleration limit allows; the same idea within the limits is "
            f'"{base} + ZV".'
        )

    return make


def _rest_to_rest(limited: Limited, design: Callable[[], tuple[RestToRest, str]]) -> Callable[[], Move]:
    """A command for a body under a limited force as one for a carriage under a limited acceleration.

    With a mass of 1 and gains of -1 its modes obey d'' + 2 z w d' + w^2 d = -u: those of a carriage accelerated by u.
    """

    def make() -> Move:
        if limited.jerk is not None:
            raise InputError("its acceleration jumps, so no jerk limit can be kept.")
        command, note = design()
        acceleration = command.force
        if not kept(acceleration, limited):
            speed = peaks_of(acceleration, limited)[0]
            raise InputError(
                f"it knows no speed limit, and would reach {speed:.3g} where {limited.speed:g} is allowed."
            )
        unproved = "not proved shortest" if command.status == "feasible" else ""
        return Move(acceleration, command.duration, note=note or unproved)

    return make


def _time_optimal(modes: Modes, limited: Limited) -> tuple[RestToRest, str]:
    body = FlexibleBody(1.0, modes, [-1.0] * len(modes))
    return time_optimal(body, limited.distance, maximum_force=limited.acceleration), ""


def _on_off(modes: Modes, limited: Limited) -> tuple[RestToRest, str]:
    body, note = _undamped(modes)
    return on_off(body, limited.distance, maximum_force=limited.acceleration), note


def _limiting(modes: Modes, limited: Limited) -> tuple[RestToRest, str]:
    body, note = _undamped(modes)
    limit = HALF * limited.acceleration / modes[0].omega ** 2
    command = deflection_limiting(body, limited.distance, maximum_force=limited.acceleration, deflection_limit=limit)
    return command, note


def _undamped(modes: Modes) -> tuple[FlexibleBody, str]:
    """What the closed forms are for, and what must be known about it."""
    if len(modes) > 1:
        raise InputError(
            f"its closed form is for one mode, and there are {len(modes)}; for several, "
            "command.rest_to_rest.time_optimal computes it."
        )
    note = "made for the mode without its damping" if modes[0].damping > 0.0 else ""
    return FlexibleBody(1.0, Mode(modes[0].frequency, 0.0), -1.0), note
