"""Contour error: how far a path leaves the curve that it should follow, whenever it is there."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.command.path.polyline import Polyline
from preshape.errors import InputError

__all__ = ["ContourError", "checked_path", "contour_error"]

PARTS, MOST_LOOKS = (8, 64), 20_000
"""Parts into which the way between two samples is divided for a closer look, and the most looks a time."""

LOOSE = 1e-3
"""A bound that exceeds the largest distance by less than this part is close enough."""


@dataclass(frozen=True, eq=False, slots=True)
class ContourError:
    """Distances of a path from a curve.

    Parameters
    ----------
    distances : ndarray, shape (time,)
        From each sample of the path to the nearest place of the curve [unit].
    nearest : ndarray, shape (axis, time)
        Those places [unit].
    largest : float
        The largest of the distances [unit].
    bound : float
        What the path, straight from sample to sample, does not exceed between them either [unit].
    rms : float
        Root mean square along the path, each stretch weighted with its length [unit].
    index : int
        The sample where the largest is.
    place : ndarray, shape (axis,)
        Where that is [unit].
    """

    distances: NDArray[np.float64]
    nearest: NDArray[np.float64]
    largest: float
    bound: float
    rms: float
    index: int
    place: NDArray[np.float64]


def contour_error(commanded: ArrayLike, path: ArrayLike) -> ContourError:
    """How far a path leaves the commanded one's curve: in space, not in time.

    Parameters
    ----------
    commanded, path : array_like, shape (axis, time)
        Samples of all axes in one unit of length, joined by straight lines; the two may differ in number and times.
        With the two exchanged it is how near the path comes to every place of the command: how far a corner is missed.

    Returns
    -------
    ContourError
        Exact for the straight lines at the samples, and a bound between them.

    Raises
    ------
    InputError
        If a path is not (axis, time), holds NaN or infinity, has another number of axes, or rests throughout.

    Examples
    --------
    >>> found = contour_error([[0.0, 2.0, 2.0], [0.0, 0.0, 2.0]], [[0.0, 1.5, 2.0], [0.0, 0.25, 2.0]])
    >>> found.largest, found.place.tolist()
    (0.25, [1.5, 0.25])
    """
    curve, points = checked_path("the commanded path", commanded).T, checked_path("the path", path).T
    if curve.shape[1] != points.shape[1]:
        raise InputError(f"the paths have {curve.shape[1]} and {points.shape[1]} axes: give as many of each.")
    for name, one in (("commanded path", curve), ("path", points)):
        if not (one != one[0]).any():
            raise InputError(f"the {name} rests at one place, so it has no contour: give one that moves.")
    line = Polyline(curve)
    near = line.nearest(points)
    distances = near.distances
    distances.setflags(write=False)
    index = int(np.argmax(distances))
    lengths = np.linalg.norm(np.diff(points, axis=0), axis=1)
    pairs = np.stack([distances[:-1], distances[1:]])
    bounds = line.bounds_between(points, near)
    _tighten(bounds, line, points, float(distances[index]))
    # The integral of the square of what is straight between two samples.
    squares = (pairs[0] ** 2 + pairs[0] * pairs[1] + pairs[1] ** 2) / 3.0
    return ContourError(
        distances=distances,
        nearest=near.places.T,
        largest=float(distances[index]),
        bound=max(float(bounds.max()), float(distances[index])),
        rms=float(np.sqrt((squares @ lengths) / lengths.sum())),
        index=index,
        place=points[index].copy(),
    )


def _tighten(bounds: NDArray[np.float64], line: Polyline, points: NDArray[np.float64], largest: float) -> None:
    """Look more closely between those neighbours whose bound is far above what the samples reach, if they are few."""
    for parts in PARTS:
        loose = np.flatnonzero(bounds > largest * (1.0 + LOOSE))
        if not 0 < loose.size * parts <= MOST_LOOKS:
            return
        shares = np.linspace(0.0, 1.0, parts + 1)[:, None]
        looks = points[loose, None] * (1.0 - shares) + points[loose + 1, None] * shares
        flat = looks.reshape(-1, points.shape[1])
        closer = np.append(line.bounds_between(flat, line.nearest(flat)), 0.0).reshape(loose.size, parts + 1)
        bounds[loose] = np.minimum(bounds[loose], closer[:, :parts].max(axis=1))


def checked_path(name: str, path: ArrayLike) -> NDArray[np.float64]:
    """A path as an array of shape (axis, time), or a clear refusal."""
    try:
        values = np.array(path, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} must be rows of numbers, one an axis, all of the same length.") from None
    if values.ndim != 2 or values.size == 0:
        raise InputError(f"{name} has shape {values.shape}: give (axis, time), one row an axis.")
    if not np.isfinite(values).all():
        axis, sample = np.argwhere(~np.isfinite(values))[0]
        raise InputError(f"{name} holds NaN or infinity in row {axis + 1} at sample {sample}: give finite numbers.")
    return values
