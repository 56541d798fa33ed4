"""Shapers of several axes that delay alike: each held back until all have the same centroid."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from preshape.checks import not_negative
from preshape.errors import InputError
from preshape.shaper import Shaper

__all__ = ["delayed", "synchronised"]

ROUNDING = 16.0 * np.finfo(float).eps
"""A delay below this part of the shaper's duration is the rounding of a centroid."""


def delayed(shaper: Shaper, time: float) -> Shaper:
    """The same shaper, `time` [s] later: a leading impulse of amplitude 0 says when the command came.

    What it leaves of any vibration is the same. It is a shaper like any other: saved, put on a grid, convolved
    and streamed with its delay.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    time : float
        Delay [s], 0 or more.

    Returns
    -------
    Shaper
        ``design.settings["delay"]`` is the whole delay [s]. A proof that the shaper was shortest is not kept.

    Raises
    ------
    InputError
        If the delay is negative or not finite.

    Examples
    --------
    >>> later = delayed(Shaper([0.0, 0.5], [0.5, 0.5]), 0.25)
    >>> later.times.tolist(), later.amplitudes.tolist(), later.centroid
    ([0.0, 0.25, 0.75], [0.0, 0.5, 0.5], 0.5)
    """
    time = not_negative("the delay", time, "s")
    if time <= ROUNDING * shaper.duration:
        return shaper
    waited = int(shaper.amplitudes[0] == 0.0)
    settings = {key: value for key, value in shaper.design.settings.items() if key not in ("proved", "gap")}
    settings["delay"] = time + settings.get("delay", 0.0)
    status = "feasible" if shaper.design.status == "optimal" else shaper.design.status
    return Shaper(
        np.append(0.0, shaper.times[waited:] + time),
        np.append(0.0, shaper.amplitudes[waited:]),
        replace(shaper.design, settings=settings, status=status, certificate=None),
        [(start + time, end + time, density) for start, end, density in shaper.boxes],
    )


def synchronised(shapers: Sequence[Shaper]) -> tuple[Shaper, ...]:
    """The shapers of several axes, all but the slowest held back so that all have the same centroid.

    At constant speed a shaper delays by its centroid. With the same one on every axis a straight line at constant speed
    stays on its line, although each axis has a shaper for its own modes; where the path accelerates by a [unit/s^2] an
    axis runs ahead by a/2 times its shaper's second central moment, and the axes differ by the difference of these.

    Parameters
    ----------
    shapers : sequence of Shaper
        One an axis.

    Returns
    -------
    tuple of Shaper
        In the same order; see :func:`delayed`.

    Raises
    ------
    InputError
        If it is no list of at least one shaper.

    Examples
    --------
    >>> import preshape
    >>> x, y = synchronised([preshape.design.zvd((40.0, 0.05)), preshape.design.zvd((65.0, 0.05))])
    >>> abs(x.centroid - y.centroid) < 1e-15, y.duration < x.duration
    (True, True)
    """
    if isinstance(shapers, Shaper) or not isinstance(shapers, Sequence) or not shapers:
        raise InputError("synchronised takes the shapers of several axes: give a list of Shaper, one an axis.")
    for number, one in enumerate(shapers, 1):
        if not isinstance(one, Shaper):
            raise InputError(f"number {number} of the shapers is {one!r}: give a list of Shaper, one an axis.")
    latest = max(one.centroid for one in shapers)
    return tuple(delayed(one, latest - one.centroid) for one in shapers)
