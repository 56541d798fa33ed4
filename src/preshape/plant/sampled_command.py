"""The sampled command of a plant with any number of inputs, and what every plant says of a wrong one."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError

__all__ = ["Hold", "checked_hold", "command_rows", "named"]

Hold: TypeAlias = Literal["zero", "linear"]
"""A command between samples: held, as a controller's output is, or the straight line to the next sample."""


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


def named(kind: str, given: Mapping[str, str] | None, count: int) -> dict[str, str]:
    """Units by name for `count` inputs or outputs: those given if they are as many, or names by number."""
    if given is None:
        return {kind: ""} if count == 1 else {f"{kind} {k}": "" for k in range(1, count + 1)}
    if len(given) != count:
        raise InputError(f"{len(given)} {kind}s are named ({', '.join(given)}), the model has {count}: name each.")
    return {str(name): str(unit) for name, unit in given.items()}
