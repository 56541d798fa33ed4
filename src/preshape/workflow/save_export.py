"""An export in a folder: all files or none, and nothing of the user's overwritten.

A small file beside them remembers the checksum of whatever was written. So a second export replaces the first one, and
a file that was there before, or was changed by hand since, is refused.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import shutil
import tempfile
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import msgspec

from preshape.errors import InputError
from preshape.export import Exported, ExportedSettings
from preshape.files import write_atomically

__all__ = ["SavedExport", "save_export"]

MEMORY = "preshape-export.json"
SCHEMA = "preshape/export/1"
LARGEST_MEMORY = 1_000_000


@dataclass(frozen=True)
class SavedExport:
    """Where the files are.

    Parameters
    ----------
    files : tuple of Path
        In the order of the export.
    """

    files: tuple[Path, ...]


class _Memory(msgspec.Struct):
    schema: str
    files: dict[str, str]


def save_export(
    exported: Exported | ExportedSettings, folder: str | os.PathLike[str], *, force: bool = False
) -> SavedExport:
    """Write the files of an export into `folder`, which is made if it does not exist.

    Parameters
    ----------
    exported : Exported or ExportedSettings
        From :func:`preshape.export.render`.
    folder : path
        Where to. Several exports may share it.
    force : bool
        Replace also files that an export did not write, or that were changed since.

    Raises
    ------
    InputError
        If such a file is in the way, or the folder cannot be made or written; then every file is what it was.
    """
    target = Path(folder)
    contents = {
        name: content.encode() if isinstance(content, str) else content for name, content in exported.files.items()
    }
    known = _remembered(target / MEMORY)
    if not force:
        _refuse_to_overwrite(target, contents, known)
    known |= {name: _checksum(content) for name, content in contents.items()}
    contents[MEMORY] = msgspec.json.format(msgspec.json.encode(_Memory(SCHEMA, known)), indent=2) + b"\n"
    new = not target.exists()
    try:
        target.mkdir(parents=True, exist_ok=True)
        _replace_all(target, contents)
    except BaseException as error:
        if new:
            with contextlib.suppress(OSError):
                target.rmdir()
        if isinstance(error, OSError):
            raise InputError(
                f"cannot write into {target}: {error.strerror or error}; choose a folder that can be written."
            ) from error
        raise
    return SavedExport(tuple(target / name for name in exported.files))


def _remembered(path: Path) -> dict[str, str]:
    """Checksums of what earlier exports wrote; InputError when the file is somebody else's."""
    try:
        if path.stat().st_size > LARGEST_MEMORY:
            raise InputError(f"{path} is larger than a megabyte: it is not of preshape export; choose another folder.")
        memory = msgspec.json.decode(path.read_bytes(), type=_Memory)
    except (FileNotFoundError, NotADirectoryError):
        return {}
    except OSError as error:
        raise InputError(f"cannot read {path}: {error.strerror or error}; choose another folder.") from None
    except (msgspec.MsgspecError, UnicodeDecodeError):
        memory = _Memory("", {})
    if memory.schema != SCHEMA:
        raise InputError(f"{path} is not of preshape export, which would overwrite it: choose another folder.")
    return memory.files


def _refuse_to_overwrite(folder: Path, contents: Mapping[str, bytes], known: Mapping[str, str]) -> None:
    for name, content in contents.items():
        path = folder / name
        try:
            there = _checksum(path.read_bytes())
        except (FileNotFoundError, NotADirectoryError):
            continue
        except OSError as error:
            raise InputError(f"cannot read {path}: {error.strerror or error}; choose another folder.") from None
        if there not in (known.get(name), _checksum(content)):
            raise InputError(
                f"{path} is there already and not as preshape export left it: nothing was written; choose another "
                "folder or name, or replace it with --force."
            )


def _replace_all(folder: Path, contents: Mapping[str, bytes]) -> None:
    """Write everything beside its place, then put it there; when that fails in the middle, put back what was there."""
    staged = Path(tempfile.mkdtemp(prefix=".preshape-export-", dir=folder))
    done: list[tuple[Path, Path | None]] = []
    try:
        for number, content in enumerate(contents.values()):
            write_atomically(staged / f"{number}.new", content)
        for number, name in enumerate(contents):
            place, old = folder / name, staged / f"{number}.old"
            place.parent.mkdir(parents=True, exist_ok=True)
            there = os.path.lexists(place)
            done.append((place, old if there else None))
            if there:
                os.replace(place, old)
            os.replace(staged / f"{number}.new", place)
    except BaseException:
        for place, before in reversed(done):
            with contextlib.suppress(OSError):
                place.unlink() if before is None else os.replace(before, place)
        raise
    finally:
        shutil.rmtree(staged, ignore_errors=True)


def _checksum(content: bytes) -> str:
    return f"sha256:{hashlib.sha256(content).hexdigest()}"
