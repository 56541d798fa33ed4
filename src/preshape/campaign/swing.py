"""How much a plant still swings after a move, linear or not, drifting or not."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.mode import Modes

__all__ = ["PERIODS", "swing"]

PERIODS = 2.0
"""Of the slowest mode, in which largest and least value are looked for; in less, drift cannot be told from it."""

FASTEST = 0.45
"""Modes above this part of the sample rate cannot be told from slower ones."""

HOPS = 4
"""Windows begin at every quarter of a window."""


def swing(values: NDArray[np.float64], dt: float, modes: Modes) -> float:
    """Half of the largest swing within two periods of the slowest mode, drift taken out.

    Drift is a parabola in each window, fitted together with the modes, so that it takes nothing of theirs: a free body
    coasts, and slow loops settle. What else the plant does, being non-linear, stays in the swing.

    Parameters
    ----------
    values : ndarray, shape (sample,)
        An output after the move [its unit].
    dt : float
        [s].
    modes : Modes
        What vibrates.

    Raises
    ------
    InputError
        If the samples are too few for a window, or miss the slowest mode.

    Examples
    --------
    >>> times = 0.01 * np.arange(500)
    >>> round(swing(3.0 * np.cos(2.0 * np.pi * times) + 0.5 * times, 0.01, Modes((1.0, 0.0))), 6)
    3.0
    """
    slowest = min(mode.frequency for mode in modes)
    length = round(PERIODS / (slowest * dt)) + 1
    seen = [mode for mode in modes if mode.frequency * dt < FASTEST]
    if not seen or length > values.size:
        raise InputError(
            f"{values.size} samples of {dt:g} s cannot show a mode of {slowest:.4g} Hz: give a smaller dt, or a longer "
            "rest."
        )
    x = np.linspace(-1.0, 1.0, length)
    slow = np.vander(x, 3)
    ringing = np.exp(np.multiply.outer(dt * np.arange(length), np.array([mode.pole for mode in seen])))
    fit = np.linalg.pinv(np.concatenate([slow, ringing.real, ringing.imag], axis=1))
    windows = np.lib.stride_tricks.sliding_window_view(values, length)[:: max(length // HOPS, 1)]
    left = windows - (windows @ fit[:3].T) @ slow.T
    return 0.5 * float(np.ptp(left, axis=1).max())
