"""What plants ask of the rows of numbers given to them, and the sentences they answer with."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError

__all__ = ["finite_row", "gain_matrix", "one_each", "same_length"]


def finite_row(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """`values` as a new array of shape (sample,), if they are finite numbers."""
    try:
        row = np.array(values, dtype=float, ndmin=1)
    except (TypeError, ValueError):
        raise InputError(f"{name} holds something that is not a number: give a row of finite numbers.") from None
    if row.ndim != 1:
        raise InputError(f"{name} has shape {row.shape}: give one row of numbers, shape (sample,).")
    finite = np.isfinite(row)
    if not finite.all():
        at = int(np.argmin(finite))
        raise InputError(f"{name} holds {row[at]} at index {at}: give finite numbers.")
    return row


def same_length(
    first: str, first_values: ArrayLike, second: str, second_values: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Both as rows, if they are finite, not empty and of one length."""
    a, b = finite_row(first, first_values), finite_row(second, second_values)
    if a.size != b.size or a.size == 0:
        raise InputError(
            f"{first} has {a.size} and {second} has {b.size} value(s): give as many of each, at least one."
        )
    return a, b


def one_each(name: str, values: ArrayLike | None, count: int) -> NDArray[np.float64]:
    """`values` as a row of one number a mode; zeros unless given."""
    row = np.zeros(count) if values is None else finite_row(name, values)
    if row.size != count:
        raise InputError(f"{name} has {row.size} value(s) for {count} mode(s): give one a mode.")
    return row


def gain_matrix(gains: ArrayLike | None, count: int) -> NDArray[np.float64]:
    """`gains` as a read-only array of shape (mode,) or (output, mode); equal shares of 1 unless given."""
    try:
        array = np.full(count, 1.0 / count) if gains is None else np.array(gains, dtype=float)
    except (TypeError, ValueError):
        raise InputError("gains hold something that is not a number: give one finite number a mode.") from None
    if array.ndim not in (1, 2) or array.shape[-1] != count or array.size == 0:
        raise InputError(
            f"gains have shape {array.shape} for {count} mode(s): give shape ({count},), or (outputs, {count})."
        )
    if not np.isfinite(array).all():
        raise InputError("gains hold NaN or infinity: give one finite number a mode.")
    array.setflags(write=False)
    return array
