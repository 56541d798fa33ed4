"""Time-optimal: the shortest move of any flexible body within limits of force, deflection and residual vibration."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.band import BandsLike, bands_of
from preshape.checks import nonzero, positive, tolerance_of
from preshape.command.rest_to_rest.first_arcs import first_arcs
from preshape.command.rest_to_rest.rest_to_rest import RestToRest, result_of
from preshape.command.rest_to_rest.shortest import PROVED, Found, Problem, shortest_move
from preshape.command.rest_to_rest.undamped_move import body_of
from preshape.engine.edges import edges_of
from preshape.errors import InputError
from preshape.plant import FlexibleBody, FloatingOscillator

__all__ = ["time_optimal"]


SHORTEST = 1e-4
"""Half the time of the rigid body, as an angle of the slowest mode [rad]. In shorter moves all that the modes do is
hidden in the rounding of the times."""

LEAST_LIMIT = 1e-6
"""Limits below this part of the static deflection are a matter of the times' last digits."""


def time_optimal(
    plant: FlexibleBody | FloatingOscillator,
    distance: float,
    *,
    maximum_force: float,
    deflection_limits: float | Sequence[float | None] | None = None,
    outputs: ArrayLike | None = None,
    bands: BandsLike | None = None,
    tolerance: float = 0.05,
    on_off: bool = False,
) -> RestToRest:
    """The shortest force that moves a body from rest to rest, with all its modes at rest at the end.

    Parameters
    ----------
    plant : FlexibleBody or FloatingOscillator
        Mass, modes and how the force drives them.
    distance : float
        Where the move ends [m]; negative moves backwards, 0 is refused.
    maximum_force : float
        What the actuator can do, both ways [N].
    deflection_limits : float or sequence of float or None, optional
        Largest magnitude of each output at any time [m], None or infinity for none; a single one for all.
    outputs : array_like, shape (output, mode), optional
        Which deflections are limited, as sums of the modes' [-]; each mode's own unless given.
    bands : Band, (low, high) in hertz, or several, optional
        Where else vibration is to be kept down: frequencies and damping ratios that the modes may have.
    tolerance : float
        Vibration allowed in the bands, relative to what one step of the maximum force leaves [-].
    on_off : bool
        Whether the actuator can only be fully on, either way, or off.

    Returns
    -------
    RestToRest
        "optimal" when no shorter command keeps the limits: `lower_bound` says of all forces, not only of those on some
        grid, what none can beat, and `gap` is below 1e-9. "feasible" otherwise: the limits are kept and the end is at
        rest to rounding, and `gap` is what is not known. Levels that hold a sum of several modes on its limit vary with
        time; such a command is a staircase.

    Raises
    ------
    InputError
        If a value is out of range, the move takes too many periods of a mode, or on_off is asked where only a part of
        the force can hold a deflection on its limit.

    References
    ----------
    Pontryagin's principle for linear plants: full force, or an output on its limit. Robertson, section II, for limited
    deflection.

    Examples
    --------
    >>> from preshape.plant import FloatingOscillator
    >>> plant = FloatingOscillator(1.0, 1.0, 1.0)
    >>> free = time_optimal(plant, 10.0, maximum_force=1.0)
    >>> limited = time_optimal(plant, 10.0, maximum_force=1.0, deflection_limits=0.3)
    >>> free.status, round(free.duration, 4), limited.status, round(limited.duration, 4)
    ('optimal', 8.9445, 'optimal', 12.6428)
    """
    body = body_of(plant)
    distance = nonzero("distance", distance, "m")
    force = positive("maximum_force", maximum_force, "N")
    weights = _weights(outputs, len(body.modes))
    limits = _limits(deflection_limits, weights.shape[0])
    limited = np.isfinite(limits)
    allowed = tolerance_of(tolerance)
    edges = () if bands is None else edges_of(bands_of(bands), allowed)
    problem = Problem(
        target=abs(distance) * body.mass / force,
        rates=-np.conj([mode.pole for mode in body.modes]),
        rows=(weights * body.static_deflections(force) / limits[:, None])[limited],
        edges=edges,
    )
    _check_sizes(problem, distance, limits[limited])
    only = float(limits[0]) if limits.size == 1 and outputs is None and limited[0] else math.inf
    first = first_arcs(problem, body, distance, force, only) if only < math.inf else None
    found = shortest_move(problem, first)
    if found is None:
        raise RuntimeError(
            "the solvers found no command for this move, though there is one: please report it; ask for looser limits."
        )
    if on_off:
        _check_on_off(found, problem, force, limits[limited])
    settings = {
        "deflection_limits": tuple(float(limit) for limit in limits),
        "outputs": weights.tolist(),
        "bands": () if bands is None else bands_of(bands),
        "tolerance": None if bands is None else tolerance,
        "on_off": on_off,
    }
    return result_of(
        "time-optimal",
        body,
        distance,
        force,
        found.motion.times,
        found.motion.levels,
        outputs=weights,
        status="optimal" if found.structure is not None and found.gap <= PROVED else "feasible",
        lower_bound=found.least,
        settings=settings,
    )


def _weights(outputs: ArrayLike | None, modes: int) -> NDArray[np.float64]:
    """The outputs as a matrix, shape (output, mode)."""
    if outputs is None:
        return np.eye(modes)
    try:
        weights = np.array(outputs, dtype=float, ndmin=2)
    except (TypeError, ValueError):
        raise InputError("outputs hold something that is not a number: give one row of weights an output.") from None
    if weights.ndim != 2 or weights.shape[1] != modes:
        raise InputError(f"outputs have shape {weights.shape}: give (output, {modes}), a weight for each mode.")
    if not np.isfinite(weights).all() or not weights.any(axis=1).all():
        raise InputError("outputs hold NaN, infinity or a row of zeros: each must show at least one mode.")
    return weights


def _limits(given: float | Sequence[float | None] | None, outputs: int) -> NDArray[np.float64]:
    """One limit an output [m], infinite where there is none."""
    several = [given] * outputs if given is None or np.isscalar(given) or not np.iterable(given) else list(given)
    if len(several) != outputs:
        raise InputError(
            f"deflection_limits has {len(several)} values where {outputs} belong: give one for each output, None for "
            "none."
        )
    limits = [math.inf if limit is None or limit == math.inf else limit for limit in several]
    return np.array([limit if limit == math.inf else positive("deflection limit", limit, "m") for limit in limits])


def _check_sizes(problem: Problem, distance: float, limits: NDArray[np.float64]) -> None:
    """InputError if sixteen digits are too few for the move."""
    slowest = float(np.abs(problem.rates).min())
    if problem.unit * slowest < SHORTEST:
        raise InputError(
            f"a move of {distance:g} m takes a rigid body {2.0 * problem.unit:.3g} s, too small a part of the slowest "
            f"mode's period of {2.0 * math.pi / slowest:.3g} s to compute with: move farther or with less force, or "
            f"use bang_bang, which leaves {(problem.unit * slowest) ** 2:.1g} of what one step of the force leaves."
        )
    for limit, sizes in zip(limits, np.abs(problem.rows).sum(axis=1), strict=True):
        if sizes > 1.0 / LEAST_LIMIT:
            raise InputError(
                f"a deflection limit of {limit:g} m is {1.0 / sizes:.1g} of the static deflection: too little to "
                f"compute with; give {1.1 * LEAST_LIMIT * sizes * limit:.2g} m or more, or less force."
            )


def _check_on_off(found: Found, problem: Problem, force: float, limits: NDArray[np.float64]) -> None:
    """InputError if the command needs a part of the force."""
    if (np.abs(found.motion.levels) == 1.0).all():
        return
    arcs = () if found.structure is None else found.structure.arcs
    held = [arc for arc in arcs if arc.row is not None and abs(arc.level) < 1.0]
    if held and held[0].row is not None:
        static = limits[held[0].row] / abs(held[0].level)
        raise InputError(
            f"the shortest command holds the deflection limit of {limits[held[0].row]:g} m with "
            f"{abs(held[0].level) * force:.6g} N, and an on-off actuator gives {force:g} N or nothing: only a "
            "proportional actuator can; leave on_off out, or limit the deflection to the static "
            f"{static:.6g} m or more."
        )
    raise InputError(
        "the shortest command that was found within these limits needs levels between nothing and the maximum force, "
        "which an on-off actuator cannot give: leave on_off out, or allow more deflection or vibration."
    )
