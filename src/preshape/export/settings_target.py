"""A target that takes settings instead of samples: text in its words, and what the controller does with them.

`write` puts a shaper into words, `execute` knows what the controller makes of such words, whoever wrote them. So the
shaper of an export is never what was meant, but what its text does; rounding, approximation and the firmware's own
slips included.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from preshape.errors import InputError
from preshape.export.target import Files, Limits
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = ["Configured", "Execute", "SettingsTarget", "Written", "text_among"]

LARGEST_TEXT = 1_000_000
"""Characters; settings are a page or two."""

MARK = re.compile(r"preshape export: (\S{1,40}) version (\S{1,40})")
"""What the first line of every export says, after the target's sign for a comment."""


class Execute(Protocol):
    """What a controller does with settings."""

    def __call__(self, text: str, version: str, axis: str | None = None) -> Shaper:
        """The impulses that are executed; InputError where the controller would refuse, or nothing is set.

        Parameters
        ----------
        text : str
            The settings, among whatever else stands in the file.
        version : str
            Of the controller's firmware.
        axis : str, optional
            Which one; by default the only one that is set, or all where they are set alike.
        """


@dataclass(frozen=True)
class Written:
    """A shaper in a target's words.

    Parameters
    ----------
    text : str
        The settings, without the comment that heads the file.
    notes : tuple of str
        What was changed or chosen, a sentence each.
    beside : mapping of str to str
        More files that the target needs, by name.
    """

    text: str
    notes: tuple[str, ...] = ()
    beside: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Configured:
    """A shaper as settings, and as the controller executes them.

    Parameters
    ----------
    shaper : Shaper
        What the controller will do; the modes in its record are those of ``asked``.
    asked : Shaper
        What was to be exported.
    name : str
        What the file is called.
    version : str
        One of the target's versions.
    axes : tuple of str
        Which axes are set; empty where the target has one shaper for everything.
    notes : tuple of str
        What was changed or chosen, a sentence each.
    """

    shaper: Shaper
    asked: Shaper
    name: str
    version: str
    axes: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @property
    def residuals(self) -> tuple[tuple[float, float], ...]:
        """For each mode what the controller leaves and what the shaper asked for leaves [-]; empty without modes."""
        if (modes := self.asked.design.modes) is None:
            return ()
        frequencies, dampings = np.array([(mode.frequency, mode.damping) for mode in modes]).T
        left = [residual_vibration(one, frequencies, dampings).tolist() for one in (self.shaper, self.asked)]
        return tuple(zip(*left, strict=True))


@dataclass(frozen=True)
class SettingsTarget:
    """One way out, in the words of a controller.

    Parameters
    ----------
    name : str
        What the command line calls it.
    summary : str
        One line on what comes out, and where it goes.
    versions : tuple of str
        Of the controller's firmware, the default first.
    limits : Limits
        What it can hold.
    write : callable
        (shaper, version, axes) -> :class:`Written`. The shaper is within the limits.
    execute : Execute
        What the controller does with settings.
    ending : str
        Of the file's name.
    comment : str
        What begins a comment; empty where there are none.
    axes : tuple of str
        That have a shaper each; empty where one serves all.
    other_limits : mapping of str to Limits
        Versions that hold something else.
    next_step : callable
        What the user does with the files, as lines of text.
    """

    name: str
    summary: str
    versions: tuple[str, ...]
    limits: Limits
    write: Callable[[Shaper, str, tuple[str, ...]], Written]
    execute: Execute
    ending: str
    comment: str
    axes: tuple[str, ...] = ()
    other_limits: Mapping[str, Limits] = field(default_factory=dict)
    next_step: Callable[[Configured], tuple[str, ...]] = field(default=lambda configured: ())

    def limits_of(self, version: str) -> Limits:
        """What a version can hold."""
        return self.other_limits.get(version, self.limits)

    def parse(self, files: Files, axis: str | None = None) -> Shaper:
        """What the controller does with exported files; InputError when there are no such settings."""
        text = text_among(files, self.ending)
        mark = MARK.search(text[:200])
        if mark is not None and (mark[1] != self.name or mark[2] not in self.versions):
            raise InputError(f"the file is for target {mark[1]} {mark[2]}: give one for target {self.name}.")
        return self.execute(text, self.versions[0] if mark is None else mark[2], axis)


def text_among(files: Files, ending: str) -> str:
    """The only file whose name ends like this, as text; InputError when there is not one."""
    named = [name for name in files if name.endswith(ending)]
    if len(named) != 1:
        raise InputError(f"{len(named)} files end in {ending}: give the files of one export.")
    content = files[named[0]]
    if len(content) > LARGEST_TEXT:
        raise InputError(f"{named[0]} is larger than {LARGEST_TEXT // 1_000_000} MB: it holds more than settings.")
    try:
        return content.decode() if isinstance(content, bytes) else content
    except UnicodeDecodeError:
        raise InputError(f"{named[0]} is not text: give the file that preshape export wrote.") from None
