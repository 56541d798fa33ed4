"""The one door to the engine: constraints in, the shortest shaper that meets them out, with what is known about it.

Which way leads there depends on what is asked: positive impulses anywhere (zero vibration, tolerated vibration or both)
are solved on the continuum and proved; a servo grid, bounded impulses, partial sums and responses on the grid; a limit
on the number of impulses by search, with the proved optimum without the limit as the bound.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.engine.choice import preferred
from preshape.engine.constraints import (
    AtMostImpulses,
    Constraint,
    ImpulsesBetween,
    PartialSumsBetween,
    ResponseBetween,
    ServoGrid,
    VibrationAtMost,
    ZeroVibration,
)
from preshape.engine.edges import edges_of, largest_vibration
from preshape.engine.gridded import MOST_SLOTS, shortest_on_grid
from preshape.engine.limited import shortest_limited
from preshape.engine.shortest import Shortest, shortest_positive
from preshape.engine.tolerant import MEETS, shortest_tolerant
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.provenance import Certificate

__all__ = ["Outcome", "minimum_duration"]

LONGEST = 60.0
"""Durations beyond this many periods of the lowest frequency are not searched."""


@dataclass(frozen=True)
class Outcome:
    """The shortest shaper found, and what is known about it.

    Parameters
    ----------
    status : str
        "optimal": proved that nothing shorter meets the constraints (`certificate`, or one grid slot fewer is
        impossible); "feasible": meets them, `gap` says how much a shorter one could save at most; "infeasible".
    times, amplitudes : ndarray, shape (impulse,)
        [s] and [-]; empty when infeasible.
    gap : float
        Part of the duration that a shorter shaper could save at most [-]; nan when nothing is known.
    reason : str
        Of an infeasible problem: which constraint, and the nearest feasible value.
    certificate : Certificate or None
        The proof on the continuum.
    """

    status: str
    times: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    gap: float = 0.0
    reason: str = ""
    certificate: Certificate | None = None


def minimum_duration(
    constraints: Sequence[Constraint], *, longest: float = math.inf, prefer: str | None = None
) -> Outcome:
    """The shortest shaper of sum one that meets all `constraints`.

    Parameters
    ----------
    constraints : sequence of Constraint
        At least one ZeroVibration or VibrationAtMost. Without ImpulsesBetween, PartialSumsBetween or ResponseBetween
        the impulses are positive.
    longest : float
        Durations above this [s] are not wanted: the outcome is infeasible then, and names the shortest.
    prefer : str, optional
        Which of several equally short shapers: "flattest" (Hyde 3.2) or "fewest" impulses.

    Raises
    ------
    InputError
        If nothing says where vibration is to be kept down, or impulses of both signs may stand anywhere: without a
        servo grid two opposite ones close to each other are limited by nothing.

    Examples
    --------
    >>> from preshape import Mode
    >>> from preshape.engine import ZeroVibration
    >>> found = minimum_duration([ZeroVibration(Mode(1.0), 0), ZeroVibration(Mode(2.3), 0)])
    >>> found.status, found.amplitudes.size
    ('optimal', 3)
    """
    zeros = [one for one in constraints if isinstance(one, ZeroVibration)]
    asks = [one for one in constraints if isinstance(one, VibrationAtMost)]
    if not zeros and not asks:
        raise InputError("nothing says where vibration is to be kept down: give a mode or a band.")
    outcome = _outcome(constraints, zeros, asks, prefer)
    duration = float(outcome.times[-1]) if outcome.times.size else 0.0
    if outcome.status == "infeasible" or duration <= longest:
        return outcome
    proof = "" if outcome.status == "optimal" else f", or {100.0 * outcome.gap:.2g} % less at best"
    reason = (
        f"a duration of {longest:g} s is too short: the shortest shaper that does this takes {duration:.9g} s{proof}."
    )
    return Outcome("infeasible", np.zeros(0), np.zeros(0), math.nan, reason)


def _outcome(
    constraints: Sequence[Constraint],
    zeros: Sequence[ZeroVibration],
    asks: Sequence[VibrationAtMost],
    prefer: str | None,
) -> Outcome:
    """The way that fits what is asked."""
    grids = [one for one in constraints if isinstance(one, ServoGrid)]
    limits = [one.count for one in constraints if isinstance(one, AtMostImpulses)]
    bounds = [one for one in constraints if isinstance(one, ImpulsesBetween)]
    signed = [one for one in bounds if (one.low, one.high) != (0.0, math.inf)]
    levels = [one for one in constraints if isinstance(one, PartialSumsBetween | ResponseBetween)]
    if prefer is not None and (grids or asks):
        raise InputError(
            "prefer chooses among equally short shapers of zero vibration with impulses anywhere: leave it out, or "
            "limit the number of impulses."
        )
    needed = max((one.order + 2 for one in zeros), default=1)
    if limits and min(limits) < needed:  # fewer columns u^k exp(-s u), k = 0..order, are linearly independent
        reason = f"{min(limits)} impulses are too few: zero vibration of order {needed - 2} takes at least {needed}."
        return Outcome("infeasible", np.zeros(0), np.zeros(0), math.nan, reason)
    if grids:
        free = bool(signed or levels)
        if limits and not (free or zeros):
            anywhere = _outcome([one for one in constraints if one not in grids], zeros, asks, None)
            if anywhere.status == "infeasible":  # then on a grid too, where to find that out takes longer
                return anywhere
        return _on_grid(constraints if free else [*constraints, ImpulsesBetween(0.0)], grids[0], zeros, asks)
    if signed or levels:
        raise InputError(
            "limits of impulses, partial sums or responses need a servo grid: give its dt, such as a fortieth of the "
            "shortest period."
        )
    found = _on_continuum(zeros, asks)
    if prefer is not None:
        found = preferred(found, prefer)
    if limits and found.times.size > min(limits):
        return _limited(found, zeros, asks, min(limits))
    status = "optimal" if found.certificate is not None else "feasible"
    return Outcome(status, found.times, found.amplitudes, found.gap, certificate=found.certificate)


def _on_continuum(zeros: Sequence[ZeroVibration], asks: Sequence[VibrationAtMost]) -> Shortest:
    """Positive impulses anywhere; tolerances that zero vibration keeps by itself change nothing."""
    if zeros:
        modes, orders = Modes([one.mode for one in zeros]), tuple(one.order for one in zeros)
        alone = shortest_positive(modes, orders)
        edges = [edge for ask in asks for edge in edges_of([ask.band], ask.tolerance)]
        leads = alone.times[-1] - alone.times[::-1]
        if not edges or largest_vibration(edges, leads, alone.amplitudes[::-1]).excess <= MEETS:
            return alone
    return shortest_tolerant(asks, zeros)


def _limited(optimum: Shortest, zeros: Sequence[ZeroVibration], asks: Sequence[VibrationAtMost], count: int) -> Outcome:
    """The shortest found with at most `count` impulses."""
    if zeros:
        raise InputError(
            f"the shortest shaper with zero vibration here has {optimum.times.size} impulses, more than {count}: allow "
            "as many, or give a servo grid, on which fewer are looked for."
        )
    edges = [edge for ask in asks for edge in edges_of([ask.band], ask.tolerance)]
    duration = float(optimum.times[-1])
    leads = duration - optimum.times[::-1]
    found = shortest_limited(edges, count, leads, optimum.amplitudes[::-1]) if count >= 2 else None
    if found is None:
        reason = (
            f"no shaper with at most {count} impulses was found that leaves at most {asks[0].tolerance:g} in these "
            f"bands; {optimum.times.size} impulses do it in {duration:.6g} s: allow as many, narrow the bands or raise "
            "the tolerance."
        )
        return Outcome("infeasible", np.zeros(0), np.zeros(0), math.nan, reason)
    leads, amplitudes = found
    return Outcome("feasible", leads[-1] - leads[::-1], amplitudes[::-1], 1.0 - duration / float(leads[-1]))


def _on_grid(
    constraints: Sequence[Constraint],
    grid: ServoGrid,
    zeros: Sequence[ZeroVibration],
    asks: Sequence[VibrationAtMost],
) -> Outcome:
    """Bisection over the slots of a servo grid."""
    frequencies = [one.mode.frequency for one in zeros] + [ask.band.high for ask in asks]
    lowest = min([one.mode.frequency for one in zeros] + [ask.band.low for ask in asks])
    coarsest = 0.5 / max(frequencies)
    if grid.dt >= coarsest:
        reason = (
            f"a grid of {grid.dt:g} s is coarser than half a period of {max(frequencies):g} Hz: give dt below "
            f"{coarsest:.6g} s."
        )
        return Outcome("infeasible", np.zeros(0), np.zeros(0), math.nan, reason)
    found = shortest_on_grid(constraints, grid, LONGEST / lowest)
    counts = [one.count for one in constraints if isinstance(one, AtMostImpulses)]
    if found is None and counts:
        more = _on_grid([one for one in constraints if not isinstance(one, AtMostImpulses)], grid, zeros, asks)
        if more.status == "infeasible":
            return more
        reason = (
            f"no shaper with at most {min(counts)} impulses was found on a grid of {grid.dt:g} s; {more.times.size} "
            f"impulses do it in {more.times[-1]:.6g} s: allow as many, or tolerate more."
        )
        return Outcome("infeasible", np.zeros(0), np.zeros(0), math.nan, reason)
    if found is None and MOST_SLOTS * grid.dt < LONGEST / lowest:
        reason = (
            f"no shaper of up to {MOST_SLOTS} slots of {grid.dt:g} s, {MOST_SLOTS * grid.dt:g} s, meets these limits, "
            "and more are too many to be solved soon: give a coarser grid."
        )
        return Outcome("infeasible", np.zeros(0), np.zeros(0), math.nan, reason)
    if found is None:
        reason = (
            f"no shaper of up to {LONGEST:g} periods of {lowest:g} Hz on a grid of {grid.dt:g} s meets these limits: "
            "widen the limits of impulses or partial sums, allow more impulses, narrow the bands, or tolerate more."
        )
        return Outcome("infeasible", np.zeros(0), np.zeros(0), math.nan, reason)
    times = found.leads[-1] - found.leads[::-1]
    status = "optimal" if found.proved else "feasible"
    gap = 0.0 if found.proved else 1.0 - (found.too_short + 1) / found.slots
    return Outcome(status, times, found.amplitudes[::-1], gap)
