"""From a shaper to a target's words, and to what the controller does with them."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace

from preshape.design.each_mode import impulses_only, recorded
from preshape.errors import InputError
from preshape.export.settings_target import Configured, SettingsTarget
from preshape.export.target import Files, Limits
from preshape.shaper import Shaper

__all__ = ["ExportedSettings", "configured_for"]

DEFAULT_AXES = ("x", "y")

SAID = 1e-4
"""More vibration left than by the shaper asked for [-] that the file's head mentions."""


@dataclass(frozen=True)
class ExportedSettings:
    """What came out for a target that takes settings.

    Parameters
    ----------
    target : SettingsTarget
        For whom.
    placed : Configured
        What the controller will do.
    files : mapping of str to str or bytes
        Names and contents.
    """

    target: SettingsTarget
    placed: Configured
    files: Files = field(repr=False)


def configured_for(
    shaper: Shaper, target: SettingsTarget, version: str, name: str, axis: str | None
) -> ExportedSettings:
    """The files, and the shaper that the target makes of them; InputError when it does not fit the target's limits."""
    axes = _axes(target, axis)
    impulses_only(shaper, f"target {target.name}")
    _check(shaper, target.limits_of(version), f"target {target.name} ({version})")
    written = target.write(shaper, version, axes)
    does = target.run(written.text, version, axes[0] if axes else None)
    if shaper.design.modes is not None:  # what is left at the modes of the shaper, not at those of the setting
        settings = {**does.design.settings, "asked_for": shaper.design.family}
        does = recorded(does, replace(does.design, modes=shaper.design.modes, settings=settings))
    configured = Configured(does, shaper, name, version, axes, written.notes, written.excess)
    text = _head(target, configured) + written.text
    return ExportedSettings(target, configured, {f"{name}{target.ending}": text, **written.beside})


def _axes(target: SettingsTarget, axis: str | None) -> tuple[str, ...]:
    if not target.axes:
        if axis is not None:
            raise InputError(f"target {target.name} has one shaper for everything: leave the axis out.")
        return ()
    if axis is None:
        return tuple(one for one in DEFAULT_AXES if one in target.axes)
    if axis not in target.axes:
        raise InputError(f"axis {axis!r} is not known for target {target.name}: it is {', '.join(target.axes)}.")
    return (axis,)


def _check(shaper: Shaper, limits: Limits, target: str) -> None:
    count, size = len(shaper), float(abs(shaper.amplitudes).min())
    if limits.taps is not None and count > limits.taps:
        raise InputError(
            f"the shaper has {count} impulses and {target} holds {limits.taps}: design one with at most so many, by "
            f"preshape design --family si or mesh with --at-most {limits.taps}, or preshape calibrate --max-impulses "
            f"{limits.taps}."
        )
    if not limits.negative and float(shaper.amplitudes.min()) < 0.0:
        raise InputError(f"the shaper has negative impulses, which {target} cannot hold: design a positive one.")
    if size < limits.smallest:
        raise InputError(
            f"the shaper has an impulse of {size:.2g}, and {target} takes none below {limits.smallest:g}: design one "
            "with fewer impulses."
        )
    if count > 1 and not limits.shortest <= shaper.duration <= limits.longest:
        raise InputError(
            f"the shaper takes {shaper.duration:g} s, and {target} takes {limits.shortest:g} to {limits.longest:g} s."
        )


def _head(target: SettingsTarget, configured: Configured) -> str:
    """The comment that heads the file: for whom, for which modes, what is left, what was changed."""
    if not target.comment:
        return ""
    asked = configured.asked
    lines = [
        f"preshape export: {target.name} version {configured.version}",
        f"{_plain(asked.design.family)} shaper, {asked.parts} in {asked.duration:.6g} s",
    ]
    if asked.design.modes is None:
        lines.append("The modes it is for are not recorded.")
    for mode, (left, wanted) in zip(asked.design.modes or (), configured.residuals, strict=True):
        more = f", where the shaper itself leaves {100.0 * wanted:.2g} %" if abs(left - wanted) > SAID else ""
        lines.append(f"{mode}: {100.0 * left:.2g} % of the vibration is left{more}")
    return "".join(f"{target.comment} {line}\n" for line in [*lines, *configured.notes])


def _plain(family: str) -> str:
    """Whatever a family's name holds, it does not end a comment."""
    return re.sub(r"[^A-Za-z0-9_ .,%+^-]", "?", family)[:60]
