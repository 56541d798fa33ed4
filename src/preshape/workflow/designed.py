"""A shaper by the options of ``preshape design``: the family is called with what it takes, and nothing else."""

from __future__ import annotations

import inspect
from collections.abc import Mapping
from typing import Any

import msgspec

from preshape import design
from preshape.band import Band
from preshape.design.families import OTHER_FAMILIES
from preshape.errors import InputError
from preshape.mode import Mode
from preshape.report import DesignJob
from preshape.shaper import Shaper

__all__ = ["designed"]

ON_THEIR_OWN = ("mesh", "si", "sd_zv")
"""Families that put the impulses on the controller's grid themselves."""


def designed(job: DesignJob) -> Shaper:
    """The shaper that the options ask for.

    Raises
    ------
    InputError
        If the family is not known, does not take an option, or lacks one that it cannot do without.

    Examples
    --------
    >>> from preshape.report import DesignJob
    >>> len(designed(DesignJob(family="zvd", modes=((47.3, 0.05),))))
    3
    """
    wishes = {
        name: value
        for name, value in msgspec.structs.asdict(job).items()
        if name not in ("family", "modes", "bands") and value is not None
    }
    dt = wishes.pop("dt", None) if job.family not in ON_THEIR_OWN else None
    modes, bands = [Mode(*mode) for mode in job.modes], [Band(*band) for band in job.bands]
    shaper = _by_family(job.family, modes, bands, wishes)
    return shaper if dt is None else design.on_grid(shaper, dt)


def _by_family(family: str, modes: list[Mode], bands: list[Band], wishes: dict[str, Any]) -> Shaper:
    if bands or family == "si":
        return _for_bands(family, modes, bands, wishes)
    if not modes:
        raise InputError("no mode was given: name at least one, such as --mode 47.3:0.05.")
    if family == "convolved":
        base = wishes.pop("base", "zvd")
        _suits(wishes, base, f"--family convolved --base {base}")
        return design.convolved(modes, base, **wishes)
    if family == "antiperiod":
        _refuse(wishes, {"impulses", "frequency_tolerance"}, "--family antiperiod")
        return design.antiperiod(modes, **wishes)
    if family == "mesh":
        _refuse(wishes, {"dt", "duration", "order", "cost", "fewest", "at_most"}, "--family mesh")
        if "dt" not in wishes:
            raise InputError("--family mesh needs --dt: give the servo period in seconds, such as --dt 0.001.")
        return design.mesh(modes, **wishes)
    _suits(wishes, family, f"--family {family}")
    return design.FAMILIES[family](modes, **wishes)


def _for_bands(family: str, modes: list[Mode], bands: list[Band], wishes: dict[str, Any]) -> Shaper:
    """The families that are tuned to bands themselves."""
    if family not in ("ei", "si") or modes:
        raise InputError(
            "--band goes with --family ei or si and without --mode: these shapers are tuned to the bands themselves."
        )
    if not bands:
        raise InputError("--family si needs --band: name each band of frequencies in hertz, such as --band 8:12.")
    if family == "si":
        _refuse(wishes, {"tolerance", "at_most", "dt"}, "--family si --band")
        return design.specified_insensitivity(bands, **wishes)
    _refuse(wishes, {"tolerance", "damping"}, "--family ei --band")
    band, *others = bands
    if others or band.highest_damping > 0.0:
        raise InputError(
            "--family ei takes one band LO:HI, its damping ratio in --damping: use --family si for several bands or a "
            "range of damping ratios."
        )
    return design.ei_for_band(band.low, band.high, **wishes)


def _suits(wishes: Mapping[str, Any], family: str, what: str) -> None:
    """Refuse a wish that the family does not take, and one that it cannot do without."""
    if family not in design.FAMILIES:
        known = ", ".join([*design.FAMILIES, *OTHER_FAMILIES])
        raise InputError(f"there is no family {family!r}: choose one of {known}.")
    _refuse(wishes, _takes(family), what)
    missing = _takes(family, needed=True) - wishes.keys()
    if missing:
        raise InputError(f"{what} needs {_option(min(missing))}: give a number.")


def _takes(family: str, needed: bool = False) -> set[str]:
    """What a family's function takes beside the modes, or only what it cannot do without."""
    parameters = inspect.signature(design.FAMILIES[family]).parameters
    return {
        name
        for name, parameter in parameters.items()
        if name != "modes" and (not needed or parameter.default is inspect.Parameter.empty)
    }


def _refuse(wishes: Mapping[str, Any], taken: set[str], what: str) -> None:
    surplus = sorted(wishes.keys() - taken)
    if surplus:
        allowed = ", ".join(_option(name) for name in sorted(taken)) or "no such option"
        raise InputError(f"{what} does not take {_option(surplus[0])}: it takes {allowed}.")


def _option(name: str) -> str:
    return "--" + name.replace("_", "-")
