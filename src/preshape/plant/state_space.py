"""LinearPlant: any linear machine as x' = A x + B u, y = C x + D u, or its sampled form."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.plant.diverged import Diverged
from preshape.plant.matrix_checks import system_matrices
from preshape.plant.oscillation import (
    Oscillation,
    check_stable,
    distinct_modes,
    mode_of,
    moved_poles,
    oscillation,
    sampled_oscillation,
    upper_poles,
)
from preshape.plant.protocol import Progress
from preshape.plant.sampled_command import Hold, checked_hold, command_rows, named
from preshape.plant.simulation import Simulation
from preshape.plant.state_scan import Steps, held_steps, scanned

__all__ = ["LinearPlant"]

ROUNDING = 1e-15
"""Accuracy of the entries of A for each state, relative to its size, unless told otherwise."""

SAME_STEP = 1e-9
"""Two sample intervals that agree to this part are the same."""


class LinearPlant:
    """A linear plant with any number of inputs and outputs.

    Parameters
    ----------
    A : array_like, shape (state, state)
        [1/s], or the transition matrix of a sampled system.
    B : array_like, shape (state, input)
        What the inputs add to x'; one row of states will do for one input.
    C : array_like, shape (output, state)
        One row of states will do for one output.
    D : array_like, shape (output, input), optional
        What passes straight through; nothing unless given.
    inputs, outputs : mapping of str to str, optional
        Units by name, in the order of the columns of B and the rows of C.
    sample_time : float, optional
        For a sampled system x_{k+1} = A x_k + B u_k: its step [s].
    accuracy : float, optional
        Of the entries of A, relative to its size: poles nearer to 0 are rigid bodies. Rounding unless given.

    Raises
    ------
    InputError
        If the matrices do not fit each other, hold NaN or infinity, or the names do not fit them.

    Examples
    --------
    >>> omega = 2.0 * np.pi
    >>> plant = LinearPlant([[0.0, 1.0], [-(omega**2), -0.02 * omega]], [0.0, omega**2], [1.0, 0.0])
    >>> str(plant.modes()[0])
    '1 Hz, damping 0.01'
    """

    def __init__(
        self,
        A: ArrayLike,
        B: ArrayLike,
        C: ArrayLike,
        D: ArrayLike | None = None,
        *,
        inputs: Mapping[str, str] | None = None,
        outputs: Mapping[str, str] | None = None,
        sample_time: float | None = None,
        accuracy: float | None = None,
    ) -> None:
        from scipy.linalg import matrix_balance

        a, b, c, d = system_matrices(A, B, C, D)
        self.A, self.B, self.C, self.D = a, b, c, d
        self._inputs = MappingProxyType(named("input", inputs, b.shape[1]))
        self._outputs = MappingProxyType(named("output", outputs, c.shape[0]))
        self.sample_time = None if sample_time is None else positive("sample_time", sample_time, "s")
        self._accuracy = ROUNDING * a.shape[0] if accuracy is None else positive("accuracy", accuracy, "(a ratio)")
        # Balanced coordinates: the same system, with states of one size.
        balanced, (scale, _) = matrix_balance(a, permute=False, separate=True)
        self._balanced = np.asarray(balanced, dtype=float), b / scale[:, np.newaxis], c * scale
        self._found: Oscillation | None = None

    @classmethod
    def from_control(
        cls, system: Any, *, inputs: Mapping[str, str] | None = None, outputs: Mapping[str, str] | None = None
    ) -> LinearPlant:
        """The plant of a python-control ``StateSpace``, or of anything with A, B, C, D and dt.

        Parameters
        ----------
        system : object
            With ``dt`` 0 or None for a continuous system, its step [s] for a sampled one.
        inputs, outputs : mapping of str to str, optional
            Units by name; the system's own labels, without units, unless given.

        Raises
        ------
        InputError
            If it has no state-space matrices, or is sampled and does not say how fast.
        """
        parts: list[Any] = [getattr(system, name, None) for name in "ABCD"]
        if any(part is None for part in parts):
            raise InputError(
                f"{type(system).__name__} has no matrices A, B, C, D: give a state-space system, for a transfer "
                "function control.ss(system)."
            )
        step = getattr(system, "dt", None)
        if step is True:
            raise InputError("the system is sampled with an unspecified step (dt is True): give it its dt [s] first.")
        labels = (getattr(system, "input_labels", None), getattr(system, "output_labels", None))
        names = [
            dict.fromkeys(found, "") if wanted is None and found else wanted
            for wanted, found in zip((inputs, outputs), labels, strict=True)
        ]
        return cls(*parts, inputs=names[0], outputs=names[1], sample_time=step or None)

    def __repr__(self) -> str:
        sampled = "" if self.sample_time is None else f", every {self.sample_time:g} s"
        return (
            f"<LinearPlant: {self.A.shape[0]} states, {', '.join(self._inputs)} to {', '.join(self._outputs)}{sampled}>"
        )

    @property
    def inputs(self) -> Mapping[str, str]:
        """Unit of each input, by name."""
        return self._inputs

    @property
    def outputs(self) -> Mapping[str, str]:
        """Unit of each output, by name."""
        return self._outputs

    @property
    def poles(self) -> NDArray[np.complex128]:
        """Poles that are not 0 [1/s], shape (pole,); of a sampled system, those below its Nyquist frequency."""
        return self._oscillation.poles

    def modes(self, configuration: object = None) -> Modes:
        """What vibrates, the slowest first; the same in every configuration. Equal modes are one.

        Raises
        ------
        InputError
            If the plant is unstable, or nothing vibrates.
        """
        poles = self.poles
        check_stable(poles, self._accuracy * float(np.abs(poles).max(initial=0.0)))
        return distinct_modes(mode_of(complex(pole)) for pole in poles[upper_poles(poles)])

    def with_modes(self, modes: ModesLike) -> LinearPlant:
        """The plant with other modes, in the order of :meth:`modes`; InputError for a sampled one, or another count."""
        wanted, old, (a, b, c) = Modes(modes), self.modes(), self._balanced
        if len(wanted) != len(old) or self.sample_time is not None:
            raise InputError(f"{len(wanted)} mode(s) are given: give {len(old)}, as many as it has, and it continuous.")
        moved = moved_poles(a, self._oscillation, old, wanted)
        return LinearPlant(moved, b, c, self.D, inputs=self._inputs, outputs=self._outputs)

    def participation(self, output: str | None = None, input: str | None = None) -> NDArray[np.float64]:
        """How strongly each mode shows in an output after an impulse at an input.

        Parameters
        ----------
        output, input : str, optional
            Their names; the first ones unless given.

        Returns
        -------
        ndarray, shape (mode,)
            Amplitude of each of :meth:`modes` after a unit impulse [unit of the output / (unit of the input s)]; 0 for
            one that this input does not excite or this output does not show.

        Examples
        --------
        >>> plant = LinearPlant([[0.0, 1.0], [-4.0, 0.0]], [0.0, 1.0], [[1.0, 0.0], [0.0, 1.0]])
        >>> plant.participation("output 1").round(12).tolist(), plant.participation("output 2").round(12).tolist()
        ([0.5], [1.0])
        """
        found, poles = self._oscillation, self.poles
        upper = upper_poles(poles)
        _, b, c = self._balanced
        row, column = _place("output", output, self._outputs), _place("input", input, self._inputs)
        residues = (c[row] @ found.right[:, upper]) * (found.left[:, upper].conj().T @ b[:, column])
        if self.sample_time is not None:  # of an impulse spread over one step
            residues = residues * np.exp(-poles[upper] * self.sample_time) / self.sample_time
        modes = self.modes()
        near = [
            int(np.argmin([abs(mode.pole - pole) for mode in modes])) for pole in poles[upper]
        ]  # equal modes add up
        sums = np.zeros(len(modes), dtype=complex)
        np.add.at(sums, near, residues)
        return 2.0 * np.abs(sums)

    @property
    def static_gain(self) -> NDArray[np.float64]:
        """Where the outputs settle under a constant unit input, shape (output, input); infinite for a rigid body."""
        a, b, c = self._balanced
        if self._oscillation.zeros:
            return np.full(self.D.shape, np.inf)
        held = -a if self.sample_time is None else np.eye(a.shape[0]) - a
        return np.asarray(c @ np.linalg.solve(held, b) + self.D)

    def simulate(
        self, command: ArrayLike, dt: float, *, hold: Hold = "zero", progress: Progress | None = None
    ) -> Simulation:
        """The outputs under a sampled command, exact at the samples; at rest at 0 before.

        Parameters
        ----------
        command : array_like, shape (input, sample) or (sample,)
            The inputs at 0, dt, 2 dt, ...
        dt : float
            Sample interval [s]; of a sampled plant, its own.
        hold : {"zero", "linear"}
            The command between samples: held, as a controller's output is, or the straight line to the next sample.
        progress : function, optional
            Called with the part done, 0 to 1.

        Returns
        -------
        Simulation

        Raises
        ------
        InputError
            If the command does not fit the inputs, or `dt` or `hold` the plant.
        Diverged
            If an unstable plant has grown beyond all numbers.

        Examples
        --------
        >>> plant = LinearPlant([[0.0, 1.0], [-39.4784176, 0.0]], [0.0, 39.4784176], [1.0, 0.0])
        >>> plant.simulate([1.0, 1.0, 1.0], 0.25).outputs["output"].round(6).tolist()
        [0.0, 1.0, 2.0]
        """
        rows = command_rows(command, self._inputs)
        dt = positive("dt", dt, "s")
        steps = self._steps(dt, checked_hold(hold))
        values, good = scanned(steps, self._balanced[2], self.D, rows, progress)
        found = Simulation(
            times=dt * np.arange(good, dtype=float),
            command=rows[:, :good],
            outputs=MappingProxyType(dict(zip(self._outputs, values[:, :good], strict=True))),
            units=self._outputs,
        )
        if good < rows.shape[1]:
            raise Diverged("the plant is unstable: check signs and gains.", good * dt, found)
        return found

    def _steps(self, dt: float, linear: bool) -> Steps:
        a, b, _ = self._balanced
        if self.sample_time is None:
            return held_steps(a, b, dt, linear=linear)
        if linear:
            raise InputError("the plant is a sampled system, whose input is held: leave hold at 'zero'.")
        if abs(dt - self.sample_time) > SAME_STEP * self.sample_time:
            raise InputError(
                f"the simulation's step is {dt:g} s and the plant is sampled every {self.sample_time:g} s: give the "
                "plant's own step as dt, or a continuous model."
            )
        return Steps(a, b, np.zeros_like(b))

    @property
    def _oscillation(self) -> Oscillation:
        if self._found is None:
            a = self._balanced[0]
            if self.sample_time is None:
                self._found = oscillation(a, self._accuracy)
            else:
                self._found = sampled_oscillation(a, self._accuracy, self.sample_time)
        return self._found


def _place(kind: str, name: str | None, names: Mapping[str, str]) -> int:
    if name is not None and name not in names:
        raise InputError(f"{kind} is {name!r}: this plant has {', '.join(names)}.")
    return 0 if name is None else list(names).index(name)
