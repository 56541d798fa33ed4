"""On-off: bang-bang convolved with the unity-magnitude shaper 1, -1, 1; never beyond the static deflection."""

from __future__ import annotations

import math

import numpy as np

from preshape.command.rest_to_rest.rest_to_rest import RestToRest, result_of
from preshape.command.rest_to_rest.undamped_move import undamped_move
from preshape.errors import InputError
from preshape.plant import FlexibleBody, FloatingOscillator

__all__ = ["on_off"]

SHORTEST = 1e-12
"""A move this little shorter than the shortest, relative to it, is the shortest, rounded."""


def on_off(plant: FlexibleBody | FloatingOscillator, distance: float, *, maximum_force: float) -> RestToRest:
    """The closed-form command of an actuator that is on, off, or on backwards: of a body with one mode.

    Nothing vibrates at the end, and the deflection never exceeds the static one, force / (first_mass w^2).

    Parameters
    ----------
    plant : FloatingOscillator or FlexibleBody
        With one undamped mode, free to move.
    distance : float
        Where the move ends [m]; negative moves backwards. At least acceleration times period^2 / 9: below that the
        pulses overlap and ask for twice the force.
    maximum_force : float
        What the actuator can do, both ways [N].

    Returns
    -------
    RestToRest
        Of duration 2 sqrt(distance / acceleration) + period / 3.

    Raises
    ------
    InputError
        If a value is out of range, or the move too short.

    References
    ----------
    Singhose, Mills and Seering 1999, as Robertson describes it; derived anew.

    Examples
    --------
    >>> from preshape.plant import FloatingOscillator
    >>> move = on_off(FloatingOscillator(1.0, 1.0, 1.0), 10.0, maximum_force=1.0)
    >>> round(move.duration, 4), move.peak_deflections.round(12).tolist(), move.levels.tolist()
    (10.4252, [0.5], [1.0, 0.0, 1.0, -1.0, 1.0, -1.0, 0.0, -1.0])
    """
    move = undamped_move(plant, distance, maximum_force, "on-off")
    third = move.period / 3.0
    shortest = move.acceleration * third**2
    if move.size < shortest * (1.0 - SHORTEST):
        raise InputError(
            f"a move of {move.size:g} m is too short for the on-off command: its pulses would overlap and ask for "
            f"twice the force; the shortest is {shortest:.6g} m, time_optimal does shorter ones."
        )
    half = max(math.sqrt(move.size / move.acceleration), third)
    times = np.add.outer([0.0, half, 2.0 * half], [0.0, 0.5 * third, third]).ravel()
    levels = [1.0, 0.0, 1.0, -1.0, 1.0, -1.0, 0.0, -1.0]
    return result_of("on-off", move.body, move.distance, move.maximum_force, times, levels)
