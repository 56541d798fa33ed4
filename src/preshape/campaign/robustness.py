"""Robustness: what a shaper leaves of a move's vibration when the machine is not quite the one it was made for."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Annotated, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from preshape.campaign.grid import MOST_POINTS
from preshape.campaign.kind import Column, Results, Row, Told, random_of
from preshape.campaign.machines import Instance, Machine, Values, drawn_factors
from preshape.campaign.robustness_told import robustness_told
from preshape.campaign.swing import PERIODS, swing
from preshape.campaign.wish import ShaperWish
from preshape.checks import not_negative, positive, tolerance_of
from preshape.errors import InputError
from preshape.plant import simulated
from preshape.shaper import Shaper

__all__ = ["Robustness", "RobustnessSettings"]

MOST_SAMPLES = 2_000_000
"""Of one simulation: a longer one is a mistaken dt."""

SHOWN_FACTORS = 6
"""Factors of one kind that have a column of their own in the results."""


class MoveSettings(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    """The command: values at times, held or joined by straight lines, from 0 before."""

    dt: float
    times: Annotated[list[float], msgspec.Meta(min_length=1, max_length=100_000)]
    values: Annotated[list[float], msgspec.Meta(min_length=1, max_length=100_000)]
    between: Literal["held", "straight"] = "held"
    input: str | None = None


class RobustnessSettings(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    """The [robustness] of a campaign file.

    Parameters
    ----------
    move : MoveSettings
        The command that is given unshaped and shaped.
    points : int
        How many machines are drawn.
    seed : int
        Of what is random.
    scatter : mapping of str to float
        Relative standard deviation of what the designer does not know [-].
    ranges : mapping of str to (float, float)
        Least and largest value of what he knows, drawn evenly [their units].
    design : {"once", "each"}
        One shaper, for the middle of all ranges; or one for each point, for its values but not for its scatter.
    output : str, optional
        What is looked at; the first output unless given.
    wait, rest : float
        When looking begins after the end of a command [s], and for how many periods of the slowest mode.
    tolerance : float
        What may remain [-]; the part of the machines within it is said.
    """

    move: MoveSettings
    points: Annotated[int, msgspec.Meta(ge=1, le=MOST_POINTS)]
    seed: Annotated[int, msgspec.Meta(ge=0)] = 0
    scatter: dict[str, float] = {}
    ranges: dict[str, tuple[float, float]] = {}
    design: Literal["once", "each"] = "once"
    output: str | None = None
    wait: float = 0.0
    rest: Annotated[float, msgspec.Meta(ge=3.0, le=1000.0)] = 6.0
    tolerance: float = 0.05


class Robustness:
    """A Monte-Carlo over machines; each is simulated unshaped and shaped.

    Parameters
    ----------
    settings : RobustnessSettings
        What varies, and under which move.
    machine : Machine
        What varies.
    wish : ShaperWish
        Which shaper.

    Raises
    ------
    InputError
        If they do not fit each other; found here, before any point is computed.
    """

    def __init__(self, settings: RobustnessSettings, machine: Machine, wish: ShaperWish) -> None:
        self._settings, self._machine, self._wish = settings, machine, wish
        positive("move.dt", settings.move.dt, "s")
        not_negative("wait", settings.wait, "s")
        tolerance_of(settings.tolerance)
        _check_names("scatter", settings.scatter, machine.scatters)
        _check_names("ranges", settings.ranges, machine.parameters)
        for name, size in settings.scatter.items():
            if not 0.0 <= size <= 1.0:
                raise InputError(f"the scatter of {name} is {size:g}: give a part from 0 to 1, such as 0.05 for 5 %.")
        for name, (low, high) in settings.ranges.items():
            if not (math.isfinite(low) and math.isfinite(high) and low <= high):
                raise InputError(f"the range of {name} is {low:g} to {high:g}: give the least value first.")
        if not settings.scatter and not settings.ranges:
            raise InputError("nothing varies: give robustness.scatter or robustness.ranges.")
        middle = {name: 0.5 * (low + high) for name, (low, high) in settings.ranges.items()}
        self._command = _sampled(settings.move)
        nominal = machine.instance(middle, middle, {})
        self._input = _named("input", settings.move.input, nominal.plant.inputs)
        self._output = _named("output", settings.output, nominal.plant.outputs)
        self._unit = nominal.plant.outputs[self._output]
        # What is asked of the design is refused here; each point of "each" asks again.
        self._shaper = wish.designed(machine.known_modes(self._after(middle)))
        self._simulated(nominal, self._shaper, dry=True)

    @property
    def title(self) -> str:
        return "Robustness"

    @property
    def count(self) -> int:
        return self._settings.points

    @property
    def columns(self) -> tuple[Column, ...]:
        units = self._machine.parameters
        return (
            *(Column(name, units[name]) for name in self._settings.ranges),
            *(Column(name, "-") for name in self._factor_names()),
            Column("unshaped", self._unit),
            Column("shaped", self._unit),
            Column("remaining", "-"),
            Column("duration", "s"),
        )

    def row(self, point: int) -> Row:
        random = random_of(self._settings.seed, point)
        values = {name: float(random.uniform(low, high)) for name, (low, high) in self._settings.ranges.items()}
        factors = drawn_factors(random, self._settings.scatter, self._machine.scatters)
        end = self._after(values)
        once = self._settings.design == "once"
        shaper = self._shaper if once else self._wish.designed(self._machine.known_modes(end))
        before, after = self._simulated(self._machine.instance(values, end, factors), shaper)
        shown = {
            f"{name} {k + 1}": float(value)
            for name, of_kind in factors.items()
            for k, value in enumerate(of_kind[:SHOWN_FACTORS])
        }
        remaining = after / before if before else math.nan
        left = {"unshaped": before, "shaped": after, "remaining": remaining, "duration": shaper.duration}
        return {**values, **shown, **left}

    def told(self, results: Results) -> Told:
        return robustness_told(results, self.columns, self._output, self._settings.tolerance)

    def _after(self, values: Values) -> Values:
        """Where the move ends: what a rate turns by, or the position where a position stops."""
        return self._machine.after(values, self._input, self._command, self._settings.move.dt)

    def _simulated(self, one: Instance, shaper: Shaper, dry: bool = False) -> tuple[float, float]:
        """What is left unshaped and shaped [unit of the output]; `dry`: only whether it could be done."""
        dt, plant = self._settings.move.dt, one.plant
        period = 1.0 / min(mode.frequency for mode in one.modes)
        rest = math.ceil(max(self._settings.rest, PERIODS + 1.0) * period / dt)
        skipped = math.ceil(self._settings.wait / dt)
        length = self._command.size + math.ceil(shaper.duration / dt) + skipped + rest
        if length > MOST_SAMPLES:
            raise InputError(f"a simulation takes {length} samples of {dt:g} s: give a larger dt, or a shorter move.")
        if dry:
            return math.nan, math.nan
        left = []
        for part in (self._command, np.asarray(shaper.shape(self._command, dt))):
            ends = part.size - 1 + skipped
            rows = np.zeros((len(plant.inputs), ends + 1 + rest))
            for row, name in zip(rows, plant.inputs, strict=True):
                row += one.start.get(name, 0.0)
                if name == self._input:
                    row[: part.size] += part
                    row[part.size :] += part[-1]
            done = simulated(plant, rows, dt)
            left.append(swing(done.outputs[self._output][ends:], dt, one.modes))
        return left[0], left[1]

    def _factor_names(self) -> list[str]:
        counts = self._machine.scatters
        return [f"{name} {k + 1}" for name in self._settings.scatter for k in range(min(counts[name], SHOWN_FACTORS))]


def _check_names(what: str, given: Mapping[str, object], known: Mapping[str, object]) -> None:
    for name in given:
        if name not in known:
            allowed = f"it has {', '.join(known)}" if known else "it has none"
            raise InputError(f"robustness.{what} names {name!r}, which this machine does not have: {allowed}.")


def _named(kind: str, name: str | None, names: Mapping[str, str]) -> str:
    if name is None:
        return next(iter(names))
    if name not in names:
        raise InputError(f"{kind} is {name!r}: this plant has {', '.join(names)}.")
    return name


def _sampled(move: MoveSettings) -> NDArray[np.float64]:
    """The command at 0, dt ... until its last time."""
    times, values = np.array(move.times), np.array(move.values)
    if times.size != values.size:
        raise InputError(f"the move has {times.size} times and {values.size} values: give one for each.")
    finite = np.isfinite(times).all() and np.isfinite(values).all()
    if not finite or times[0] < 0.0 or (np.diff(times) <= 0.0).any():
        raise InputError("the move's times do not increase from 0 s on: give finite ones, each once, in order.")
    if not values.any():
        raise InputError("the move's values are all 0: nothing moves.")
    count = math.ceil(times[-1] / move.dt - 1e-6) + 1
    if count > MOST_SAMPLES:
        raise InputError(f"the move takes {count} samples of {move.dt:g} s: give a larger dt.")
    samples = move.dt * np.arange(count)
    if move.between == "straight":
        return np.asarray(np.interp(samples, times, values, left=0.0 if times[0] > 0.0 else None))
    at = np.searchsorted(times, samples + 1e-6 * move.dt, side="right") - 1
    return np.asarray(np.where(at < 0, 0.0, values[np.maximum(at, 0)]))
