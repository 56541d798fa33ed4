"""Sums of exponentials, sum_i a_i exp(s t_i): every residual, sensitivity curve and certificate is one.

A complex exponential costs about forty times a multiplication. On an evenly spaced grid of rates most of them can be
saved: with k = m q + r the factor exp(k ds t) is exp(m q ds t) exp(r ds t), so n points need about 2 sqrt(n)
exponentials an impulse and one matrix product.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["exponential_sum", "exponential_sum_uniform"]

BLOCK = 4096
"""Rates evaluated at a time, so that the phase table of a 27-impulse shaper stays in the cache."""


def exponential_sum(
    amplitudes: NDArray[np.float64], times: NDArray[np.float64], rates: NDArray[np.complex128]
) -> NDArray[np.complex128]:
    """sum_i amplitudes[i] exp(rates * times[i]), directly.

    Parameters
    ----------
    amplitudes, times : ndarray, shape (impulse,)
        Weights [-] and times [s]; give times <= 0 when the rates have positive real parts, so that nothing overflows.
    rates : ndarray of complex, shape (rate,)
        [1/s]

    Returns
    -------
    ndarray of complex, shape (rate,)
    """
    result = np.empty(rates.shape, dtype=np.complex128)
    for start in range(0, rates.size, BLOCK):
        block = rates[start : start + BLOCK]
        phase = np.multiply.outer(block.imag, times)
        if block.real.any():
            weights = amplitudes * np.exp(np.multiply.outer(block.real, times))
            result.real[start : start + BLOCK] = np.einsum("ri,ri->r", np.cos(phase), weights)
            result.imag[start : start + BLOCK] = np.einsum("ri,ri->r", np.sin(phase), weights)
        else:
            result.real[start : start + BLOCK] = np.cos(phase) @ amplitudes
            result.imag[start : start + BLOCK] = np.sin(phase) @ amplitudes
    return result


def exponential_sum_uniform(
    amplitudes: NDArray[np.float64], times: NDArray[np.float64], first: complex, step: complex, count: int
) -> NDArray[np.complex128]:
    """The same sum at the `count` rates first, first + step, first + 2 step, ..., with few exponentials.

    Parameters
    ----------
    amplitudes, times : ndarray, shape (impulse,)
        As for :func:`exponential_sum`.
    first, step : complex
        First rate and increment [1/s].
    count : int
        How many rates, at least one.

    Returns
    -------
    ndarray of complex, shape (count,)
    """
    fine_count = max(1, math.isqrt(count))
    coarse_count = -(-count // fine_count)
    fine = np.exp(np.multiply.outer(times, step * np.arange(fine_count)))
    coarse = np.exp(np.multiply.outer(first + step * fine_count * np.arange(coarse_count), times))
    coarse *= amplitudes
    values: NDArray[np.complex128] = (coarse @ fine).reshape(-1)[:count]
    return values
