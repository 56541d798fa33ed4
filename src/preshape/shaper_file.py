"""The schema ``preshape/shaper/1``: dataclasses to plain JSON data and back, with limits and clear refusals.

The fields are documented in docs/reference/shaper-file.md and stable.
"""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypeVar

import msgspec

from preshape.errors import InputError
from preshape.mode import Mode, Modes
from preshape.shaper_parts import Box

__all__ = ["SCHEMA", "boxes_from_plain", "from_plain", "read_json", "to_json", "to_plain"]

SCHEMA = "preshape/shaper/1"

MAXIMUM_FILE_SIZE = 10_000_000
"""Bytes; a shaper of 10,000 impulses takes half a megabyte."""

T = TypeVar("T")


def to_plain(value: object) -> Any:
    """A dataclass as dicts, lists and numbers."""
    return msgspec.to_builtins(value, enc_hook=_encode)


def from_plain(data: object, kind: type[T]) -> T:
    """The dataclass `kind` from plain data; InputError naming the first field that is wrong."""
    try:
        return msgspec.convert(data, kind, dec_hook=_decode)
    except msgspec.ValidationError as error:
        raise InputError(f"not a {SCHEMA} shaper: {error}.") from None


def boxes_from_plain(data: object) -> list[Box]:
    """Boxes from plain data, a list of start [s], end [s], density [1/s] by name."""
    rows = from_plain(data, list[dict[str, float]])
    if any(row.keys() != set(Box._fields) for row in rows):
        raise InputError(f"not a {SCHEMA} shaper: a box has the fields {', '.join(Box._fields)} and no others.")
    return [Box(**row) for row in rows]


def to_json(data: Mapping[str, Any]) -> str:
    """Indented JSON text that ends with a line feed; floats keep every digit."""
    return msgspec.json.format(msgspec.json.encode(data), indent=2).decode() + "\n"


def read_json(path: str | os.PathLike[str]) -> Any:
    """What a JSON file of limited size holds; InputError when it cannot be read or is not JSON."""
    source = Path(path)
    try:
        if source.stat().st_size > MAXIMUM_FILE_SIZE:
            raise InputError(
                f"{source} is larger than {MAXIMUM_FILE_SIZE // 1_000_000} MB: it is not a shaper file; give the "
                "shaper.json that preshape wrote."
            )
        text = source.read_bytes()
    except OSError as error:
        raise InputError(f"cannot read {source}: {error.strerror or error}.") from None
    try:
        return msgspec.json.decode(text)
    except (msgspec.DecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{source} is not JSON ({error}): give the shaper.json that preshape wrote.") from None


def _encode(value: object) -> Any:
    if isinstance(value, Modes):
        return [{"frequency": mode.frequency, "damping": mode.damping} for mode in value]
    if isinstance(value, complex):
        return [value.real, value.imag]
    if isinstance(value, MappingProxyType):
        return dict(value)
    raise TypeError(f"{type(value).__name__} has no place in a {SCHEMA} file.")


def _decode(kind: type, data: Any) -> Any:
    if kind is Modes:
        return Modes(msgspec.convert(data, list[Mode]))
    if kind is complex:
        real, imaginary = msgspec.convert(data, tuple[float, float])
        return complex(real, imaginary)
    raise TypeError(f"{kind.__name__} has no place in a {SCHEMA} file.")
