"""The largest magnitude of a piecewise polynomial, between its knots too: exact, no samples.

Between two roots of its derivative a polynomial is monotone. From the highest derivative, which is linear, down to the
first, the roots of each lie one by one between those of the next: they are bracketed, so none is missed.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from preshape.kernel.driven_extremum import Extremum

__all__ = ["polynomial_extremum"]

HALVINGS = 54
"""Of a bracket of a root, down to rounding."""


def polynomial_extremum(starts: NDArray[np.float64], taylor: NDArray[np.float64]) -> Extremum:
    """Where a piecewise polynomial that is 0 before its first piece is largest in magnitude.

    Parameters
    ----------
    starts : ndarray, shape (segment,)
        Where each piece begins [s], increasing; the last one goes on for ever.
    taylor : ndarray, shape (segment, order + 1)
        Value and derivatives at the start of each piece [unit/s^order].

    Returns
    -------
    Extremum
        At a jump the larger of both sides counts; infinite when the last piece grows.
    """
    if starts.size == 0 or taylor.shape[1] == 0:
        return Extremum(0.0, 0.0, 0.0)
    if taylor[-1, 1:].any():
        return Extremum(math.inf, math.inf, math.inf)
    gaps = np.diff(starts, append=starts[-1])
    powers = np.arange(taylor.shape[1])
    # In parts of each piece's own length, so that all numbers of a piece are of one size.
    pieces = taylor * gaps[:, None] ** powers / np.array([math.factorial(n) for n in powers])
    looks = np.tile([0.0, 1.0], (starts.size, 1))
    for order in range(powers.size - 2, 0, -1):
        looks = np.column_stack([looks[:, :1], _roots(_derivative(pieces, order), looks), looks[:, -1:]])
    sizes = np.abs(_values(pieces, looks))
    piece, look = np.unravel_index(int(np.argmax(sizes)), sizes.shape)
    largest = float(sizes[piece, look])
    return Extremum(largest, float(starts[piece] + gaps[piece] * looks[piece, look]), largest)


def _derivative(pieces: NDArray[np.float64], order: int) -> NDArray[np.float64]:
    for _ in range(order):
        pieces = pieces[:, 1:] * np.arange(1, pieces.shape[1])
    return pieces


def _values(pieces: NDArray[np.float64], at: NDArray[np.float64]) -> NDArray[np.float64]:
    value = np.repeat(pieces[:, -1:], at.shape[1], axis=1)
    for column in range(pieces.shape[1] - 2, -1, -1):
        value = value * at + pieces[:, column : column + 1]
    return value


def _roots(pieces: NDArray[np.float64], knots: NDArray[np.float64]) -> NDArray[np.float64]:
    """The root between each two knots, between which the pieces are monotone; the first knot where there is none."""
    low, high = knots[:, :-1], knots[:, 1:]
    at_low, at_high = _values(pieces, low), _values(pieces, high)
    crossing = at_low * at_high < 0.0
    if pieces.shape[1] == 2:
        share = at_low / np.where(crossing, at_low - at_high, 1.0)
        return np.where(crossing, low + share * (high - low), low)
    first, rising = low, at_high > at_low
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        above = (_values(pieces, middle) > 0.0) == rising
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return np.where(crossing, 0.5 * (low + high), first)
