"""A design map: the shaper at every point of a workspace, how long it is and what it tolerates."""

from __future__ import annotations

import math
from typing import Annotated

import msgspec
import numpy as np

from preshape.campaign.grid import AxisSettings, Grid
from preshape.campaign.grid_panels import grid_panel
from preshape.campaign.kind import Column, Results, Row, Told
from preshape.campaign.machines import Machine, Values
from preshape.campaign.wish import ShaperWish
from preshape.checks import tolerance_of
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.shaper import Shaper
from preshape.vibration import insensitivity, residual_vibration

__all__ = ["DesignMap", "DesignMapSettings"]

PROVED = "optimal"
"""Status of a design that is proved shortest."""

OFF = np.linspace(-1.0, 1.0, 21)
"""Parts of the frequency error at which vibration is looked for."""


class DesignMapSettings(msgspec.Struct, forbid_unknown_fields=True, omit_defaults=True):
    """The [map] of a campaign file.

    Parameters
    ----------
    axes : mapping of str to AxisSettings
        Parameters of the machine, and their values.
    fixed : mapping of str to float
        Other parameters, the same at all points.
    frequency_error : float
        By which all frequencies are off together, for what remains then [-].
    tolerance : float, optional
        Vibration up to which the insensitivity is taken [-]; none is, which is faster, unless given.
    """

    axes: dict[str, AxisSettings]
    fixed: dict[str, float] = {}
    frequency_error: Annotated[float, msgspec.Meta(gt=0.0, lt=1.0)] = 0.05
    tolerance: float | None = None


class DesignMap:
    """One design for each point of a grid.

    Parameters
    ----------
    settings : DesignMapSettings
        The grid, and what is looked at.
    machine : Machine
        Whose modes there are.
    wish : ShaperWish
        Which shaper.

    Raises
    ------
    InputError
        If they do not fit each other.
    """

    def __init__(self, settings: DesignMapSettings, machine: Machine, wish: ShaperWish) -> None:
        self._settings, self._machine, self._wish = settings, machine, wish
        if settings.tolerance is not None:
            tolerance_of(settings.tolerance)
        self.grid = Grid(settings.axes, machine.parameters)
        check_fixed(settings.fixed, machine, self.grid)

    @property
    def title(self) -> str:
        return "Design map"

    @property
    def count(self) -> int:
        return len(self.grid)

    @property
    def columns(self) -> tuple[Column, ...]:
        ends = (Column("insensitivity", "-"),) if self._settings.tolerance is not None else ()
        return (
            *(Column(name, unit) for name, unit in self.grid.units.items()),
            Column("slowest mode", "Hz"),
            Column("duration", "s"),
            Column("impulses", "-"),
            Column("proved shortest", "-"),
            Column("residual", "-"),
            Column("vibration off", "-"),
            *ends,
        )

    def row(self, point: int) -> Row:
        values: Values = {**self._settings.fixed, **self.grid.at(point)}
        modes = self._wish.known(self._machine.known_modes(values))
        shaper = self._wish.designed(modes)
        found = {
            **self.grid.at(point),
            "slowest mode": modes[0].frequency,
            "duration": shaper.duration,
            "impulses": float(len(shaper)),
            "proved shortest": float(shaper.design.status == PROVED),
            "residual": math.nan if shaper.design.residual is None else shaper.design.residual,
            "vibration off": _vibration_off(shaper, modes, self._settings.frequency_error),
        }
        if self._settings.tolerance is not None:
            found["insensitivity"] = min(insensitivity(shaper, mode, self._settings.tolerance).value for mode in modes)
        return found

    def told(self, results: Results) -> Told:
        numbers, error = results.numbers, 100.0 * self._settings.frequency_error
        spans = [
            ("slowest mode", "slowest mode", "Hz", 1.0),
            ("duration", "duration of the shaper", "s", 1.0),
            ("vibration off", f"vibration, frequencies off by {error:g} %", "%", 100.0),
            *([("insensitivity", "insensitivity", "-", 1.0)] if "insensitivity" in numbers else []),
        ]
        rows = []
        for name, title, unit, scale in spans:
            low, high = (f"{scale * float(end(numbers[name])):.4g}" for end in (np.min, np.max))
            rows.append((title, f"{low} to {high} {unit}".removesuffix(" -")))
        rows.append(("impulses", f"{int(numbers['impulses'].min())} to {int(numbers['impulses'].max())}"))
        rows.append(("proved shortest", f"{100.0 * float(np.mean(numbers['proved shortest'])):.4g} % of the points"))
        panels = tuple(
            grid_panel(self.grid, results.points, scale * numbers[name], f"{title} [{unit}]")
            for name, title, unit, scale in spans
        )
        notes = ("drawn over the first two axes; the others are at their first values.",)
        return Told(tuple(rows), panels, {}, notes if len(self.grid.shape) > 2 else ())


def check_fixed(fixed: Values, machine: Machine, grid: Grid) -> None:
    """InputError if a fixed parameter is none of the machine's, or an axis as well."""
    for name, value in fixed.items():
        if name not in machine.parameters or name in grid.axes or not math.isfinite(value):
            raise InputError(
                f"fixed.{name} is no parameter of the machine that is free: give finite values for "
                f"{', '.join(one for one in machine.parameters if one not in grid.axes) or 'none'}."
            )


def _vibration_off(shaper: Shaper, modes: Modes, error: float) -> float:
    """The most that remains of any mode when all frequencies are off by up to `error` together [-]."""
    f, z = np.array([(mode.frequency, mode.damping) for mode in modes]).T
    return float(residual_vibration(shaper, np.multiply.outer(1.0 + error * OFF, f), z).max())
