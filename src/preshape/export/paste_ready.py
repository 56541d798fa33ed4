"""A shaper as text to paste, for every firmware whose settings can hold it."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from preshape.errors import InputError
from preshape.export.configure import ExportedSettings
from preshape.export.render import render
from preshape.export.settings_target import Configured, SettingsTarget
from preshape.export.target import Files
from preshape.export.targets import TARGETS
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = ["PasteText", "paste_ready"]

SETTINGS = (".cfg", ".g")
"""Endings of files that are pasted into a firmware's configuration."""

AROUND = np.linspace(0.9, 1.1, 21)
"""The modes may be off by these factors."""

POOR = 0.05
"""A firmware whose nearest setting leaves more vibration than the shaper, by more than this [-], cannot hold it."""

SEEN = 0.005
"""More vibration [-] than this is mentioned."""

LONGEST_REASON = 110


@dataclass(frozen=True)
class PasteText:
    """The text for one target, or why there is none.

    Parameters
    ----------
    target, version : str
        For whom.
    text : str
        The settings without their comments; empty when the shaper does not fit.
    note : str
        What is lost, or why the shaper does not fit; empty when the firmware does the same as the shaper.
    files : mapping of str to str or bytes
        To be written, each in a folder named after the target; empty when the shaper does not fit.
    """

    target: str
    version: str
    text: str
    note: str
    files: Files = field(repr=False, default_factory=dict)

    @property
    def fits(self) -> bool:
        """Whether there is a text."""
        return bool(self.files)


def paste_ready(shaper: Shaper, axis: str | None = None) -> tuple[PasteText, ...]:
    """The texts of every firmware that takes settings, in the order of :data:`preshape.export.TARGETS`.

    A firmware that only has families gets its nearest setting, unless that leaves clearly more vibration within 10 %
    of the shaper's modes than the shaper itself.

    Parameters
    ----------
    shaper : Shaper
        What was chosen.
    axis : str, optional
        "x", "y" or "z" for firmwares with settings for each; x and y are set alike unless given.

    Examples
    --------
    >>> import preshape
    >>> texts = {one.target: one for one in paste_ready(preshape.design.zv((50.0, 0.1)), axis="x")}
    >>> texts["klipper"].text.splitlines()
    ['[input_shaper]', 'shaper_type_x: zv', 'shaper_freq_x: 50.00', 'damping_ratio_x: 0.1000']
    >>> texts["rrf"].fits
    True
    """
    targets = (one for one in TARGETS.values() if isinstance(one, SettingsTarget) and one.ending in SETTINGS)
    return tuple(_text(target, shaper, axis) for target in targets)


def _text(target: SettingsTarget, shaper: Shaper, axis: str | None) -> PasteText:
    version, name = target.versions[0], target.name.replace("-", "_")
    try:
        exported = render(shaper, target.name, name=name, axis=axis if target.axes else None)
    except InputError as error:
        return PasteText(target.name, version, "", _short(str(error)))
    more = _more_left(exported.placed)
    if more > POOR:
        note = f"its nearest setting leaves up to {100.0 * more:.0f} % more of the vibration"
        return PasteText(target.name, version, "", note)
    note = f"nearest setting: up to {100.0 * more:.1f} % more of the vibration is left" if more > SEEN else ""
    files = {f"{target.name}/{file}": content for file, content in exported.files.items()}
    return PasteText(target.name, version, _without_comments(exported, name), note, files)


def _more_left(placed: Configured) -> float:
    """The most that the firmware leaves beyond what the shaper leaves, within 10 % of its modes [-]."""
    if (modes := placed.asked.design.modes) is None:
        return 0.0  # then only firmwares that take the impulses themselves got this far
    frequencies = np.array([mode.frequency for mode in modes])[:, np.newaxis] * AROUND
    dampings = np.array([[mode.damping] for mode in modes])
    does, wanted = (residual_vibration(one, frequencies, dampings) for one in (placed.shaper, placed.asked))
    return max(float((does - wanted).max()), 0.0)


def _without_comments(exported: ExportedSettings, name: str) -> str:
    comment = exported.target.comment
    settings = str(exported.files[f"{name}{exported.target.ending}"])
    return "\n".join(line for line in settings.splitlines() if line and not (comment and line.startswith(comment)))


def _short(reason: str) -> str:
    """The part of a refusal that says what is wrong; what to do stands behind the colon."""
    said = reason.split(": ")[0].rstrip(".")
    return said if len(said) <= LONGEST_REASON else f"{said[:LONGEST_REASON]} ..."
