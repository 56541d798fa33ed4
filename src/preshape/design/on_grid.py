"""A shaper on a controller's sample grid, with what that costs at the design modes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.checks import positive
from preshape.design.each_mode import impulses_only, recorded
from preshape.design.grid_split import exact_split, vanishing_orders
from preshape.design.mesh import rounded
from preshape.errors import InputError
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = ["on_grid"]


def on_grid(shaper: Shaper, dt: float, method: str = "linear") -> Shaper:
    """The shaper with every impulse on a multiple of `dt` [s], and what that leaves at the design modes.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    dt : float
        Sample time of the controller [s].
    method : {"linear", "nearest", "exact", "optimised"}
        "linear": each impulse is split between its two neighbours; the mean delay stays exact, and the residual at a
        mode of frequency f rises by about (pi f dt)^2 / 2. "nearest": each impulse moves to the nearest sample; as many
        impulses as before, and a residual of up to about pi f dt. "exact": the linear split, changed by the least that
        leaves the residual at the modes, and every derivative of it that vanishes, exactly what they were; impulses may
        become slightly negative. "optimised": positive impulses on the neighbours, often fewer, with zero
        residual where that can be, by :func:`preshape.design.rounded`; what the shaper does beside its modes is lost.

    Returns
    -------
    Shaper
        ``design.residual`` is the largest residual that is left; ``design.settings`` says ``dt``, ``grid_method`` and,
        for each mode, ``samples_per_period`` and ``residuals`` [-].

    Raises
    ------
    InputError
        If dt is not a positive number, the method is none of these, or cannot be used for this shaper: "exact" and
        "optimised" need to know its modes and two samples a period, "optimised" positive impulses that leave zero.

    References
    ----------
    Murphy & Watanabe, Digital shaping filters for reducing machine vibration, IEEE Trans. Robotics and Automation 8
    (1992): zeros of the filter at the modes' poles in the plane of z.
    Hyde, 3.4.2.c, and Singer name the loss by rounding.

    Examples
    --------
    >>> import preshape
    >>> coarse = on_grid(preshape.design.zv((40.0, 0.0)), 0.001)
    >>> coarse.times.round(6).tolist(), 0.001 < coarse.design.residual < 0.01
    ([0.0, 0.012, 0.013], True)
    >>> on_grid(preshape.design.zv((40.0, 0.0)), 0.001, "exact").design.residual < 1e-12
    True
    """
    if method not in METHODS:
        raise InputError(f"method {method!r} is not known: it is {', '.join(METHODS)}.")
    if method != "linear":
        positive("dt", dt, "s")
    placed = METHODS[method](shaper, dt)
    settings: dict[str, Any] = {**shaper.design.settings, **placed.design.settings}
    settings |= {"dt": float(dt), "grid_method": method}
    if shaper.design.modes is not None:
        frequencies, dampings = np.array([(mode.frequency, mode.damping) for mode in shaper.design.modes]).T
        settings["samples_per_period"] = [mode.damped_period / dt for mode in shaper.design.modes]
        settings["residuals"] = residual_vibration(placed, frequencies, dampings).tolist()
    status = "feasible" if shaper.design.status in ("exact", "optimal") else shaper.design.status
    if method == "optimised":
        status = placed.design.status
    return recorded(placed, replace(shaper.design, settings=settings, status=status, certificate=None))


def _linear(shaper: Shaper, dt: float) -> Shaper:
    delays, weights = shaper.taps(dt)
    return _used(delays.astype(float), weights, dt)


def _nearest(shaper: Shaper, dt: float) -> Shaper:
    impulses_only(shaper, "moving each impulse to the nearest sample")
    delays, where = np.unique(np.rint(shaper.times / dt), return_inverse=True)
    return _used(delays, np.bincount(where, shaper.amplitudes).astype(float), dt)


def _exact(shaper: Shaper, dt: float) -> Shaper:
    return _used(*exact_split(shaper, dt), dt)


def _optimised(shaper: Shaper, dt: float) -> Shaper:
    orders = vanishing_orders(shaper, 'method "optimised"')
    if min(orders) < 0:
        raise InputError(
            'method "optimised" aims at zero residual, and this shaper leaves some at its modes: use method "exact", '
            "which keeps what it leaves."
        )
    return rounded(shaper, dt, order=orders, neighbours=True)


def _used(delays: NDArray[np.float64], weights: NDArray[np.float64], dt: float) -> Shaper:
    """The shaper of those taps that are not zero; a first one of zero says that it begins with a delay."""
    used = weights != 0.0
    delays, weights = delays[used], weights[used]
    if delays[0] > 0.0:
        delays, weights = np.append(0.0, delays), np.append(0.0, weights)
    return Shaper(delays * np.float64(dt), weights / weights.sum())


METHODS: dict[str, Callable[[Shaper, float], Shaper]] = {
    "linear": _linear,
    "nearest": _nearest,
    "exact": _exact,
    "optimised": _optimised,
}
