"""What the tests of exports share: shapers of every family, and an export in a folder."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from tests.laws import FAMILIES

from preshape import Modes, Shaper
from preshape.export import TARGETS, Exported, SettingsTarget

MODES = Modes([(10.0, 0.02), (27.0, 0.05)])
NAMES = [family.name for family in FAMILIES]
DT = 0.0013


@cache
def shaper_of(name: str) -> Shaper:
    """The family's shaper for two modes, made once."""
    return next(family for family in FAMILIES if family.name == name).build(MODES)


def written(exported: Exported, folder: Path) -> Path:
    """The files of an export in `folder`."""
    folder.mkdir(exist_ok=True)
    for name, content in exported.files.items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder


def executed(target: str, text: str, version: str | None = None, axis: str | None = None) -> Shaper:
    """What a target that takes settings does with a text."""
    chosen = TARGETS[target]
    assert isinstance(chosen, SettingsTarget)
    return chosen.execute(text, version or chosen.versions[0], axis)
