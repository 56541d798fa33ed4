"""A record found again in a report, HTML or PDF: with limits, checked, never evaluated."""

from __future__ import annotations

import hashlib
import os
import re
import stat
import time
import zlib
from pathlib import Path

import msgspec

from preshape.errors import InputError
from preshape.report.document import printable
from preshape.report.html import RECORD_TYPE
from preshape.report.record import REPORT_SCHEMA, Record, RecordedFile

__all__ = ["read_record", "unpacked"]

LARGEST_REPORT = 100_000_000
"""Bytes; the inputs that travel in a report take at most a tenth, its figures a few megabytes."""

LARGEST_RECORD = 50_000_000
"""Bytes of the record in a PDF, where it is compressed."""

LARGEST_INPUT = 200_000_000
"""Bytes of an input once unpacked; no measurement file may be larger."""

OPENING, CLOSING = f'<script type="{RECORD_TYPE}">'.encode(), b"</script>"

ATTACHED, STREAM = b"/Type/EmbeddedFile", re.compile(rb"stream\r?\n")
"""How Typst names an attachment, and what follows on its description."""

DESCRIPTION = 1_000
"""Bytes within which the attachment begins."""

DAY_AND_TIME = "%Y-%m-%dT%H:%M:%SZ"

LONGEST_NAME = 255
"""Bytes that a file system takes."""

DIGEST = re.compile(r"[0-9a-f]{64}")


def read_record(path: str | os.PathLike[str]) -> tuple[Record, bytes]:
    """The record in a report, and the whole report as it is.

    Raises
    ------
    InputError
        If the file cannot be read, is no report, is truncated, or its record is not of the schema.
    """
    source = Path(path)
    whole = _whole(source)
    text = _from_pdf(source, whole) if whole.startswith(b"%PDF-") else _from_html(source, whole)
    try:
        record = msgspec.json.decode(text, type=Record)
    except (msgspec.DecodeError, UnicodeDecodeError, RecursionError) as error:
        raise InputError(
            f"{source}: its record is damaged or was changed ({printable(str(error))}): take the original."
        ) from None
    if record.schema != REPORT_SCHEMA:
        raise InputError(f"{source}: its record is {record.schema!r}, and this version reads {REPORT_SCHEMA!r}.")
    if not _is_date(record.made) or "preshape" not in record.versions:
        raise InputError(f"{source}: its record was changed: it does not say when and by which preshape it was made.")
    for one in record.inputs:
        _check(source, one)
    return record, whole


def unpacked(one: RecordedFile) -> bytes | None:
    """The bytes of an input, None if it did not travel along; InputError when they are not what the record says."""
    if one.packed is None:
        return None
    stream = zlib.decompressobj()
    try:
        content = stream.decompress(one.packed, one.size + 1)  # one byte more than it may have: a bomb stops there
    except zlib.error as error:
        raise InputError(f"the input {one.name} in the report is damaged ({error}): take the original.") from None
    if len(content) != one.size or not stream.eof:
        raise InputError(
            f"the input {one.name} in the report does not have the {one.size} bytes that the report says: it was "
            "changed; take the original report."
        )
    if hashlib.sha256(content).hexdigest() != one.sha256:
        raise InputError(
            f"the input {one.name} in the report does not have the SHA-256 that the report says: one of them was "
            "changed; take the original report."
        )
    return content


def _whole(source: Path) -> bytes:
    try:
        status = source.stat()
        if not stat.S_ISREG(status.st_mode):
            raise InputError(f"{source} is not a regular file: give a report.html or report.pdf of preshape.")
        if status.st_size > LARGEST_REPORT:
            raise InputError(
                f"{source} has {status.st_size / 1e6:.0f} MB, and no report of preshape has more than "
                f"{LARGEST_REPORT / 1e6:.0f} MB: give a report.html or report.pdf of preshape."
            )
        return source.read_bytes()
    except OSError as error:
        raise InputError(f"cannot read {source}: {error.strerror or error}.") from None


def _from_html(source: Path, whole: bytes) -> bytes:
    _, found, rest = whole.partition(OPENING)
    text, closed, after = rest.partition(CLOSING)
    if not found:
        raise InputError(f"{source} holds no record of preshape: it is another page, or was truncated.")
    if not closed or not after.rstrip().endswith(b"</html>"):
        raise InputError(f"{source} is truncated: take the original report.")
    if OPENING in after:
        raise InputError(f"{source} holds two records: it was changed; take the original report.")
    return text


def _from_pdf(source: Path, whole: bytes) -> bytes:
    if not whole.rstrip().endswith(b"%%EOF"):
        raise InputError(f"{source} is truncated: take the original report.")
    count, place = whole.count(ATTACHED), whole.find(ATTACHED)
    begin = STREAM.search(whole, place, place + DESCRIPTION)
    if count != 1 or begin is None:
        raise InputError(
            f"{source} holds {count} attachments, and a report of preshape holds one: it is another PDF, or was "
            "written anew by another program."
        )
    stream = zlib.decompressobj()
    try:
        text = stream.decompress(whole[begin.end() :], LARGEST_RECORD)
    except zlib.error as error:
        raise InputError(f"{source}: its record is damaged ({error}): take the original report.") from None
    if not stream.eof:
        raise InputError(f"{source}: its record is truncated, or larger than any that preshape writes.")
    return text


def _is_date(text: str) -> bool:
    """Whether it is a date as reports write it, and in the calendar."""
    try:
        return time.strftime(DAY_AND_TIME, time.strptime(text, DAY_AND_TIME)) == text
    except ValueError:
        return False


def _check(source: Path, one: RecordedFile) -> None:
    named = one.name not in ("", ".", "..") and printable(one.name) == one.name and not set(one.name) & set("/\\\n\t")
    if not (
        named
        and len(one.name.encode()) <= LONGEST_NAME
        and 0 <= one.size <= LARGEST_INPUT
        and DIGEST.fullmatch(one.sha256)
    ):
        raise InputError(
            f"{source}: the input {one.name!r} of {one.size} bytes in its record is none that preshape wrote: the "
            "report was changed."
        )
