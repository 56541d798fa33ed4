"""What can be asked of a shaper, each a small object; the engine knows them by the numbers they give for impulses.

A constraint turns leads (times before the last impulse) into rows: linear in the amplitudes once the times are fixed.
Adding a kind of constraint is adding a class here with a method `rows`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from preshape.band import Band
from preshape.checks import positive, tolerance_of, whole_number
from preshape.errors import InputError
from preshape.mode import Mode

__all__ = [
    "AtMostImpulses",
    "Constraint",
    "ImpulsesBetween",
    "PartialSumsBetween",
    "ResponseBetween",
    "Rows",
    "ServoGrid",
    "VibrationAtMost",
    "ZeroVibration",
    "deflection_at_most",
]


LEAST_TOLERANCE = 1e-5
"""The conic solver meets cones to 1e-9; below this tolerance that is not fine enough to find the shortest duration."""


AT_ONCE = 1e-6
"""A sample that is earlier than an impulse by less than this part of the sample time is at it."""


@dataclass(frozen=True)
class Rows:
    """What a constraint asks of amplitudes a at given leads: |cones a| <= radii, rows a <= limits, low <= a <= high.

    Parameters
    ----------
    cones : ndarray of complex, shape (cone, impulse)
        Sums whose magnitude is limited.
    radii : ndarray, shape (cone,)
        The limits [-].
    inequalities : ndarray, shape (row, impulse)
        Sums that are limited from above.
    limits : ndarray, shape (row,)
        The limits.
    low, high : float
        Limits of every single amplitude [-].
    """

    cones: NDArray[np.complex128] = field(default_factory=lambda: np.zeros((0, 0), dtype=complex))
    radii: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))
    inequalities: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 0)))
    limits: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))
    low: float = -math.inf
    high: float = math.inf


class Constraint(Protocol):
    """Something that is asked of a shaper."""

    def rows(self, leads: NDArray[np.float64]) -> Rows:
        """The rows for impulses at `leads` [s], the largest lead being the first impulse."""
        ...


@dataclass(frozen=True)
class ZeroVibration:
    """No residual vibration at a mode, nor `order` derivatives of it; the engine orthonormalises these rows itself."""

    mode: Mode
    order: int = 0

    def __post_init__(self) -> None:
        whole_number("order", self.order, 0, 30)

    def rows(self, leads: NDArray[np.float64]) -> Rows:
        """Nothing beside the orthonormal rows."""
        return Rows()


@dataclass(frozen=True)
class VibrationAtMost:
    """Residual vibration of at most `tolerance` everywhere in a band, and in particular at sampled points of it.

    Parameters
    ----------
    band : Band
        Natural frequencies [Hz] and damping ratios [-].
    tolerance : float
        V allowed [-], at least 0.00001.
    points : tuple of complex
        Rates s = z w + i w sqrt(1 - z^2) [1/s] at which it is asked; the exchange adds to them.
    """

    band: Band
    tolerance: float
    points: tuple[complex, ...] = ()

    def __post_init__(self) -> None:
        if tolerance_of(self.tolerance) < LEAST_TOLERANCE:
            raise InputError(
                f"tolerance {self.tolerance:g} is below {LEAST_TOLERANCE:g}, too little for the conic solver: tolerate "
                "more, or ask for no vibration at all (ZeroVibration, design.direct), which is met to the last digits."
            )

    def rows(self, leads: NDArray[np.float64]) -> Rows:
        """One cone a point."""
        rates = np.array(self.points, dtype=complex)
        cones = np.exp(np.multiply.outer(-rates, leads))
        return Rows(cones=cones, radii=np.full(rates.size, self.tolerance))


@dataclass(frozen=True)
class ImpulsesBetween:
    """Every amplitude in [low, high] [-]; (0, inf) asks for a positive shaper.

    0 is always allowed, for it means that there is no impulse: low <= 0.
    """

    low: float = 0.0
    high: float = math.inf

    def __post_init__(self) -> None:
        if not self.low < self.high or self.high <= 0.0:
            raise InputError(
                f"impulses between {self.low:g} and {self.high:g} cannot sum to 1: give a lower limit below the upper "
                "one, the upper one above 0."
            )
        if self.low > 0.0:
            raise InputError(
                f"impulses of at least {self.low:g} are not convex, since most places have none: give a lower limit of "
                "0 or below, and limit their number instead."
            )

    def rows(self, leads: NDArray[np.float64]) -> Rows:
        """Bounds only."""
        return Rows(low=self.low, high=self.high)


@dataclass(frozen=True)
class ResponseBetween:
    """The response to the shaped command in [low, high] at all sampled times: deflection, actuator level, anything.

    Parameters
    ----------
    response : callable
        h(t) for an array of times [s] from the first sample of the unshaped command on: the response (any unit) of the
        output to the *unshaped* command, zero for t < 0.
    low, high : float
        Limits in the unit of the response.
    sample_time : float
        Distance of the times at which it is asked [s].
    until : float
        How long after the last impulse it is asked [s].
    """

    response: Callable[[NDArray[np.float64]], NDArray[np.float64]]
    low: float
    high: float
    sample_time: float
    until: float = 0.0

    def rows(self, leads: NDArray[np.float64]) -> Rows:
        """The shaped response at even times, once from above and once from below, where limited."""
        duration = float(leads.max())
        times = np.arange(0.0, duration + self.until + 0.5 * self.sample_time, self.sample_time)
        delay = times[:, None] - (duration - leads)[None, :]
        begun = delay >= -AT_ONCE * self.sample_time  # a sample at an impulse sees it, rounding or not
        shaped: NDArray[np.float64] = np.where(begun, self.response(np.maximum(delay, 0.0)), 0.0)
        return _between(shaped, self.low, self.high)


@dataclass(frozen=True)
class PartialSumsBetween:
    """The partial sums of the amplitudes in [low, high] [-]: levels of a shaped step, what the actuator must hold."""

    low: float
    high: float

    def __post_init__(self) -> None:
        if not self.low < self.high or not self.low <= 1.0 <= self.high:
            raise InputError(
                f"partial sums between {self.low:g} and {self.high:g} cannot end at 1: give limits with 1 between them."
            )

    def rows(self, leads: NDArray[np.float64]) -> Rows:
        """The level after each impulse but the last, whose level is 1."""
        earlier = (leads[None, :] >= leads[:, None]).astype(float)
        return _between(earlier[leads > leads.min()], self.low, self.high)


@dataclass(frozen=True)
class ServoGrid:
    """Impulses at multiples of `dt` [s] after the first one only."""

    dt: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "dt", positive("dt", self.dt, "s"))

    def rows(self, leads: NDArray[np.float64]) -> Rows:
        """Nothing: it chooses the leads."""
        return Rows()

    def leads(self, slots: int) -> NDArray[np.float64]:
        """0, dt, ..., slots dt [s]."""
        return np.arange(slots + 1, dtype=float) * self.dt


@dataclass(frozen=True)
class AtMostImpulses:
    """No more than `count` impulses."""

    count: int

    def __post_init__(self) -> None:
        whole_number("the number of impulses", self.count, 1, 10_000)

    def rows(self, leads: NDArray[np.float64]) -> Rows:
        """Nothing linear: integers decide (engine/fewest.py)."""
        return Rows()


def deflection_at_most(mode: Mode, limit: float, sample_time: float) -> ResponseBetween:
    """The deflection of a mode that sets off at a shaped constant speed, at most `limit` of the unshaped, both ways.

    The deflection is d = r - x of a mass on a spring and a damper that act on the error (a positioned arm, a payload on
    its rope): d'' + 2 z w d' + w^2 d = r''. Setting off at speed v without a shaper, it peaks at (v / w) exp(-s phi),
    cos(phi) = z, s = z / sqrt(1 - z^2).

    Parameters
    ----------
    mode : Mode
        Frequency [Hz] and damping ratio [-].
    limit : float
        Largest deflection [-], as a fraction of the unshaped peak.
    sample_time : float
        Distance of the times at which it is asked [s].

    References
    ----------
    Robertson, section III (SD-ZV shapers).
    """
    if not (math.isfinite(limit) and limit > 0.0):
        raise InputError(f"the deflection limit is {limit:g}: give a fraction of the unshaped peak, such as 0.4.")
    rate, turn, root = mode.damping * mode.omega, mode.omega_d, math.sqrt(1.0 - mode.damping**2)
    peak = root * math.exp(-mode.damping / root * math.acos(mode.damping))

    def response(t: NDArray[np.float64]) -> NDArray[np.float64]:
        wave: NDArray[np.float64] = np.exp(-rate * t) * np.sin(turn * t) / peak
        return wave

    return ResponseBetween(response, -limit, limit, sample_time)


def _between(rows: NDArray[np.float64], low: float, high: float) -> Rows:
    parts = ([rows] if math.isfinite(high) else []) + ([-rows] if math.isfinite(low) else [])
    limits = ([high] if math.isfinite(high) else []) + ([-low] if math.isfinite(low) else [])
    if not parts:
        return Rows()
    return Rows(inequalities=np.concatenate(parts), limits=np.repeat(limits, rows.shape[0]))
