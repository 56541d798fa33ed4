"""FunctionPlant: a machine written as a Python function, x' = f(t, x, u), however non-linear."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.plant.checks import finite_row
from preshape.plant.diverged import Diverged
from preshape.plant.followed import METHODS, Derivative, Method, followed
from preshape.plant.protocol import Progress
from preshape.plant.sampled_command import Hold, checked_hold, command_rows
from preshape.plant.simulation import Simulation
from preshape.plant.state_space import LinearPlant

__all__ = ["FunctionPlant", "Look"]

Array: TypeAlias = NDArray[np.float64]

Look: TypeAlias = int | Callable[[Array, Array], float]
"""An output: the number of a state, from 0, or a function of state and input."""

DIFFERENCE = float(np.cbrt(np.finfo(float).eps))
"""Step of a central difference, relative to the scale of a state: where rounding and curvature cost alike."""

DIFFERENCED = 1e-9
"""Accuracy of a derivative by such differences, relative to the largest."""


class FunctionPlant:
    """A plant from the function of its equations of motion.

    Parameters
    ----------
    derivative : function
        f(t, x, u): time [s], state of shape (state,), input of shape (input,), to x' of shape (state,).
    initial : array_like, shape (state,)
        Where it stands at time 0, at rest under no command.
    outputs : mapping of str to int or function
        By name: the number of a state, or a function h(x, u) to a number.
    inputs : mapping of str to str
        Units by name; one input "input" unless given.
    output_units : mapping of str to str, optional
        Units by name; none unless given.
    tolerance : float
        Error of a step of the integration, relative to the state and to `scale` [-].
    scale : float or array_like, shape (state,)
        How large each state typically is; 1 unless given.
    method : {"DOP853", "RK45", "LSODA", "Radau", "BDF"}
        Of :func:`scipy.integrate.solve_ivp`; the last three for stiff equations.

    Raises
    ------
    InputError
        If the function does not give one number a state, or an output is not one.

    Examples
    --------
    A pendulum of 1 m on a trolley whose acceleration is commanded:

    >>> def swing(t, x, u):
    ...     return [x[1], -9.81 * np.sin(x[0]) - u[0] * np.cos(x[0])]
    >>> crane = FunctionPlant(swing, [0.0, 0.0], {"angle": 0}, inputs={"acceleration": "m/s^2"})
    >>> round(crane.modes()[0].frequency, 4), round(crane.modes([0.5, 0.0])[0].frequency, 4)
    (0.4985, 0.467)
    """

    def __init__(
        self,
        derivative: Derivative,
        initial: ArrayLike,
        outputs: Mapping[str, Look],
        *,
        inputs: Mapping[str, str] = MappingProxyType({"input": ""}),
        output_units: Mapping[str, str] | None = None,
        tolerance: float = 1e-8,
        scale: ArrayLike = 1.0,
        method: Method = "DOP853",
    ) -> None:
        self._start = finite_row("initial", initial)
        self._scale = (
            np.broadcast_to(finite_row("scale", scale), self._start.shape) if self._start.size else self._start
        )
        if not self._start.size or not (self._scale > 0.0).all():
            raise InputError("initial and scale do not make a state: give one number a state, scales above 0.")
        self._tolerance = positive("tolerance", tolerance, "(a ratio)")
        if method not in METHODS:
            raise InputError(f"method is {method!r}: give one of {', '.join(METHODS)}.")
        self._method: Method = method
        if not outputs or not inputs:
            raise InputError("the plant has no inputs or no outputs: name at least one of each.")
        self._derivative = derivative
        units = output_units or {}
        self._inputs = MappingProxyType(dict(inputs))
        self._outputs = MappingProxyType({name: units.get(name, "") for name in outputs})
        self._looks = [_look(name, look, self._start.size) for name, look in outputs.items()]
        still = np.zeros(len(inputs))
        self._slope(0.0, self._start, still)
        self._seen(self._start, still)

    def __repr__(self) -> str:
        return f"<FunctionPlant: {self._start.size} states, {', '.join(self._inputs)} to {', '.join(self._outputs)}>"

    @property
    def inputs(self) -> Mapping[str, str]:
        """Unit of each input, by name."""
        return self._inputs

    @property
    def outputs(self) -> Mapping[str, str]:
        """Unit of each output, by name."""
        return self._outputs

    def modes(self, configuration: ArrayLike | None = None) -> Modes:
        """What vibrates about a state: the modes of :meth:`linearised`.

        Friction and freeplay make f jump, and what jumps has no linearisation: identify such a machine instead, with
        :func:`preshape.workflow.identify_plant`.
        """
        return self.linearised(configuration).modes()

    def linearised(self, configuration: ArrayLike | None = None, command: ArrayLike | None = None) -> LinearPlant:
        """The plant for small motion about a state and a constant command, by central differences at time 0.

        Parameters
        ----------
        configuration : array_like, shape (state,), optional
            The state; the initial one unless given.
        command : array_like, shape (input,), optional
            The inputs there; 0 unless given.

        Returns
        -------
        LinearPlant
            Its inputs and outputs are deviations.
        """
        x = self._state(configuration)
        u = np.zeros(len(self._inputs)) if command is None else finite_row("command", command)
        steps = DIFFERENCE * np.concatenate([np.maximum(np.abs(x), self._scale), np.maximum(np.abs(u), 1.0)])
        both = np.concatenate([x, u])
        columns = []
        for k, step in enumerate(steps):
            ahead, behind = both.copy(), both.copy()
            ahead[k] += step
            behind[k] -= step
            values = [
                np.concatenate([self._slope(0.0, at[: x.size], at[x.size :]), self._seen(at[: x.size], at[x.size :])])
                for at in (ahead, behind)
            ]
            columns.append((values[0] - values[1]) / (ahead[k] - behind[k]))
        whole = np.array(columns).T
        if not np.isfinite(whole).all():
            raise InputError("the derivative is not finite near this configuration: give one where the motion exists.")
        n = x.size
        return LinearPlant(
            whole[:n, :n], whole[:n, n:], whole[n:, :n], whole[n:, n:],
            inputs=self._inputs, outputs=self._outputs, accuracy=DIFFERENCED,
        )  # fmt: skip

    def simulate(
        self,
        command: ArrayLike,
        dt: float,
        *,
        hold: Hold = "zero",
        configuration: ArrayLike | None = None,
        progress: Progress | None = None,
    ) -> Simulation:
        """The outputs under a sampled command.

        Integration starts anew wherever the command, or its slope, changes, so that no step of a solver bridges a jump.

        Parameters
        ----------
        command : array_like, shape (input, sample) or (sample,)
            The inputs at 0, dt, 2 dt, ...
        dt : float
            Sample interval [s].
        hold : {"zero", "linear"}
            The command between samples: held, as a controller's output is, or the straight line to the next sample.
        configuration : array_like, shape (state,), optional
            Where it starts; the initial state unless given.
        progress : function, optional
            Called with the part done, 0 to 1.

        Returns
        -------
        Simulation

        Raises
        ------
        InputError
            If the command does not fit the inputs, or `dt` or `hold` makes no sense.
        Diverged
            If the state runs away, or the equations cannot be followed; with the samples before.
        """
        rows = command_rows(command, self._inputs)
        dt = positive("dt", dt, "s")
        slopes = np.diff(rows, axis=1) / dt if checked_hold(hold) else np.zeros((rows.shape[0], rows.shape[1] - 1))
        changes = np.any((np.diff(rows[:, :-1], axis=1) != 0.0) | (np.diff(slopes, axis=1) != 0.0), axis=0)
        starts = np.concatenate([[0], np.flatnonzero(changes) + 1])[: max(rows.shape[1] - 1, 0)]
        times = dt * np.arange(rows.shape[1], dtype=float)
        states = np.empty((self._start.size, rows.shape[1]))
        states[:, 0] = self._state(configuration)
        for first, last in zip(starts, np.append(starts[1:], rows.shape[1] - 1), strict=True):
            stretch = slice(first, last + 1)
            way = followed(
                self._slope, states[:, first], times[stretch], rows[:, first], slopes[:, first], self._tolerance,
                self._scale, self._method,
            )  # fmt: skip
            good = first + way.states.shape[1]
            states[:, first:good] = way.states
            if way.reason:
                raise Diverged(way.reason, way.time, self._simulation(times[:good], rows[:, :good], states[:, :good]))
            if progress is not None:
                progress(float(last) / (rows.shape[1] - 1))
        return self._simulation(times, rows, states)

    def _simulation(self, times: Array, rows: Array, states: Array) -> Simulation:
        values = np.array([self._seen(x, u) for x, u in zip(states.T, rows.T, strict=True)])
        columns = values.reshape(-1, len(self._outputs)).T
        return Simulation(times, rows, MappingProxyType(dict(zip(self._outputs, columns, strict=True))), self._outputs)

    def _slope(self, t: float, x: Array, u: Array) -> Array:
        slope = np.asarray(self._derivative(t, x, u), dtype=float)
        if slope.shape != x.shape:
            raise InputError(
                f"the derivative has shape {slope.shape} for {x.size} state(s): return one number a state."
            )
        return slope

    def _seen(self, x: Array, u: Array) -> Array:
        found = np.array([look(x, u) for look in self._looks], dtype=float)
        if found.ndim != 1:
            raise InputError(f"an output is not one number: it has shape {found.shape[1:]}; return a float.")
        return found

    def _state(self, configuration: ArrayLike | None) -> Array:
        if configuration is None:
            return self._start
        state = finite_row("configuration", configuration)
        if state.size != self._start.size:
            raise InputError(f"configuration has {state.size} numbers: give a state, {self._start.size} numbers.")
        return state


def _look(name: str, look: Look, states: int) -> Callable[[Array, Array], float]:
    if callable(look):
        return look
    if isinstance(look, bool) or not isinstance(look, int) or not -1 < look < states:
        raise InputError(f"output {name!r} is {look!r}: give the number of a state, 0 to {states - 1}, or a function.")
    return lambda x, u: float(x[look]) if math.isfinite(x[look]) else math.nan
