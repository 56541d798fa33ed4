"""Newton's method on the switching structure: the times at which everything that is asked holds to the last digit.

Unknown are the starts of the arcs, the touches and the end. The equations say: at rest on the target, every mode at
rest, an output on its limit and not moving where a hold or a touch begins, and vibration equal to its tolerance where a
tolerance is active. All of them are sums over the steps of the force before a time t,
  sum_k step_k phi(t - t_k),
so that first and second derivatives are at hand. More unknowns than equations leave a choice: then the end is
minimised, by the conditions of Lagrange. (The p of witness.py is zero at every switch: these are the same conditions.)
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from preshape.command.rest_to_rest.shortest.problem import Problem, kappa
from preshape.command.rest_to_rest.shortest.structure import Structure

__all__ = ["ActiveTolerance", "Polished", "polish"]

MAXIMUM_STEPS = 50

ACCEPTED = 3e-12
"""Equations (all scaled to 1) that are missed by less than this are met, or by what rounding leaves of tight limits."""

STILL = 1e-9
"""After a step of this part of the duration the next one is rounding. Met equations alone do not say so: where they
leave a choice, the shortest of all solutions is still to be found."""

RANK = 1e-11
"""Singular values below this part of the largest are zero: harmonics and symmetric moves drop the rank."""

NO_CHOICE = 1e-9
"""As many equations as unknowns leave no choice, if their slopes have no singular value below this part of the largest:
then they are solved alone, which loses fewer digits."""

SAMPLES, SMALLEST = 32, 1e-13
"""Samples for each mode of the functions that are made orthonormal; combinations smaller than this part of the largest
are nothing but rounding."""

ROUNDING, ROUNDINGS = 4e-16, 3.0
"""Of each equation, before they are combined; and so many times what rounding of the times leaves of outputs."""

CLOSEST = 0.5
"""No arc loses more than this part of its length in one step."""

VANISHED = 1e-7
"""An arc that is shorter than this part of the duration, and would be shorter still, is none."""

MISSED = 1e-10
"""The target is missed by no more than this part of it, and left in the whole duration by no more: what rounding of the
times leaves where modes are slow."""

FARTHEST = 0.5
"""A step of more than this part of the duration is lost."""

Wave = Callable[[NDArray[np.float64], int], NDArray[np.float64]]


@dataclass(frozen=True)
class ActiveTolerance:
    """A point where vibration is as large as allowed: rate s [1/s] and tolerance [-]."""

    rate: complex
    tolerance: float


@dataclass(frozen=True)
class Polished:
    """Exact arcs, and which of the tolerances really keep the move from being shorter, shape (tolerance,)."""

    structure: Structure
    needed: NDArray[np.bool_]


@dataclass(frozen=True)
class _Equation:
    """sum_k step_k phi(t - t_k) = side, at the unknown time of number `at` (over all steps before it)."""

    phi: Wave
    side: float
    at: int
    including_end: bool = False

    def value(self, t: NDArray[np.float64], steps: NDArray[np.float64]) -> float:
        """By how much it is missed."""
        before = np.arange(self.at) if self.at < steps.size else np.flatnonzero(t[: steps.size] < t[self.at])
        missed = float(self.phi(t[self.at] - t[before], 0) @ steps[before]) - self.side
        return missed + float(self.phi(np.zeros(1), 0)[0]) * float(steps[-1]) if self.including_end else missed


def polish(problem: Problem, structure: Structure, tolerances: Sequence[ActiveTolerance] = ()) -> Polished | None:
    """The exact times of a structure near given ones, or None when Newton's method does not find any.

    Parameters
    ----------
    problem : Problem
        What is asked.
    structure : Structure
        Arcs and touches, about where they are.
    tolerances : sequence of ActiveTolerance
        Where the vibration is to be as large as allowed.
    """
    unit, steps = problem.unit, structure.steps
    end = len(structure.arcs)
    # the starts of the arcs, the end, then the touches; the first start stays at 0
    t = np.concatenate([structure.times, [touch.time for touch in structure.touches]]) / unit
    equations = _equations(problem, structure)
    waves = [(one.rate * unit, one.tolerance) for one in tolerances]
    combined = _orthonormal(problem.rates * unit, float(t[end]))
    multipliers = np.zeros(len(equations) + len(waves))
    goal = np.zeros(t.size - 1)
    goal[end - 1] = 1.0
    met: NDArray[np.float64] | None = None
    least, moved = np.inf, np.inf
    largest = float(np.abs(combined).sum(axis=1).max())
    accepted = max(ACCEPTED, ROUNDINGS * problem.rounding(structure.end), ROUNDING * largest)
    for _ in range(MAXIMUM_STEPS):
        values, slopes, curve = _system(t, steps, equations, waves, multipliers, combined)
        error, (distance, velocity) = float(np.abs(values).max()), (one.value(t, steps) for one in equations[:2])
        missed = max(abs(distance), abs(velocity) * t[end])
        if error <= accepted and missed <= MISSED and (error <= least or moved > STILL):
            met, least = t, error
        if met is not None and moved <= STILL and error >= 0.5 * least:
            break
        step, multipliers = _lagrange_step(values, slopes, curve, goal)
        moved = float(np.abs(step).max()) / t[end]
        if not moved < FARTHEST:
            break
        part = _shortened(t[: end + 1], step[:end])
        t = np.append(0.0, t[1:] + part * step)
        shortest = int(np.argmin(np.diff(t[: end + 1])))
        if part < 1.0 and t[shortest + 1] - t[shortest] < VANISHED * t[end]:
            return polish(problem, _moved(structure, t * unit).without(shortest), tolerances) if end > 2 else None
    if met is None:
        return None
    return Polished(_moved(structure, met * unit), multipliers[len(equations) :] >= 0.0)


def _moved(structure: Structure, times: NDArray[np.float64]) -> Structure:
    """A structure at other times [s]: starts of its arcs, the end, the touches."""
    end = len(structure.arcs)
    arcs = [replace(arc, start=float(time)) for arc, time in zip(structure.arcs, times[:end], strict=True)]
    touches = [replace(one, time=float(when)) for one, when in zip(structure.touches, times[end + 1 :], strict=True)]
    return Structure(tuple(arcs), tuple(touches), float(times[end]))


def _equations(problem: Problem, structure: Structure) -> list[_Equation]:
    """In units of `problem.unit`."""
    unit = problem.unit
    end = len(structure.arcs)
    rates = problem.rates * unit
    found = [
        _Equation(lambda x, n: (0.5 * x**2, x, np.ones_like(x))[n], 1.0, end),
        _Equation(lambda x, n: (x, np.ones_like(x), np.zeros_like(x))[n], 0.0, end),
    ]
    for rate in rates:
        found.append(_Equation(_decay(rate, 1.0), 0.0, end, True))
        found.append(_Equation(_decay(rate, -1.0j), 0.0, end, True))
    contacts = [(k, arc.row, arc.sign) for k, arc in enumerate(structure.arcs) if arc.row is not None]
    contacts += [(end + 1 + k, touch.row, touch.sign) for k, touch in enumerate(structure.touches)]
    for at, row, sign in contacts:
        weights = problem.rows[row]
        scale = float(np.abs(rates[weights != 0.0]).max())
        found.append(_Equation(_deflection(rates, weights, 0, 1.0), sign, at))
        found.append(_Equation(_deflection(rates, weights, 1, 1.0 / scale), 0.0, at))
    return found


def _orthonormal(rates: NDArray[np.complex128], end: float) -> NDArray[np.float64]:
    """How the equations of the end combine to functions that are orthonormal over the duration.

    In a move that is short for the modes, or for their differences, the functions are nearly the same, and their
    differences tell where the switches are.
    """
    lead = np.linspace(0.0, end, SAMPLES * (1 + rates.size))
    waves = np.exp(-np.multiply.outer(lead, rates))
    columns = np.column_stack([0.5 * lead**2, lead, *(part for wave in waves.T for part in (wave.real, wave.imag))])
    # steps sum to zero, so constants do not matter
    _, sizes, combined = np.linalg.svd((columns - columns.mean(axis=0)) / math.sqrt(lead.size), full_matrices=False)
    return np.asarray(combined / np.maximum(sizes, SMALLEST * sizes[0])[:, None])


def _decay(rate: complex, part: complex) -> Wave:
    """Re(part exp(-rate x)) and its derivatives."""
    return lambda x, n: np.asarray(np.real(part * (-rate) ** n * np.exp(-rate * x)))


def _deflection(rates: NDArray[np.complex128], weights: NDArray[np.float64], derivative: int, scale: float) -> Wave:
    """An output's step response, `derivative` times differentiated, and its derivatives."""
    taken = kappa(rates)

    def wave(x: NDArray[np.float64], n: int) -> NDArray[np.float64]:
        order = derivative + n
        each = -np.real(taken * (-rates) ** order * np.exp(-np.multiply.outer(x, rates)))
        if order == 0:
            each = each + 1.0
        return np.asarray(scale * (each @ weights))

    return wave


def _system(
    t: NDArray[np.float64],
    steps: NDArray[np.float64],
    equations: Sequence[_Equation],
    waves: Sequence[tuple[complex, float]],
    multipliers: NDArray[np.float64],
    combined: NDArray[np.float64],
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Values (equation,), slopes (equation, unknown), and second derivatives summed with the multipliers.

    The first equations, those of the end, are combined as the square matrix says.
    """
    of_end = combined.shape[0]
    multipliers = np.concatenate([multipliers[:of_end] @ combined, multipliers[of_end:]])
    count, end = len(equations) + len(waves), steps.size - 1
    values, slopes = np.zeros(count), np.zeros((count, t.size))
    curve = np.zeros((t.size, t.size))
    for k, equation in enumerate(equations):
        at = equation.at
        before = np.arange(at) if at <= end else np.flatnonzero(t[: end + 1] < t[at])
        lag, size = t[at] - t[before], steps[before]
        values[k] = equation.value(t, steps)
        first, second = equation.phi(lag, 1) * size, equation.phi(lag, 2) * size * multipliers[k]
        slopes[k, before] -= first
        slopes[k, at] += first.sum()
        curve[before, before] += second
        curve[before, at] -= second
        curve[at, before] -= second
        curve[at, at] += second.sum()
    for k, (rate, tolerance) in enumerate(waves, start=len(equations)):
        wave = steps * np.exp(-rate * (t[end] - t[: end + 1]))
        total = complex(wave.sum())
        change = np.zeros(t.size, dtype=complex)
        change[:end] = rate * wave[:end]
        change[end] = -rate * wave[:end].sum()
        values[k] = abs(total) ** 2 / tolerance**2 - 1.0
        slopes[k] = 2.0 * np.real(total.conjugate() * change) / tolerance**2
        bend = np.zeros((t.size, t.size), dtype=complex)
        twice = rate**2 * wave[:end]
        bend[np.arange(end), np.arange(end)] = twice
        bend[:end, end] = bend[end, :end] = -twice
        bend[end, end] = twice.sum()
        second = 2.0 * (np.real(total.conjugate() * bend) + np.real(np.multiply.outer(change.conj(), change)))
        curve += multipliers[k] * second / tolerance**2
    values[:of_end], slopes[:of_end] = combined @ values[:of_end], combined @ slopes[:of_end]
    return values, slopes[:, 1:], curve[1:, 1:]


def _lagrange_step(
    values: NDArray[np.float64], slopes: NDArray[np.float64], curve: NDArray[np.float64], goal: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Newton's step for: least goal . t with all values zero; and the new multipliers."""
    count, size = slopes.shape
    if count == size and np.linalg.cond(slopes) < 1.0 / NO_CHOICE:
        return np.asarray(np.linalg.solve(slopes, -values)), np.asarray(np.linalg.solve(slopes.T, -goal))
    left = np.block([[curve, slopes.T], [slopes, np.zeros((count, count))]])
    right = np.concatenate([-goal, -values])
    answer = np.linalg.lstsq(left, right, rcond=RANK)[0]
    return answer[:size], answer[size:]


def _shortened(starts: NDArray[np.float64], step: NDArray[np.float64]) -> float:
    """The part of a step that keeps the order of the switches."""
    gaps, closing = np.diff(starts), -np.diff(np.concatenate([[0.0], step]))
    short = closing > CLOSEST * gaps
    return float((CLOSEST * gaps[short] / closing[short]).min()) if short.any() else 1.0
