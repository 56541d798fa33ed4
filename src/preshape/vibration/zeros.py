"""Zeros of a shaper in the s-plane: a pole of the plant on a zero is vibration that is not left."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Modes, ModesLike
from preshape.shaper import Shaper
from preshape.vibration.transform import transform

__all__ = ["ShaperZero", "zeros_near"]

SPREAD = (-1.0, -0.5, 0.0, 0.5, 1.0)
"""Newton's method starts so many spacings of zeros, 1/duration, above and below each pole, and on it."""

STEPS = 30

CONVERGED = 1e-7
"""Newton's method has arrived when it moves by less than this fraction of the spacing."""

SAME = 1e-4
"""Newton's method has found the same zero when two ends are nearer than this fraction of the spacing."""

CIRCLE, AROUND = 0.02, 32
"""Zeros within this radius, relative to the spacing, count as one of a higher order; points on the circle."""

ZERO = 1e-9
"""|F| there, relative to the sum of the sizes of its terms, where it counts as zero."""

REACH = 1.5
"""Zeros farther from each pole than this many spacings are left out."""


@dataclass(frozen=True, slots=True)
class ShaperZero:
    """A zero of F(s) = sum_i A_i exp(-s t_i).

    Parameters
    ----------
    place : complex
        s [1/s], above the real axis; its conjugate is one too.
    order : int
        Multiplicity: 1 as of ZV at its mode, 2 as of ZVD ...
    """

    place: complex
    order: int


def zeros_near(shaper: Shaper, modes: ModesLike) -> tuple[ShaperZero, ...]:
    """The zeros of a shaper's transfer function about the poles of modes.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    modes : Mode, (frequency, damping) or several
        Whose poles: natural frequencies [Hz], damping ratios [-].

    Returns
    -------
    tuple of ShaperZero
        Within about 1.5 / duration of a pole's frequency, in order of the imaginary part; found by Newton's method on
        F/F', which converges on multiple zeros as on simple ones.

    Examples
    --------
    >>> import preshape
    >>> zero, = [z for z in zeros_near(preshape.design.zvd((10.0, 0.1)), (10.0, 0.1)) if z.place.imag < 70.0]
    >>> zero.order, round(zero.place.real, 4), round(zero.place.imag, 4)
    (2, -6.2832, 62.5169)
    """
    poles = np.array([mode.pole for mode in Modes(modes)])
    if shaper.duration == 0.0:
        return ()
    spacing = 2.0 * math.pi / shaper.duration
    s = (poles[:, np.newaxis] + 1j * spacing * np.array(SPREAD)).ravel()
    moving = np.arange(s.size)
    for _ in range(STEPS):
        value, first, second = _derivatives(shaper, s[moving])
        # u = F/F' has a simple zero wherever F has one of any order; u / u' is Newton's step.
        step = _limited(value * first, first**2 - value * second, 0.25 * spacing)
        s[moving] -= step
        moving = moving[np.abs(step) > CONVERGED * spacing]
        if moving.size == 0:
            break
    value, _, _ = _derivatives(shaper, s)
    scale = _size(shaper, s)
    near = np.abs(s[:, np.newaxis] - poles).min(axis=1) <= REACH * spacing
    found = s[near & (np.abs(value) <= ZERO * scale) & (s.imag > 0.0)]
    return tuple(_merged(shaper, found, spacing))


def _derivatives(
    shaper: Shaper, s: NDArray[np.complex128]
) -> tuple[NDArray[np.complex128], NDArray[np.complex128], NDArray[np.complex128]]:
    """F and two derivatives of F exp(s T), which has the same zeros and does not overflow left of the axis."""
    origin = shaper.duration
    if shaper.boxes:
        h, first, second = (transform(shaper, -s, origin=origin, moment=moment) for moment in range(3))
    else:
        times = shaper.times - origin
        weights = shaper.amplitudes[:, np.newaxis] * times[:, np.newaxis] ** np.arange(3)
        h, first, second = (np.exp(np.multiply.outer(-s, times)) @ weights).T
    return h, -first, second


def _size(shaper: Shaper, s: NDArray[np.complex128]) -> NDArray[np.float64]:
    decays = np.exp(np.multiply.outer(-s.real, shaper.times - shaper.duration))
    sizes = decays @ np.abs(shaper.amplitudes)
    for start, end, density in shaper.boxes:
        ends = np.exp(np.multiply.outer(-s.real, np.array([start, end]) - shaper.duration)).max(axis=1)
        sizes = sizes + abs(density) * (end - start) * ends
    return np.asarray(sizes)


def _merged(shaper: Shaper, found: NDArray[np.complex128], spacing: float) -> list[ShaperZero]:
    """One of each cluster, with its order."""
    places: list[complex] = []
    for place in found[np.argsort(found.imag, kind="stable")].tolist():
        if not any(abs(place - other) <= SAME * spacing for other in places):
            places.append(place)
    if not places:
        return []
    # The principle of the argument on a small circle: F'/F integrates to the zeros within and, times s, to their sum,
    # which is exact where the zeros of a multiple one by one are rounding.
    turns = CIRCLE * spacing * np.exp(2j * np.pi * np.arange(AROUND) / AROUND)
    value, first, _ = _derivatives(shaper, np.add.outer(np.array(places), turns).ravel())
    ratios = (first / _nonzero(value)).reshape(len(places), AROUND) * turns / AROUND
    orders = np.maximum(np.rint(ratios.sum(axis=1).real), 1.0)
    centres = np.array(places) + (ratios @ turns) / orders
    zeros: list[ShaperZero] = []
    for centre, order in zip(centres.tolist(), orders.astype(int).tolist(), strict=True):
        if not any(abs(centre - other.place) <= CIRCLE * spacing for other in zeros):
            zeros.append(ShaperZero(centre, order))
    return zeros


def _limited(above: NDArray[np.complex128], below: NDArray[np.complex128], longest: float) -> NDArray[np.complex128]:
    """above / below, shortened to `longest`; 0 where both vanish, on a multiple zero."""
    direction = above * below.conj()
    size, square = np.abs(direction), np.abs(below) ** 2
    short = size < longest * square
    scale = np.where(short, square, np.where(size > 0.0, size / longest, 1.0))
    return np.where(scale > 0.0, direction / np.where(scale > 0.0, scale, 1.0), 0.0)


def _nonzero(values: NDArray[np.complex128]) -> NDArray[np.complex128]:
    return np.where(values == 0.0, np.finfo(float).tiny, values)
