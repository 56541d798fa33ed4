"""A shaper's frequency response as data of python-control."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from preshape.errors import InputError
from preshape.shaper import Shaper
from preshape.vibration.transform import transform

__all__ = ["frequency_response"]


def frequency_response(shaper: Shaper, omega: ArrayLike) -> Any:
    """S(i w) of a shaper, exact: sum_k A_k exp(-i w t_k), and what its boxes add; no samples, no rational fit.

    Multiply it with the frequency response of a plant to see what the shaped command excites.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    omega : array_like, shape (frequency,)
        Increasing frequencies, at least 0 [rad/s].

    Returns
    -------
    control.FrequencyResponseData
        ``pip install preshape[interop]`` brings python-control.

    Raises
    ------
    InputError
        If the frequencies are no increasing row of finite numbers from 0 on, or python-control is not installed.
    """
    try:
        w = np.asarray(omega, dtype=float)
    except (TypeError, ValueError):
        w = np.empty(0)
    if w.ndim != 1 or w.size == 0 or not np.isfinite(w).all() or w[0] < 0.0 or (np.diff(w) <= 0.0).any():
        raise InputError("omega must be a row of increasing frequencies in rad/s, finite and at least 0.")
    try:
        import control
    except ImportError:
        raise InputError("python-control is not installed: pip install 'preshape[interop]'.") from None
    return control.frd(transform(shaper, np.asarray(-1j * w)), w)
