"""From a family's name and wishes to a shaper: the one place that knows which family takes what."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import Any

from preshape.band import Band
from preshape.design.antiperiod import antiperiod
from preshape.design.band import ei_for_band
from preshape.design.convolved import convolved
from preshape.design.families import FAMILIES, OTHER_FAMILIES
from preshape.design.mesh import mesh
from preshape.design.on_grid import on_grid
from preshape.design.specified_insensitivity import specified_insensitivity
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.shaper import Shaper

__all__ = ["ASKED_FAMILIES", "designed", "needed_by", "taken_by"]

ASKED_FAMILIES: tuple[str, ...] = (*FAMILIES, *OTHER_FAMILIES)
"""What can be asked for by name."""

OWN_GRID = ("mesh", "si", "sd_zv")
"""Families that place their impulses on a sample grid themselves; the others are put on it afterwards."""

MESH = frozenset({"dt", "duration", "order", "cost", "fewest", "at_most"})
ANTIPERIOD = frozenset({"impulses", "frequency_tolerance"})
SPECIFIED = frozenset({"tolerance", "at_most", "dt"})
EI_BAND = frozenset({"tolerance", "damping"})

NOT_WISHES = frozenset({"modes", "near"})
"""Parameters of families that are no wishes of a user."""

Spelled = Callable[[str], str]


def designed(
    family: str,
    modes: Iterable[Mode],
    bands: Iterable[Band] = (),
    wishes: Mapping[str, Any] | None = None,
    *,
    spelled: Spelled = str,
) -> Shaper:
    """The shaper of a family, by names.

    Parameters
    ----------
    family : str
        One of :data:`ASKED_FAMILIES`.
    modes : iterable of Mode
        Natural frequencies [Hz] and damping ratios [-]; none for a family that is tuned to bands.
    bands : iterable of Band
        For "si" any number, for "ei" one in place of modes.
    wishes : mapping of str to number, str or bool, optional
        What the family takes beside them: names of :data:`preshape.design.OPTIONS`.
    spelled : callable
        How the messages spell an option's name.

    Raises
    ------
    InputError
        If there is no such family, it does not take a wish or cannot do without one that is missing; or as the family
        does.

    Examples
    --------
    >>> designed("zvdk", [Mode(10.0, 0.0)], wishes={"order": 1}).times.round(6).tolist()
    [0.0, 0.05, 0.1]
    """
    if family not in ASKED_FAMILIES:
        raise InputError(f"there is no family {family!r}: choose one of {', '.join(ASKED_FAMILIES)}.")
    asked, wanted, over = dict(wishes or {}), list(modes), list(bands)
    dt = None if family in OWN_GRID else asked.pop("dt", None)
    if over or family == "si":
        shaper = _for_bands(family, wanted, over, asked, spelled)
    else:
        shaper = _for_modes(family, wanted, asked, spelled)
    return shaper if dt is None else on_grid(shaper, dt)


def taken_by(family: str, wishes: Mapping[str, Any] | None = None) -> frozenset[str]:
    """Names of the wishes that a family takes for modes; of "convolved" by its base among `wishes`, or its default."""
    if family == "si":
        return SPECIFIED
    if family == "mesh":
        return MESH
    grid = frozenset({"dt"})
    if family == "antiperiod":
        return ANTIPERIOD | grid
    if family == "convolved":
        return taken_by((wishes or {}).get("base", "zvd")) | grid | {"base"}
    return _parameters(family) | grid


def needed_by(family: str, wishes: Mapping[str, Any] | None = None) -> frozenset[str]:
    """Names of those that it cannot do without."""
    if family == "mesh":
        return frozenset({"dt"})
    if family in ("si", "antiperiod"):
        return frozenset()
    return _parameters((wishes or {}).get("base", "zvd") if family == "convolved" else family, needed=True)


def _for_modes(family: str, modes: list[Mode], wishes: dict[str, Any], spelled: Spelled) -> Shaper:
    """Call the family with what it takes; say so when it does not take a wish."""
    what = f"{spelled('family')} {family}"
    if not modes:
        raise InputError(f"no mode was given: name at least one, such as {spelled('mode')} 47.3:0.05.")
    if family == "convolved":
        base = wishes.pop("base", "zvd")
        _suits(wishes, base, f"{what} {spelled('base')} {base}", spelled)
        return convolved(modes, base, **wishes)
    if family == "antiperiod":
        _refuse(wishes, ANTIPERIOD, what, spelled)
        return antiperiod(modes, **wishes)
    if family == "mesh":
        _refuse(wishes, MESH, what, spelled)
        if "dt" not in wishes:
            dt = spelled("dt")
            raise InputError(f"{what} needs {dt}: give the servo period in seconds, such as {dt} 0.001.")
        return mesh(modes, **wishes)
    _suits(wishes, family, what, spelled)
    return FAMILIES[family](modes, **wishes)


def _for_bands(family: str, modes: list[Mode], bands: list[Band], wishes: dict[str, Any], spelled: Spelled) -> Shaper:
    """The families that are tuned to bands themselves."""
    the_family, band = spelled("family"), spelled("band")
    if family not in ("ei", "si") or modes:
        raise InputError(
            f"{band} goes with {the_family} ei or si and without {spelled('mode')}: these shapers are tuned to the "
            "bands themselves."
        )
    if not bands:
        raise InputError(f"{the_family} si needs {band}: name each band of frequencies in hertz, such as {band} 8:12.")
    what = f"{the_family} {family} {band}"
    if family == "si":
        _refuse(wishes, SPECIFIED, what, spelled)
        return specified_insensitivity(bands, **wishes)
    _refuse(wishes, EI_BAND, what, spelled)
    first, *others = bands
    if others or first.highest_damping > 0.0:
        raise InputError(
            f"{the_family} ei takes one band LO:HI, its damping ratio in {spelled('damping')}: use {the_family} si for "
            "several bands or a range of damping ratios."
        )
    return ei_for_band(first.low, first.high, **wishes)


def _suits(wishes: dict[str, Any], family: str, what: str, spelled: Spelled) -> None:
    """Refuse a wish that the family does not take, and one that it cannot do without."""
    if family not in FAMILIES:
        raise InputError(f"there is no family {family!r}: choose one of {', '.join(ASKED_FAMILIES)}.")
    _refuse(wishes, _parameters(family), what, spelled)
    missing = _parameters(family, needed=True) - wishes.keys()
    if missing:
        raise InputError(f"{what} needs {spelled(min(missing))}: give a number.")


@cache
def _parameters(family: str, needed: bool = False) -> frozenset[str]:
    """What a family's function takes beside the modes, or only what it cannot do without."""
    parameters = inspect.signature(FAMILIES[family]).parameters
    return frozenset(
        name
        for name, parameter in parameters.items()
        if name not in NOT_WISHES and (not needed or parameter.default is inspect.Parameter.empty)
    )


def _refuse(wishes: dict[str, Any], taken: frozenset[str], what: str, spelled: Spelled) -> None:
    surplus = sorted(wishes.keys() - taken)
    if surplus:
        allowed = ", ".join(spelled(name) for name in sorted(taken)) or "no such option"
        raise InputError(f"{what} does not take {spelled(surplus[0])}: it takes {allowed}.")
