"""What a machine does with the settings that it has, and what that leaves of a measured vibration."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from preshape import identify
from preshape.errors import InputError
from preshape.export import TARGETS, SettingsTarget, klipper
from preshape.shaper import Shaper
from preshape.workflow.remaining import lines_to_still, remaining_amplitude
from preshape.workflow.spectra import scored_spectrum

__all__ = ["SpectrumLeft", "executed_shaper", "left_of_spectrum"]

LARGEST_FILE = 1_000_000
"""Bytes of a file with settings."""


@dataclass(frozen=True)
class SpectrumLeft:
    """What a shaper leaves of a measured vibration.

    Parameters
    ----------
    name : str
        Of the measurement.
    by_klipper : float
        Klipper's own measure [-]: power, in the worst case of three damping ratios; the first 5 % of the highest peak
        are free.
    amplitude : float
        Root mean square of what is left of the amplitudes [-], with all frequencies 5 % off: what `calibrate` goes by.
    """

    name: str
    by_klipper: float
    amplitude: float


def executed_shaper(
    path: str | os.PathLike[str], target: str, *, version: str | None = None, axis: str | None = None
) -> Shaper:
    """The impulses that a controller executes with the settings in a file.

    Parameters
    ----------
    path : path
        ``printer.cfg``, a G-code file, or the part of it that holds the settings.
    target : str
        Whose settings: a target of :data:`preshape.export.TARGETS` that takes settings, such as "klipper" or "rrf".
    version : str, optional
        Of its firmware, one of the target's ``versions``; by default the first.
    axis : str, optional
        "x", "y" or "z"; needed where the axes differ.

    Returns
    -------
    Shaper
        Its modes are what is set: a frequency and a damping ratio.

    Raises
    ------
    InputError
        If the file cannot be read, holds no such settings, or the controller would refuse them.
    """
    known = {name: one for name, one in TARGETS.items() if isinstance(one, SettingsTarget)}
    if target not in known:
        raise InputError(f"{target!r} takes no settings that could be looked at: it is one of {', '.join(known)}.")
    chosen = known[target]
    if version is not None and version not in chosen.versions:
        raise InputError(f"version {version!r} is not known for {target}: it is {' or '.join(chosen.versions)}.")
    source = Path(path)
    try:
        if source.stat().st_size > LARGEST_FILE:
            raise InputError(f"{source} is larger than a megabyte: give the part of it that holds the settings.")
        text = source.read_text(encoding="utf-8", errors="replace")
    except OSError as error:
        raise InputError(f"cannot read {source}: {error.strerror or error}.") from None
    try:
        return chosen.execute(text, version or chosen.versions[0], axis)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None


def left_of_spectrum(shaper: Shaper, path: str | os.PathLike[str], damping: float | None = None) -> SpectrumLeft:
    """What a shaper leaves of the vibration in a measurement, by Klipper's measure and by ours.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    path : path
        A measurement in any format that :func:`preshape.identify.read` knows.
    damping : float, optional
        Damping ratio [-] of the modes, when it is known better than the measurement shows it.
    """
    measurement = identify.read(path)
    found = identify.find_modes(measurement, damping=damping)
    scored = scored_spectrum(measurement, found)
    spectra = klipper.as_spectra([(scored.frequencies, scored.power)])
    lines = lines_to_still(spectra, found.modes, found.clear, damping)
    return SpectrumLeft(
        Path(path).name, klipper.remaining_vibration(shaper, spectra), remaining_amplitude(shaper, lines)
    )
