"""Writing files so that an interrupted run leaves either the old file or the new one, never half of one."""

from __future__ import annotations

import contextlib
import os
from pathlib import Path

from preshape.errors import InputError

__all__ = ["write_atomically"]


def write_atomically(path: str | os.PathLike[str], content: str | bytes) -> Path:
    """Write `content` to `path` through a temporary file beside it, which replaces `path` only when it is complete.

    Parameters
    ----------
    path : path-like
        Where to; its folder must exist.
    content : str or bytes
        Text is written as UTF-8.

    Raises
    ------
    InputError
        If the place cannot be written (no such folder, no permission, disk full); whatever was at `path` is untouched.
    """
    target = Path(path)
    data = content.encode() if isinstance(content, str) else content
    temporary = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        with open(temporary, "xb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(temporary, target)
    except OSError as error:
        raise InputError(
            f"cannot write {target}: {error.strerror or error}; choose a folder that exists and can be written."
        ) from error
    finally:
        with contextlib.suppress(OSError):
            temporary.unlink()
    return target
