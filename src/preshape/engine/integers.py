"""The mixed-integer linear programme of engine/fewest.py, as HiGHS takes it.

Unknown are the amplitudes b_i = SCALE a_i, and integers z_i that say which of them there are:
low z_i <= a_i <= high z_i.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.engine.programme import Programme

__all__ = ["Places", "find_places"]

SCALE = 1e4
"""HiGHS meets rows to 1e-7 and integers to 1e-6, enough to hide a grid full of tiny impulses; this makes it 1e-11. It
also spares HiGHS (in SciPy 1.17) its repairs of such answers, which it announces on standard output, options or not.
"""

SIDES = 16
"""Sides of the polygon around a disc; it reaches 2 % beyond it, so nothing that is allowed is lost."""

WHOLE = 1e-6
"""A bound on a whole number may be this much too large."""

INFEASIBLE = 2
"""SciPy's status for it."""


@dataclass(frozen=True)
class Places:
    """What HiGHS says.

    Parameters
    ----------
    places : ndarray of bool, shape (impulse,), or None
        Where there is an impulse; to be checked. None when nothing was found.
    at_least : int
        Bound on the number of impulses, within HiGHS' tolerances.
    """

    places: NDArray[np.bool_] | None
    at_least: int


def find_places(
    programme: Programme,
    windows: Sequence[slice],
    cuts: Sequence[NDArray[np.bool_]],
    wanted: int,
    *,
    minimise: bool,
    time_limit: float,
) -> Places:
    """At most `wanted` impulses, or as few as possible, that meet a programme.

    Parameters
    ----------
    programme : Programme
        With finite limits of the amplitudes; none that excludes 0.
    windows : sequence of slice
        Places that are known to need an impulse each.
    cuts : sequence of ndarray of bool, shape (impulse,)
        Sets of places that are known not to be enough.
    wanted : int
        The number allowed.
    minimise : bool
        Look for the fewest, instead of the first that are few enough.
    time_limit : float
        [s].
    """
    from scipy.optimize import Bounds, LinearConstraint, milp
    from scipy.sparse import csr_array, vstack

    count = programme.leads.size
    none, every = np.zeros((1, count)), np.ones(count)
    unit = csr_array((every, (np.arange(count), np.arange(count))), shape=(count, count))
    equations = np.vstack([programme.equalities, every])
    total = SCALE * (np.arange(equations.shape[0]) == equations.shape[0] - 1)
    blocks = [
        _Block(equations, None, total, total),
        _Block(unit, -SCALE * programme.high * unit, -math.inf, 0.0),
        _Block(none, every[None, :], len(windows), wanted),
    ]
    if programme.low < 0.0:
        blocks.append(_Block(unit, -SCALE * programme.low * unit, 0.0, math.inf))
    if programme.limits.size:
        blocks.append(_Block(programme.inequalities, None, -math.inf, SCALE * programme.limits))
    for turn in np.exp(2j * np.pi * np.arange(SIDES) / SIDES) if programme.radii.size else ():
        blocks.append(_Block((turn * programme.cones).real, None, -math.inf, SCALE * programme.radii))
    for window in windows:
        blocks.append(_Block(none, _mask(count, window)[None, :], 1.0, math.inf))
    for cut in cuts:
        blocks.append(_Block(none, np.where(cut, 0.0, 1.0)[None, :], 1.0, math.inf))
    integers = np.concatenate([np.zeros(count), every])
    answer = milp(
        integers if minimise else np.zeros(2 * count),
        integrality=integers,
        bounds=Bounds(
            np.concatenate([SCALE * programme.low * every, np.zeros(count)]),
            np.concatenate([SCALE * programme.high * every, every]),
        ),
        constraints=LinearConstraint(
            vstack([block.rows for block in blocks]).tocsc(),
            np.concatenate([block.sides(block.low) for block in blocks]),
            np.concatenate([block.sides(block.up) for block in blocks]),
        ),
        options={"time_limit": time_limit},
    )
    if answer.status == INFEASIBLE:
        return Places(None, wanted + 1)
    bound = answer.mip_dual_bound if minimise else None
    at_least = math.ceil(bound - WHOLE) if bound is not None and math.isfinite(bound) else 0
    return Places(None if answer.x is None else answer.x[count:] > 0.5, at_least)


class _Block:
    """low <= A b + Z z <= up."""

    def __init__(self, amplitudes: Any, integers: Any, low: ArrayLike, up: ArrayLike) -> None:
        from scipy.sparse import csr_array, hstack

        left = csr_array(amplitudes)
        self.rows: Any = hstack([left, csr_array(left.shape) if integers is None else csr_array(integers)])
        self.low, self.up = low, up

    def sides(self, side: ArrayLike) -> NDArray[np.float64]:
        """One side, once a row."""
        return np.broadcast_to(np.asarray(side, dtype=float), (self.rows.shape[0],))


def _mask(count: int, window: slice) -> NDArray[np.float64]:
    mask = np.zeros(count)
    mask[window] = 1.0
    return mask
