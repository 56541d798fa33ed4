"""The schedule file ``preshape/schedule/1``: modes and the shaper of every row, JSON, as `preshape campaign` writes it.

The fields are documented in docs/how-to/campaign.md and stable.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import msgspec

from preshape.errors import InputError
from preshape.mode import Modes
from preshape.shaper import Shaper
from preshape.stream.schedule import Schedule

__all__ = ["SCHEDULE_SCHEMA", "load_schedule", "schedule_json"]

SCHEDULE_SCHEMA = "preshape/schedule/1"

LARGEST_FILE = 500_000_000
"""Bytes; a row of four modes and nine impulses takes five thousand."""


class _Axis(msgspec.Struct, forbid_unknown_fields=True):
    name: str
    unit: str = ""


class _Row(msgspec.Struct, forbid_unknown_fields=True):
    at: list[float]
    modes: list[tuple[float, float]]
    shaper: Any = None


class _File(msgspec.Struct, forbid_unknown_fields=True):
    schema: str
    order: int
    axes: list[_Axis]
    rows: list[_Row]


def schedule_json(
    axes: Sequence[tuple[str, str]], order: int, rows: Iterable[tuple[Sequence[float], Modes, Shaper]]
) -> bytes:
    """The file's content.

    Parameters
    ----------
    axes : sequence of (str, str)
        Name and unit of each number of a configuration.
    order : int
        Of the shapers.
    rows : iterable of (configuration, Modes, Shaper)
        The shapers direct ones for these modes.
    """
    written = [
        _Row(list(at), [(mode.frequency, mode.damping) for mode in modes], shaper.to_dict())
        for at, modes, shaper in rows
    ]
    file = _File(SCHEDULE_SCHEMA, order, [_Axis(*axis) for axis in axes], written)
    return msgspec.json.encode(file) + b"\n"


def load_schedule(path: str | os.PathLike[str], *, outside: str = "refuse") -> Schedule:
    """The schedule in a file, its rows designed already.

    Parameters
    ----------
    path : path-like
        A ``schedule.json`` of `preshape campaign`.
    outside : {"refuse", "hold"}
        As for :class:`Schedule`.

    Returns
    -------
    Schedule

    Raises
    ------
    InputError
        If the file cannot be read, is not of this schema, or its rows do not make a schedule.
    """
    source = Path(path)
    try:
        if source.stat().st_size > LARGEST_FILE:
            raise InputError(f"{source} is larger than {LARGEST_FILE // 1_000_000} MB: it is not a schedule file.")
        given = msgspec.json.decode(source.read_bytes(), type=_File)
    except OSError as error:
        raise InputError(f"cannot read {source}: {error.strerror or error}; give a schedule.json.") from None
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{source}: not a {SCHEDULE_SCHEMA} file: {error}.") from None
    if given.schema != SCHEDULE_SCHEMA:
        raise InputError(f"{source}: its schema is {given.schema!r}: this version reads {SCHEDULE_SCHEMA!r}.")
    try:
        table = {tuple(row.at): Modes(row.modes) for row in given.rows}
        shapers = {tuple(row.at): Shaper.from_dict(row.shaper) for row in given.rows if row.shaper is not None}
        return Schedule(table, given.order, outside=outside, shapers=shapers)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None
