"""The sampled command of a plant with any number of inputs, and what every plant says of a wrong one."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.errors import InputError

__all__ = ["Hold", "checked_hold", "command_rows", "named", "steps_of"]

Hold: TypeAlias = Literal["zero", "linear"]
"""A command between samples: held, as a controller's output is, or the straight line to the next sample."""

FITS = 1e-9
"""A sample interval is a whole number of simulation steps to this relative accuracy."""


def command_rows(command: ArrayLike, inputs: Mapping[str, str]) -> NDArray[np.float64]:
    """`command` as a new array of shape (input, sample); one row of samples will do for one input.

    Examples
    --------
    >>> command_rows([0.0, 1.0], {"force": "N"})
    array([[0., 1.]])
    """
    try:
        rows = np.array(command, dtype=float)
    except (TypeError, ValueError):
        raise InputError("the command holds something that is not a number: give rows of finite numbers.") from None
    if rows.ndim == 1 and len(inputs) == 1:
        rows = rows[np.newaxis]
    if rows.ndim != 2 or rows.shape[0] != len(inputs):
        raise InputError(
            f"the command has shape {rows.shape} for {len(inputs)} input(s) ({', '.join(inputs)}): "
            "give one row of samples for each, shape (input, sample)."
        )
    if rows.shape[1] == 0:
        raise InputError("the command has no samples: give at least one.")
    finite = np.isfinite(rows).all(axis=0)
    if not finite.all():
        raise InputError(f"the command holds NaN or infinity at sample {int(np.argmin(finite))}: give finite numbers.")
    return rows


def checked_hold(hold: str) -> bool:
    """Whether the command runs straight from sample to sample; InputError for what is neither that nor held."""
    if hold not in ("zero", "linear"):
        raise InputError(f"hold is {hold!r}: give 'zero' or 'linear'.")
    return hold == "linear"


def steps_of(dt: float, step: float | None, largest: float) -> tuple[int, float]:
    """How many steps of the simulation a sample takes, and the step [s]: the one asked for, or up to the largest.

    Parameters
    ----------
    dt : float
        Sample interval [s].
    step : float or None
        [s]; None for the longest up to `largest`, of which `dt` is a whole number.
    largest : float
        [s].

    Raises
    ------
    InputError
        If `step` is not above 0, or `dt` is not a whole number of it.

    Examples
    --------
    >>> steps_of(0.01, None, 0.004)
    (3, 0.0033333333333333335)
    >>> steps_of(0.01, 0.002, 0.004)
    (5, 0.002)
    """
    if step is None:
        ratio = math.ceil(dt / largest * (1.0 - FITS))
        return ratio, dt / ratio
    fine = positive("step", step, "s")
    ratio = round(dt / fine)
    if ratio < 1 or abs(ratio * fine - dt) > FITS * dt:
        raise InputError(
            f"the command's sample time {dt:g} s is {dt / fine:.6g} simulation steps of {fine:g} s: "
            "give a step that it is a whole number of, or none."
        )
    return ratio, dt / ratio


def named(kind: str, given: Mapping[str, str] | None, count: int) -> dict[str, str]:
    """Units by name for `count` inputs or outputs: those given if they are as many, or names by number."""
    if given is None:
        return {kind: ""} if count == 1 else {f"{kind} {k}": "" for k in range(1, count + 1)}
    if len(given) != count:
        raise InputError(f"{len(given)} {kind}s are named ({', '.join(given)}), the model has {count}: name each.")
    return {str(name): str(unit) for name, unit in given.items()}
