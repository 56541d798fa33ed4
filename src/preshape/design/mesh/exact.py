"""The exact solution near a guess: Hyde's non-linear equations (3.1), with the first impulse held (3.4.3.b).

The equations are homogeneous in the amplitudes and do not change when all times move together. Holding time and
amplitude of the first impulse takes out both freedoms; 2m complex equations (order 1) then stand against times and
amplitudes of the other 2m impulses, a square system, and dividing by the sum afterwards gives unity gain. With more
impulses than that the smallest step is taken; with fewer, which is enough for odd harmonics, the best one.

The outcome is the solution nearest to the guess, not the shortest shaper: only an optimality system knows about that
(:func:`preshape.design.direct`), and it may need one impulse more than 2m + 1.
"""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import NDArray

from preshape.design.each_mode import impulses_only, recorded
from preshape.design.mesh.problem import orders_of
from preshape.design.mesh.verify import EXACT, misses
from preshape.engine.basis import Basis, plain_rows
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.provenance import Design
from preshape.shaper import Shaper

__all__ = ["solved_from"]

MAXIMUM_STEPS = 100

LARGEST_MOVE = 0.4
"""No impulse moves by more than this fraction of the smallest gap in one step, so that their order is kept."""

CLOSED = 1e-6
"""Impulses nearer to each other than this fraction of the duration are on their way into each other."""

RANK_TOLERANCE = 1e-12

ROOM = 1.2
"""The last impulse may move this far, relative to the guess's duration; the solutions lie within a few per cent."""

LAST_STEPS = 3
"""Newton steps on the papers' own rows, which carry less rounding than the orthonormal ones."""


def solved_from(shaper: Shaper, order: int | Iterable[int] = 1) -> Shaper:
    """The exact shaper that Newton's method reaches from a guess, its first impulse held.

    Parameters
    ----------
    shaper : Shaper
        The guess, such as an interpreted mesh shaper, with its modes in ``design.modes``.
    order : int or one a mode
        Vanishing derivatives at the modes.

    Returns
    -------
    Shaper
        Status "exact": residual and derivatives are zero within rounding, the impulses positive and in order.

    Raises
    ------
    InputError
        If Newton's method does not end at such a shaper, as with too few impulses. Hyde's routine did not either for
        two modes with f2 > 3 f1, nor for more than five modes; :func:`preshape.design.direct` does.

    References
    ----------
    Hyde, 3.4.3.b and 3.4.3.c.

    Examples
    --------
    >>> import preshape
    >>> guess = preshape.design.interpreted(preshape.design.mesh([(1.0, 0.0), (2.0, 0.0)], dt=0.02), dt=0.02)
    >>> exact = solved_from(guess)
    >>> exact.design.status, len(exact), exact.design.residual < 1e-12
    ('exact', 5, True)
    """
    modes = impulses_only(shaper, "Newton's method").design.modes
    if modes is None:
        raise InputError("this shaper does not know its modes: give one that a design function has made.")
    orders = orders_of(modes, order)
    times, amplitudes = _newton(Basis(modes, orders, ROOM * shaper.duration), shaper.times, shaper.amplitudes)
    trouble = _trouble(modes, orders, times, amplitudes)
    needed = 1 + sum(q + 1 for q in orders)
    if trouble and len(shaper) < needed:
        raise InputError(
            f"{len(shaper)} impulses are too few for an exact solution of order {order} at {len(modes)} modes that are "
            f"no harmonics of each other: give a guess of {needed}."
        )
    if trouble:
        raise InputError(
            f"Newton's method from this guess ends {trouble}: Hyde's way can fail, he names two modes with f2 > 3 f1 "
            "and more than five modes; try another grid or cost, or design.direct, which finds the shortest shaper."
        )
    settings = {
        "order": orders[0] if len(set(orders)) == 1 else list(orders),
        "first_impulse": float(shaper.amplitudes[0]),
    }
    return recorded(Shaper.normalised(times, amplitudes), Design("solved_from", modes, settings, "exact"))


def _newton(
    basis: Basis, times: NDArray[np.float64], amplitudes: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Times and amplitudes after as many steps as help, the first of both unchanged."""
    scale, t, a = basis.duration, times.copy(), amplitudes.copy()
    for step in range(MAXIMUM_STEPS + LAST_STEPS):
        leads = scale - t
        if leads[-1] < 0.0:
            break
        if step < MAXIMUM_STEPS:
            raw = basis.raw(leads)
            rows, slopes = basis.values(raw), basis.slopes(raw, 1)
        else:
            rows, slopes = plain_rows(basis.modes, basis.orders, leads, scale)
        miss = rows @ a
        jacobian = np.hstack([rows[:, 1:], (-slopes * a * scale)[:, 1:]])
        change = np.linalg.lstsq(jacobian, -miss, rcond=RANK_TOLERANCE)[0]
        move = change[a.size - 1 :] * scale
        gap, largest = float(np.diff(t).min()), float(np.abs(move).max())
        if not np.isfinite(largest) or gap < CLOSED * scale:
            break
        part = min(1.0, LARGEST_MOVE * gap / largest) if largest > 0.0 else 1.0
        a[1:] += part * change[: a.size - 1]
        t[1:] += part * move
    return t, a


def _trouble(modes: Modes, orders: tuple[int, ...], times: NDArray[np.float64], amplitudes: NDArray[np.float64]) -> str:
    """Why this is no shaper, or nothing."""
    if not (np.diff(times) > CLOSED * times[-1]).all():
        return "with impulses that run into each other"
    total = amplitudes.sum()
    if total <= 0.0 or not (amplitudes > 0.0).all():
        return "with negative impulses"
    if misses(modes, orders, times[-1] - times, amplitudes / total) > EXACT:
        return "without reaching zero residual vibration"
    return ""
