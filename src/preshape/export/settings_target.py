"""A target that takes settings instead of samples: text in its words, and what the controller does with them.

`write` puts a shaper into words, `run` knows what the controller makes of such words, whoever wrote them. So the
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
from preshape.export.read_back import only_text
from preshape.export.target import AnyTarget, Files, Limits
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = ["Configured", "Run", "Settings", "SettingsTarget", "Written"]

LARGEST_TEXT = 1_000_000
"""Characters; settings are a page or two."""

MARK = re.compile(r"preshape export: (\S{1,40}) version (\S{1,40})")
"""What the first line of every export says, after the target's sign for a comment."""


class Run(Protocol):
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
class Settings:
    """What stands in a file with settings.

    Parameters
    ----------
    text : str
        The settings, among whatever else stands there.
    version : str
        Of the firmware that they are for: what an export says of itself, otherwise the target's first.
    """

    text: str
    version: str


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
    excess : float
        The most vibration [-] that is left within 10 % of the modes beyond what the shaper leaves, where a setting that
        comes near it is written instead of its impulses.
    """

    text: str
    notes: tuple[str, ...] = ()
    beside: Mapping[str, str] = field(default_factory=dict)
    excess: float = 0.0


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
    excess : float
        As of :class:`Written`; 0 for a target that takes impulses.
    """

    shaper: Shaper
    asked: Shaper
    name: str
    version: str
    axes: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    excess: float = 0.0

    @property
    def residuals(self) -> tuple[tuple[float, float], ...]:
        """For each mode what the controller leaves and what the shaper asked for leaves [-]; empty without modes."""
        if (modes := self.asked.design.modes) is None:
            return ()
        frequencies, dampings = np.array([(mode.frequency, mode.damping) for mode in modes]).T
        left = [residual_vibration(one, frequencies, dampings).tolist() for one in (self.shaper, self.asked)]
        return tuple(zip(*left, strict=True))


@dataclass(frozen=True)
class SettingsTarget(AnyTarget):
    """One way out, in the words of a controller.

    Parameters
    ----------
    name, summary, versions, limits
        As of :class:`AnyTarget`.
    write : callable
        (shaper, version, axes) -> :class:`Written`. The shaper is within the limits.
    run : Run
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

    write: Callable[[Shaper, str, tuple[str, ...]], Written]
    run: Run
    ending: str
    comment: str
    axes: tuple[str, ...] = ()
    other_limits: Mapping[str, Limits] = field(default_factory=dict)
    next_step: Callable[[Configured], tuple[str, ...]] = field(default=lambda configured: ())

    def limits_of(self, version: str) -> Limits:
        """What a version can hold."""
        return self.other_limits.get(version, self.limits)

    def parse(self, files: Files | str) -> Settings:
        """The settings in exported files, or in a file of any name, or in a text; InputError when there are none."""
        named = {self.ending: files} if isinstance(files, str) else files
        text = only_text(named, "" if len(named) == 1 else self.ending, most=LARGEST_TEXT)
        mark = MARK.search(text[:200])
        if mark is not None and (mark[1] != self.name or mark[2] not in self.versions):
            raise InputError(f"the file is for target {mark[1]} {mark[2]}: give one for target {self.name}.")
        return Settings(text, self.versions[0] if mark is None else mark[2])

    def execute(self, files: Files | str, version: str | None = None, axis: str | None = None) -> Shaper:
        """As :class:`AnyTarget` says."""
        given = None if version is None else self.version_of(version)
        found = self.parse(files)
        return self.run(found.text, given or found.version, axis)
