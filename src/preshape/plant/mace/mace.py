"""Mace: the non-linear test bed as a plant, with modes in any configuration and simulation of commands."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import not_negative, positive, whole_number
from preshape.errors import InputError
from preshape.mode import Modes
from preshape.plant.diverged import Diverged
from preshape.plant.mace.control import Control
from preshape.plant.mace.linear import Linearised, oscillations
from preshape.plant.mace.multibody import MaceBody
from preshape.plant.mace.recording import OUTPUTS, Recording
from preshape.plant.mace.structure import CALIBRATED, GimbalLimits, MaceGains, MaceStructure
from preshape.plant.sampled_command import command_rows, steps_of
from preshape.plant.simulation import Simulation

__all__ = ["LARGEST_STEP", "Mace"]

LARGEST_STEP = 1e-3
"""The simulation's step unless given [s]: halving it changes the residual of a slew by less than 0.1 %."""

LIGHT = 0.15
"""What is damped more than this does not vibrate: the loops' own slow motions."""

HIGHEST = 30.0
"""`modes` lists those up to here [Hz]; Hyde's spectra end at 20 Hz."""

UNSTABLE = 1e-3
"""A pole that grows faster than this [1/s] makes a loop unstable; rounding of the rigid motions stays below."""


@dataclass(frozen=True)
class Mace:
    """The Middeck Active Control Experiment in the plane, in Hyde's configuration: the left payload clamped vertical.

    With gains the first input is the right payload's commanded angle (inertial: 0 vertical, positive inboard); without
    them both loops are open, and torques are all there is.

    Parameters
    ----------
    gains : MaceGains, optional
        Of both loops, as :data:`CALIBRATED_GAINS`.
    angle : float
        Of the right payload at first [rad].
    structure : MaceStructure
        Masses and stiffnesses.
    limits : GimbalLimits, optional
        Of the gimbal; none in Hyde's model.
    damping : float
        Ratio of the bus's bending modes, payloads vertical [-].
    elements : int
        A strut.

    Raises
    ------
    InputError
        If a value is out of its range.

    Examples
    --------
    >>> [round(mode.frequency, 2) for mode in Mace().modes()]
    [1.73, 5.26, 7.07, 19.52]

    References
    ----------
    Hyde, sections 4.3, 5.3 and appendix.
    """

    gains: MaceGains | None = None
    angle: float = 0.0
    structure: MaceStructure = field(default=CALIBRATED)
    limits: GimbalLimits | None = None
    damping: float = 0.01
    elements: int = 2

    def __post_init__(self) -> None:
        object.__setattr__(self, "angle", _angle(self.angle))
        object.__setattr__(self, "damping", not_negative("damping", self.damping, "as a ratio"))
        whole_number("elements", self.elements, 1, 16)

    @property
    def inputs(self) -> Mapping[str, str]:
        """Unit of each input, by name."""
        torques = {"gimbal torque": "N m", "attitude torque": "N m"}
        return torques if self.gains is None else {"payload angle": "rad", **torques}

    @property
    def outputs(self) -> Mapping[str, str]:
        """Unit of each output, by name."""
        return OUTPUTS

    def modes(self, configuration: float | None = None) -> Modes:
        """What vibrates: the linearised model's modes up to 30 Hz with less than 15 % damping.

        Parameters
        ----------
        configuration : float, optional
            The payload's angle [rad]; where it starts unless given.

        Raises
        ------
        InputError
            If the loop is unstable there.

        Examples
        --------
        >>> import math
        >>> from preshape.plant.mace import CALIBRATED_GAINS
        >>> closed = Mace(CALIBRATED_GAINS)
        >>> [round(closed.modes(math.radians(a))[0].frequency, 2) for a in (60, -60)]
        [1.76, 2.03]
        """
        angle = self.angle if configuration is None else _angle(configuration)
        poles = self._linear(angle).poles()
        growth = float(poles.real.max())
        if growth > UNSTABLE:
            raise InputError(f"{_grows(angle, growth)}: it has no modes. Give gains that make it stable.")
        frequencies, dampings = oscillations(poles)
        seen = (dampings < LIGHT) & (frequencies <= HIGHEST)
        # Without dampers rounding puts a pole on either side of the axis.
        return Modes(list(zip(frequencies[seen].tolist(), np.maximum(dampings[seen], 0.0).tolist(), strict=True)))

    def simulate(
        self,
        command: ArrayLike,
        dt: float,
        *,
        step: float | None = None,
        energy: bool = False,
        progress: Callable[[float], object] | None = None,
    ) -> Simulation:
        """What the article does under a held, sampled command, from rest.

        Parameters
        ----------
        command : array_like, shape (input, sample) or (sample,)
            [Units of the inputs.] One row alone is the first input's; the others are then 0.
        dt : float
            Sample interval [s].
        step : float, optional
            The simulation's [s], of which `dt` must be a whole number; the longest up to 1 ms unless given.
        energy : bool
            Whether to account for the energy.
        progress : function, optional
            Called with the part done, 0 to 1.

        Returns
        -------
        Simulation
            At the samples' times; at each, what is before that sample of the command acts.

        Raises
        ------
        InputError
            If the command is not finite numbers, or `dt` is not a whole number of steps.
        Diverged
            If the motion leaves what the model can say, as with unstable gains; what was computed is in `partial`.
        """
        rows = self._rows(command)
        ratio, fine = steps_of(positive("dt", dt, "s"), step, LARGEST_STEP)
        count = rows.shape[1]
        body = MaceBody(self.structure, self.angle, elements=self.elements, damping=self.damping, gains=self.gains)
        control = Control(self, rows, ratio, fine, progress)
        positions, velocities, failure = body.run(fine, (count - 1) * ratio, control)
        gimbal, attitude = control.applied(positions, velocities)
        recording = Recording(self.structure, self.elements, self.angle, fine, positions, velocities, gimbal, attitude)
        kept = slice(None, None, ratio)
        outputs = {name: values[kept] for name, values in recording.outputs().items()}
        energies = {name: values[kept] for name, values in recording.energy(self.damping).items()} if energy else None
        done = len(next(iter(outputs.values())))
        simulation = Simulation(dt * np.arange(done, dtype=float), rows[:, :done], outputs, OUTPUTS, energies)
        if failure:
            raise Diverged(self._reason(control.reason or failure, fine), (len(positions) - 1) * fine, simulation)
        return simulation

    def _rows(self, command: ArrayLike) -> NDArray[np.float64]:
        if np.ndim(command) != 1:
            return command_rows(command, self.inputs)
        first = next(iter(self.inputs))
        row = command_rows(command, {first: self.inputs[first]})
        return np.vstack([row, np.zeros((len(self.inputs) - 1, row.shape[1]))])

    def _linear(self, angle: float) -> Linearised:
        return Linearised(self.structure, angle, elements=self.elements, gains=self.gains, damping=self.damping)

    def _reason(self, what: str, step: float) -> str:
        angles = {self.angle, *np.radians([-60.0, -30.0, 0.0, 30.0, 60.0]).tolist()}
        growth = {angle: float(self._linear(angle).poles().real.max()) for angle in angles}
        worst = max(growth, key=lambda angle: growth[angle])
        if growth[worst] > UNSTABLE:
            return f"{what}. {_grows(worst, growth[worst])}: give gains that make it stable."
        return f"{what}. Give a smaller command, or a shorter step than {step:g} s."


def _grows(angle: float, growth: float) -> str:
    return (
        f"With these gains and the payload at {math.degrees(angle):.0f} deg the loop is unstable, "
        f"motion grows by e every {1.0 / growth:.3g} s"
    )


def _angle(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, int | float | np.floating) or not math.isfinite(value):
        raise InputError(f"the payload's angle is {value!r}: give a finite number of radians.")
    return float(value)
