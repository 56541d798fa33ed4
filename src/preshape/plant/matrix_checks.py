"""What plants ask of the matrices given to them, and the sentences they answer with."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError

__all__ = ["matrix_of", "symmetric_matrix", "system_matrices"]

MOST_STATES = 1000
"""Poles take time as the cube: seconds at a thousand."""

UNSYMMETRIC = 1e-6
"""Of the largest entry: matrices printed with seven digits are symmetric by this measure."""


def matrix_of(name: str, values: ArrayLike, column: bool = False) -> NDArray[np.float64]:
    """`values` as a new matrix of finite numbers; a row becomes a matrix of one row, or one column."""
    try:
        matrix = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} is not a matrix of numbers: give rows of equal length.") from None
    if matrix.ndim < 2:
        matrix = matrix.reshape(-1, 1) if column else matrix.reshape(1, -1)
    if matrix.ndim != 2:
        raise InputError(f"{name} has shape {matrix.shape}: give rows of equal length.")
    if not np.isfinite(matrix).all():
        row, at = np.argwhere(~np.isfinite(matrix))[0]
        raise InputError(f"{name} holds {matrix[row, at]} in row {row}, column {at}: give finite numbers.")
    return matrix


def symmetric_matrix(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """`values` as a symmetric matrix; what is not symmetric by rounding is made so."""
    matrix = matrix_of(name, values)
    if matrix.shape[0] != matrix.shape[1] or matrix.size == 0:
        raise InputError(f"{name} has shape {matrix.shape}: give a square matrix, a row and a column a coordinate.")
    apart = np.abs(matrix - matrix.T)
    if apart.max() > UNSYMMETRIC * np.abs(matrix).max():
        i, j = np.unravel_index(int(np.argmax(apart)), apart.shape)
        raise InputError(
            f"{name} is not symmetric: it holds {matrix[i, j]:g} in row {i}, column {j} and {matrix[j, i]:g} in "
            f"row {j}, column {i}: correct it, or give A, B, C, D when forces do not come from a potential."
        )
    return np.asarray(0.5 * (matrix + matrix.T))


def system_matrices(
    a_given: ArrayLike, b_given: ArrayLike, c_given: ArrayLike, d_given: ArrayLike | None
) -> tuple[NDArray[np.float64], ...]:
    """A, B, C and D of a linear system as read-only matrices that fit each other; D is 0 unless given."""
    a = matrix_of("A", a_given)
    states = a.shape[0]
    if a.shape != (states, states) or states == 0:
        raise InputError(f"A has shape {a.shape}: give a square matrix, a row and a column for each state.")
    if states > MOST_STATES:
        raise InputError(f"A has {states} states: give at most {MOST_STATES}, reduce the model to its modes first.")
    b, c = matrix_of("B", b_given, column=True), matrix_of("C", c_given)
    if b.shape[0] != states or c.shape[1] != states or not b.size or not c.size:
        raise InputError(
            f"B has shape {b.shape} and C {c.shape} for {states} state(s): give B as (state, input), C as "
            "(output, state)."
        )
    d = np.zeros((c.shape[0], b.shape[1])) if d_given is None else matrix_of("D", d_given)
    if d.shape != (c.shape[0], b.shape[1]):
        raise InputError(
            f"D has shape {d.shape} for {c.shape[0]} output(s) and {b.shape[1]} input(s): give (output, input)."
        )
    for matrix in (a, b, c, d):
        matrix.setflags(write=False)
    return a, b, c, d
