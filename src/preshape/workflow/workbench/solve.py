"""From what is asked for to a shaper, or to the sentence that says why there is none; both are remembered."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

from preshape.band import Band
from preshape.design import CLOSED_FAMILIES, designed
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.shaper import Shaper
from preshape.workflow.workbench.state import AskedDesign, Controller, Workbench

__all__ = ["MOST_IMPULSES", "Solved", "bands_asked", "misfit", "shaper_named", "solved"]

MOST_IMPULSES = 4096
"""A shaper convolved from more impulses is not designed here: it could be neither drawn nor used."""

REMEMBERED = 64
"""Designs kept, with their shapers or sentences."""


@dataclass(frozen=True)
class Solved:
    """The outcome of a design.

    Parameters
    ----------
    shaper : Shaper or None
        None if there is none.
    trouble : str
        Why there is none, as a sentence; else empty.
    """

    shaper: Shaper | None
    trouble: str = ""


def solved(asked: AskedDesign, modes: tuple[Mode, ...]) -> Solved:
    """The design's outcome; one that was asked for before is remembered, as are those that do not see the modes.

    Parameters
    ----------
    asked : AskedDesign
        What is wanted; its name does not matter.
    modes : tuple of Mode
        Natural frequencies [Hz] and damping ratios [-].
    """
    bands = bands_asked(asked, modes)
    return _solved(asked.family, asked.options, () if bands else modes, bands)


def bands_asked(asked: AskedDesign, modes: tuple[Mode, ...]) -> tuple[Band, ...]:
    """What a design for bands must cover: its own bands, or one about each mode; empty for the other families."""
    if asked.family != "si":
        return ()
    half = 0.5 * asked.band_width
    return asked.bands or tuple(
        Band((1.0 - half) * mode.frequency, (1.0 + half) * mode.frequency, mode.damping) for mode in modes
    )


def misfit(shaper: Shaper, controller: Controller) -> str:
    """Why a controller cannot hold a shaper, as a sentence; empty if it can."""
    if controller.most_impulses is not None and len(shaper) > controller.most_impulses:
        return f"it has {len(shaper)} impulses and the controller holds {controller.most_impulses}."
    if controller.longest is not None and shaper.duration > controller.longest:
        return f"it takes {shaper.duration:.4g} s and the controller holds {controller.longest:g} s."
    if not controller.negative and (
        float(shaper.amplitudes.min()) < 0.0 or any(box.density < 0.0 for box in shaper.boxes)
    ):
        return "it has negative impulses, which the controller cannot hold."
    return ""


def shaper_named(workbench: Workbench, name: str) -> Shaper:
    """The shaper of one of the designs.

    Raises
    ------
    InputError
        If the workbench has no such design, or it has no shaper; the sentence says why.
    """
    for asked in workbench.designs:
        if asked.name == name:
            found = solved(asked, workbench.modes)
            if found.shaper is None:
                raise InputError(f"design {name} has no shaper: {found.trouble}")
            return found.shaper
    names = ", ".join(asked.name for asked in workbench.designs) or "none"
    raise InputError(f"design {name!r} is not on the workbench: there is {names}.")


@lru_cache(maxsize=REMEMBERED)
def _solved(
    family: str,
    options: tuple[tuple[str, float | int | str | bool], ...],
    modes: tuple[Mode, ...],
    bands: tuple[Band, ...],
) -> Solved:
    try:
        _check_count(family, options, modes)
        return Solved(designed(family, modes, bands, dict(options)))
    except InputError as error:
        return Solved(None, str(error))


def _check_count(
    family: str, options: tuple[tuple[str, float | int | str | bool], ...], modes: tuple[Mode, ...]
) -> None:
    """Refuse a convolution of so many impulses that it would fill the memory."""
    if len(modes) < 2 or (family not in CLOSED_FAMILIES and family != "convolved"):
        return
    wishes = {name: value for name, value in options if name != "dt"}
    count = 1
    for mode in modes:
        count *= len(designed(family, [mode], (), wishes))
        if count > MOST_IMPULSES:
            raise InputError(
                f"{family} convolved for {len(modes)} modes has more than {MOST_IMPULSES} impulses: give fewer modes, "
                "or take the family direct, which designs for all of them at once."
            )
