"""Integrals of exponentials over boxes, sum_i d_i int t^m exp(s t) dt: a shaper's constant parts in every residual.

(exp(s b) - exp(s a)) / s loses its digits as s goes to 0, where the box's mass is what remains; the phi functions keep
them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.kernel.phi_functions import phi_functions

__all__ = ["box_exponentials"]


def box_exponentials(
    boxes: NDArray[np.float64], rates: NDArray[np.complex128], moment: int = 0
) -> NDArray[np.complex128]:
    """sum_i density_i int_{start_i}^{end_i} t^moment exp(rate t) dt.

    Parameters
    ----------
    boxes : ndarray, shape (box, 3)
        Start [s], end [s] and density [1/s] of each; give times <= 0 when the rates have positive real parts, so that
        nothing overflows.
    rates : ndarray of complex, shape (rate,)
        [1/s], of any real part that is not far below zero.
    moment : int
        0, 1 or 2.

    Returns
    -------
    ndarray of complex, shape (rate,)

    Examples
    --------
    >>> box_exponentials(np.array([[-2.0, 0.0, 0.5]]), np.array([0j])).real.tolist()
    [1.0]
    """
    start, end, density = boxes.T
    width = end - start
    # With t = end - width x the integral over x is phi: exp(s end) width int_0^1 exp(-s width x) dx.
    phi = phi_functions(np.multiply.outer(-np.asarray(rates, dtype=complex), width), moment + 1)
    # t = start + width (1 - x), and phi_k holds (1 - x)^(k - 1) / (k - 1)!.
    values = start**moment * phi[1]
    if moment > 0:
        values = values + moment * start ** (moment - 1) * width * phi[2]
    if moment > 1:
        values = values + 2.0 * width**2 * phi[3]
    return np.asarray((np.exp(np.multiply.outer(rates, end)) * values) @ (density * width))
