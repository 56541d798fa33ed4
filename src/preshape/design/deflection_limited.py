"""Deflection-limited: the shortest shaper that keeps outputs of a plant within limits while a given command runs.

SD-ZV knows neither the command nor the plant: it limits what one step of speed does. Here both are given, so the limit
is a length, holds for all of the command, and costs no more time than this command needs.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from preshape.checks import positive
from preshape.design.each_mode import recorded
from preshape.engine import (
    Constraint,
    ImpulsesBetween,
    Outcome,
    ResponseBetween,
    ServoGrid,
    ZeroVibration,
    minimum_duration,
)
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.plant import Motion, Plant
from preshape.profile import Profile
from preshape.provenance import Design
from preshape.shaper import Shaper

__all__ = ["deflection_limited"]

LOOKS_PER_PERIOD = 100
"""How often in a period of the fastest mode an output is looked at; what it bulges by in between is taken off the
limit, and the shaper made again."""

TIGHTENINGS = 8

SLACK = 1e-9
"""A limit exceeded by this part of it is kept, to rounding of the linear programme."""

MOST_LOOKS = 20_000
"""Rows of the linear programme for one output, while the command lasts."""


def deflection_limited(
    plant: Plant,
    command: Profile,
    limits: float | Mapping[str, float],
    *,
    dt: float,
    order: int = 0,
    positive_only: bool = True,
) -> Shaper:
    """The shortest shaper on a servo grid that leaves no vibration and keeps a plant's outputs within limits.

    Parameters
    ----------
    plant : PositionedMass, ModalPlant, FlexibleBody or alike
        What bends; all its modes are left at rest.
    command : Profile
        What it is commanded before shaping, as the plant takes it: position, acceleration or force, at rest at the end.
    limits : float or mapping of str to float
        Largest size of the output "deflection" at any time [its unit], or of each output named.
    dt : float
        Servo period [s]: impulses stand at its multiples.
    order : int
        How many derivatives of the vibration over frequency are zero, too, at every mode.
    positive_only : bool
        Whether impulses are positive. Otherwise they are between -1 and 1.

    Returns
    -------
    Shaper
        ``design.settings["deflection_reached"]`` is the exact peak of each output, ``["nothing_shorter_than"]`` a
        duration [s] that no shaper on this grid can beat, ``["duration_without_limits"]`` what the limits cost nothing
        of: if it is the duration itself, nothing had to be limited.

    Raises
    ------
    InputError
        If a limit is not above zero, an output is unknown or never at rest, or no shaper keeps the limits.

    References
    ----------
    Robertson, section III (there for one mode and a step of speed; see :func:`sd_zv`).

    Examples
    --------
    >>> from preshape.plant import PositionedMass
    >>> arm = PositionedMass((1.0, 0.1))
    >>> move = Profile.steps([0.0, 1.5], [2.0 / 1.5, -2.0 / 1.5], order=1)
    >>> shaper = deflection_limited(arm, move, 0.08, dt=0.01)
    >>> peak = arm.motion(move.shaped(shaper)).peak("deflection").value
    >>> shaper.design.status, round(shaper.duration, 2), bool(peak <= 0.08)
    ('optimal', 0.61, True)
    """
    if not isinstance(command, Profile):
        raise InputError(f"command is a {type(command).__name__}: give a Profile, such as Command.profile of a move.")
    wanted = dict(limits) if isinstance(limits, Mapping) else {"deflection": limits}
    motion = plant.motion(command)
    for name, limit in wanted.items():
        _check(motion, name, limit)
    modes = Modes(motion.modes)
    looks = _looks(motion, dt)
    zeros = [ZeroVibration(mode, order) for mode in modes]
    asked: list[Constraint] = [*zeros, ImpulsesBetween(0.0 if positive_only else -1.0, 1.0), ServoGrid(dt)]
    found = minimum_duration(asked)
    least, alone = math.inf, float(found.times[-1]) if found.times.size else math.nan
    tightened: dict[str, float] = {}  # at first none, then all: the shortest without limits may keep them by itself
    for _ in range(TIGHTENINGS):
        if found.status == "infeasible":
            raise InputError(_impossible(wanted, motion, found))
        if tightened in ({}, wanted):
            least = float(found.times[-1])  # looking now and then asks less: nothing shorter keeps the limits
        shaper = Shaper.normalised(found.times, found.amplitudes)
        shaped = plant.motion(command.shaped(shaper))
        peaks = {name: shaped.peak(name).value for name in wanted}
        if all(peaks[name] <= limit * (1.0 + SLACK) for name, limit in wanted.items()):
            break
        kept = {name: limit * min(1.0, wanted[name] / peaks[name]) for name, limit in tightened.items()}
        tightened = kept or wanted
        found = minimum_duration(
            [*asked, *(_response(motion, name, limit, looks) for name, limit in tightened.items())]
        )
    else:
        raise RuntimeError(f"after {TIGHTENINGS} rounds the limits are still exceeded: please report this case.")
    proved = found.status == "optimal" and shaper.duration <= least + 0.5 * dt
    settings: dict[str, object] = {
        "deflection_limits": wanted,
        "deflection_reached": peaks,
        "duration_without_limits": alone,
        "dt": dt,
        "order": order,
        "nothing_shorter_than": least,
    }
    return recorded(shaper, Design("deflection_limited", modes, settings, "optimal" if proved else "feasible"))


def _check(motion: Motion, name: str, limit: float) -> None:
    """InputError if an output cannot be limited, or not so."""
    unit = motion.outputs[name].unit if name in motion.outputs else ""
    positive(f"the limit of {name}", limit, unit or "the unit of the output")
    if not math.isfinite(motion.peak(name).value):
        raise InputError(f"the output {name!r} grows for ever under this command: give one that ends at rest.")


def _looks(motion: Motion, dt: float) -> float:
    """How far apart the outputs are looked at [s]: a part of the servo period, and many in a period of every mode."""
    dt = positive("dt", dt, "s")
    period = min(mode.damped_period for mode in motion.modes)
    spacing = dt / math.ceil(dt * LOOKS_PER_PERIOD / period)
    if motion.end_time > MOST_LOOKS * spacing:
        raise InputError(
            f"the command takes {motion.end_time:g} s, more than {MOST_LOOKS:d} looks of {spacing:g} s at the outputs: "
            "leave out the fastest modes, or shorten the command where nothing changes."
        )
    return spacing


def _response(motion: Motion, name: str, limit: float, spacing: float) -> ResponseBetween:
    def response(times: NDArray[np.float64]) -> NDArray[np.float64]:
        return motion(name, times)

    return ResponseBetween(response, -limit, limit, spacing, until=motion.end_time)


def _impossible(wanted: Mapping[str, float], motion: Motion, found: Outcome) -> str:
    """What was asked, what the command does unshaped, and what the engine says."""
    limits = ", ".join(
        f"{name} of {limit:g} (unshaped {motion.peak(name).value:.4g})" for name, limit in wanted.items()
    )
    return f"no shaper keeps the limits, {limits}: {found.reason}"
