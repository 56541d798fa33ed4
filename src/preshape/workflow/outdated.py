"""Results of an earlier run that this one does not have: set aside, so that nobody pastes or exports them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from preshape.export import TARGETS, SettingsTarget
from preshape.export.settings_target import MARK

__all__ = ["set_aside"]

ENDING = ".outdated"
"""What is appended to the name. Nothing is deleted: somebody may have edited the file."""

LARGEST = 1_000_000
"""Bytes; settings have fewer."""


def set_aside(folder: Path, names: Iterable[str], settings: Path, kept: Iterable[Path | None]) -> None:
    """Rename what a calibration left in `folder` under these names, and settings that bear our mark, but for `kept`."""
    old = {folder / name for name in names}
    for name, target in TARGETS.items():
        if isinstance(target, SettingsTarget):
            old |= {path for path in (settings / name).glob("*") if path.suffix != ENDING and _is_marked(path)}
    for path in old - set(kept):
        try:
            path.replace(path.with_name(path.name + ENDING))
        except OSError:
            continue  # not there, which is the usual case, or not ours to move


def _is_marked(path: Path) -> bool:
    """Klipper's module bears no mark, and may stay, for it holds no impulses."""
    try:
        return path.is_file() and path.stat().st_size < LARGEST and MARK.search(path.read_text()[:200]) is not None
    except (OSError, UnicodeDecodeError):
        return False
