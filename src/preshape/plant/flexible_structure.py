"""FlexibleStructure: modes and a rigid body under one force or torque, seen at any number of places."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.kernel import scanned_outputs, twice_summed
from preshape.mode import Modes, ModesLike
from preshape.plant.checks import one_each
from preshape.plant.exact import Motion, Output, exact_motion
from preshape.plant.modal_motion import retuned_modes
from preshape.plant.sampled_command import Hold, checked_hold, command_rows
from preshape.plant.simulation import Simulation

if TYPE_CHECKING:
    from preshape.profile import Profile

__all__ = ["FlexibleStructure"]


class FlexibleStructure:
    """What a structure reduces to: x'' + 2 z w x' + w^2 x = gain u for every mode, and X'' = u for the rigid body.

    :meth:`Beam.plant` makes one; so do modes and gains from anywhere else.

    Parameters
    ----------
    modes : Modes or what makes them
        Frequencies [Hz] and damping ratios [-].
    gains : array_like, shape (mode,)
        How the input drives each modal coordinate [1/sqrt(kg) for unit modal masses and a force].
    outputs : mapping of str to Output
        What is looked at: weights of the modes, of their rates, of the rigid body X (its gain times the output's) and
        of the input.
    input : str
        What the input is called.
    unit : str
        Of the input, "N" or "N m".

    Raises
    ------
    InputError
        If the gains or an output do not fit the modes.

    Examples
    --------
    >>> from preshape.profile import Profile
    >>> structure = FlexibleStructure([(1.0, 0.0)], [1.0], {"tip": Output((1.0,), rigid=0.5, unit="m")})
    >>> pulses = Profile.steps([0.0, 1.0, 2.0], [1.0, -2.0, 1.0])
    >>> round(float(structure.motion(pulses)("tip", 2.0)), 12)
    0.5
    """

    __slots__ = ("_gains", "_input", "_looks", "_modes", "_unit")

    def __init__(
        self,
        modes: ModesLike,
        gains: ArrayLike,
        outputs: Mapping[str, Output],
        *,
        input: str = "load",
        unit: str = "N",
    ) -> None:
        self._modes = Modes(modes)
        self._gains = one_each("gains", gains, len(self._modes))
        self._gains.setflags(write=False)
        if not outputs:
            raise InputError("the structure has no outputs: name at least one.")
        for name, look in outputs.items():
            for what, weights in (("displacement", look.displacement), ("velocity", look.velocity)):
                if np.size(weights):
                    one_each(f"{what} of output {name!r}", weights, len(self._modes))
        self._looks = MappingProxyType(dict(outputs))
        self._input, self._unit = input, unit

    def __repr__(self) -> str:
        return (
            f"<FlexibleStructure: {len(self._modes)} modes, {self._input} [{self._unit}] to {', '.join(self._looks)}>"
        )

    @property
    def inputs(self) -> Mapping[str, str]:
        """Unit of the input, by name."""
        return MappingProxyType({self._input: self._unit})

    @property
    def outputs(self) -> Mapping[str, str]:
        """Units of the outputs, by name."""
        return MappingProxyType({name: look.unit for name, look in self._looks.items()})

    @property
    def gains(self) -> NDArray[np.float64]:
        """How the input drives each modal coordinate, shape (mode,)."""
        return self._gains

    def modes(self, configuration: object = None) -> Modes:
        """What vibrates; the same in every configuration, as long as motion is small."""
        return self._modes

    def weights(self, output: str) -> NDArray[np.float64]:
        """Of the modal coordinates in an output, shape (mode,)."""
        given = self._look(output).displacement
        return one_each(output, None if np.size(given) == 0 else given, len(self._modes))

    def static_deflections(self, output: str, load: float = 1.0) -> NDArray[np.float64]:
        """What each mode adds to an output under a constant load: [unit of the output], shape (mode,)."""
        omega = np.array([mode.omega for mode in self._modes])
        return np.asarray(self.weights(output) * self._gains * load / omega**2)

    def retuned(self, frequency_ratio: float = 1.0, damping_ratio: float | None = None) -> FlexibleStructure:
        """The structure as it may really be: frequencies scaled, and damping ratios replaced if one is given [-]."""
        modes = retuned_modes(self._modes, frequency_ratio, damping_ratio)
        return FlexibleStructure(modes, self._gains, self._looks, input=self._input, unit=self._unit)

    def with_modes(self, modes: ModesLike) -> FlexibleStructure:
        """The structure with other frequencies and damping ratios, mode by mode; shapes and gains stay.

        Raises
        ------
        InputError
            If they are not as many.

        Examples
        --------
        >>> structure = FlexibleStructure([(1.0, 0.0), (3.0, 0.0)], [1.0, 1.0], {"tip": Output((1.0, 1.0), unit="m")})
        >>> structure.with_modes([(1.1, 0.0), (2.9, 0.01)]).modes()
        Modes([(1.1, 0.0), (2.9, 0.01)])
        """
        return FlexibleStructure(modes, self._gains, self._looks, input=self._input, unit=self._unit)

    def motion(self, command: Profile) -> Motion:
        """The exact motion under a Profile of the input, at rest at 0 before it: at any time, peaks between samples."""
        return exact_motion(self._modes, command, forces=self._gains, rigid=1.0, outputs=self._looks)

    def simulate(self, command: ArrayLike, dt: float, *, hold: Hold = "zero") -> Simulation:
        """The outputs under a sampled command, exact at the samples; at rest at 0 before.

        Parameters
        ----------
        command : array_like, shape (sample,) or (1, sample)
            The input at 0, dt, 2 dt, ...
        dt : float
            Sample interval [s].
        hold : {"zero", "linear"}
            The command between samples: held, as a controller's output is, or the straight line to the next sample.

        Returns
        -------
        Simulation

        Raises
        ------
        InputError
            If the command is not a row of finite numbers, `dt` not above zero, or `hold` unknown.

        Examples
        --------
        >>> structure = FlexibleStructure([(1.0, 0.0)], [39.4784176], {"tip": Output((1.0,), unit="m")})
        >>> structure.simulate([1.0, 1.0, 1.0], 0.25).outputs["tip"].round(6).tolist()
        [0.0, 1.0, 2.0]
        """
        given = command_rows(command, self.inputs)
        values, dt, linear = given[0], positive("dt", dt, "s"), checked_hold(hold)
        poles = np.array([mode.pole for mode in self._modes])
        looks = list(self._looks.values())
        rows, _ = scanned_outputs(
            poles, np.array([self._phasor_weights(look) for look in looks]), values, dt, linear=linear
        )
        if any(look.rigid or look.rigid_velocity for look in looks):
            velocity, position = twice_summed(values, dt, linear=linear)
            for row, look in zip(rows, looks, strict=True):
                row += look.rigid * position
                row += look.rigid_velocity * velocity
        for row, look in zip(rows, looks, strict=True):
            if look.command:
                row += look.command * values
        return Simulation(
            times=dt * np.arange(values.size, dtype=float),
            command=given,
            outputs=MappingProxyType(dict(zip(self._looks, rows, strict=True))),
            units=self.outputs,
        )

    def _phasor_weights(self, look: Output) -> NDArray[np.complex128]:
        """Of the phasors q = x' - conj(s) x of unit gain in an output: x = Im q / w_d, x' = Re q + Re(s) x."""
        count = len(self._modes)
        poles = np.array([mode.pole for mode in self._modes])
        displacement, velocity = (
            one_each(name, None if np.size(given) == 0 else given, count)
            for name, given in (("displacement", look.displacement), ("velocity", look.velocity))
        )
        return np.asarray(self._gains * (velocity - 1j * (displacement + poles.real * velocity) / poles.imag))

    def _look(self, output: str) -> Output:
        if output not in self._looks:
            raise InputError(f"output is {output!r}: this structure has {', '.join(self._looks)}.")
        return self._looks[output]
