"""SimulatorPlant: any simulator behind a function, and SampledPlant: any plant with exact motion."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.plant.deflection import Plant
from preshape.plant.diverged import Diverged
from preshape.plant.sampled_command import Hold, checked_hold, command_rows
from preshape.plant.simulation import Simulation
from preshape.profile import Profile

__all__ = ["SampledPlant", "Simulator", "SimulatorPlant"]

Simulator: TypeAlias = Callable[[NDArray[np.float64], float], Mapping[str, ArrayLike]]
"""A command of shape (input, sample) and its interval [s], to the outputs by name, shape (sample,)."""


class SimulatorPlant:
    """A plant of which nothing is known but a function that simulates it: another program, a co-simulation, a log.

    Parameters
    ----------
    simulate : function
        f(command, dt): the inputs, shape (input, sample), and their interval [s], to a mapping from each output's name
        to its samples, shape (sample,); from rest, every time anew.
    inputs, outputs : mapping of str to str
        Units by name.
    modes : Mode, (frequency, damping) or several, optional
        What vibrates, where it is known, as from :func:`preshape.workflow.identify_plant`.

    Examples
    --------
    >>> box = SimulatorPlant(lambda u, dt: {"way": u[0]}, inputs={"command": "m"}, outputs={"way": "m"})
    >>> box.simulate([0.0, 1.0], 0.01).outputs["way"].tolist()
    [0.0, 1.0]
    """

    def __init__(
        self,
        simulate: Simulator,
        *,
        inputs: Mapping[str, str],
        outputs: Mapping[str, str],
        modes: ModesLike | None = None,
    ) -> None:
        if not inputs or not outputs:
            raise InputError("the plant has no inputs or no outputs: name at least one of each, with its unit.")
        self._simulate = simulate
        self.inputs: Mapping[str, str] = MappingProxyType(dict(inputs))
        self.outputs: Mapping[str, str] = MappingProxyType(dict(outputs))
        self._modes = None if modes is None else Modes(modes)

    def __repr__(self) -> str:
        return f"<SimulatorPlant: {', '.join(self.inputs)} to {', '.join(self.outputs)}>"

    def with_modes(self, modes: ModesLike) -> SimulatorPlant:
        """The same plant, of which is known what vibrates."""
        return SimulatorPlant(self._simulate, inputs=self.inputs, outputs=self.outputs, modes=modes)

    def modes(self, configuration: object = None) -> Modes:
        """Those it was given; InputError if none were."""
        if self._modes is None:
            raise InputError(
                "this plant is a simulator whose modes are not known: find them with preshape.workflow.identify_plant "
                "and take plant.with_modes(modes)."
            )
        return self._modes

    def simulate(self, command: ArrayLike, dt: float) -> Simulation:
        """What the simulator makes of a command of shape (input, sample), every `dt` [s].

        Raises
        ------
        InputError
            If the command does not fit, or the simulator does not return every output at every sample.
        Diverged
            If an output is not finite; with the samples before.
        """
        rows = command_rows(command, self.inputs)
        dt = positive("dt", dt, "s")
        found = self._simulate(rows, dt)
        missing = [name for name in self.outputs if name not in found]
        if missing:
            raise InputError(f"the simulator returned no {', '.join(missing)}: return every output by its name.")
        outputs = {name: np.array(found[name], dtype=float) for name in self.outputs}
        times = dt * np.arange(rows.shape[1], dtype=float)
        for name, values in outputs.items():
            if values.shape != times.shape:
                raise InputError(
                    f"the simulator returned {name} of shape {values.shape} for {times.size} samples: one each."
                )
        finite = np.logical_and.reduce([np.isfinite(values) for values in outputs.values()])
        good = int(np.argmin(np.append(finite, False)))
        partial = {name: values[:good] for name, values in outputs.items()}
        result = Simulation(times[:good], rows[:, :good], MappingProxyType(partial), self.outputs)
        if good < times.size:
            raise Diverged("the simulator returned what is not finite: check the model.", good * dt, result)
        return result


class SampledPlant:
    """A plant with exact motion under a Profile, as one that is simulated under samples.

    Parameters
    ----------
    plant : FloatingOscillator, FlexibleBody, PositionedMass, ModalPlant or alike
        With ``motion(profile)``.
    input, unit : str
        What its command is called, and the unit of that.

    Examples
    --------
    >>> from preshape.plant import FloatingOscillator
    >>> plant = SampledPlant(FloatingOscillator(1.0, 1.0, 1.0), "force", "N")
    >>> sorted(plant.outputs), round(plant.modes()[0].frequency, 4)
    (['centre', 'deflection', 'first_position', 'second_position'], 0.2251)
    """

    def __init__(self, plant: Plant, input: str = "command", unit: str = "") -> None:
        self._plant = plant
        self._still = plant.motion(Profile.steps([0.0], [0.0]))
        self.inputs: Mapping[str, str] = MappingProxyType({input: unit})
        self.outputs: Mapping[str, str] = MappingProxyType(
            {name: output.unit for name, output in self._still.outputs.items()}
        )

    def __repr__(self) -> str:
        return f"SampledPlant({self._plant!r})"

    def modes(self, configuration: object = None) -> Modes:
        """What vibrates; the same in every configuration."""
        return Modes(self._still.modes)

    def simulate(self, command: ArrayLike, dt: float, *, hold: Hold = "zero") -> Simulation:
        """The outputs under samples that are held, or joined by straight lines; exact, at rest at 0 before."""
        rows = command_rows(command, self.inputs)
        dt = positive("dt", dt, "s")
        times = dt * np.arange(rows.shape[1], dtype=float)
        motion = self._plant.motion(_profile(rows[0], times, checked_hold(hold)))
        outputs = {name: motion(name, times) for name in self.outputs}
        return Simulation(times, rows, MappingProxyType(outputs), self.outputs)


def _profile(values: NDArray[np.float64], times: NDArray[np.float64], linear: bool) -> Profile:
    """The samples as a profile: stairs, or lines after a step to the first; at the end it stays."""
    if not linear or values.size == 1:
        jumps = np.diff(values, prepend=0.0)
        kept = jumps != 0.0
        kept[0] = True
        return Profile.steps(times[kept], jumps[kept])
    slopes = np.diff(np.diff(values) / times[1], prepend=0.0, append=0.0)
    return Profile(
        np.concatenate([times[:1], times]),
        np.concatenate([values[:1], slopes]),
        np.concatenate([[0], np.ones(times.size, dtype=int)]),
    )
