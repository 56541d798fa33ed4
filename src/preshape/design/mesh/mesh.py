"""Hyde's mesh: an impulse allowed at every servo slot, their amplitudes found by optimisation (chapter 3.4).

The times are given, so zero vibration is linear in the amplitudes. The result needs no rounding in a controller with
this servo period, and there it is exact.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

from preshape.checks import whole_number
from preshape.design.each_mode import recorded
from preshape.design.mesh.few import Few, few_impulses
from preshape.design.mesh.problem import GridProblem
from preshape.design.mesh.slots import SlotImpulses, convolved_on_slots, impulses_in, shortest_slots
from preshape.design.mesh.verify import verified
from preshape.engine.flattest import flattest
from preshape.errors import InputError
from preshape.mode import ModesLike
from preshape.provenance import Design
from preshape.shaper import Shaper

__all__ = ["mesh"]

Cost = Literal["zero", "second_derivative"]

COSTS = ("zero", "second_derivative")

MOST_IMPULSES = 10_000

SMALLEST = 1e-9
"""An amplitude below this is none; the equations are met again without it."""


def mesh(
    modes: ModesLike,
    dt: float,
    *,
    duration: float | None = None,
    order: int | Iterable[int] = 1,
    cost: Cost = "zero",
    fewest: bool = False,
    at_most: int | None = None,
) -> Shaper:
    """The positive shaper with impulses at multiples of the servo period only: the shortest, the flattest, the fewest.

    Parameters
    ----------
    modes : Mode, (frequency, damping) or several
        Frequencies [Hz], damping ratios [-].
    dt : float
        Servo period [s], at most half a period of the fastest mode.
    duration : float, optional
        Time in which all impulses must lie [s] (Hyde's t_N). By default the shortest that is possible on this grid,
        found by bisection.
    order : int or one a mode
        Vanishing derivatives: 0 as ZV, 1 as ZVD (Hyde's choice) ...
    cost : {"zero", "second_derivative"}
        "zero": any solution, about 4 impulses a mode. "second_derivative": the one whose next derivative, squared and
        summed over the modes, is least: the sensitivity curve is flatter at the modes (Hyde's equation 3.2).
    fewest : bool
        Look for the fewest impulses by integer programming, for some seconds at most. On a grid that fits no symmetry
        of the modes these are as many as there are equations; ``settings["impulses_at_least"]`` is the proved bound.
    at_most : int, optional
        Most impulses allowed; without a duration, the shortest duration is found at which that is possible.

    Returns
    -------
    Shaper
        ``design.status`` is "optimal" when what was looked for is proved on this grid (``settings["proved"]`` says in
        words what), else "feasible". It carries no certificate: that would speak of all impulse times, and
        :func:`preshape.design.direct` is the shaper that has one.

    Raises
    ------
    InputError
        If the grid is too coarse or too fine, the duration too short or the impulses too few; the sentence names the
        nearest value that will do.

    References
    ----------
    Hyde, 3.4.1 and 3.4.2; the exponent's sign as in Robertson's eq. 1-3.

    Examples
    --------
    >>> shaper = mesh([(1.0, 0.0), (10.0, 0.0)], dt=0.005)
    >>> round(shaper.duration, 6), shaper.design.status
    (1.055, 'optimal')
    """
    problem = GridProblem.checked(modes, order, dt)
    if cost not in COSTS:
        raise InputError(f"cost {cost!r} is not known: it is {' or '.join(COSTS)}.")
    limit = None if at_most is None else whole_number("at_most", at_most, 1, MOST_IMPULSES)
    found = _shortest(problem) if duration is None else _within(problem, duration)
    if not found.resolved and (cost != "zero" or fewest or limit is not None):
        raise InputError(
            "these modes are too near each other to do more than put one shaper after the other: ask for cost='zero' "
            "and any number of impulses, merge near modes, or lower the order."
        )
    chosen = _flattened(problem, found, np.arange(found.slots + 1)) if cost == "second_derivative" else found
    few: Few | None = None
    if fewest or (limit is not None and chosen.places.size > limit):
        few = few_impulses(problem, found, limit, minimise=fewest, longer=duration is None)
        chosen = few.impulses
        if cost == "second_derivative":
            chosen = _flattened(problem, chosen, chosen.places)
    shaper = _on_slots(problem, chosen)
    settings: dict[str, Any] = {"dt": problem.dt, "order": _plain(problem.orders), "cost": cost, "fewest": bool(fewest)}
    if duration is not None:
        settings["duration"] = float(duration)
    if limit is not None:
        settings["at_most"] = limit
    settings["slots"] = int(chosen.places[-1] - chosen.places[0])
    proved: list[bool] = []
    if duration is None:
        proved.append(_says_how_short(settings, found, chosen, few))
    if fewest and few is not None:
        proved.append(_says_how_few(settings, chosen, few))
    status = "optimal" if proved and all(proved) else "feasible"
    return recorded(shaper, Design("mesh", problem.modes, settings, status))


def _says_how_short(settings: dict[str, Any], found: SlotImpulses, chosen: SlotImpulses, few: Few | None) -> bool:
    """Into the settings: the proof that nothing on the grid is shorter, or what is missing; whether it is proved."""
    if not (found.shortest if few is None else few.shorter_excluded):
        settings["gap"] = 1.0 - (found.excluded + 1) / chosen.slots
        return False
    few_enough = "" if few is None or "at_most" not in settings else f" of at most {settings['at_most']} impulses"
    settings["proved"] = f"no positive shaper{few_enough} on this grid is shorter"
    if chosen.slots == found.slots:
        settings["separation"] = found.separation
    return True


def _says_how_few(settings: dict[str, Any], chosen: SlotImpulses, few: Few) -> bool:
    """Into the settings: how many impulses are needed at least; whether these are the fewest."""
    count = chosen.places.size
    settings["impulses_at_least"] = min(few.at_least, count)
    known = f"at least {few.at_least} impulses are needed"
    if few.at_least >= count:
        known = f"none on its {chosen.slots} slots has fewer impulses"
    settings["proved"] = "; ".join([settings["proved"], known] if "proved" in settings else [known])
    return few.at_least >= count


def _shortest(problem: GridProblem) -> SlotImpulses:
    """The fewest slots, or, for modes too near for the arithmetic, one shaper after the other."""
    return shortest_slots(problem) or convolved_on_slots(problem)


def _within(problem: GridProblem, duration: float) -> SlotImpulses:
    """Impulses within a duration; the sentence names the shortest that is possible when there are none."""
    slots = problem.slots_in(duration)
    found = impulses_in(problem, slots)
    if found is not None:
        return found
    shortest = _shortest(problem)
    if shortest.slots <= slots:
        return replace(shortest, slots=slots)
    none = "no positive shaper with these constraints lies" if slots <= shortest.excluded else "none was found"
    raise InputError(
        f"{none} within {float(duration):.9g} s on a grid of {problem.dt:g} s: give a duration of at least "
        f"{shortest.slots * problem.dt:.9g} s, or a finer grid."
    )


def _flattened(problem: GridProblem, found: SlotImpulses, allowed: NDArray[np.intp]) -> SlotImpulses:
    """The flattest amplitudes on the `allowed` places, that is with the least next derivative (Hyde 3.2)."""
    leads = problem.leads(found.slots)[allowed]
    amplitudes = flattest(problem.basis(found.slots)(leads), _next_derivative(problem, leads, found.slots))
    used = np.flatnonzero(amplitudes > SMALLEST)
    return replace(found, places=allowed[used], amplitudes=amplitudes[used])


def _next_derivative(problem: GridProblem, leads: NDArray[np.float64], slots: int) -> NDArray[np.float64]:
    """(u/T)^(q+1) exp(-s u), u the lead: where the derivatives up to q vanish, time and lead give the same sum."""
    rows = []
    for mode, order in zip(problem.modes, problem.orders, strict=True):
        wave = (leads / (slots * problem.dt)) ** (order + 1) * np.exp(mode.pole.conjugate() * leads)
        rows += [wave.real, wave.imag]
    return np.array(rows)


def _on_slots(problem: GridProblem, found: SlotImpulses) -> Shaper:
    """The shaper, its equations verified; times are whole multiples of dt."""
    leads = (found.places - found.places[0]) * problem.dt
    amplitudes = verified(problem.modes, problem.orders, leads, found.amplitudes)
    times = (found.places[-1] - found.places[::-1]) * problem.dt
    return Shaper(times, amplitudes[::-1])


def _plain(orders: tuple[int, ...]) -> int | list[int]:
    return orders[0] if len(set(orders)) == 1 else list(orders)
