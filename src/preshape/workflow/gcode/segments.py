"""A sampled motion as few straight segments of constant speed, within a tolerance at every sample."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError

__all__ = ["segments"]


def segments(
    motion: NDArray[np.float64], tolerance: float, fewest: int, digits: int, unit: float
) -> tuple[NDArray[np.intp], NDArray[np.float64], float]:
    """Where the segments end: each as long as the tolerance allows.

    Parameters
    ----------
    motion : ndarray, shape (axis, time)
        What is to be followed [mm].
    tolerance : float
        How far it may be left at any sample, at the same time [mm]: in space and in the time law at once.
    fewest : int
        Samples that a segment lasts at least; the last one may go on into the rest behind the motion.
    digits : int
        Decimals of the places, in units of `unit` [mm].
    unit : float
        [mm].

    Returns
    -------
    ends : ndarray of int, shape (segment + 1,)
        Samples where they begin and end.
    places : ndarray, shape (axis, segment + 1)
        Rounded places there [mm].
    deviation : float
        The largest distance at a sample, rounding included [mm].

    Raises
    ------
    InputError
        If a segment of the fewest samples leaves the motion by more than the tolerance.
    """
    last = motion.shape[1] - 1
    held = np.pad(motion, ((0, 0), (0, fewest)), mode="edge")
    rounded = np.round(held / unit, digits) * unit
    ends, worst, here = [0], 0.0, 0
    while here < last:
        low = here + fewest
        error = _deviation(held, rounded, here, low)
        if error > tolerance:
            raise InputError(
                f"segments of {fewest} samples leave the shaped motion by {error:.3g} mm, more than the tolerance of "
                f"{tolerance:g} mm: allow shorter segments, or a larger tolerance."
            )
        step, high = fewest, low
        while high < last:  # longer and longer, until one is too long
            further = min(here + 2 * step, last)
            found = _deviation(held, rounded, here, further)
            if found > tolerance:
                high = further
                break
            low, error, step, high = further, found, further - here, further
        while high - low > 1:
            middle = (low + high) // 2
            found = _deviation(held, rounded, here, middle)
            low, high, error = (middle, high, found) if found <= tolerance else (low, middle, error)
        worst, here = max(worst, error), low
        ends.append(here)
    at = np.array(ends, dtype=np.intp)
    return at, rounded[:, at], worst


def _deviation(held: NDArray[np.float64], rounded: NDArray[np.float64], begin: int, end: int) -> float:
    """The largest distance between the motion and the segment at a sample of it."""
    shares = np.linspace(0.0, 1.0, end - begin + 1)
    line = rounded[:, begin, None] + (rounded[:, end] - rounded[:, begin])[:, None] * shares
    return float(np.sqrt(((held[:, begin : end + 1] - line) ** 2).sum(axis=0).max()))
