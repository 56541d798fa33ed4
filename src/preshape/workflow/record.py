"""What a report records of its making: the inputs with their SHA-256, the versions, the date."""

from __future__ import annotations

import hashlib
import os
import platform
import time
import zlib
from collections.abc import Iterable
from importlib.metadata import version
from pathlib import Path

from preshape.errors import InputError
from preshape.kernel import active_kernel
from preshape.report import Job, Record, RecordedFile, can_make_pdf, printable
from preshape.shaper import Shaper

__all__ = ["LARGEST_INPUTS", "current_versions", "new_record", "recorded_files"]

LARGEST_INPUTS = 32_000_000
"""Bytes of all inputs together that travel in a report."""

LARGEST_PACKED = 8_000_000
"""The same after compression; a page of more is no page to send around."""

COMPRESSION = 9

LONGEST_NAME = 240
"""Bytes of a file's name; of a longer one the end is kept."""

BUFFER = 1 << 20

LATEST_DATE = 253_402_300_799
"""The end of the year 9999 [s since 1970], the last that a date can name."""


def recorded_files(paths: Iterable[str | os.PathLike[str]]) -> tuple[RecordedFile, ...]:
    """Each file with its SHA-256; its bytes too, as long as all together are not too large to travel.

    Raises
    ------
    InputError
        If a file cannot be read.
    """
    found: list[RecordedFile] = []
    room, packed_room = LARGEST_INPUTS, LARGEST_PACKED
    for path in map(Path, paths):
        size, checksum = _measured(path)
        packed = zlib.compress(path.read_bytes(), COMPRESSION) if size <= room else None
        if packed is not None and len(packed) > packed_room:
            packed = None
        if packed is not None:
            room, packed_room = room - size, packed_room - len(packed)
        found.append(RecordedFile(name=_shown_name(path), size=size, sha256=checksum, packed=packed))
    return tuple(found)


def new_record(job: Job, shaper: Shaper, inputs: tuple[RecordedFile, ...] = (), command_line: str = "") -> Record:
    """The record of a job that was done here and now."""
    return Record(
        job=job,
        command_line=printable(command_line),
        made=_now(),
        versions=current_versions(),
        inputs=inputs,
        shaper=shaper.to_dict(),
    )


def _shown_name(path: Path) -> str:
    """The name of a file without what would lead out of a folder or to a second line."""
    name = printable(path.name)
    for bad in "\n\t/\\":
        name = name.replace(bad, "\N{REPLACEMENT CHARACTER}")
    return name if len(name.encode()) <= LONGEST_NAME else name[-LONGEST_NAME // 4 :]


def _measured(path: Path) -> tuple[int, str]:
    """Size and SHA-256, read in pieces: a recording may be larger than the memory that is free."""
    checksum, size = hashlib.sha256(), 0
    try:
        with path.open("rb") as stream:
            while piece := stream.read(BUFFER):
                checksum.update(piece)
                size += len(piece)
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}.") from error
    return size, checksum.hexdigest()


def current_versions() -> dict[str, str]:
    """Of preshape, and of everything that a shaper or a page may depend on."""
    sheets = ("typst",) if can_make_pdf() else ()
    return {
        "preshape": version("preshape"),
        "kernel": active_kernel(),
        "Python": platform.python_version(),
        **{name: version(name) for name in ("numpy", "scipy", "clarabel", "matplotlib", *sheets)},
        "platform": platform.platform(),
    }


def _now() -> str:
    """UTC; from SOURCE_DATE_EPOCH where that is set, so that a report can be made twice alike."""
    asked = os.environ.get("SOURCE_DATE_EPOCH", "")
    if not asked:
        return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime())
    if not (asked.isascii() and asked.isdigit() and int(asked) <= LATEST_DATE):
        raise InputError(
            f"SOURCE_DATE_EPOCH is {asked!r}: give the seconds since 1970 as a whole number, or unset the variable."
        )
    return time.strftime("%Y-%m-%dT%H:%M:%SZ", time.gmtime(int(asked)))
