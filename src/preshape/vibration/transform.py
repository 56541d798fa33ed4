"""The transform of a shaper, sum_i a_i exp(s t_i) and its boxes: what every measure of vibration evaluates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.kernel import box_exponentials, exponential_sum, exponential_sum_uniform
from preshape.shaper import Shaper

__all__ = ["transform", "transform_uniform"]


def transform(
    shaper: Shaper, rates: NDArray[np.complex128], *, origin: float = 0.0, moment: int = 0
) -> NDArray[np.complex128]:
    """The integral of (t - origin)^moment exp(s (t - origin)) over the shaper.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    rates : ndarray of complex, shape (rate,)
        s [1/s].
    origin : float
        From when times are counted [s]; the shaper's duration, so that nothing overflows where s has a positive real
        part.
    moment : int
        0, or 1 and 2 for derivatives with respect to s.

    Returns
    -------
    ndarray of complex, shape (rate,)
    """
    times = shaper.times - origin
    weights = shaper.amplitudes * times**moment if moment else shaper.amplitudes
    values = exponential_sum(weights, times, rates)
    return values + box_exponentials(_boxes(shaper, origin), rates, moment) if shaper.boxes else values


def transform_uniform(
    shaper: Shaper, first: complex, step: complex, count: int, *, origin: float = 0.0, moment: int = 0
) -> NDArray[np.complex128]:
    """The same at the `count` rates first, first + step, ..., with few exponentials for the impulses."""
    times = shaper.times - origin
    weights = shaper.amplitudes * times**moment if moment else shaper.amplitudes
    values = exponential_sum_uniform(weights, times, first, step, count)
    if not shaper.boxes:
        return values
    rates: NDArray[np.complex128] = first + step * np.arange(count, dtype=complex)
    return values + box_exponentials(_boxes(shaper, origin), rates, moment)


def _boxes(shaper: Shaper, origin: float) -> NDArray[np.float64]:
    return np.asarray(np.array(shaper.boxes) - np.array([origin, origin, 0.0]))
