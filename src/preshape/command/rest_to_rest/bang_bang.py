"""Bang-bang: full force forwards, then full force backwards. The fastest for a rigid body, and it leaves vibration."""

from __future__ import annotations

import math

from preshape.checks import nonzero, positive
from preshape.command.rest_to_rest.rest_to_rest import RestToRest, result_of
from preshape.command.rest_to_rest.undamped_move import body_of
from preshape.plant import FlexibleBody, FloatingOscillator

__all__ = ["bang_bang"]


def bang_bang(plant: FlexibleBody | FloatingOscillator, distance: float, *, maximum_force: float) -> RestToRest:
    """The time-optimal move of the mass centre, whatever vibrates on the way.

    Steps 1, -2, 1 at 0, t2, 2 t2 with t2 = sqrt(distance / acceleration). An undamped mode keeps V = 4 sin^2(w t2 / 2):
    nothing for distances of acceleration times (n periods)^2, and up to four times what one step leaves for others.

    Parameters
    ----------
    plant : FloatingOscillator or FlexibleBody
        Free to move.
    distance : float
        Where the move ends [m]; negative moves backwards, 0 is refused.
    maximum_force : float
        What the actuator can do, both ways [N].

    Returns
    -------
    RestToRest
        The mass centre is at rest at the target at the end; `residuals` says what still vibrates.

    Raises
    ------
    InputError
        If a value is out of range.

    References
    ----------
    Robertson, eq. 5 and 6.

    Examples
    --------
    >>> from preshape.plant import FloatingOscillator
    >>> move = bang_bang(FloatingOscillator(1.0, 1.0, 1.0), 10.0, maximum_force=1.0)
    >>> move.switch_times.round(4).tolist(), move.peak_deflections.round(4).tolist()
    ([0.0, 4.4721, 8.9443], [1.0009])
    """
    body = body_of(plant)
    distance, force = nonzero("distance", distance, "m"), positive("maximum_force", maximum_force, "N")
    half = math.sqrt(abs(distance) * body.mass / force)
    return result_of("bang-bang", body, distance, force, [0.0, half, 2.0 * half], [1.0, -1.0])
