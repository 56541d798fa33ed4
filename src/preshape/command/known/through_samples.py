"""A sampled command as a profile: the smooth curve through its samples."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.profile import Profile

__all__ = ["through_samples"]

FEWEST = 6


def through_samples(samples: ArrayLike, dt: float) -> Profile:
    """The cubic spline through the samples of a move from rest to rest, relative to the first one.

    So a recorded or generated move has the peaks of speed, acceleration and jerk that :func:`fastest_within` needs. The
    spline begins and ends with no speed and no acceleration; for that it leaves out the second sample and the last but
    one. Where the acceleration of the original jumps, that of the spline overshoots and its jerk grows with the sample
    rate: give such a command as its own profile.

    Parameters
    ----------
    samples : array_like, shape (time,)
        Positions [unit], evenly spaced, at least six.
    dt : float
        Sample time [s].

    Raises
    ------
    InputError
        If there are fewer samples, or one is NaN or infinite.

    Examples
    --------
    >>> t = np.linspace(0.0, 1.0, 101)
    >>> cycloidal = through_samples(t - np.sin(2.0 * np.pi * t) / (2.0 * np.pi), 0.01)
    >>> [round(cycloidal.peak(k).value, 2) for k in (1, 2, 3)], cycloidal.ends_at_rest
    ([2.0, 6.29, 39.47], True)
    """
    from scipy.linalg import solve_banded

    dt = positive("dt", dt, "s")
    values = np.asarray(samples, dtype=float)
    if values.ndim != 1 or values.size < FEWEST:
        raise InputError(f"the samples have shape {values.shape}: give one row of at least {FEWEST}, (time,).")
    if not np.isfinite(values).all():
        raise InputError(
            f"the samples hold NaN or infinity at {int(np.argmin(np.isfinite(values)))}: cut or mend them."
        )
    y = values - values[0]
    # The accelerations at the knots, 0 at the ends. From rest the second sample would be dt^2/6 of the next one away.
    rows = np.array([np.ones(y.size - 2), np.full(y.size - 2, 4.0), np.ones(y.size - 2)])
    rows[1, [0, -1]], rows[2, 0], rows[0, -1] = 6.0, 0.0, 0.0
    wanted = np.diff(y, 2)
    wanted[[0, -1]] = y[2] - y[0], y[-3] - y[-1]
    wanted[1], wanted[-2] = y[0] - 2.0 * y[2] + y[3], y[-4] - 2.0 * y[-3] + y[-1]
    knots = np.concatenate([[0.0], solve_banded((1, 1), rows, 6.0 / dt**2 * wanted), [0.0]])
    knots = knots + _closing(knots, dt, float(y[-1]))
    return Profile.steps(np.arange(y.size) * dt, np.diff(np.diff(knots) / dt, prepend=0.0, append=0.0), order=3)


def _closing(knots: NDArray[np.float64], dt: float, distance: float) -> NDArray[np.float64]:
    """What the accelerations at the knots lack to end at rest on the distance, 0 at the ends.

    It is rounding: the second differences of samples lose digits, and the whole move would drift by them.
    """
    u = np.linspace(0.0, 1.0, knots.size)
    shapes = [u * (1.0 - u), u**2 * (1.0 - u)]
    speed, way = _ends(knots, dt)
    weights = np.linalg.solve(np.array([_ends(shape, dt) for shape in shapes]).T, [-speed, distance - way])
    return np.asarray(weights @ np.array(shapes))


def _ends(knots: NDArray[np.float64], dt: float) -> tuple[float, float]:
    """Speed and way at the end of accelerations that are straight between the knots."""
    gained = 0.5 * dt * (knots[1:] + knots[:-1])
    speeds = np.concatenate([[0.0], np.cumsum(gained)])[:-1]
    return math.fsum(gained), math.fsum(dt * speeds + dt**2 * (2.0 * knots[:-1] + knots[1:]) / 6.0)
