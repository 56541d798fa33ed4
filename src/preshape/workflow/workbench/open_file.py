"""The workbench that a file opens: a shaper's own design, or the modes of a measurement."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from preshape.design import ASKED_FAMILIES, OPTIONS, needed_by, taken_by
from preshape.errors import InputError
from preshape.identify.source_file import open_source
from preshape.shaper import Shaper
from preshape.workflow.workbench.measurement import measured
from preshape.workflow.workbench.state import MOST_MODES, AskedDesign, Workbench

__all__ = ["Opened", "opened_file"]


@dataclass(frozen=True)
class Opened:
    """What a file opens.

    Parameters
    ----------
    workbench : Workbench
        With its modes, and its design if it is a shaper.
    dropped : (str, bytes) or None
        Name and content of a measurement, to be shown.
    """

    workbench: Workbench
    dropped: tuple[str, bytes] | None = None


def opened_file(path: str | os.PathLike[str]) -> Opened:
    """Open a shaper's JSON file or a measurement.

    Raises
    ------
    InputError
        If it is neither, has no modes, or has more than the workbench holds.

    Examples
    --------
    >>> opened = opened_file("examples/data/gantry_x.csv")
    >>> [round(mode.frequency) for mode in opened.workbench.modes]
    [47, 79]
    """
    source = open_source(path)
    if Path(source.name).suffix.lower() == ".json":
        return Opened(_of_shaper(Shaper.load(path), source.name))
    content = source.data()
    name = Path(source.name).name
    found = measured(content, name)
    modes = tuple(one.mode for one in found.modes)
    return Opened(Workbench(modes) if modes else Workbench(), (name, content))


def _of_shaper(shaper: Shaper, name: str) -> Workbench:
    """Modes and family of its record; of a family that cannot be asked for by name, the modes only."""
    design = shaper.design
    if design.modes is None:
        raise InputError(f"{name}: the shaper does not say its modes; give a measurement, or design it anew.")
    if len(design.modes) > MOST_MODES:
        raise InputError(f"{name}: the shaper has {len(design.modes)} modes and the studio holds {MOST_MODES}.")
    modes = tuple(design.modes)
    if design.family not in ASKED_FAMILIES:
        return Workbench(modes)
    taken = taken_by(design.family, design.settings)
    options = {key: value for key, value in design.settings.items() if key in taken and key in OPTIONS}
    if needed_by(design.family, options) - options.keys():
        return Workbench(modes)
    try:
        return Workbench(modes, (AskedDesign("A", design.family, tuple(options.items())),))
    except InputError:  # settings that a workbench cannot hold, such as one order a mode
        return Workbench(modes)
