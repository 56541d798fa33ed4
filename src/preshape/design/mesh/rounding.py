"""Any positive shaper on a servo grid, its amplitudes optimised again for the slots it lands on.

Rounding the times alone leaves a residual of up to about pi f dt at each mode. With the times fixed, better amplitudes
are a small convex problem: zero of everything if that is possible, else zero residual with the least derivatives, else
the least residual whose derivatives are no larger than they were.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.design.each_mode import impulses_only, recorded
from preshape.design.mesh.problem import GridProblem
from preshape.design.mesh.verify import verified
from preshape.engine.basis import Basis
from preshape.engine.programme import Programme, solve
from preshape.engine.projection import nearest_on
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.provenance import Design
from preshape.shaper import Shaper

__all__ = ["rounded"]

STIFF = 1e3
"""Derivatives may exceed what is allowed by the residual over this: hardly at all."""

SMALLEST = 1e-8
"""An amplitude below this is none: the conic solver gives every slot a little."""


def rounded(
    shaper: Shaper,
    dt: float,
    modes: ModesLike | None = None,
    order: int | Iterable[int] = 1,
    neighbours: bool = False,
) -> Shaper:
    """The shaper on a servo grid, its amplitudes optimised for the slots.

    Parameters
    ----------
    shaper : Shaper
        Any shaper; only its times are used.
    dt : float
        Servo period [s], at most half a period of the fastest mode.
    modes : Mode, (frequency, damping) or several, optional
        Where the residual is to vanish; by default the modes it was designed for.
    order : int or one a mode
        Vanishing derivatives wanted.
    neighbours : bool
        False: each impulse goes to the nearest slot. True: it may use the slots on both sides, which makes up to twice
        as many impulses, and zero usually possible.

    Returns
    -------
    Shaper
        Positive impulses on the grid. Status "feasible": residual and derivatives are zero. Else "given", and
        ``design.residual``, the largest residual at the modes, is zero with the derivatives as small as possible, or,
        when that is impossible, the least at which no derivative exceeds the largest of plain rounding (with
        `neighbours`: of the linear split), all at the time of the last slot. ``settings["slope"]`` is the largest
        derivative with respect to a relative change of frequency [-]: a frequency error of 1 % leaves about 1 % of it.
        The least residual of all, whatever its slope, is that of order 0.

    Raises
    ------
    InputError
        If the shaper does not know its modes and none are given, an impulse is not positive, or the grid is too coarse.

    Examples
    --------
    >>> import preshape
    >>> exact = preshape.design.direct([(1.0, 0.0), (10.0, 0.0)])
    >>> near, both = rounded(exact, dt=0.005), rounded(exact, dt=0.005, neighbours=True)
    >>> len(near), near.design.residual < 1e-12, round(near.design.settings["slope"], 2)
    (7, True, 0.14)
    >>> len(both), both.design.residual < 1e-12, both.design.status
    (9, True, 'feasible')
    """
    wanted = shaper.design.modes if modes is None else modes
    if wanted is None:
        raise InputError("this shaper does not know its modes: give the modes at which its residual is to vanish.")
    if (shaper.amplitudes <= 0.0).any():
        raise InputError("an impulse is not positive: the optimisation keeps impulses positive; use design.on_grid.")
    problem = GridProblem.checked(wanted, order, dt)
    places, before = _places(shaper, problem.dt, neighbours)
    amplitudes, exact = _amplitudes(problem.modes, problem.orders, (places[-1] - places) * problem.dt, before)
    leads = (places[-1] - places) * problem.dt
    settings: dict[str, Any] = {**shaper.design.settings, "dt": problem.dt, "neighbours": bool(neighbours)}
    settings["slope"] = _slope(problem.modes, problem.orders, leads, amplitudes)
    design = Design(shaper.design.family, problem.modes, settings, "feasible" if exact else "given")
    used = np.flatnonzero(amplitudes)
    times = (places[used] - places[used][0]) * problem.dt
    return recorded(Shaper(times, amplitudes[used] / amplitudes.sum()), design)


def _places(shaper: Shaper, dt: float, neighbours: bool) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """The slots that the impulses may use, increasing, and the amplitudes without optimisation."""
    if neighbours:
        return shaper.taps(dt)
    impulses_only(shaper, "moving each impulse to the nearest slot")
    places, where = np.unique(np.rint(shaper.times / dt).astype(np.intp), return_inverse=True)
    return places, np.bincount(where, shaper.amplitudes).astype(float)


def _amplitudes(
    modes: Modes, orders: tuple[int, ...], leads: NDArray[np.float64], before: NDArray[np.float64]
) -> tuple[NDArray[np.float64], bool]:
    """Amplitudes that leave the least, zeros where no impulse is used, and whether they leave nothing at all."""
    every = _zeros(modes, orders, leads)
    if every is not None:
        return every, True
    values = (0,) * len(modes)
    waves, derivative = _waves(modes, orders, leads), np.array(_derivatives(orders))
    if not derivative.any():
        return _least(waves, np.zeros(len(modes)), leads), False
    if _zeros(modes, values, leads) is not None:
        slopes = waves[derivative > 0]
        amplitudes = _least(slopes, np.zeros(slopes.shape[0]), leads, Basis(modes, values, float(leads[0])))
        used = amplitudes > 0.0
        amplitudes[used] = verified(modes, values, leads[used], amplitudes[used])
        return amplitudes, False
    weights = np.where(derivative > 0, STIFF, 1.0)
    allowed = np.where(derivative > 0, STIFF * _slope(modes, orders, leads, before), 0.0)
    return _least(weights[:, None] * waves, allowed, leads), False


def _zeros(modes: Modes, orders: tuple[int, ...], leads: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Amplitudes that meet all equations, or None."""
    basis = Basis(modes, orders, float(leads[0]))
    nearest = nearest_on(basis, leads)
    if nearest.distance > basis.rounding:
        return None
    full = np.zeros(leads.size)
    used = np.isin(leads, nearest.leads)
    full[used] = verified(modes, orders, leads[used], nearest.amplitudes)
    return full


def _least(
    waves: NDArray[np.complex128],
    allowed: NDArray[np.float64],
    leads: NDArray[np.float64],
    basis: Basis | None = None,
) -> NDArray[np.float64]:
    """Positive amplitudes with the largest |waves a| - allowed as small as possible; what `basis` asks is met."""
    count = leads.size
    programme = Programme(
        leads=leads,
        basis=basis,
        equalities=np.zeros((0, count)) if basis is None else basis(leads),
        cones=waves,
        radii=allowed,
        inequalities=np.zeros((0, count)),
        limits=np.zeros(0),
        low=0.0,
        high=math.inf,
    )
    found = solve(programme)
    if not found.solved:
        raise InputError(
            f"the least residual on these {count} slots was not found: give another servo period, or neighbours=True."
        )
    amplitudes = np.where(found.amplitudes > SMALLEST, found.amplitudes, 0.0)
    result: NDArray[np.float64] = amplitudes / amplitudes.sum()
    return result


def _waves(modes: Modes, orders: tuple[int, ...], leads: NDArray[np.float64]) -> NDArray[np.complex128]:
    """(s u)^k exp(-s u) / k! for k up to each order: what a relative change of frequency makes of the residual."""
    rates = np.repeat([-mode.pole.conjugate() for mode in modes], [order + 1 for order in orders])
    turns = np.multiply.outer(rates, leads)
    powers = np.array(_derivatives(orders))[:, None]
    factorials = np.array([math.factorial(k) for k in _derivatives(orders)])[:, None]
    waves: NDArray[np.complex128] = turns**powers * np.exp(-turns) / factorials
    return waves


def _derivatives(orders: tuple[int, ...]) -> list[int]:
    return [k for order in orders for k in range(order + 1)]


def _slope(modes: Modes, orders: tuple[int, ...], leads: NDArray[np.float64], amplitudes: NDArray[np.float64]) -> float:
    """The largest of the derivatives that were wanted at zero; 0 when none was."""
    sizes = np.abs(_waves(modes, orders, leads) @ amplitudes)
    return max((float(size) for size, k in zip(sizes, _derivatives(orders), strict=True) if k > 0), default=0.0)
