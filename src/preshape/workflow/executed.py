"""What a machine does with the settings that it has, and what that leaves of a measured vibration."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

from preshape import identify
from preshape.errors import InputError
from preshape.export import TARGETS, klipper
from preshape.shaper import Shaper
from preshape.workflow.remaining import lines_to_still, remaining_amplitude
from preshape.workflow.save_export import MEMORY
from preshape.workflow.spectra import scored_spectrum

__all__ = ["SpectrumLeft", "executed_shaper", "left_of_spectrum"]

MOST_FILES, LARGEST = 100, 50_000_000
"""Files of an export, and bytes of them all; what counts among them has limits of its own."""


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
    """The impulses that a controller executes with the settings or the export in a file.

    Parameters
    ----------
    path : path
        ``printer.cfg``, a G-code file, or the part of it that holds the settings; or an export, its folder where a
        target such as "c" has several files.
    target : str
        Whose: one of :data:`preshape.export.TARGETS`, such as "klipper" or "rrf".
    version : str, optional
        Of it, one of the target's ``versions``; by default what an export says of itself, otherwise the first.
    axis : str, optional
        "x", "y" or "z"; needed where the axes differ.

    Returns
    -------
    Shaper
        Of settings, its modes are what is set: a frequency and a damping ratio.

    Raises
    ------
    InputError
        If nothing can be read, there are no such settings or taps, or the controller would refuse them.
    """
    if target not in TARGETS:
        raise InputError(f"target {target!r} is not known: it is {', '.join(TARGETS)}.")
    source = Path(path)
    files = _files(source)
    try:
        return TARGETS[target].execute(files, version, axis)
    except InputError as error:
        raise InputError(f"{source}: {error}") from None


def _files(source: Path) -> dict[str, bytes]:
    """The file, or the files in a folder but for the list that save_export keeps of them, by name."""
    try:
        paths = (
            sorted(one for one in source.iterdir() if one.is_file() and one.name != MEMORY)
            if source.is_dir()
            else [source]
        )
        if len(paths) > MOST_FILES or sum(one.stat().st_size for one in paths) > LARGEST:
            raise InputError(
                f"{source} holds more than {MOST_FILES} files or {LARGEST // 1_000_000} MB: give those of one export."
            )
        return {one.name: one.read_bytes() for one in paths}
    except OSError as error:
        raise InputError(f"cannot read {source}: {error.strerror or error}.") from None


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
