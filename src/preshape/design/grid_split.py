"""Impulses split over samples so that the modes do not notice: Murphy & Watanabe's zeros in the plane of z.

On the grid a residual at a mode is a polynomial in z = exp(-s dt), linear in the taps. The taps nearest to the linear
split (least sum of squares) that give the values the shaper had between samples are a small linear problem. Two
neighbours an impulse are as many unknowns as a shortest shaper has equations; where some impulses lie on samples, or a
tap would turn negative, further neighbours join.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.checks import positive
from preshape.engine.basis import plain_rows
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.shaper import Shaper
from preshape.vibration.transform import transform

__all__ = ["exact_split", "vanishing_orders"]

ZERO = 1e-9
"""A residual or derivative below this is one that vanishes [-]; designs are zero to about 1e-13."""

HELD = 1e-11
"""How well the equations must hold on the grid [-]: rounding of some hundred taps."""

HIGHEST_ORDER = 6

WIDEST = 4
"""Samples on each side of an impulse's own two that may join."""

SPARED = 1e-14
"""Taps smaller than this are rounding of zero [-]."""


def vanishing_orders(shaper: Shaper, what: str) -> tuple[int, ...]:
    """How many derivatives of the residual vanish at each design mode with it; -1 where the residual does not.

    Raises
    ------
    InputError
        If the shaper does not know its modes, which `what` needs.
    """
    modes = shaper.design.modes
    if modes is None:
        raise InputError(f"{what} needs the modes, which this shaper does not know: give one from a design function.")
    orders = []
    for mode in modes:
        values = np.abs(_values(shaper, Modes(mode), (HIGHEST_ORDER,), max(shaper.duration, mode.damped_period)))
        large = values.reshape(2, -1).max(axis=0) > ZERO
        orders.append(int(np.argmax(large)) - 1 if large.any() else HIGHEST_ORDER)
    return tuple(orders)


def exact_split(shaper: Shaper, dt: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Delays [samples] and weights [-], both shape (tap,), that leave at the modes what the shaper leaves.

    Raises
    ------
    InputError
        If the shaper does not know its modes, the grid has fewer than two samples a period of one, or no weights near
        the impulses do it.
    """
    positive("dt", dt, "s")
    orders = tuple(max(order, 0) for order in vanishing_orders(shaper, 'method "exact"'))
    modes = shaper.design.modes
    assert modes is not None
    fastest = min(modes, key=lambda mode: mode.damped_period)
    if fastest.damped_period < 2.0 * dt:
        raise InputError(
            f"dt is {dt:.6g} s, more than half a period of {fastest}: such samples cannot tell how it moves; sample at "
            f"least every {fastest.damped_period / 2.0:.6g} s."
        )
    own, split = shaper.taps(dt)
    own, split = own[split != 0.0], split[split != 0.0]  # a delay stays one: nothing is put at its beginning
    found = None
    for wider in range(WIDEST + 1):
        last = int(own[-1]) + max(0, wider - 1)  # first inside the duration
        near = np.unique(np.clip(np.add.outer(own, np.arange(-wider, wider + 1)), 0, last))
        weights = _nearest_weights(shaper, modes, orders, near, dt, (own, split))
        if weights is not None:
            if (split < 0.0).any() or (weights > -SPARED).all():
                return near.astype(float), np.where(np.abs(weights) < SPARED, 0.0, weights)
            found = found or (near.astype(float), weights)
    if found is None:
        raise InputError(
            f"no weights on the samples near the impulses leave the modes as they are at dt = {dt:.6g} s: sample "
            'faster, or use method "optimised", which says what is left.'
        )
    return found


def _nearest_weights(
    shaper: Shaper,
    modes: Modes,
    orders: tuple[int, ...],
    near: NDArray[np.intp],
    dt: float,
    split: tuple[NDArray[np.intp], NDArray[np.float64]],
) -> NDArray[np.float64] | None:
    """The weights nearest to the linear split that meet the equations, or None."""
    end = float(near[-1]) * dt
    rows, _ = plain_rows(modes, orders, np.asarray(end - near * dt, dtype=float), end)
    rows = np.vstack([rows, np.ones(near.size)])
    wanted = np.append(_values(shaper, modes, orders, end), 1.0)
    scale = np.linalg.norm(rows, axis=1)
    scale[scale == 0.0] = 1.0
    weights = np.zeros(near.size)
    weights[np.searchsorted(near, split[0])] = split[1]
    for _ in range(3):  # the second and third take away the rounding of the first
        weights += np.linalg.lstsq(rows / scale[:, None], (wanted - rows @ weights) / scale, rcond=1e-13)[0]
    return weights if np.abs(rows @ weights - wanted).max() <= HELD else None


def _values(shaper: Shaper, modes: Modes, orders: tuple[int, ...], end: float) -> NDArray[np.float64]:
    """The sums of (u / end)^k exp(-s u) over the shaper, u the time before `end`; those that should vanish are zero.

    Real parts come before imaginary parts. Derivatives are of impulses only: a box counts with its linear split.
    """
    rows, _ = plain_rows(modes, orders, end - shaper.times, end)
    values = rows @ shaper.amplitudes
    if shaper.boxes:
        first = np.cumsum([0, *(order + 1 for order in orders[:-1])])
        rates = np.array([-mode.pole.conjugate() for mode in modes])
        whole = transform(shaper, rates, origin=end)
        half = values.size // 2
        values = np.full(values.size, np.inf)
        values[first], values[half + first] = whole.real, whole.imag
    return np.where(np.abs(values) <= ZERO, 0.0, values)
