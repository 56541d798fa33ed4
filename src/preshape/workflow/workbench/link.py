"""A workbench as plain data and as a short text for a link: JSON, compressed, in letters that a URL takes as they are.

A link comes from outside: its length is limited before and after decompression, its schema has a version, and fields
that are not known are refused.
"""

from __future__ import annotations

import base64
import binascii
import re
import zlib
from typing import Any

import msgspec

from preshape.band import Band
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.workflow.workbench.state import AskedDesign, Controller, Move, Plant, Workbench

__all__ = ["LONGEST_TEXT", "SCHEMA", "from_plain", "from_text", "to_plain", "to_text"]

SCHEMA = "preshape/workbench/1"

LONGEST_TEXT = 8_000
"""Characters of a link's text; four designs for twelve modes take about a thousand."""

LONGEST_DATA = 50_000
"""Bytes of it, decompressed."""

LETTERS = re.compile(r"[A-Za-z0-9_-]*")

LINK_BROKEN = "the link does not hold a workbench: copy it again, from its first letter to its last."


class _Design(msgspec.Struct, forbid_unknown_fields=True):
    name: str
    family: str
    options: dict[str, float | int | str | bool] = {}
    bands: list[tuple[float, float, float, float]] = []
    band_width: float = 0.2


class _Plant(msgspec.Struct, forbid_unknown_fields=True):
    kind: str = "driven"
    gains: list[float] = []


class _Move(msgspec.Struct, forbid_unknown_fields=True):
    distance: float = 0.1
    speed: float = 0.5
    acceleration: float = 5.0
    kind: str = "trapezoid"


class _Controller(msgspec.Struct, forbid_unknown_fields=True):
    most_impulses: int | None = None
    longest: float | None = None
    negative: bool = True


class _Workbench(msgspec.Struct, forbid_unknown_fields=True):
    schema: str
    modes: list[tuple[float, float]]
    designs: list[_Design] = []
    plant: _Plant = msgspec.field(default_factory=_Plant)
    move: _Move = msgspec.field(default_factory=_Move)
    controller: _Controller = msgspec.field(default_factory=_Controller)


def to_plain(workbench: Workbench) -> dict[str, Any]:
    """The workbench as plain data, schema ``preshape/workbench/1``.

    Examples
    --------
    >>> to_plain(Workbench((Mode(10.0, 0.02),), ()))["modes"]
    [[10.0, 0.02]]
    """
    move, controller = workbench.move, workbench.controller
    return {
        "schema": SCHEMA,
        "modes": [[mode.frequency, mode.damping] for mode in workbench.modes],
        "designs": [
            {
                "name": asked.name,
                "family": asked.family,
                "options": dict(asked.options),
                "bands": [[band.low, band.high, band.least_damping, band.highest_damping] for band in asked.bands],
                "band_width": asked.band_width,
            }
            for asked in workbench.designs
        ],
        "plant": {"kind": workbench.plant.kind, "gains": list(workbench.plant.gains)},
        "move": {
            "distance": move.distance,
            "speed": move.speed,
            "acceleration": move.acceleration,
            "kind": move.kind,
        },
        "controller": {
            "most_impulses": controller.most_impulses,
            "longest": controller.longest,
            "negative": controller.negative,
        },
    }


def from_plain(data: object) -> Workbench:
    """The workbench of :func:`to_plain`; InputError where the data are not of that schema or cannot be a state."""
    try:
        return _workbench(msgspec.convert(data, _Workbench))
    except msgspec.ValidationError as error:
        raise InputError(f"the data are not a workbench ({error}): it has the schema {SCHEMA}.") from None


def to_text(workbench: Workbench) -> str:
    """The workbench as letters, digits, - and _, for a link.

    Examples
    --------
    >>> bench = Workbench((Mode(10.0, 0.02), Mode(31.0, 0.01)))
    >>> from_text(to_text(bench)) == bench
    True
    """
    data = msgspec.json.encode(to_plain(workbench))
    return base64.urlsafe_b64encode(zlib.compress(data, 9)).rstrip(b"=").decode()


def from_text(text: str) -> Workbench:
    """The workbench in a link's text.

    Raises
    ------
    InputError
        If the text is too long, damaged, of another version, or holds what a workbench cannot be.
    """
    if len(text) > LONGEST_TEXT:
        raise InputError(f"the link has {len(text)} characters and a workbench takes at most {LONGEST_TEXT}.")
    if not text or not LETTERS.fullmatch(text):
        raise InputError(LINK_BROKEN)
    try:
        packed = base64.urlsafe_b64decode(text + "=" * (-len(text) % 4))
        opened = zlib.decompressobj()
        data = opened.decompress(packed, LONGEST_DATA)
    except (binascii.Error, ValueError, zlib.error):
        raise InputError(LINK_BROKEN) from None
    if not opened.eof or opened.unused_data:
        raise InputError(LINK_BROKEN)
    try:
        return _workbench(msgspec.json.decode(data, type=_Workbench))
    except (msgspec.MsgspecError, UnicodeDecodeError):
        raise InputError("the link was made by another version of preshape, or changed: make it again.") from None


def _workbench(given: _Workbench) -> Workbench:
    if given.schema != SCHEMA:
        raise InputError(f"the data say schema {given.schema[:40]!r}: a workbench has {SCHEMA!r}.")
    return Workbench(
        modes=tuple(Mode(*pair) for pair in given.modes),
        designs=tuple(
            AskedDesign(
                one.name,
                one.family,
                tuple(one.options.items()),
                tuple(Band(*band) for band in one.bands),
                one.band_width,
            )
            for one in given.designs
        ),
        # The states refuse kinds that are not theirs.
        plant=Plant(given.plant.kind, tuple(given.plant.gains)),  # type: ignore[arg-type]
        move=Move(given.move.distance, given.move.speed, given.move.acceleration, given.move.kind),  # type: ignore[arg-type]
        controller=Controller(given.controller.most_impulses, given.controller.longest, given.controller.negative),
    )
