"""phi functions: the integrals of an exponential against powers, good to the last digits at any argument.

phi_0(z) = exp(z), phi_{k+1}(z) = (phi_k(z) - 1/k!) / z = sum_n z^n / (n + k + 1)!. They are what a linear system makes
of a polynomial: the solution of q' = s q + t^k / k!, q(0) = 0, is q = t^(k+1) phi_{k+1}(s t). The division by z cancels
all digits at small z, so there the highest one is summed and the others follow downwards.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

__all__ = ["phi_functions"]

SUMMED_BELOW = 2.5
"""\\|z\\| below which the highest phi is summed as a power series. Going up from exp(z) multiplies rounding by
k!/\\|z\\|^k (8 at k = 7), going down by exp(\\|z\\|)/\\|z\\| (5): here both stay small."""

TERMS = 27
"""Of the power series; the next is below 1e-17 of the first at \\|z\\| = 2.5."""


def phi_functions(z: NDArray[np.complex128], count: int) -> list[NDArray[np.complex128]]:
    """phi_0, ..., phi_count of `z`.

    Parameters
    ----------
    z : ndarray of complex
        Real part not far above 0, or phi overflows.
    count : int
        Index of the highest one, 0 to about 8.

    Returns
    -------
    list of ndarray, each of the shape of `z`

    References
    ----------
    Hochbruck & Ostermann, Exponential integrators (2010), eq. 2.10 and 2.11.

    Examples
    --------
    >>> [round(float(phi[0].real), 12) for phi in phi_functions(np.array([1e-9 + 0j]), 3)]
    [1.000000001, 1.0000000005, 0.500000000167, 0.166666666708]
    """
    values = [np.exp(z)]
    if count == 0:
        return values
    if count == 1:
        with np.errstate(invalid="ignore", divide="ignore"):
            first = np.expm1(z) / z
        return [*values, np.where(z == 0.0, 1.0, first)]
    small = np.abs(z) < SUMMED_BELOW
    safe = np.where(small, 1.0, z)
    for k in range(count):
        values.append((values[k] - 1.0 / math.factorial(k)) / safe)
    if small.any():
        near = z[small]
        top = np.full(near.shape, 1.0 / math.factorial(count + TERMS), dtype=complex)
        for n in range(TERMS - 1, -1, -1):
            top = top * near + 1.0 / math.factorial(count + n)
        values[count][small] = top
        for k in range(count - 1, 0, -1):
            top = top * near + 1.0 / math.factorial(k)
            values[k][small] = top
    return values
