"""Impulses for whatever reads columns or objects: CSV and JSON, every digit that a double has."""

from __future__ import annotations

import csv

import msgspec

from preshape.errors import InputError
from preshape.export.settings_target import SettingsTarget, Written
from preshape.export.target import Limits
from preshape.provenance import Design
from preshape.shaper import Shaper
from preshape.shaper_file import to_json

__all__ = ["CSV", "JSON"]

TITLES = ["time_s", "amplitude"]
MOST = 20_000
LIMITS = Limits(taps=MOST, resolution="every bit")
TABLE = Design("table")


class _Impulses(msgspec.Struct):
    times: list[float]
    amplitudes: list[float]


def _write_csv(shaper: Shaper, version: str, axes: tuple[str, ...]) -> Written:
    rows = [f"{time!r},{amplitude!r}" for time, amplitude in _pairs(shaper)]
    return Written("\n".join([",".join(TITLES), *rows]) + "\n")


def _run_csv(text: str, version: str, axis: str | None = None) -> Shaper:
    _one_shaper(axis)
    rows = [row for row in csv.reader(line for line in text.splitlines() if not line.startswith("#")) if row]
    if not rows or rows[0] != TITLES or not 1 < len(rows) <= MOST + 1:
        raise InputError(f"the table must begin with {','.join(TITLES)} and hold 1 to {MOST} rows.")
    if any(len(row) != len(TITLES) for row in rows):
        raise InputError(f"every row must hold {' and '.join(TITLES)}, and nothing else.")
    try:
        times, amplitudes = zip(*((float(time), float(amplitude)) for time, amplitude in rows[1:]), strict=True)
    except ValueError:
        raise InputError("the table holds something that is no number.") from None
    return Shaper(times, amplitudes, TABLE)


def _write_json(shaper: Shaper, version: str, axes: tuple[str, ...]) -> Written:
    return Written(to_json({"times": shaper.times.tolist(), "amplitudes": shaper.amplitudes.tolist()}))


def _run_json(text: str, version: str, axis: str | None = None) -> Shaper:
    _one_shaper(axis)
    try:
        found = msgspec.json.decode(text, type=_Impulses)
    except (msgspec.MsgspecError, UnicodeError) as error:
        raise InputError(f"this is no object with times and amplitudes ({error}).") from None
    return Shaper(found.times, found.amplitudes, TABLE)


def _pairs(shaper: Shaper) -> list[tuple[float, float]]:
    return list(zip(shaper.times.tolist(), shaper.amplitudes.tolist(), strict=True))


def _one_shaper(axis: str | None) -> None:
    if axis is not None:
        raise InputError("a table holds one shaper: leave the axis out.")


CSV = SettingsTarget(
    "csv",
    "a table of times [s] and amplitudes [-] for other software",
    ("1",),
    LIMITS,
    _write_csv,
    _run_csv,
    ".csv",
    "#",
)
JSON = SettingsTarget(
    "json",
    "an object with times [s] and amplitudes [-] for other software",
    ("1",),
    LIMITS,
    _write_json,
    _run_json,
    ".json",
    "",
)
