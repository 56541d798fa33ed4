"""From a shaper to a target's files: placed on its grid or put into its words, checked against its limits, written."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import overload

import numpy as np

from preshape.checks import positive
from preshape.design.on_grid import on_grid
from preshape.errors import InputError
from preshape.export.configure import ExportedSettings, configured_for
from preshape.export.settings_target import SettingsTarget
from preshape.export.target import PRECISIONS, Exported, Placed, Taps, Target
from preshape.export.targets import TARGETS
from preshape.provenance import Design
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = ["render"]

NAME = re.compile(r"[a-z][a-z0-9_]{0,30}")

TAKEN = "preshape"
"""Names that begin so are the kernel's own."""


@overload
def render(
    shaper: Shaper,
    target: str,
    *,
    dt: float,
    name: str = ...,
    version: str | None = ...,
    precision: str | None = ...,
    grid: str | None = ...,
    axis: None = ...,
) -> Exported: ...


@overload
def render(
    shaper: Shaper,
    target: str,
    *,
    dt: None = ...,
    name: str = ...,
    version: str | None = ...,
    precision: None = ...,
    grid: None = ...,
    axis: str | None = ...,
) -> ExportedSettings: ...


@overload
def render(
    shaper: Shaper,
    target: str,
    *,
    dt: float | None,
    name: str = ...,
    version: str | None = ...,
    precision: str | None = ...,
    grid: str | None = ...,
    axis: str | None = ...,
) -> Exported | ExportedSettings: ...


def render(
    shaper: Shaper,
    target: str,
    *,
    dt: float | None = None,
    name: str = "shaper",
    version: str | None = None,
    precision: str | None = None,
    grid: str | None = None,
    axis: str | None = None,
) -> Exported | ExportedSettings:
    """A shaper as the files that somebody else's controller takes.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    target : str
        For whom: a name of :data:`preshape.export.TARGETS`.
    dt : float
        Sample time of the controller [s], for a target that works on samples; left out for one that takes settings.
    name : str
        What files and identifiers are called: a lower-case letter and up to 30 lower-case letters, digits, underscores.
    version : str, optional
        Of the target's language or host, one of its ``versions``; by default the first.
    precision : {"double", "single"}, optional
        Of the controller's arithmetic; by default the first that the target knows.
    grid : str, optional
        How impulses between samples are placed, a method of :func:`preshape.design.on_grid`; by default "exact", or
        "linear" for a shaper that does not know its modes.
    axis : str, optional
        "x", "y" or "z", for a target that takes settings for each axis; by default x and y are set alike.

    Returns
    -------
    Exported or ExportedSettings
        The files, and in ``placed`` the shaper that the controller will run and the residuals it leaves at each mode.

    Raises
    ------
    InputError
        If the target, the version, the precision, the name or the grid method is not known, dt is not a positive
        number, or the shaper does not fit the target's limits or the grid.

    Examples
    --------
    >>> import preshape
    >>> exported = render(preshape.design.zv((40.0, 0.0)), "c", dt=0.001, name="gantry_x")
    >>> list(exported.files)[2:], exported.placed.latency_samples
    (['gantry_x.h', 'gantry_x.c', 'gantry_x_selftest.c'], 13)
    >>> mzv = preshape.design.mzv((50.0, 0.1))
    >>> print(str(render(mzv, "rrf", version="3.6").files["shaper.g"]).splitlines()[-1])
    M593 P"custom" H0.365128:0.407489 T0.0075378:0.0150756
    """
    if target not in TARGETS:
        raise InputError(f"target {target!r} is not known: it is {', '.join(TARGETS)}.")
    chosen = TARGETS[target]
    version = chosen.version_of(version)
    if not (isinstance(name, str) and NAME.fullmatch(name)) or name.startswith(TAKEN):
        raise InputError(
            f"name {name!r} cannot be used in every language: give a lower-case letter and up to 30 lower-case "
            f"letters, digits or underscores, which do not begin with {TAKEN}."
        )
    if isinstance(chosen, SettingsTarget):
        if not (dt is None and precision is None and grid is None):
            raise InputError(f"target {target} has no sample grid: leave the sample rate, precision and grid out.")
        return configured_for(shaper, chosen, version, name, axis)
    if dt is None or axis is not None:
        raise InputError(f"target {target} works on samples of one axis: say the sample rate, and leave the axis out.")
    precision = _one_of("precision", precision, chosen.limits.precisions, target)
    placed = _placed(chosen, shaper, positive("dt", dt, "s"), grid, name, precision, version)
    files = chosen.render(placed)
    return Exported(chosen, placed, files, chosen.notes(files))


def _placed(
    target: Target, shaper: Shaper, dt: float, grid: str | None, name: str, precision: str, version: str
) -> Placed:
    """The shaper on the grid, in the controller's precision, and what the target makes of it."""
    if grid is None:  # the best that the shaper's record allows
        grid = "linear" if shaper.design.modes is None else "exact"
    on = on_grid(shaper, dt, grid)
    delays, weights = on.taps(dt)
    rounded = weights.astype(PRECISIONS[precision]).astype(np.float64)
    taps = Taps(dt, delays.astype(np.uint32), rounded, precision)
    target.check(taps)
    does = _with_residuals(target.run(taps), on.design)
    return Placed(dt, taps.delays, rounded, precision, does, name, version)


def _with_residuals(shaper: Shaper, design: Design) -> Shaper:
    """The shaper with this record, and in it what exactly this shaper leaves at the modes."""
    if (modes := design.modes) is None:
        return shaper.with_design(design)
    left = residual_vibration(shaper, [mode.frequency for mode in modes], [mode.damping for mode in modes])
    settings = {**design.settings, "residuals": left.tolist()}
    return shaper.with_design(replace(design, settings=settings, residual=float(left.max())))


def _one_of(what: str, given: str | None, allowed: tuple[str, ...], target: str) -> str:
    if given is None:
        return allowed[0]
    if given not in allowed:
        raise InputError(f"{what} {given!r} is not known for target {target}: it is {' or '.join(allowed)}.")
    return given
