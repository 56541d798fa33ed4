"""Functions that span u^k exp(-s_j u) of several rates s_j and stay independent when rates nearly coincide.

exp(-s_1 u) and exp(-s_2 u) of two near-equal rates are parallel to within rounding; their difference, divided by the
distance of the rates, is not: it tends to u exp(-s u). So rates that are near each other, for the interval's length,
form a group, and the functions of a group are divided differences (Newton's basis) of the exponential in the rate.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

__all__ = ["DividedExponentials", "near_rates"]

LINKED = 1.5
"""Rates closer than this, times half the duration, are near: below it the difference of two exponentials is small."""

RADIUS = 4.0
"""Largest distance of a rate from its group's centre, times half the duration: exp(4) costs the series two digits."""

SERIES = 40
"""Terms of the power series beyond the number of functions: 4^40 / 40! is below 1e-23."""


def near_rates(rates: Sequence[complex], duration: float) -> tuple[tuple[int, ...], ...]:
    """Which of the `rates` [1/s] form a group on an interval of `duration` [s]: indices, group by group."""
    order = sorted(range(len(rates)), key=lambda i: (rates[i].imag, rates[i].real))
    half = duration / 2.0
    groups: list[list[int]] = []
    for i in order:
        home = next((group for group in reversed(groups) if _fits(rates, group, i, half)), None)
        if home is None:
            groups.append([i])
        else:
            home.append(i)
    return tuple(tuple(group) for group in groups)


def _fits(rates: Sequence[complex], group: list[int], i: int, half: float) -> bool:
    if min(abs(rates[i] - rates[k]) for k in group) * half > LINKED:
        return False
    return all(abs(rates[i] - rates[k]) * half <= RADIUS for k in group)


class DividedExponentials:
    """phi_n(u) = exp(-s u) n! [d_0 ... d_n] exp(d x) for each group, with x = 1 - 2 u / T and n = 0, 1, ...

    u is the lead, the time before the end. [d_0 ... d_n] is the divided difference in d over the nodes
    d_i = (s_i - s) T / 2, a rate s_i as often as it has functions, and s the middle of the group. A group of one rate
    gives x^n exp(-s u).

    Parameters
    ----------
    groups : sequence of sequences of complex
        The rates s_i [1/s] of each group, repeated.
    duration : float
        T [s].

    Examples
    --------
    >>> pair = DividedExponentials([[1j, 1j]], 2.0)
    >>> bool(np.allclose(pair(np.array([1.5])), [[np.exp(-1.5j)], [-0.5 * np.exp(-1.5j)]]))
    True
    """

    def __init__(self, groups: Sequence[Sequence[complex]], duration: float) -> None:
        self.duration = duration
        self.rates = np.array([rate for group in groups for rate in group])
        self._centres = np.array([_middle(group) for group in groups])
        self._group = np.repeat(np.arange(len(groups)), [len(group) for group in groups])
        self._degree = np.concatenate([np.arange(len(group)) for group in groups])
        self._groups = groups
        self._single = all(len(set(group)) == 1 for group in groups)

    @property
    def size(self) -> int:
        """How many complex functions there are."""
        return int(self.rates.size)

    @cached_property
    def _series(self) -> NDArray[np.complex128]:
        """Coefficients of x^l of every n! [d_0 ... d_n] exp(d x), shape (function, l)."""
        length = int(self._degree.max()) + SERIES + 1
        series = np.zeros((self.size, length), dtype=complex)
        row = 0
        for group, centre in zip(self._groups, self._centres, strict=True):
            nodes = (np.asarray(group) - centre) * self.duration / 2.0
            # h[m] is the complete homogeneous symmetric polynomial of degree m in the nodes so far
            h = np.zeros(length, dtype=complex)
            h[0] = 1.0
            for n, node in enumerate(nodes):
                for m in range(1, length):
                    h[m] += node * h[m - 1]
                factor = math.factorial(n)
                for degree in range(n, length):
                    series[row, degree] = h[degree - n] * (factor / math.factorial(degree))
                row += 1
        return series

    def __call__(self, leads: NDArray[np.float64]) -> NDArray[np.complex128]:
        """phi at `leads` [s], shape (function, lead)."""
        wave = np.exp(np.multiply.outer(-self._centres, leads))
        x = 1.0 - leads * (2.0 / self.duration)
        if self._single:
            powers = _powers(x, int(self._degree.max()) + 1)
            factors: NDArray[np.float64] | NDArray[np.complex128] = powers[self._degree]
        else:
            factors = self._series @ _powers(x, self._series.shape[1])
        return np.asarray(factors * wave[self._group], dtype=complex)

    @cached_property
    def derivative(self) -> NDArray[np.complex128]:
        """The matrix D with d phi / du = D phi, shape (function, function) [1/s]."""
        matrix = np.diag(-self.rates)
        rows = np.flatnonzero(self._degree)
        matrix[rows, rows - 1] = self._degree[rows] * (-2.0 / self.duration)
        return matrix


def _middle(group: Sequence[complex]) -> complex:
    if len(set(group)) == 1:
        return complex(group[0])
    parts = np.asarray(group)
    return complex(parts.real.min() + parts.real.max(), parts.imag.min() + parts.imag.max()) / 2.0


def _powers(x: NDArray[np.float64], count: int) -> NDArray[np.float64]:
    """x^0 ... x^(count - 1), shape (power, time)."""
    powers = np.empty((count, x.size))
    powers[0] = 1.0
    for k in range(1, count):
        np.multiply(powers[k - 1], x, out=powers[k])
    return powers
