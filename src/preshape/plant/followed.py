"""Equations of motion followed from sample to sample while the command is one straight line, until they run away."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

__all__ = ["METHODS", "Derivative", "Followed", "Method", "followed"]

Array: TypeAlias = NDArray[np.float64]

Derivative: TypeAlias = Callable[[float, Array, Array], ArrayLike]
"""x' at a time [s], a state of shape (state,) and an input of shape (input,)."""

Method: TypeAlias = Literal["DOP853", "RK45", "LSODA", "Radau", "BDF"]

METHODS = ("DOP853", "RK45", "LSODA", "Radau", "BDF")

RUN_AWAY = 1e12
"""Times the scale of the states: beyond, nothing that was modelled is left."""

FINEST = 1e-13
"""Tolerance below which a solver only counts roundings."""


class Followed(NamedTuple):
    """How far it went.

    Parameters
    ----------
    states : ndarray, shape (state, sample)
        At the samples that were reached, the first included.
    reason : str
        Why it went no further; empty when it reached the end.
    time : float
        When it stopped [s].
    """

    states: Array
    reason: str
    time: float


def followed(
    derivative: Callable[[float, Array, Array], Array],
    start: Array,
    times: Array,
    level: Array,
    slope: Array,
    tolerance: float,
    scale: Array,
    method: Method,
) -> Followed:
    """The states at the samples, from the first.

    Parameters
    ----------
    derivative : function
        f(t, x, u).
    start : ndarray, shape (state,)
        The state at the first sample.
    times : ndarray, shape (sample,)
        The samples [s].
    level, slope : ndarray, shape (input,)
        The command at the first sample, and its change a second.
    tolerance : float
        Of a step of the solver, relative to the state and to `scale` [-].
    scale : ndarray, shape (state,)
        How large each state typically is.
    method : str
        Of :func:`scipy.integrate.solve_ivp`.

    Examples
    --------
    x' = x^2 is infinite at 1 s:

    >>> times, still, one = np.array([0.0, 0.5, 1.5]), np.zeros(1), np.ones(1)
    >>> way = followed(lambda t, x, u: x**2, one, times, still, still, 1e-8, one, "RK45")
    >>> way.states.round(6).tolist(), round(way.time, 6)
    ([[1.0, 2.0]], 1.0)
    """
    from scipy.integrate import solve_ivp

    def field(t: float, x: Array) -> Array:
        return derivative(t, x, level + slope * (t - times[0]))

    def within(t: float, x: Array) -> float:
        return RUN_AWAY - float(np.max(np.abs(x) / scale))

    # solve_ivp reads whether an event ends the integration from an attribute of the function, which has no type.
    within.terminal = True  # type: ignore[attr-defined]
    try:
        with np.errstate(all="ignore"):
            found = solve_ivp(
                field,
                (times[0], times[-1]),
                start,
                method=method,
                t_eval=times[1:],
                events=within,
                rtol=max(tolerance, FINEST),
                atol=tolerance * scale,
            )
    except (OverflowError, ZeroDivisionError, FloatingPointError) as error:
        reason = f"the derivative failed ({error}) before the next sample: check the model and its gains."
        return Followed(start[:, np.newaxis], reason, float(times[0]))
    reached = np.reshape(np.asarray(found.y, dtype=float), (start.size, -1))
    good = int(np.argmin(np.append(np.isfinite(reached).all(axis=0), False)))
    states = np.concatenate([start[:, np.newaxis], reached[:, :good]], axis=1)
    if found.status == 0 and good == times.size - 1:
        return Followed(states, "", float(times[-1]))
    if found.status == 1 and found.t_events:
        return Followed(states, "the state has run away: check signs and gains.", float(found.t_events[0][0]))
    reason = (
        f"the equations cannot be followed any further ({str(found.message).rstrip('.').lower()}): look at the model "
        "there, or take a method for stiff ones."
    )
    return Followed(states, reason, float(times[good]))
