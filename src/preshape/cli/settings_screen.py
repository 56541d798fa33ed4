"""The end of a calibration on the screen: the settings to paste, and who cannot hold the shaper."""

from __future__ import annotations

from rich.text import Text

from preshape.cli.screens import console
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
        head = f"  {one.target} ({one.version})"
        if not one.fits:
            screen.print(Text(f"{head}: does not fit: {one.note}", style="dim"))
            continue
        lines = one.text.splitlines()
        where = "" if saved is None else _file_of(one.target, saved)
        screen.print(f"{head}: {'; '.join(part for part in (where, one.note) if part) or 'as it is'}")
        if saved is None or len(lines) <= SHOWN_LINES:
            for line in lines:
                screen.print(f"    {line}", soft_wrap=True)


def _file_of(target: str, saved: SavedCalibration) -> str:
    return ", ".join(str(path) for path in saved.settings if path.parent.name == target)
