"""The farthest move in a given time: a sparse conic programme over the levels of the force on a grid.

Feasibility in a given time is asked as "how far at most", because that has an answer for every time: standing still
meets all constraints. No solver ever has to find out that something is impossible, which some do badly. Limited outputs
are sampled at the grid's nodes and between them; what that leaves out makes the programme only easier, so its
multipliers prove lower bounds (witness.py).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.command.rest_to_rest.shortest.problem import Problem, kappa
from preshape.command.rest_to_rest.shortest.solvers import by_interior_points, by_vertices

__all__ = ["SAMPLES", "Farthest", "farthest", "left_by_levels"]

BETWEEN = (0.0, 0.5)
"""Where in each interval the limits are asked. With the nodes alone, levels could alternate between them unseen."""

SAMPLES = len(BETWEEN)


@dataclass(frozen=True, eq=False)
class Farthest:
    """The farthest move found, and its multipliers.

    Parameters
    ----------
    solved : bool
        Whether the solver reached its precision.
    vertex : bool
        Whether it is a vertex: on a limit exactly or not at all.
    distance : float
        How far it goes, as :attr:`Problem.target` [s^2].
    times : ndarray, shape (interval + 1,)
        Nodes of the grid [s].
    levels : ndarray, shape (interval,)
        Force of each interval [-].
    sample_times : ndarray, shape (sample,)
        Where the outputs are limited [s], increasing.
    outputs, masses : ndarray, shape (output, sample)
        The outputs there, in units of their limits, and the multipliers of the limits [s^2]: positive above,
        negative below.
    velocity : float
        Multiplier of the final velocity [s].
    points, tolerances : ndarray, shape (point,)
        Rates [1/s] at which vibration was limited, and to how much [-].
    waves : ndarray of complex, shape (mode + point,)
        Multipliers of the vibration left at every mode and every point [s^2].
    """

    solved: bool
    vertex: bool
    distance: float
    times: NDArray[np.float64]
    levels: NDArray[np.float64]
    sample_times: NDArray[np.float64]
    outputs: NDArray[np.float64]
    masses: NDArray[np.float64]
    velocity: float
    points: NDArray[np.complex128]
    tolerances: NDArray[np.float64]
    waves: NDArray[np.complex128]

    @property
    def steps(self) -> NDArray[np.float64]:
        """By how much the force steps at each node [-], shape (interval + 1,)."""
        return np.diff(self.levels, prepend=0.0, append=0.0)


def farthest(
    problem: Problem,
    duration: float,
    grid: NDArray[np.float64],
    points: NDArray[np.complex128],
    tolerances: NDArray[np.float64],
    limits: NDArray[np.float64] | float = 1.0,
    vertex: bool = False,
) -> Farthest:
    """The farthest rest-to-rest move in `duration` [s] on a grid.

    Parameters
    ----------
    problem : Problem
        Modes and limits; its target does not matter.
    duration : float
        Time of the move [s].
    grid : ndarray, shape (interval + 1,)
        Nodes as fractions of the duration, increasing from 0 to 1.
    points, tolerances : ndarray, shape (point,)
        Rates [1/s] at which vibration is limited, and to how much [-].
    limits : ndarray, shape (output, sample), or float
        What the outputs are kept to, in units of their limits [-].
    vertex : bool
        Whether a vertex is wanted; not with points.
    """
    from scipy import sparse

    # in units of the duration, so that the solver always sees numbers of about 1
    rates, steps = problem.rates * duration, np.diff(grid)
    count = steps.size
    # the columns are the levels, then the real and the imaginary part of each limited mode's phasor
    tracked = problem.tracked
    size = count * (1 + 2 * len(tracked))
    system = _Equalities(rates, grid, tracked)
    per_output = (problem.rows.shape[0], count * SAMPLES)
    outputs = _limited(problem.rows, rates, steps, tracked)
    bounds = sparse.eye_array(count, size)
    left = left_by_levels(points * duration, grid)
    cones = np.zeros((3 * points.size, count))
    cones[1::3], cones[2::3] = -left.real, -left.imag
    matrix = sparse.vstack([system.matrix, bounds, -bounds, outputs, -outputs, _widened(cones, size)], format="csc")
    equalities, inequalities = system.matrix.shape[0], 2 * count + 2 * outputs.shape[0]
    sides = np.concatenate(
        [
            np.zeros(equalities),
            np.ones(2 * count),
            np.tile(np.broadcast_to(limits, per_output).ravel(), 2),
            np.zeros(3 * points.size),
        ]
    )
    sides[equalities + inequalities :: 3] = tolerances
    cost = np.zeros(size)
    cost[:count] = -(1.0 - 0.5 * (grid[:-1] + grid[1:])) * steps
    solve = by_vertices if vertex and points.size == 0 else by_interior_points
    solved, x, dual = solve(matrix, sides, cost, equalities, inequalities)
    if not solved and points.size == 0:
        solved, x, dual = by_vertices(matrix, sides, cost, equalities, inequalities)
    above, below = dual[equalities + 2 * count : equalities + inequalities].reshape(2, -1)
    cone = dual[equalities + inequalities :].reshape(-1, 3)
    waves = np.zeros(rates.size + points.size, dtype=complex)
    waves[: rates.size], waves[rates.size :] = system.waves(dual), -(cone[:, 1] + 1j * cone[:, 2])
    return Farthest(
        solved=solved,
        vertex=vertex,
        distance=-float(cost @ x) * duration**2,
        times=grid * duration,
        levels=x[:count],
        sample_times=np.ravel(grid[:-1, None] + np.multiply.outer(steps, BETWEEN)) * duration,
        outputs=(outputs @ x).reshape(per_output),
        masses=(above - below).reshape(per_output) * duration**2,
        velocity=float(dual[0]) * duration,
        points=points,
        tolerances=tolerances,
        waves=np.asarray(waves * duration**2, dtype=complex),
    )


def left_by_levels(rates: NDArray[np.complex128], nodes: NDArray[np.float64]) -> NDArray[np.complex128]:
    """What a unit level in each interval leaves at the end, shape (rate, interval)."""
    leads = np.exp(-np.multiply.outer(rates, nodes[-1] - nodes))
    return np.asarray(leads[:, :-1] - leads[:, 1:])


class _Equalities:
    """Rest at the end, and the phasors of the limited modes from node to node.

    A phasor z_k makes the deflection in interval k  v_k + Re z_k exp(-s t), so that
      z_k + kappa v_k = exp(-s h) z_(k-1) + kappa v_(k-1)
    for all k including the end, where z and v are zero. Other modes need one complex row: what is left of them.
    """

    def __init__(self, rates: NDArray[np.complex128], grid: NDArray[np.float64], tracked: list[int]) -> None:
        from scipy import sparse

        steps = np.diff(grid)
        count = steps.size
        size = count * (1 + 2 * len(tracked))
        free = [mode for mode in range(rates.size) if mode not in tracked]
        left = left_by_levels(rates[free], grid)
        blocks = [_widened(np.concatenate([steps[None], left.real, left.imag]), size)]
        now, then = sparse.eye_array(count + 1, count), sparse.eye_array(count + 1, count, k=-1)
        self._rates, self._free, self._tracked, self._intervals = rates, free, tracked, count
        for place, mode in enumerate(tracked):
            carried = now - then @ sparse.diags_array(np.exp(-rates[mode] * steps))
            taken = kappa(rates)[mode]
            before, after = (sparse.csr_array((count + 1, 2 * count * n)) for n in (place, len(tracked) - 1 - place))
            for level, real, imaginary in (
                (taken.real, carried.real, -carried.imag),
                (taken.imag, carried.imag, carried.real),
            ):
                blocks.append(sparse.hstack([float(level) * (now - then), before, real, imaginary, after]))
        self.matrix: Any = sparse.vstack(blocks, format="csr")

    def waves(self, dual: NDArray[np.float64]) -> NDArray[np.complex128]:
        """Multipliers of what is left of each mode, shape (mode,)."""
        waves = np.zeros(self._rates.size, dtype=complex)
        count, free = self._intervals, len(self._free)
        waves[self._free] = dual[1 : 1 + free] + 1j * dual[1 + free : 1 + 2 * free]
        for place, mode in enumerate(self._tracked):
            last = 1 + 2 * free + 2 * place * (count + 1) + count
            waves[mode] = complex(dual[last], dual[last + count + 1]) * np.conj(kappa(self._rates)[mode])
        return waves


def _limited(
    rows: NDArray[np.float64], rates: NDArray[np.complex128], steps: NDArray[np.float64], tracked: list[int]
) -> Any:
    """The outputs at all samples, in the order of the outputs and then of time, shape (output * sample, column)."""
    from scipy import sparse

    count = steps.size
    interval = np.repeat(np.arange(count), SAMPLES)
    turned = np.exp(-np.multiply.outer(np.ravel(np.multiply.outer(steps, BETWEEN)), rates))
    held = sparse.csr_array((np.ones(interval.size), (np.arange(interval.size), interval)))
    blocks = []
    for weights in rows:
        parts = [held * weights.sum()]
        for mode in tracked:
            wave = weights[mode] * turned[:, mode]
            parts += [sparse.diags_array(wave.real) @ held, sparse.diags_array(-wave.imag) @ held]
        blocks.append(sparse.hstack(parts))
    return sparse.vstack(blocks, format="csr") if blocks else sparse.csr_array((0, count * (1 + 2 * len(tracked))))


def _widened(rows: NDArray[np.float64], size: int) -> Any:
    """Rows over the levels as rows over all columns."""
    from scipy import sparse

    return sparse.hstack([sparse.csr_array(rows), sparse.csr_array((rows.shape[0], size - rows.shape[1]))])
