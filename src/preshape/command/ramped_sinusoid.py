"""Ramped sinusoids (Meckl & Seering): an acceleration near bang-bang's, without the harmonics that excite a mode.

The acceleration is a sum of functions that vanish at both ends and are antisymmetric about the middle,
phi_l(u) = 1/2 - u - cos(a_l u) / 2 + sin(a_l u) / a_l with tan(a_l / 2) = a_l / 2; the coefficients are the linear
least squares of (distance from bang-bang)^2 + weight x (what it excites at and around the mode)^2.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.checks import nonzero, positive
from preshape.command.command import Command
from preshape.command.shape import Limits, MoveShape, shaped_move, shortest_of
from preshape.mode import ModesLike, one_mode

__all__ = ["ramped_sinusoid", "ramped_sinusoid_shape"]

TERMS = 8
"""Functions in the sum."""

WEIGHT = 1e3
"""Weight of what is excited against the distance from bang-bang, as Meckl & Seering chose it."""

AROUND = (0.95, 1.0, 1.05)
"""Frequencies at which excitation counts, relative to the mode's."""

SAMPLES = 2001
"""Points of the quadrature over the move."""


def ramped_sinusoid_shape(mode: ModesLike, duration: float) -> MoveShape:
    """The form of the move of `duration` [s] that excites `mode` least."""
    omega = one_mode(mode).omega * positive("duration", duration, "s")
    alphas = _alphas()
    u = np.linspace(0.0, 1.0, SAMPLES)
    weights = np.full(SAMPLES, 1.0 / (SAMPLES - 1))
    weights[[0, -1]] *= 0.5
    functions = np.array([_phi(alpha, u) for alpha in alphas])
    rows = [functions * np.sqrt(weights)]
    for ratio in AROUND:
        wave = np.exp(1j * ratio * omega * u) * weights
        excited = functions @ wave * math.sqrt(WEIGHT)
        rows += [excited.real[:, None], excited.imag[:, None]]
    target = np.concatenate([np.where(u < 0.5, 1.0, -1.0) * np.sqrt(weights), np.zeros(2 * len(AROUND))])
    coefficients = np.linalg.lstsq(np.concatenate(rows, axis=1).T, target, rcond=None)[0]
    coefficients = coefficients / sum(b * _moved(a, np.ones(1))[0] for a, b in zip(alphas, coefficients, strict=True))

    def total(kind: Callable[[float, NDArray[np.float64]], NDArray[np.float64]], u: NDArray[np.float64]) -> Any:
        summed: NDArray[np.float64] = sum(b * kind(a, u) for a, b in zip(alphas, coefficients, strict=True))
        return summed

    return MoveShape(
        position=lambda u: total(_moved, u),
        velocity=lambda u: total(_speed, u),
        acceleration=lambda u: total(_phi, u),
        peak_velocity=float(np.abs(total(_speed, u)).max()),
        peak_acceleration=float(np.abs(total(_phi, u)).max()),
        peak_jerk=float(np.abs(total(_slope, u)).max()),
    )


def ramped_sinusoid(
    distance: float,
    mode: ModesLike,
    *,
    duration: float | None = None,
    maximum_speed: float | None = None,
    maximum_acceleration: float | None = None,
    maximum_jerk: float | None = None,
    dt: float,
    rest: float = 0.0,
    quantity: str = "position [m]",
) -> Command:
    """A move of ramped sinusoids that spares one mode.

    Parameters
    ----------
    distance : float
        Where the move ends [m]; negative moves backwards, 0 is refused.
    mode : Mode or (frequency [Hz], damping)
        What it spares; the damping is not used.
    duration : float, optional
        [s]; about the shortest within the limits unless given (the form depends on it).
    maximum_speed, maximum_acceleration, maximum_jerk : float, optional
        Limits [m/s, m/s^2, m/s^3].
    dt, rest, quantity
        As for :func:`preshape.command.cycloidal`.

    Raises
    ------
    InputError
        As for :func:`preshape.command.cycloidal`.

    References
    ----------
    Meckl & Seering (1985, 1988), as quoted by Singer & Seering.

    Examples
    --------
    >>> move = ramped_sinusoid(1.0, (1.0, 0.0), duration=3.0, dt=0.001)
    >>> round(float(move.values[-1]), 12)
    1.0
    """
    limits = Limits(maximum_speed, maximum_acceleration, maximum_jerk)
    size = nonzero("distance", distance, "m")
    time = shortest_of(lambda t: ramped_sinusoid_shape(mode, t), size, limits) if duration is None else duration
    shape = ramped_sinusoid_shape(mode, time)
    return shaped_move(shape, size, time, limits, dt=dt, rest=rest, quantity=quantity)


def _alphas() -> list[float]:
    """Roots of tan(a / 2) = a / 2, from the first one above 0."""
    from scipy.optimize import brentq

    found = []
    for k in range(1, TERMS + 1):
        low, high = k * np.pi + 1e-9, (k + 0.5) * np.pi - 1e-12
        found.append(2.0 * float(brentq(lambda x: math.sin(x) - x * math.cos(x), low, high, xtol=1e-14)))
    return found


def _phi(alpha: float, u: NDArray[np.float64]) -> NDArray[np.float64]:
    """The acceleration of one function."""
    phi: NDArray[np.float64] = 0.5 - u - 0.5 * np.cos(alpha * u) + np.sin(alpha * u) / alpha
    return phi


def _slope(alpha: float, u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Its derivative."""
    slope: NDArray[np.float64] = -1.0 + 0.5 * alpha * np.sin(alpha * u) + np.cos(alpha * u)
    return slope


def _speed(alpha: float, u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Its integral from 0."""
    speed: NDArray[np.float64] = (
        0.5 * u - 0.5 * u**2 - 0.5 * np.sin(alpha * u) / alpha + (1.0 - np.cos(alpha * u)) / alpha**2
    )
    return speed


def _moved(alpha: float, u: NDArray[np.float64]) -> NDArray[np.float64]:
    """Its second integral from 0."""
    moved: NDArray[np.float64] = (
        u**2 / 4.0
        - u**3 / 6.0
        + (np.cos(alpha * u) - 1.0) / (2.0 * alpha**2)
        + u / alpha**2
        - np.sin(alpha * u) / alpha**3
    )
    return moved
