"""A shaper table for scheduling: modes and direct shaper of every row, which `preshape.stream.load_schedule` reads."""

from __future__ import annotations

import math

import msgspec
import numpy as np

from preshape.campaign.design_map import check_fixed
from preshape.campaign.grid import AxisSettings, Grid
from preshape.campaign.grid_panels import grid_panel
from preshape.campaign.kind import Column, Results, Row, Told
from preshape.campaign.machines import Machine, Values
from preshape.campaign.wish import ShaperWish
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.shaper import Shaper
from preshape.stream import schedule_json

__all__ = ["ScheduleSettings", "ScheduleTable"]

MOST_ROWS = 50_000
"""A row with its proof takes five thousand bytes of the file."""

ORDER = 1
"""Of a direct shaper and of a schedule, unless given."""

WRITTEN = "schedule.json"

WORTH_SAYING = 0.02
"""Relative error of an interpolated frequency from which on a finer table is advised [-]."""


class ScheduleSettings(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    """The [schedule] of a campaign file: its axes, and parameters that are the same in all rows."""

    axes: dict[str, AxisSettings]
    fixed: dict[str, float] = {}


class ScheduleTable:
    """Rows of a schedule, and how far interpolation between them is off.

    Parameters
    ----------
    settings : ScheduleSettings
        The rows.
    machine : Machine
        Whose modes they hold.
    wish : ShaperWish
        The family is "direct", which is what a schedule designs between its rows.

    Raises
    ------
    InputError
        If they do not fit each other.
    """

    def __init__(self, settings: ScheduleSettings, machine: Machine, wish: ShaperWish) -> None:
        self._settings, self._machine, self._wish = settings, machine, wish
        if wish.family != "direct":
            raise InputError('a schedule designs direct shapers between its rows: give shaper.family = "direct".')
        self.grid = Grid(settings.axes, machine.parameters)
        if len(self.grid) > MOST_ROWS:
            raise InputError(f"the schedule has {len(self.grid)} rows: give at most {MOST_ROWS}.")
        check_fixed(settings.fixed, machine, self.grid)

    @property
    def title(self) -> str:
        return "Schedule"

    @property
    def count(self) -> int:
        return len(self.grid)

    @property
    def columns(self) -> tuple[Column, ...]:
        return (
            *(Column(name, unit) for name, unit in self.grid.units.items()),
            Column("slowest mode", "Hz"),
            Column("duration", "s"),
            Column("frequency error between", "-"),
            Column("shaper", "", text=True),
        )

    def row(self, point: int) -> Row:
        here = self.grid.at(point)
        modes = self._modes(here)
        shaper = self._wish.designed(modes)
        return {
            **here,
            "slowest mode": modes[0].frequency,
            "duration": shaper.duration,
            "frequency error between": self._error_between(point, modes),
            "shaper": msgspec.json.encode(shaper.to_dict()).decode(),
        }

    def told(self, results: Results) -> Told:
        numbers = results.numbers
        worst = 100.0 * float(np.nanmax(numbers["frequency error between"], initial=0.0))
        rows = (
            ("slowest mode", f"{numbers['slowest mode'].min():.4g} Hz to {numbers['slowest mode'].max():.4g} Hz"),
            ("duration of the shaper", f"{numbers['duration'].min():.4g} s to {numbers['duration'].max():.4g} s"),
            ("frequency off between the rows, at most", f"{worst:.3g} %"),
        )
        panels = tuple(
            grid_panel(self.grid, results.points, scale * numbers[name], title)
            for name, title, scale in (
                ("slowest mode", "slowest mode [Hz]", 1.0),
                ("duration", "duration of the shaper [s]", 1.0),
                ("frequency error between", "frequency off halfway to the next row [%]", 100.0),
            )
        )
        notes = []
        if worst > 100.0 * WORTH_SAYING:
            notes.append(f"halfway between two rows a frequency is off by {worst:.2g} %: give more rows there.")
        if results.points.size < self.count:
            return Told(rows, panels, {}, (*notes, f"{WRITTEN} is written when every row is done: it must be a grid."))
        return Told(rows, panels, {WRITTEN: self._file(results)}, tuple(notes))

    def _file(self, results: Results) -> bytes:
        shapers = (Shaper.from_dict(msgspec.json.decode(text)) for text in results.texts["shaper"])
        written = (
            (tuple(self.grid.at(int(point)).values()), modes, shaper)
            for point, shaper in zip(results.points, shapers, strict=True)
            if (modes := shaper.design.modes) is not None
        )
        return schedule_json(
            list(self.grid.units.items()), ORDER if self._wish.order is None else self._wish.order, written
        )

    def _modes(self, values: Values) -> Modes:
        return self._wish.known(self._machine.known_modes({**self._settings.fixed, **values}))

    def _error_between(self, point: int, modes: Modes) -> float:
        """Largest relative error of a frequency halfway to the next row along any axis; NaN at the end of all [-]."""
        here, errors = self.grid.at(point), [math.nan]
        for (name, axis), k in zip(self.grid.axes.items(), self.grid.indices(point), strict=True):
            if k + 1 < axis.size:
                after = self._modes({**here, name: float(axis[k + 1])})
                middle = self._modes({**here, name: 0.5 * float(axis[k] + axis[k + 1])})
                for a, b, true in zip(modes, after, middle, strict=True):
                    errors.append(abs(math.sqrt(a.frequency * b.frequency) / true.frequency - 1.0))
        return float(np.nanmax(errors)) if len(errors) > 1 else math.nan
