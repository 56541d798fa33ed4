"""Motion: the exact response of a problem's modes to a force of constant levels, with its exact extrema."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from preshape.command.rest_to_rest.shortest.problem import Problem
from preshape.kernel import DrivenOutput, driven_phasors, extremum

__all__ = ["Motion"]


class Motion:
    """What a force of constant levels does.

    Parameters
    ----------
    problem : Problem
        With the modes and outputs.
    times : ndarray, shape (arc + 1,)
        Where the levels begin, and the end [s].
    levels : ndarray, shape (arc,)
        Force of each arc, in units of the largest [-].
    """

    def __init__(self, problem: Problem, times: NDArray[np.float64], levels: NDArray[np.float64]) -> None:
        self.problem, self.times, self.levels = problem, times, levels

    @property
    def steps(self) -> NDArray[np.float64]:
        """By how much the force steps at each time [-], shape (arc + 1,)."""
        return np.diff(self.levels, prepend=0.0, append=0.0)

    @property
    def leads(self) -> NDArray[np.float64]:
        """How long before the end each step happens [s], shape (arc + 1,)."""
        return np.asarray(self.times[-1] - self.times)

    @cached_property
    def residuals(self) -> NDArray[np.float64]:
        """Vibration left in each mode, in units of what one step of the largest force leaves [-], shape (mode,)."""
        return np.array([abs(self.left(rate)) for rate in self.problem.rates])

    def left(self, rate: complex) -> complex:
        """The vibration left at any rate s [1/s], as a phasor in the same unit."""
        return complex(self.steps @ np.exp(-rate * self.leads))

    def largest(self) -> NDArray[np.float64]:
        """Largest magnitude of every output at any time, in units of its limit [-], shape (output,)."""
        return np.array([extremum(output).value for output in self._outputs], dtype=float)

    def largest_in_arcs(self, samples: int) -> NDArray[np.float64]:
        """About the largest magnitude of every output in every arc [-], from even samples, shape (output, arc)."""
        arcs = np.repeat(np.arange(self.levels.size), samples)
        spacing = np.diff(self.times) / (samples - 1)
        since = np.multiply.outer(spacing, np.arange(samples)).ravel()
        largest = np.zeros((len(self._outputs), self.levels.size))
        for row, output in enumerate(self._outputs):
            value, slope, bend = output.values(arcs, since, 2)
            # the parabola through a sample tells its peak, if it is not farther than the next sample
            bent = (value * bend < 0.0) & (np.abs(slope) < np.abs(bend) * spacing[arcs])
            beyond = np.where(bent, 0.5 * slope**2 / np.where(bent, np.abs(bend), 1.0), 0.0)
            largest[row] = (np.abs(value) + beyond).reshape(-1, samples).max(axis=1)
        return largest

    @cached_property
    def _outputs(self) -> list[DrivenOutput]:
        rates = self.problem.rates
        phasors = driven_phasors(-rates, self.times, np.append(self.levels, 0.0)[:, np.newaxis])
        # the response to a unit impulse of force is w^2 / w_d exp(-z w t) sin(w_d t) = Re(i w^2 / w_d exp(-s t))
        gains = 1j * np.abs(rates) ** 2 / rates.imag
        nothing = np.zeros((self.times.size, 1))
        return [DrivenOutput(phasors, row * gains, nothing) for row in self.problem.rows]
