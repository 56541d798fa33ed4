"""A file from outside: opened with limits, looked at from both ends, read in a stream, never evaluated.

Readers decide by its first bytes or lines. Large tables are parsed as they stream by, so that a file need not fit into
memory beside the numbers in it.
"""

from __future__ import annotations

import io
import os
import stat
from collections.abc import Generator
from dataclasses import dataclass, field
from functools import cached_property
from itertools import islice
from pathlib import Path
from typing import BinaryIO

from preshape.errors import MeasurementError

__all__ = ["MAXIMUM_FILE_SIZE", "MOST_NUMBERS", "SourceFile", "open_source", "source_in_memory"]

MAXIMUM_FILE_SIZE = 200_000_000
"""Files of this size [bytes] and above are refused before anything is read (about 80 minutes of Klipper raw data)."""

MOST_NUMBERS = MAXIMUM_FILE_SIZE // 8
"""Numbers that a binary file may hold: in memory each takes eight bytes, however short it is in the file."""

BEGINNING = 65_536
"""Bytes at the beginning in which comments, header and first rows of a text file must stand."""

ENDING = 4_096
"""Bytes at the end that are looked at for a trailer or a number that was cut."""

BUFFER = 1 << 20
MARK = b"\xef\xbb\xbf"
"""The byte order mark that some programs put before UTF-8 text."""


@dataclass(frozen=True)
class SourceFile:
    """A regular file below the size limit, or one that is in memory only.

    Attributes
    ----------
    name : str
        The path as the user gave it, for messages.
    size : int
        Bytes.
    begin : bytes
        The first of them.
    content : bytes or None
        All of them, of a file in memory: nothing is read from a disk then.
    """

    name: str
    size: int
    begin: bytes
    content: bytes | None = field(default=None, repr=False)

    @cached_property
    def head(self) -> list[str]:
        """The first lines, without their ends; raises MeasurementError for a file that is not text."""
        if b"\0" in self.begin:
            raise MeasurementError(
                f"{self.name}: the file is binary, and not of a binary format that is known; "
                "give the measurement as CSV."
            )
        begin = self.begin
        if self.size > len(begin):  # the last line is cut, perhaps within a character
            begin = begin[: max(begin.rfind(b"\n"), begin.rfind(b"\r")) + 1] or begin
        try:
            text = begin.decode("utf-8-sig")
        except UnicodeDecodeError as error:
            raise MeasurementError(
                f"{self.name}: the file is not text (byte {error.start} is not UTF-8), and not of a binary format that "
                "is known; give the measurement as CSV."
            ) from None
        return _lines(text)

    @cached_property
    def tail(self) -> list[str]:
        """The last lines that are not blank."""
        with self.open() as stream:
            stream.seek(max(self.size - ENDING, 0))
            lines = _lines(stream.read(ENDING).decode("utf-8", errors="replace"))
        return [line for line in lines[self.size > ENDING :] if line.strip()]

    def lines(self, first: int = 0) -> Generator[str, None, None]:
        """The lines from index `first` on, as they stream by; close it where not all of them are taken."""
        with self.open() as stream:
            if stream.read(len(MARK)) != MARK:
                stream.seek(0)
            try:
                with io.TextIOWrapper(stream, encoding="utf-8") as text:
                    yield from islice(text, first, None)
            except UnicodeDecodeError:
                raise MeasurementError(
                    f"{self.name}: the file is not text throughout (some of its bytes are not UTF-8); "
                    "give the measurement as CSV."
                ) from None
            except OSError as error:
                raise self._unreadable(error) from None

    def data(self) -> bytes:
        """All bytes; no more than the size that was checked."""
        if self.content is not None:
            return self.content
        if self.size <= len(self.begin):
            return self.begin
        with self.open() as stream:
            try:
                return stream.read(self.size)
            except OSError as error:
                raise self._unreadable(error) from None

    def open(self) -> BinaryIO:
        """The file as a stream of bytes."""
        if self.content is not None:
            return io.BytesIO(self.content)
        try:
            return Path(self.name).open("rb", buffering=BUFFER)
        except OSError as error:
            raise self._unreadable(error) from None

    def _unreadable(self, error: OSError) -> MeasurementError:
        return MeasurementError(f"{self.name}: the file cannot be read ({_reason(error)}); check its permissions.")


def open_source(path: str | os.PathLike[str]) -> SourceFile:
    """The file at a path, checked; raises MeasurementError where it cannot be a measurement."""
    source = os.fspath(path)
    try:
        status = os.stat(source)
    except FileNotFoundError:
        raise MeasurementError(f"{source}: there is no such file; check the path.") from None
    except (OSError, ValueError) as error:
        raise MeasurementError(f"{source}: the file cannot be opened ({_reason(error)}); check the path.") from None
    if stat.S_ISDIR(status.st_mode):
        raise MeasurementError(f"{source}: this is a directory; give the measurement file in it.")
    if not stat.S_ISREG(status.st_mode):
        raise MeasurementError(f"{source}: this is not a regular file; give a measurement file.")
    _check_size(source, status.st_size)
    with SourceFile(source, status.st_size, b"").open() as stream:
        begin = stream.read(BEGINNING)
    _check_begin(source, status.st_size, begin)
    return SourceFile(source, status.st_size, begin)


def source_in_memory(content: bytes, name: str) -> SourceFile:
    """A file that came over a network and is in memory; `name` is for messages. Raises as :func:`open_source` does."""
    _check_size(name, len(content))
    begin = content[:BEGINNING]
    _check_begin(name, len(content), begin)
    return SourceFile(name, len(content), begin, content)


def _check_size(name: str, size: int) -> None:
    if size >= MAXIMUM_FILE_SIZE:
        raise MeasurementError(
            f"{name}: the file has {size / 1e6:.0f} MB and the limit is below {MAXIMUM_FILE_SIZE / 1e6:.0f} MB; "
            "cut the part that holds the vibration."
        )


def _check_begin(name: str, size: int, begin: bytes) -> None:
    if not begin.strip() and size <= BEGINNING:
        raise MeasurementError(f"{name}: the file is empty; record the measurement again.")


def _lines(text: str) -> list[str]:
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n")


def _reason(error: Exception) -> str:
    """The operating system's words for what went wrong, without the path."""
    return str(getattr(error, "strerror", None) or error).lower()
