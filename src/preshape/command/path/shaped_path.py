"""A path through the shapers of its axes, delayed alike or each as its shaper does."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.command.known.advanced import acceleration_error, late_samples, samples_ahead
from preshape.command.path.contour import ContourError, checked_path, contour_error
from preshape.errors import InputError
from preshape.shaper import Shaper

__all__ = ["DELAYS", "ShapedPath", "one_an_axis", "shaped_path"]

DELAYS = ("equal", "own")


@dataclass(frozen=True, eq=False, slots=True)
class ShapedPath:
    """A shaped path beside the commanded one.

    Parameters
    ----------
    commanded : ndarray, shape (axis, time)
        What was asked for [unit]; its first sample is at time 0.
    shaped : ndarray, shape (axis, time)
        What the axes are given [unit]; longer.
    dt : float
        Sample time of both [s].
    start : float
        Time of the first shaped sample [s], below 0 where it begins ahead.
    delays : tuple of float
        By how much each axis is late at constant speed [s]; 0 where it begins ahead by that much.
    acceleration_errors : tuple of float
        By how much each axis, apart from the delay, runs ahead of a constant acceleration, over that acceleration
        [s^2].
    """

    commanded: NDArray[np.float64]
    shaped: NDArray[np.float64]
    dt: float
    start: float
    delays: tuple[float, ...]
    acceleration_errors: tuple[float, ...]

    @property
    def times(self) -> NDArray[np.float64]:
        """Of the shaped samples [s], shape (time,)."""
        return np.asarray(self.start + np.arange(self.shaped.shape[1]) * self.dt)

    def contour_error(self) -> ContourError:
        """How far the shaped path leaves the commanded curve: :func:`contour_error` of both."""
        return contour_error(self.commanded, self.shaped)


def shaped_path(
    path: ArrayLike,
    shapers: Shaper | Sequence[Shaper],
    dt: float,
    *,
    delays: str = "equal",
    advance: bool = False,
) -> ShapedPath:
    """Shape the axes of a path that is known in advance.

    One shaper for all axes filters the path as a whole: straight lines stay straight, a circle of radius R at the
    angular speed w becomes one of radius R \\|S(i w)\\|. With a shaper for each axis the axes must be delayed alike, or
    each slanted line is left at every speed, by the difference of the delays.

    Parameters
    ----------
    path : array_like, shape (axis, time)
        Positions, evenly sampled, joined by straight lines; the machine rests at the first sample before and at the
        last one afterwards.
    shapers : Shaper, or sequence of Shaper
        One for all axes, or one each.
    dt : float
        Sample time [s].
    delays : {"equal", "own"}
        "equal" holds all axes back to the longest delay at constant speed, between the samples too; "own" leaves each
        with its shaper's. It is what :func:`preshape.design.synchronised` does for a controller.
    advance : bool
        Whether to begin the path ahead by the longest delay.

    Returns
    -------
    ShapedPath

    Raises
    ------
    InputError
        If the path is not (axis, time) or holds NaN, there is another number of shapers than one or one an axis, or an
        option is none of these.

    Examples
    --------
    >>> import preshape
    >>> from preshape.command import trapezoid
    >>> way = trapezoid(0.1, maximum_speed=0.2, maximum_acceleration=2.0, dt=0.001).values
    >>> line = np.outer([1.0, 0.5], way)
    >>> pair = [preshape.design.zv((10.0, 0.0)), preshape.design.zv((14.0, 0.0))]
    >>> own = shaped_path(line, pair, 0.001, delays="own").contour_error()
    >>> equal = shaped_path(line, pair, 0.001).contour_error()
    >>> bool(equal.largest < 0.3 * own.largest)
    True
    """
    rows = checked_path("the path", path)
    if delays not in DELAYS:
        raise InputError(f'delays is {delays!r}: it is "equal" or "own".')
    dt = positive("dt", dt, "s")
    each = one_an_axis(shapers, len(rows))
    centroids = [one.centroid for one in each]
    longest = max(centroids)
    ahead = longest if advance else 0.0
    held = [longest - centroid if delays == "equal" else 0.0 for centroid in centroids]
    early = samples_ahead(ahead, dt)
    shaped = [
        late_samples(row, one, dt, wait + early * dt - ahead, row[0])
        for row, one, wait in zip(rows, each, held, strict=True)
    ]
    length = max(row.size for row in shaped)
    return ShapedPath(
        commanded=rows,
        shaped=np.stack([np.pad(row, (0, length - row.size), mode="edge") for row in shaped]),
        dt=dt,
        start=-early * dt,
        delays=tuple(centroid + wait - ahead for centroid, wait in zip(centroids, held, strict=True)),
        acceleration_errors=tuple(acceleration_error(one) for one in each),
    )


def one_an_axis(shapers: Shaper | Sequence[Shaper], axes: int) -> tuple[Shaper, ...]:
    """The shapers of all axes from one for all or one each; InputError if they are neither."""
    if isinstance(shapers, Shaper):
        return (shapers,) * axes
    if not isinstance(shapers, Sequence) or not all(isinstance(one, Shaper) for one in shapers):
        raise InputError(f"{shapers!r} is no shaper: give one Shaper for all axes, or a list of one an axis.")
    if len(shapers) != axes:
        raise InputError(f"{len(shapers)} shapers were given for {axes} axes: give one for all, or one for each.")
    return tuple(shapers)
