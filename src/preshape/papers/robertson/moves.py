"""The benchmark of Robertson's section II, its three commands, and how robust they are."""

from __future__ import annotations

from collections.abc import Callable
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.command import rest_to_rest
from preshape.command.rest_to_rest import RestToRest
from preshape.plant import FloatingOscillator, deflection_sensitivity
from preshape.vibration import command_insensitivity
from preshape.vibration.rest_to_rest import Reference

__all__ = [
    "DISTANCES",
    "FORCE",
    "LIMIT",
    "MODE",
    "OSCILLATOR",
    "Kind",
    "Vector",
    "band",
    "move",
    "peaks",
    "ratio",
    "span",
]

Vector: TypeAlias = NDArray[np.float64]
Kind: TypeAlias = Literal["bang-bang", "on-off", "limited", "lean", "weak"]

OSCILLATOR = FloatingOscillator(1.0, 1.0, 1.0)
"""Figure 3 with m1 = m2 = k = 1."""

MODE = OSCILLATOR.mode

FORCE = 1.0
"""What gives the printed force-to-mass ratio of 0.5 [N]."""

LIMIT = 0.3
"""Of the limited command, 60 % of what on-off reaches [m]."""

DISTANCES = (5.0, 10.0, 15.0, 20.0)
"""Moves that the text names [m]."""


def move(kind: Kind, distance: float, limit: float = LIMIT) -> RestToRest:
    """One of the paper's commands; "lean" and "weak" are two other ways to keep the limit.

    "weak" is on-off with a part of the force only, whose static deflection is the limit.
    """
    if kind == "bang-bang":
        return rest_to_rest.bang_bang(OSCILLATOR, distance, maximum_force=FORCE)
    if kind == "on-off":
        return rest_to_rest.on_off(OSCILLATOR, distance, maximum_force=FORCE)
    if kind == "weak":
        part = limit / OSCILLATOR.static_deflection(FORCE)
        return rest_to_rest.on_off(OSCILLATOR, distance, maximum_force=part * FORCE)
    return rest_to_rest.deflection_limiting(
        OSCILLATOR, distance, maximum_force=FORCE, deflection_limit=limit, fuel_lean=kind == "lean"
    )


def band(kind: Kind, distance: float, limit: float = LIMIT, *, relative_to: Reference = "impulse") -> float:
    """I at 5 % [-], relative to an impulse of the whole force or to bang-bang with it."""
    command = move(kind, distance, limit).force
    return command_insensitivity(command, MODE, relative_to=relative_to, maximum_force=FORCE).value


def ratio(distance: float, *, relative_to: Reference = "impulse", kind: Kind = "limited") -> float:
    """I of the limited command over that of on-off [-]."""
    return band(kind, distance, relative_to=relative_to) / band("on-off", distance, relative_to=relative_to)


def peaks(distance: float, frequency_ratios: ArrayLike) -> Vector:
    """Peak deflection of the limited command relative to its limit [-], over actual by modelled frequency."""
    found = deflection_sensitivity(
        OSCILLATOR, move("limited", distance).force, frequency_ratios=frequency_ratios, limit=LIMIT
    )
    return np.asarray(found.relative[0])


def span(peak: Callable[[Vector], Vector], allowed: float, low: float = 0.7, high: float = 1.5) -> tuple[float, float]:
    """The frequency ratios around 1 for which `peak` stays within `allowed` (a little above 1), to 1e-9.

    `low` or `high` itself where it stays so until there; 1 where more is reached as modelled.
    """
    return _edge(peak, allowed, low), _edge(peak, allowed, high)


SAMPLES = 41
"""Between 1 and either end, when the edge of a span is looked for: 0.0025 to 0.025 of the frequency apart."""


def _edge(peak: Callable[[Vector], Vector], allowed: float, end: float) -> float:
    from scipy.optimize import brentq

    ratios = np.linspace(1.0, end, SAMPLES)
    above = np.flatnonzero(peak(ratios) > allowed)
    if above.size == 0:
        return end
    beside = int(above[0])
    if beside == 0:
        return 1.0
    return float(
        brentq(lambda r: float(peak(np.array([r]))[0]) - allowed, ratios[beside - 1], ratios[beside], xtol=1e-9)
    )
