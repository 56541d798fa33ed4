"""An FMU as a zip file: written the same from the same content, read with limits."""

from __future__ import annotations

import io
import zipfile
import zlib
from collections.abc import Mapping

from preshape.errors import InputError

__all__ = ["names_in", "packed", "unpacked"]

FIRST_DAY = (1980, 1, 1, 0, 0, 0)
"""The earliest time a zip file can say: the content decides the bytes, not the clock."""

MOST_PACKED, MOST_ENTRIES, MOST_UNPACKED = 50_000_000, 1000, 10_000_000
"""Bytes of an FMU, entries in it, and bytes of one entry that is read."""

DAMAGED = (
    zipfile.BadZipFile,  # no zip file, or a checksum that differs
    zlib.error,  # what was packed is not
    EOFError,  # it ends within an entry
    RuntimeError,  # an entry is encrypted, or (NotImplementedError) of another zip's version
    ValueError,  # a directory that points before the file's beginning, or (UnicodeDecodeError) no text
)
"""What zipfile raises for files that are damaged; every one is seen when each byte of a small FMU is changed."""


def packed(entries: Mapping[str, str | bytes]) -> bytes:
    """The zip file of some entries, sorted by name."""
    whole = io.BytesIO()
    with zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED, compresslevel=9) as archive:
        for name in sorted(entries):
            info = zipfile.ZipInfo(name, FIRST_DAY)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.create_system = 3  # Unix, whose permissions follow
            info.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            archive.writestr(info, entries[name])
    return whole.getvalue()


def names_in(content: bytes) -> list[str]:
    """The names of the entries."""
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return archive.namelist()


def unpacked(content: bytes, *names: str) -> list[str]:
    """The text of some entries; InputError when it is no FMU of ours or beyond the limits."""
    if len(content) > MOST_PACKED:
        raise InputError(f"the FMU has {len(content):,} bytes: up to {MOST_PACKED:,} are read.")
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            if len(archive.infolist()) > MOST_ENTRIES:
                raise InputError(f"the FMU has {len(archive.infolist())} entries: up to {MOST_ENTRIES} are read.")
            return [_text(archive, name) for name in names]
    except InputError:
        raise
    except KeyError:
        raise InputError(f"the FMU holds no {' and '.join(names)}: give one that preshape wrote.") from None
    except DAMAGED as error:
        raise InputError(f"the FMU is damaged ({error or 'it ends too early'}): export it again.") from None


def _text(archive: zipfile.ZipFile, name: str) -> str:
    if archive.getinfo(name).compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
        raise InputError(f"{name} in the FMU is packed in a way that preshape does not use: export it again.")
    with archive.open(name) as stream:  # what the directory says of its size may be wrong
        data = stream.read(MOST_UNPACKED + 1)
    if len(data) > MOST_UNPACKED:
        raise InputError(
            f"{name} in the FMU is longer than {MOST_UNPACKED:,} bytes: it is not one that preshape wrote."
        )
    return data.decode("utf-8")
