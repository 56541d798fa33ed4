"""Residual vibration, and how it depends on frequency and damping.

V(w, z) = exp(-z w t_N) |sum_i A_i exp((z w + i w sqrt(1 - z^2)) t_i)|   (Robertson eq. 1-3; mind the + sign)

is the amplitude that mode (w, z) keeps after the last impulse at t_N, relative to what one unit impulse at t = 0 would
leave; a part of constant density adds its integral to the sum. All of this library evaluates this one formula, with
times counted from t_N so that nothing overflows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError
from preshape.shaper import Shaper
from preshape.vibration.transform import transform, transform_uniform

__all__ = [
    "Sensitivity",
    "checked_frequency_and_damping",
    "damping_sensitivity_curve",
    "residual_vibration",
    "sensitivity_curve",
    "sensitivity_map",
]


@dataclass(frozen=True)
class Sensitivity:
    """Residual vibration over frequency, damping or both.

    Parameters
    ----------
    frequencies : ndarray, shape (frequency,)
        Undamped natural frequencies [Hz].
    dampings : ndarray, shape (damping,)
        Damping ratios [-].
    vibration : ndarray, shape (damping, frequency)
        V [-]: 1 is as much as without a shaper, 0.05 is 5 %.
    """

    frequencies: NDArray[np.float64]
    dampings: NDArray[np.float64]
    vibration: NDArray[np.float64]


def residual_vibration(shaper: Shaper, frequency: ArrayLike, damping: ArrayLike = 0.0) -> NDArray[np.float64]:
    """V at given natural frequencies and damping ratios.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    frequency : array_like
        Undamped natural frequencies [Hz], finite and at least 0.
    damping : array_like
        Damping ratios [-] in [0, 1), broadcast against `frequency`.

    Returns
    -------
    ndarray
        V [-] of the broadcast shape.

    Raises
    ------
    InputError
        If a frequency or damping ratio is out of range.

    References
    ----------
    Robertson, eq. 1-3.

    Examples
    --------
    >>> import preshape
    >>> float(residual_vibration(preshape.Shaper([0.0, 0.5], [0.5, 0.5]), 0.0))
    1.0
    """
    f, z = checked_frequency_and_damping(frequency, damping)
    shape = np.broadcast_shapes(f.shape, z.shape)
    if z.ndim == 0 and f.ndim == 1 and (uniform := _uniform_step(f)) is not None:
        rate = 2.0 * math.pi * complex(float(z), math.sqrt(1.0 - float(z) ** 2))
        return np.abs(transform_uniform(shaper, rate * float(f[0]), rate * uniform, f.size, origin=shaper.duration))
    rates = 2.0 * np.pi * (f * z + 1j * f * np.sqrt(1.0 - z**2))
    return np.abs(transform(shaper, np.ravel(rates), origin=shaper.duration)).reshape(shape)


def sensitivity_curve(shaper: Shaper, frequencies: ArrayLike, damping: float = 0.0) -> Sensitivity:
    """V over natural frequency at one damping ratio.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    frequencies : array_like, shape (frequency,)
        [Hz]; evenly spaced ones are about ten times faster.
    damping : float
        Damping ratio [-].

    Examples
    --------
    >>> import preshape
    >>> curve = sensitivity_curve(preshape.design.zv((10.0, 0.0)), [5.0, 10.0])
    >>> curve.vibration.round(3).tolist()
    [[0.707, 0.0]]
    """
    return sensitivity_map(shaper, frequencies, [damping])


def damping_sensitivity_curve(shaper: Shaper, frequency: float, dampings: ArrayLike) -> Sensitivity:
    """V over damping ratio (array_like, shape (damping,)) at one natural frequency [Hz]."""
    return sensitivity_map(shaper, [frequency], dampings)


def sensitivity_map(shaper: Shaper, frequencies: ArrayLike, dampings: ArrayLike) -> Sensitivity:
    """V over natural frequency [Hz] (shape (frequency,)) and damping ratio [-] (shape (damping,))."""
    f, z = checked_frequency_and_damping(frequencies, dampings)
    if f.ndim != 1 or z.ndim != 1:
        raise InputError("frequencies and dampings must be flat lists: one axis each of the map.")
    rows = [residual_vibration(shaper, f, float(damping)) for damping in z]
    return Sensitivity(f, z, np.array(rows).reshape(z.size, f.size))


def checked_frequency_and_damping(
    frequency: ArrayLike, damping: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Both as arrays; InputError when one is out of range."""
    f, z = np.asarray(frequency, dtype=float), np.asarray(damping, dtype=float)
    if not (np.isfinite(f).all() and (f >= 0.0).all()):
        raise InputError("a frequency is negative, NaN or infinite: give natural frequencies in hertz, 0 or more.")
    if not ((z >= 0.0) & (z < 1.0)).all():
        raise InputError("a damping ratio is outside [0, 1): give 0.05 for 5 %.")
    return f, z


def _uniform_step(f: NDArray[np.float64]) -> float | None:
    """The step of an evenly spaced grid, or None."""
    if f.size < 3:
        return None
    step = float(f[-1] - f[0]) / (f.size - 1)
    deviation = np.abs(f - (f[0] + step * np.arange(f.size))).max()
    return step if deviation <= 8.0 * np.finfo(float).eps * max(abs(float(f[0])), abs(float(f[-1]))) else None
