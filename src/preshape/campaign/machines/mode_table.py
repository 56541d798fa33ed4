"""Modes, or a table of modes over a configuration: each follows a commanded position, side by side."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from preshape.campaign.machines.factors import scattered_modes
from preshape.campaign.machines.machine import Factors, Instance, Values
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.plant import FlexibleStructure, Output
from preshape.stream import Schedule

__all__ = ["ModeTable", "followers"]


class ModeTable:
    """Modes by configuration, interpolated as :class:`preshape.stream.Schedule` does.

    Parameters
    ----------
    parameters : mapping of str to str
        Units of the numbers of a configuration, by name; none for modes that stay.
    rows : mapping of tuple of float to Modes
        By configuration.
    """

    def __init__(self, parameters: Mapping[str, str], rows: Mapping[tuple[float, ...], Modes]) -> None:
        self._parameters = dict(parameters)
        sizes = {len(key) for key in rows} - {len(self._parameters)}
        if sizes:
            raise InputError(
                f"a row of the machine's table has {sizes.pop()} number(s) and {len(self._parameters)} parameter(s) "
                "are named: give one number for each."
            )
        self._first = next(iter(rows.values()))
        self._table = Schedule(rows) if self._parameters else None

    @property
    def parameters(self) -> Mapping[str, str]:
        return self._parameters

    @property
    def scatters(self) -> Mapping[str, int]:
        return {"frequency": len(self._first), "damping": len(self._first)}

    def known_modes(self, values: Values) -> Modes:
        if self._table is None:
            return self._first
        missing = [name for name in self._parameters if name not in values]
        if missing:
            raise InputError(f"the machine's table needs a value for {missing[0]!r}: give an axis or a range of it.")
        return self._table.modes([values[name] for name in self._parameters])

    def after(self, values: Values, name: str, command: NDArray[np.float64], dt: float) -> Values:
        return values

    def instance(self, values: Values, end: Values, factors: Factors) -> Instance:
        modes = scattered_modes(self.known_modes(values), factors)
        return Instance(followers(modes), modes)


def followers(modes: Modes) -> FlexibleStructure:
    """One follower a mode, x'' + 2 z w x' + w^2 x = w^2 u, of a position u; their mean is seen."""
    return FlexibleStructure(
        modes,
        np.array([mode.omega**2 for mode in modes]),
        {"position": Output(tuple([1.0 / len(modes)] * len(modes)), unit="m")},
        input="position",
        unit="m",
    )
