"""First arcs: the closed form of one mode's limited move, from which the engine begins where there is one.

Short pulses between long holds are what a grid sees worst, and the closed form knows them. With damping there is none,
but there is a path to it: the damping is raised in steps, and Newton's method follows.
"""

from __future__ import annotations

import numpy as np

from preshape.command.rest_to_rest.deflection_limiting import deflection_limiting
from preshape.command.rest_to_rest.shortest import Arc, Problem, Structure, polish
from preshape.errors import InputError
from preshape.plant import FlexibleBody

__all__ = ["first_arcs"]

STEP = 0.02
"""The damping ratio is raised by no more than this at once [-]."""


def first_arcs(problem: Problem, body: FlexibleBody, distance: float, force: float, limit: float) -> Structure | None:
    """The arcs that hold the only mode of a body on its limit; None where nothing holds it.

    Parameters
    ----------
    problem : Problem
        The same move, as the engine sees it.
    body : FlexibleBody
        With any number of modes; more than one have no closed form.
    distance : float
        Where the move ends [m].
    force : float
        What the actuator can do [N].
    limit : float
        Largest size of the mode's deflection [m].
    """
    if len(body.modes) > 1 or problem.edges or problem.rows.size != 1:
        return None
    try:
        move = deflection_limiting(
            body.retuned(damping_ratio=0.0), abs(distance), maximum_force=force, deflection_limit=limit
        )
    except InputError:  # too short to be held, or too loose a limit
        return None
    levels = move.levels / force
    sign = float(np.sign(problem.rows[0, 0]))
    arcs = [
        Arc(float(start), float(level)) if abs(level) == 1.0 else _held(problem, float(start), float(level), sign)
        for start, level in zip(move.switch_times, levels, strict=False)
    ]
    structure = Structure(tuple(arcs), (), move.duration)
    damping = body.modes[0].damping
    for z in np.linspace(0.0, damping, 1 + int(np.ceil(damping / STEP)))[1:]:
        rate = abs(problem.rates[0]) * complex(z, np.sqrt(1.0 - z**2))
        followed = polish(Problem(problem.target, np.array([rate]), problem.rows), structure)
        if followed is None:
            return None
        structure = followed.structure
    return structure


def _held(problem: Problem, start: float, level: float, sign: float) -> Arc:
    """An arc of the level that holds the mode."""
    side = float(np.sign(level)) * sign
    return Arc(start, problem.held_level(0, 0, side), 0, side)
