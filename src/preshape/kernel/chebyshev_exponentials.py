"""The span of u^k exp(-s_j u) as orthonormal Chebyshev series, for rates too dense to be told apart in doubles.

Where many modes fill a frequency range, their exponentials on a short interval are dependent to ten digits and more.
Their Chebyshev coefficients (Jacobi-Anger: modified Bessel functions of s T / 2, by Miller's backward recurrence) and
their orthogonalisation take thirty-two digits; the orthonormal series that come out are ordinary well-behaved functions
that doubles evaluate to the last digit.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.kernel.double_double import DoubleDouble

__all__ = ["chebyshev_derivative", "chebyshev_values", "orthonormal_series"]

STRETCH, TAIL = 1.2, 60.0
"""Coefficients beyond 1.2 |s T / 2| + 60 are below 1e-32 of the largest."""

SEED = 1e-40
"""Where the backward recurrence starts; its end is scaled to the right value."""

DEPENDENT = 1e-22
"""A function of which orthogonalisation leaves no more than this is a combination of the others, for ten digits of
what is left would be rounding: it asks for nothing that they do not ask."""


def orthonormal_series(rates: NDArray[np.complex128], orders: tuple[int, ...], duration: float) -> NDArray[np.float64]:
    """Chebyshev coefficients, in x = 1 - 2 u / T, of orthonormal real functions spanning u^k exp(-s_j u), k <= order_j.

    Parameters
    ----------
    rates : ndarray of complex, shape (mode,)
        s_j [1/s].
    orders : tuple of int
        Highest power k of each.
    duration : float
        T [s].

    Returns
    -------
    ndarray, shape (row, coefficient)
        At most 2 sum_j (order_j + 1) rows, orthonormal as vectors; none where a function falls by more than floating
        point holds.
    """
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        real, imaginary = _exponentials(rates * (duration / 2.0))
    if not (np.isfinite(real.high).all() and np.isfinite(imaginary.high).all()):
        return np.empty((0, 1))
    parts: list[DoubleDouble] = []
    for part in (real, imaginary):
        for j, order in enumerate(orders):
            row = part[j]
            for k in range(order + 1):
                parts.append(row)
                if k < order:
                    row = _times_x(row)
    return _orthonormal(DoubleDouble(np.array([p.high for p in parts]), np.array([p.low for p in parts])))


def chebyshev_values(leads: NDArray[np.float64], duration: float, count: int) -> NDArray[np.float64]:
    """T_0 ... T_(count-1) of x = 1 - 2 u / T at `leads` u [s], shape (coefficient, lead)."""
    ratio = leads / duration
    inside = 2.0 * np.arcsin(np.sqrt(np.clip(ratio, 0.0, 1.0)))
    values = np.cos(np.multiply.outer(np.arange(count), inside))
    beyond = np.flatnonzero((ratio > 1.0) | (ratio < 0.0))
    if beyond.size:
        values[:, beyond] = np.polynomial.chebyshev.chebvander(1.0 - 2.0 * ratio[beyond], count - 1).T
    return values


def chebyshev_derivative(count: int, duration: float) -> NDArray[np.float64]:
    """The matrix D with d T_l / du = sum_k D[l, k] T_k, shape (count, count) [1/s]."""
    matrix = np.zeros((count, count))
    for degree in range(1, count):
        matrix[degree, degree - 1 :: -2] = 2.0 * degree
        if degree % 2:
            matrix[degree, 0] = degree
    return matrix * (-2.0 / duration)


def _exponentials(z: NDArray[np.complex128]) -> tuple[DoubleDouble, DoubleDouble]:
    """Coefficients of exp(z (x - 1)) for each z, real and imaginary parts, shape (rate, coefficient)."""
    ends = np.ceil(STRETCH * np.abs(z) + TAIL).astype(int)
    count = int(ends.max()) + 1
    zero = DoubleDouble.of(np.zeros(z.size))
    size = DoubleDouble.of(z.real) * DoubleDouble.of(z.real) + DoubleDouble.of(z.imag) * DoubleDouble.of(z.imag)
    over_real, over_imaginary = DoubleDouble.of(z.real) / size, DoubleDouble.of(-z.imag) / size
    later, now = (zero, zero), (zero, zero)
    columns: list[tuple[DoubleDouble, DoubleDouble]] = []
    for degree in range(count - 1, -1, -1):
        seed = DoubleDouble.of(np.where(ends == degree, SEED, 0.0))
        now = (now[0] + seed, now[1])
        columns.append(now)
        factor = DoubleDouble.of(np.full(z.size, 2.0 * degree))
        real, imaginary = factor * over_real, factor * over_imaginary
        before = (
            later[0] + (real * now[0] - imaginary * now[1]),
            later[1] + (real * now[1] + imaginary * now[0]),
        )
        later, now = now, before
    columns.reverse()
    real = DoubleDouble(np.array([c[0].high for c in columns]).T, np.array([c[0].low for c in columns]).T)
    imaginary = DoubleDouble(np.array([c[1].high for c in columns]).T, np.array([c[1].low for c in columns]).T)
    twice = DoubleDouble.of(np.where(np.arange(count) > 0, 2.0, 1.0) * np.ones((z.size, 1)))
    real, imaginary = real * twice, imaginary * twice
    # at x = 1 the value is 1: that scales the whole series
    total_real, total_imaginary = real.sum()[:, None], imaginary.sum()[:, None]
    norm = total_real * total_real + total_imaginary * total_imaginary
    return (
        (real * total_real + imaginary * total_imaginary) / norm,
        (imaginary * total_real - real * total_imaginary) / norm,
    )


def _times_x(row: DoubleDouble) -> DoubleDouble:
    """The series of x f from that of f: x T_l = (T_(l-1) + T_(l+1)) / 2; the end of the series is zero to rounding."""
    up_high, up_low = np.zeros_like(row.high), np.zeros_like(row.low)
    down_high, down_low = np.zeros_like(row.high), np.zeros_like(row.low)
    up_high[1:], up_low[1:] = 0.5 * row.high[:-1], 0.5 * row.low[:-1]
    up_high[1], up_low[1] = row.high[0], row.low[0]
    down_high[:-1], down_low[:-1] = 0.5 * row.high[1:], 0.5 * row.low[1:]
    return DoubleDouble(up_high, up_low) + DoubleDouble(down_high, down_low)


def _orthonormal(rows: DoubleDouble) -> NDArray[np.float64]:
    """Modified Gram-Schmidt in 32 digits, the function with the largest rest first."""
    high, low = rows.high.copy(), rows.low.copy()
    count = high.shape[0]
    for i in range(count):
        rest = DoubleDouble(high[i:], low[i:])
        sizes = (rest * rest).sum()
        chosen = i + int(np.argmax(sizes.high))
        for array in (high, low):
            array[[i, chosen]] = array[[chosen, i]]
        one = DoubleDouble(high[i : i + 1], low[i : i + 1])
        length = (one * one).sum().sqrt()
        if not length.high[0] > DEPENDENT:
            return np.asarray(high[:i], dtype=float)
        one = one / length[:, None]
        high[i], low[i] = one.high[0], one.low[0]
        if i + 1 < count:
            others = DoubleDouble(high[i + 1 :], low[i + 1 :])
            others = others - (others * one).sum()[:, None] * one
            high[i + 1 :], low[i + 1 :] = others.high, others.low
    return high
