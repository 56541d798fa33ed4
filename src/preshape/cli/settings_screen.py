"""The end of a calibration on the screen: the settings to paste, and who cannot hold the shaper."""

from __future__ import annotations

from pathlib import Path

from rich.text import Text

from preshape.cli.screens import console, indented
from preshape.report import Calibration
from preshape.workflow import SavedCalibration

__all__ = ["settings_screen"]

SHOWN_LINES = 2
"""A longer text is shown by its file."""


def settings_screen(calibration: Calibration, saved: SavedCalibration | None) -> None:
    """A line or two a firmware; `saved` says where the files are, if they were written."""
    if not calibration.texts:
        return
    screen = console()
    screen.print(Text("\nSettings to paste", style="bold"))
    for one in calibration.texts:
        head = f"{one.target} ({one.version})"
        if not one.fits:
            screen.print(indented(Text(f"{head}: does not fit: {one.note}", style="dim")))
            continue
        lines = one.text.splitlines()
        screen.print(indented(f"{head}: {one.note or 'as it is'}"))
        for path in () if saved is None else _files_of(one.target, saved):
            screen.print(f"    {path}", soft_wrap=True)
        if saved is None or len(lines) <= SHOWN_LINES:
            for line in lines:
                screen.print(f"    {line}", soft_wrap=True)


def _files_of(target: str, saved: SavedCalibration) -> list[Path]:
    return [path for path in saved.settings if path.parent.name == target]
