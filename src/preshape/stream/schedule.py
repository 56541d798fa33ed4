"""Schedule: the modes of a machine by its configuration, from a table; the modes are interpolated, not the impulses.

Between two rows of the table the impulses of a shaper move as the optimum does: they appear, vanish and merge. Mixed
impulses of two rows leave vibration at every mode between them. Modes move smoothly, and a design between is quick.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import whole_number
from preshape.design import direct
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.shaper import Shaper

__all__ = ["Schedule"]

Table: TypeAlias = Mapping[float, ModesLike] | Mapping[tuple[float, ...], ModesLike]
"""By configuration: a number, such as a rope's length, or several, such as a pose."""


class Schedule:
    """Modes by configuration: a table on a grid, straight lines between its rows.

    The logarithm of a frequency is interpolated, and the damping ratio itself, linearly along each axis of the
    configuration. What counts for a shaper is the *relative* error of a frequency, and that is at most
    h^2 / 8 times the largest second derivative of ln f along an axis with rows h apart. Choose the axis so that ln f is
    nearly straight along it: of a crane, whose frequency falls as 1 / sqrt(length), rows h apart err by at most
    h^2 / (16 length^2); by ln(length) instead of length there is no error at all.

    Parameters
    ----------
    table : mapping of float or tuple of float to modes
        By configuration [the user's units]: the modes there, natural frequencies [Hz] and damping ratios [-]. The k-th
        mode of every row is the same mode of the machine. Tuples must fill a grid: each value of the first number with
        each of the second, and so on.
    order : int
        Of the shapers, as for :func:`preshape.design.direct`.
    outside : {"refuse", "hold"}
        What happens to a configuration outside the table: it is refused, or the nearest one in the table is taken.
    shapers : mapping of float or tuple of float to Shaper, optional
        Of rows that are designed already, as those of :func:`preshape.stream.load_schedule`.

    Raises
    ------
    InputError
        If the table is empty, no grid, or its rows do not have equally many modes; or a shaper is not that of its row.

    Examples
    --------
    >>> ropes = Schedule({length: (math.sqrt(9.81 / length) / (2.0 * math.pi), 0.0) for length in (2.0, 3.0, 4.0)})
    >>> round(ropes.modes(2.5)[0].frequency, 3), round(math.sqrt(9.81 / 2.5) / (2.0 * math.pi), 3)
    (0.319, 0.315)
    >>> ropes.shaper(2.5).design.modes == ropes.modes(2.5)
    True
    """

    def __init__(
        self,
        table: Table,
        order: int = 1,
        *,
        outside: str = "refuse",
        shapers: Mapping[float, Shaper] | Mapping[tuple[float, ...], Shaper] | None = None,
    ) -> None:
        if outside not in ("refuse", "hold"):
            raise InputError(f'outside is {outside!r}: it is "refuse" or "hold".')
        if not isinstance(table, Mapping) or not table:
            raise InputError("the table has no rows: give modes by configuration, at least one.")
        self._outside, self._order = outside, whole_number("order", order, 0, 6)
        rows = {_numbers(key): Modes(modes) for key, modes in table.items()}
        if len(rows) != len(table):
            raise InputError("the table names a configuration twice: give each once.")
        self._axes = _axes(rows)
        first = next(iter(rows))
        for key, modes in rows.items():
            if len(modes) != len(rows[first]):
                raise InputError(
                    f"the table has {len(rows[first])} modes at {_words(first)} and {len(modes)} at {_words(key)}: "
                    "give the same modes in every row, in the same order."
                )
        shape = [axis.size for axis in self._axes]
        ordered = [rows[key] for key in itertools.product(*(axis.tolist() for axis in self._axes))]
        values = [[(math.log(mode.frequency), mode.damping) for mode in modes] for modes in ordered]
        self._values = np.array(values).reshape(*shape, len(rows[first]), 2)
        self._designed: dict[tuple[int, ...], Shaper] = {}
        for at, shaper in (shapers or {}).items():
            self._take(_numbers(at), shaper, rows)

    def modes(self, configuration: ArrayLike) -> Modes:
        """The modes at a configuration.

        Parameters
        ----------
        configuration : float, or array_like of shape (axis,)
            As the table's [the user's units].

        Raises
        ------
        InputError
            If it is not as many finite numbers as the table's, or outside it (unless that is held); where two modes
            cross, and are the same there.
        """
        values = self._values
        for axis, value in zip(self._axes, self._point(configuration), strict=True):
            k = min(max(int(np.searchsorted(axis, value, side="right")) - 1, 0), max(axis.size - 2, 0))
            if axis[k] == value or axis.size == 1:
                values = values[k]
            else:
                part = (value - axis[k]) / (axis[k + 1] - axis[k])
                values = (1.0 - part) * values[k] + part * values[k + 1]
        return Modes([(math.exp(logarithm), damping) for logarithm, damping in values.tolist()])

    def shaper(self, configuration: ArrayLike) -> Shaper:
        """The direct shaper for the modes at a configuration, from that of the nearest row.

        The same configuration gives the same shaper, whatever was asked for before. The shaper of a row is designed
        when it is first needed; a stream that tracks ``schedule.modes(configuration)`` needs none of them.
        """
        wanted, point = self.modes(configuration), self._point(configuration)
        nearest = tuple(int(np.argmin(np.abs(a - value))) for a, value in zip(self._axes, point, strict=True))
        if nearest not in self._designed:
            at = [axis[k] for axis, k in zip(self._axes, nearest, strict=True)]
            self._designed[nearest] = direct(self.modes(at), self._order)
        row = self._designed[nearest]
        return direct(wanted, self._order, near=None if row.design.certificate is None else row)

    def _take(self, key: tuple[float, ...], shaper: Shaper, rows: Mapping[tuple[float, ...], Modes]) -> None:
        design = shaper.design
        if key not in rows or design.family != "direct" or design.modes != rows[key]:
            raise InputError(f"the shaper at {_words(key)} is not the direct one for the table's modes there.")
        if design.settings.get("order") != self._order:
            raise InputError(f"the shaper at {_words(key)} has another order than the schedule's, {self._order}.")
        self._designed[tuple(int(np.searchsorted(a, value)) for a, value in zip(self._axes, key, strict=True))] = shaper

    def _point(self, configuration: ArrayLike) -> tuple[float, ...]:
        point = _numbers(configuration)
        if len(point) != len(self._axes):
            raise InputError(f"the configuration has {len(point)} numbers and the table's have {len(self._axes)}.")
        held = tuple(min(max(q, float(a[0])), float(a[-1])) for q, a in zip(point, self._axes, strict=True))
        if held != point and self._outside == "refuse":
            spans = ", ".join(f"{axis[0]:g} to {axis[-1]:g}" for axis in self._axes)
            raise InputError(
                f"the configuration {_words(point)} is outside the table, {spans}: extend the table, or say "
                'outside="hold".'
            )
        return held

    def __repr__(self) -> str:
        spans = ", ".join(f"{axis[0]:g} to {axis[-1]:g} ({axis.size})" for axis in self._axes)
        return f"<Schedule: {self._values.shape[-2]} mode(s) over {spans}>"


def _axes(rows: Mapping[tuple[float, ...], Modes]) -> list[NDArray[np.float64]]:
    """The values along each number of the configurations, increasing; InputError when they are no grid."""
    sizes = {len(key) for key in rows}
    if len(sizes) != 1 or 0 in sizes:
        raise InputError(f"the table's configurations have {sorted(sizes)} numbers: give equally many in each.")
    axes = [np.unique([key[k] for key in rows]) for k in range(sizes.pop())]
    for key in itertools.product(*(axis.tolist() for axis in axes)):
        if key not in rows:
            raise InputError(f"the table is no grid, it has no row at {_words(key)}: give one for every combination.")
    return axes


def _numbers(configuration: object) -> tuple[float, ...]:
    try:
        point = np.atleast_1d(np.asarray(configuration, dtype=float))
    except (TypeError, ValueError):
        point = np.array([math.nan])
    if point.ndim != 1 or not np.isfinite(point).all():
        raise InputError(f"the configuration is {configuration!r}: give a finite number, or a row of them.")
    return tuple(point.tolist())


def _words(point: tuple[float, ...]) -> str:
    return ", ".join(f"{value:g}" for value in point)
