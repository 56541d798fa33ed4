"""Deflection-limiting: the command that brings the deflection to its limit and holds it there, in closed form."""

from __future__ import annotations

import math
from dataclasses import dataclass

from preshape.checks import positive
from preshape.command.rest_to_rest.rest_to_rest import RestToRest, result_of
from preshape.command.rest_to_rest.undamped_move import UndampedMove, undamped_move
from preshape.errors import InputError
from preshape.plant import FlexibleBody, FloatingOscillator

__all__ = ["deflection_limiting"]

SAME = 1e-12
"""Limits and distances this near their ends, relative to them, are there, rounded."""


@dataclass(frozen=True)
class _Parts:
    """Times of the parts of the command [s]; what they contribute to the quadratic equation for the hold.

    first, second: switches of the start. reversal: length of each of the two pulses in the middle.
    linear [s], constant [s^2]: of (a/2) h^2 + linear h + constant = distance / (2 acceleration).
    """

    first: float
    second: float
    reversal: float
    linear: float
    constant: float


def deflection_limiting(
    plant: FlexibleBody | FloatingOscillator,
    distance: float,
    *,
    maximum_force: float,
    deflection_limit: float,
    fuel_lean: bool = False,
) -> RestToRest:
    """The fastest move of a body with one mode whose deflection stays within a limit below the static one.

    With a = limit / static deflection, the levels are 1, -1, a | -1, 1 | -a, 1, -1: the deflection is brought to
    the limit at rest, held there by the force a, turned to the other limit, held, and ended in the mirror of the start.
    The hold needs an actuator that can give a part of its force.

    Parameters
    ----------
    plant : FloatingOscillator or FlexibleBody
        With one undamped mode, free to move.
    distance : float
        Where the move ends [m]; negative moves backwards.
    maximum_force : float
        What the actuator can do, both ways [N].
    deflection_limit : float
        Largest size of the deflection [m], above 0 and at most the static deflection under the maximum force.
    fuel_lean : bool
        Start with 1, 0, a instead: a little longer, and at rest in between instead of full force backwards.

    Returns
    -------
    RestToRest
        Nothing vibrates at the end, and the deflection's peak is the limit.

    Raises
    ------
    InputError
        If a value is out of range, the limit above the static deflection, or the move too short to reach the limit.

    References
    ----------
    Robertson, section II, describes such commands; the structure and its formulas are derived anew, and that the first
    is the fastest is what :func:`time_optimal` proves of each case.

    Examples
    --------
    >>> from preshape.plant import FloatingOscillator
    >>> plant = FloatingOscillator(1.0, 1.0, 1.0)
    >>> move = deflection_limiting(plant, 10.0, maximum_force=1.0, deflection_limit=0.3)
    >>> round(move.duration, 4), move.peak_deflections.round(12).tolist(), move.levels.round(12).tolist()
    (12.6428, [0.3], [1.0, -1.0, 0.6, -1.0, 1.0, -0.6, 1.0, -1.0])
    """
    move = undamped_move(plant, distance, maximum_force, "deflection-limiting")
    limit = positive("deflection_limit", deflection_limit, "m")
    if limit > move.static * (1.0 + SAME):
        raise InputError(
            f"a deflection limit of {limit:g} m is above the static deflection of {move.static:.6g} m, which on_off "
            "never exceeds: nothing needs to be limited; use on_off, or time_optimal with this limit, which is faster."
        )
    a = min(limit / move.static, 1.0)
    parts = _parts(a, move.omega, fuel_lean)
    hold = _hold(move, a, parts)
    middle = parts.second + hold + parts.reversal
    start = [0.0, parts.first, parts.second, middle - parts.reversal]
    times = [*start, middle, *(2.0 * middle - time for time in reversed(start))]
    second = 0.0 if fuel_lean else -1.0
    levels = [1.0, second, a, -1.0, 1.0, -a, 0.0 - second, -1.0]
    return result_of(
        "deflection-limiting",
        move.body,
        move.distance,
        move.maximum_force,
        times,
        levels,
        settings={"deflection_limits": (limit,), "fuel_lean": fuel_lean},
    )


def _parts(a: float, omega: float, fuel_lean: bool) -> _Parts:
    """From the level of the hold [-] and w [rad/s]."""
    if fuel_lean:
        angle = 2.0 * math.asin(0.5 * a)
        first, second = angle / omega, (0.5 * angle + 0.5 * math.pi) / omega
        linear, constant = first, 0.5 * first**2 + first * (second - first)
    else:
        # cos(w first) = 1 - (2 a + a^2) / 4 and cos(w second) = 1 - (4 a + a^2) / (2 + 2 a), without cancellation
        first = 2.0 * math.asin(math.sqrt(0.125 * a * (2.0 + a))) / omega
        second = 2.0 * math.asin(math.sqrt(0.25 * a * (4.0 + a) / (1.0 + a))) / omega
        linear = 2.0 * first - second
        constant = 0.5 * first**2 + first * (second - first) - 0.5 * (second - first) ** 2
    # cos(w reversal) = 1 / (1 + a)
    reversal = 2.0 * math.asin(math.sqrt(0.5 * a / (1.0 + a))) / omega
    return _Parts(first, second, reversal, linear + a * reversal, constant + linear * reversal - 0.5 * reversal**2)


def _hold(move: UndampedMove, a: float, parts: _Parts) -> float:
    """How long the deflection is held on each limit [s]."""
    shortest = 2.0 * move.acceleration * parts.constant
    if move.size < shortest * (1.0 - SAME):
        raise InputError(
            f"a move of {move.size:g} m is too short to hold the deflection at its limit: the shortest is "
            f"{shortest:.6g} m; time_optimal with the same limit does shorter ones."
        )
    left = max(move.size / (2.0 * move.acceleration) - parts.constant, 0.0)
    return 2.0 * left / (parts.linear + math.sqrt(parts.linear**2 + 2.0 * a * left))
