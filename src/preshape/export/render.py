"""From a shaper to a target's files: placed on the grid, checked against the target's limits, written."""

from __future__ import annotations

import re
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from preshape.checks import positive
from preshape.design.on_grid import on_grid
from preshape.errors import InputError
from preshape.export.target import Exported, Placed, Target
from preshape.shaper import Shaper

__all__ = ["render_for"]

NAME = re.compile(r"[a-z][a-z0-9_]{0,30}")


def render_for(
    targets: Mapping[str, Target],
    shaper: Shaper,
    target: str,
    *,
    dt: float,
    name: str = "shaper",
    version: str | None = None,
    precision: str | None = None,
    grid: str | None = None,
) -> Exported:
    """The files of one of `targets`; see :func:`preshape.export.render`."""
    if target not in targets:
        raise InputError(f"target {target!r} is not known: it is {', '.join(targets)}.")
    chosen = targets[target]
    version = _one_of("version", version, chosen.versions, target)
    precision = _one_of("precision", precision, chosen.limits.precisions, target)
    if not NAME.fullmatch(name):
        raise InputError(
            f"name {name!r} cannot be used in every language: give a lower-case letter and up to 30 lower-case "
            "letters, digits or underscores."
        )
    positive("dt", dt, "s")
    if grid is None:  # the best that the shaper's record allows
        grid = "linear" if shaper.design.modes is None else "exact"
    placed = on_grid(shaper, dt, grid)
    delays, weights = placed.taps(dt)
    _check(chosen, delays, weights, dt)
    if precision == "single":
        weights = weights.astype(np.float32).astype(float)
    whole = Placed(placed, dt, delays.astype(np.uint32), weights, name, precision, version)
    files = chosen.render(whole)
    return Exported(chosen, whole, files, chosen.notes(files))


def _one_of(what: str, given: str | None, allowed: tuple[str, ...], target: str) -> str:
    if given is None:
        return allowed[0]
    if given not in allowed:
        raise InputError(f"{what} {given!r} is not known for target {target}: it is {' or '.join(allowed)}.")
    return given


def _check(target: Target, delays: NDArray[np.intp], weights: NDArray[np.float64], dt: float) -> None:
    limits = target.limits
    if delays.size > limits.taps:
        raise InputError(
            f"the shaper has {delays.size} taps at dt = {dt:g} s and target {target.name} holds {limits.taps}: design "
            "one with fewer impulses, or sample less often."
        )
    if int(delays[-1]) > limits.samples:
        raise InputError(
            f"the shaper is {int(delays[-1])} samples long at dt = {dt:g} s and target {target.name} holds "
            f"{limits.samples}: sample less often."
        )
    if not limits.negative and float(weights.min()) < 0.0:
        raise InputError(
            f"the shaper has negative taps, which target {target.name} cannot hold: design a positive one."
        )
