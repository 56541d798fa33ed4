"""From a shaper to a target's files: placed on its grid or put into its words, checked against its limits, written."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from typing import overload

import numpy as np
from numpy.typing import NDArray

from preshape.checks import positive
from preshape.design.on_grid import on_grid
from preshape.errors import InputError
from preshape.export.configure import ExportedSettings, configured_for
from preshape.export.settings_target import SettingsTarget
from preshape.export.target import Exported, Placed, Target
from preshape.export.targets import TARGETS
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = ["render"]

NAME = re.compile(r"[a-z][a-z0-9_]{0,30}")

TAKEN = "preshape"
"""Names that begin so are the kernel's own."""

LARGEST_SUM = 1e6
"""Most that the sizes of the weights may sum to: what the kernel takes."""


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
    version = _one_of("version", version, chosen.versions, target)
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
    placed = _placed(shaper, positive("dt", dt, "s"), grid, name, precision, version)
    _check(chosen, placed)
    files = chosen.render(placed)
    return Exported(chosen, placed, files, chosen.notes(files))


def _placed(shaper: Shaper, dt: float, grid: str | None, name: str, precision: str, version: str) -> Placed:
    """The shaper on the grid, in the controller's precision."""
    if grid is None:  # the best that the shaper's record allows
        grid = "linear" if shaper.design.modes is None else "exact"
    on = on_grid(shaper, dt, grid)
    delays, weights = on.taps(dt)
    if delays[0] > 0:  # the shaper keeps an impulse of amplitude 0 there, which the taps leave out
        delays, weights = np.insert(delays, 0, 0), np.insert(weights, 0, 0.0)
    if precision == "single":
        weights = weights.astype(np.float32).astype(float)
        on = _rounded(on, delays, weights, dt)
    return Placed(on, dt, delays.astype(np.uint32), weights, name, precision, version)


def _rounded(shaper: Shaper, delays: NDArray[np.intp], weights: NDArray[np.float64], dt: float) -> Shaper:
    """The shaper of these weights, the last one what the others leave of 1, and what that leaves at the modes."""
    whole = [*weights[:-1].tolist(), 1.0 - math.fsum(weights[:-1])]
    rounded = Shaper(delays * np.float64(dt), whole, shaper.design)
    if (modes := shaper.design.modes) is None:
        return rounded
    left = residual_vibration(rounded, [mode.frequency for mode in modes], [mode.damping for mode in modes])
    settings = {**shaper.design.settings, "residuals": left.tolist()}
    return rounded.with_design(replace(shaper.design, settings=settings, residual=float(left.max())))


def _one_of(what: str, given: str | None, allowed: tuple[str, ...], target: str) -> str:
    if given is None:
        return allowed[0]
    if given not in allowed:
        raise InputError(f"{what} {given!r} is not known for target {target}: it is {' or '.join(allowed)}.")
    return given


def _check(target: Target, placed: Placed) -> None:
    limits, taps = target.limits, placed.delays.size
    at = f"at dt = {placed.dt:g} s and target {target.name} holds"
    if limits.taps is not None and taps > limits.taps:
        raise InputError(
            f"the shaper has {taps} taps {at} {limits.taps}: design one with fewer impulses, or sample less often."
        )
    if limits.samples is not None and placed.latency_samples > limits.samples:
        raise InputError(
            f"the shaper is {placed.latency_samples} samples long {at} {limits.samples}: sample less often."
        )
    if not limits.negative and float(placed.weights.min()) < 0.0:
        raise InputError(
            f"the shaper has negative taps, which target {target.name} cannot hold: design a positive one."
        )
    if not (size := float(np.abs(placed.weights).sum())) <= LARGEST_SUM:
        raise InputError(
            f"the sizes of the shaper's weights sum to {size:g}, and {LARGEST_SUM:g} is the most: design a shaper with "
            "smaller negative impulses."
        )
