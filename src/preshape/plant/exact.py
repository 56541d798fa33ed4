"""The exact motion of modes and a rigid body under a Profile: no time step, no grid.

A command made of polynomials drives each mode to a polynomial plus a decaying phasor, both in closed form; so the
motion is a function that can be asked at any time, its largest deflection is found between all samples, and what is
left after the command is its state there.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive, whole_number
from preshape.errors import InputError
from preshape.kernel import (
    DrivenOutput,
    DrivenPhasors,
    Extremum,
    driven_phasors,
    extremum,
    free_phasors,
    last_outside,
    rested,
    taylor_shifted,
)
from preshape.mode import Mode, Modes, ModesLike
from preshape.plant.checks import one_each

if TYPE_CHECKING:
    from preshape.profile import Profile

__all__ = ["Motion", "Output", "exact_motion"]

HIGHEST_DERIVATIVE = 3
"""Of an output; jerk."""


@dataclass(frozen=True, eq=False, slots=True)
class Output:
    """What is looked at: a combination of modes, their rates, the rigid body and the command itself.

    Parameters
    ----------
    displacement, velocity : array_like, shape (mode,)
        Weights of the modal coordinates and of their rates; left out, none.
    rigid, rigid_velocity : float
        Weights of the rigid body's position and velocity.
    command : float
        Weight of the command.
    unit : str
        Unit of the output.
    """

    displacement: ArrayLike = ()
    velocity: ArrayLike = ()
    rigid: float = 0.0
    rigid_velocity: float = 0.0
    command: float = 0.0
    unit: str = ""


@dataclass(frozen=True, eq=False, slots=True)
class Motion:
    """The exact motion of a plant under a command, at any time.

    Attributes
    ----------
    modes : tuple of Mode
        What vibrates.
    outputs : mapping of str to Output
        What can be asked for by name; any other :class:`Output` can be given in place of a name.
    end_time : float
        When the command last changes [s]; free vibration about the resting place follows.

    Examples
    --------
    >>> from preshape.plant import FloatingOscillator
    >>> from preshape.profile import Profile
    >>> plant = FloatingOscillator(1.0, 1.0, 1.0)
    >>> motion = plant.motion(Profile.steps([0.0, 3.0, 6.0], [1.0, -2.0, 1.0]))
    >>> motion("second_position", [0.0, 3.0, 100.0]).shape
    (3,)
    >>> bool(motion.peak("deflection").value > plant.static_deflection(1.0))
    True
    """

    modes: tuple[Mode, ...]
    outputs: Mapping[str, Output]
    end_time: float
    _phasors: DrivenPhasors
    _forces: NDArray[np.float64]
    _command: NDArray[np.float64]
    _rigid: NDArray[np.float64]

    def __call__(self, output: str | Output, times: ArrayLike, derivative: int = 0) -> NDArray[np.float64]:
        """The output, or a derivative of it, at any times.

        Parameters
        ----------
        output : str or Output
            A name in `outputs`, or a combination.
        times : array_like
            When [s], of any shape. Where the output jumps, the value is the one after the jump.
        derivative : int
            Order of the derivative with respect to time, 0 to 3.

        Returns
        -------
        ndarray
            Of the shape of `times` [unit of the output / s^derivative].
        """
        order = whole_number("derivative", derivative, 0, HIGHEST_DERIVATIVE)
        driven = self._driven(output)
        t = np.asarray(times, dtype=float)
        if not np.isfinite(t).all():
            raise InputError("a time is NaN or infinite: give finite times in seconds.")
        flat = t.ravel()
        segment = self._phasors.segment(flat)
        moving = segment >= 0
        result = np.zeros(flat.size)
        if moving.any():
            since = flat[moving] - self._phasors.starts[segment[moving]]
            result[moving] = driven.values(segment[moving], since, order)[order]
        return result.reshape(t.shape)

    def peak(self, output: str | Output) -> Extremum:
        """The largest \\|output\\| over all time, what comes after the command included: exact, not the largest sample.

        Returns
        -------
        Extremum
            `value` [unit of the output], `time` [s], and `bound`, which nothing exceeds at any time. The bound is above
            the value only when a mode rings for ever and others beside it: such a motion never repeats, and its largest
            value is approached, not reached. Both are infinite when the output grows for ever.
        """
        return extremum(self._driven(output))

    def highest(self, output: str | Output) -> Extremum:
        """The largest value of the output over all time, at least the 0 that it starts from; as :meth:`peak`."""
        return extremum(self._driven(output), 1)

    def lowest(self, output: str | Output) -> Extremum:
        """The smallest value of the output over all time, at most the 0 that it starts from; `bound` is below it."""
        found = extremum(self._driven(output), -1)
        return Extremum(-found.value, found.time, -found.bound)

    def residual(self, output: str | Output) -> float:
        """Amplitude of the free vibration after the command [unit of the output], at `end_time`.

        With several modes the sum of their amplitudes, which the deviation of the output from its trend cannot exceed.
        """
        driven = self._driven(output)
        return float(np.abs(driven.weights) @ np.abs(free_phasors(self._phasors))) if self._phasors.starts.size else 0.0

    @property
    def residual_amplitudes(self) -> NDArray[np.float64]:
        """Amplitude of the free vibration of each modal coordinate after the command, at `end_time`, shape (mode,)."""
        if self._phasors.starts.size == 0:
            return np.zeros(len(self.modes))
        return np.asarray(np.abs(self._forces * free_phasors(self._phasors)) / self._phasors.poles.imag)

    def settling_time(self, output: str | Output, within: float) -> float:
        """The time [s] after which the output stays `within` [unit of the output] of its final value; exact.

        Infinite if undamped vibration of a larger amplitude is left, or the output does not come to rest.
        """
        return last_outside(self._driven(output), positive("within", within, self._output(output).unit or "units"))

    def _output(self, output: str | Output) -> Output:
        if isinstance(output, Output):
            return output
        if output not in self.outputs:
            raise InputError(f"output is {output!r}: this motion has {', '.join(self.outputs) or 'no outputs'}.")
        return self.outputs[output]

    def _driven(self, output: str | Output) -> DrivenOutput:
        """The output as weights of the phasors and a polynomial."""
        asked, poles = self._output(output), self._phasors.poles
        displacement = _weights("displacement", asked.displacement, poles.size)
        velocity = _weights("velocity", asked.velocity, poles.size)
        # x = Im q / w_d = Re(-i q / w_d), and x' = Re q + Re(s) x.
        turned = (displacement + poles.real * velocity) / poles.imag
        weights = np.asarray(self._forces * (velocity - 1j * turned), dtype=np.complex128)
        smooth = np.zeros((self._rigid.shape[0], max(self._rigid.shape[1], self._command.shape[1])))
        parts = [(asked.command, self._command), (asked.rigid, self._rigid), (asked.rigid_velocity, self._rigid[:, 1:])]
        for weight, taylor in parts:
            if weight:
                smooth[:, : taylor.shape[1]] += weight * taylor
        return DrivenOutput(self._phasors, weights, smooth)


def exact_motion(
    modes: ModesLike | None,
    command: Profile,
    *,
    outputs: Mapping[str, Output] = MappingProxyType({}),
    forces: ArrayLike | None = None,
    driven_by: int = 0,
    rigid: float = 0.0,
) -> Motion:
    """The motion of modes and a rigid body, at rest at 0 before the command.

    Each mode obeys  x'' + 2 z w x' + w^2 x = b u^(k),  the rigid body  X'' = r u,  u the command.

    Parameters
    ----------
    modes : Mode, (frequency, damping) pair, several, or None
        Undamped natural frequencies [Hz] and damping ratios [-]; None for a rigid body alone.
    command : Profile
        The command u.
    outputs : mapping of str to Output
        What the motion can be asked for by name.
    forces : array_like, shape (mode,), optional
        b, what the command adds to each mode's right-hand side; 1 unless given.
    driven_by : int
        k, which derivative of the command drives the modes: 2 for a carrier that moves as the command says. A command
        that jumps kicks the modes then; what a jump does to the output at its very instant is left out.
    rigid : float
        r, the rigid body's acceleration for each unit of command: 1 / mass for a force.

    Returns
    -------
    Motion

    Raises
    ------
    InputError
        If a mode is not one, or the forces do not fit the modes.

    Examples
    --------
    >>> from preshape.profile import Profile
    >>> step = Profile.steps([0.0], [1.0])
    >>> motion = exact_motion((1.0, 0.0), step, outputs={"deflection": Output((39.4784176,), unit="m")})
    >>> round(motion.peak("deflection").value, 6)
    2.0
    """
    each = () if modes is None else tuple(Modes(modes))
    given = np.ones(len(each)) if forces is None else one_each("forces", forces, len(each))
    order = whole_number("driven_by", driven_by, 0, 2)
    poles = np.array([mode.pole for mode in each], dtype=complex)
    starts, taylor = command.segments()
    driving = taylor[:, order:] if order < taylor.shape[1] else np.zeros((starts.size, 1))
    phasors = driven_phasors(poles, starts, driving, _kicks(poles, command, starts, order))
    return Motion(
        modes=each,
        outputs=MappingProxyType(dict(outputs)),
        end_time=float(starts[-1]) if starts.size else 0.0,
        _phasors=phasors,
        _forces=given,
        _command=taylor,
        _rigid=rested(rigid * _twice_integrated(starts, taylor)) if rigid else np.zeros((starts.size, 1)),
    )


def _weights(name: str, given: ArrayLike, count: int) -> NDArray[np.float64]:
    """One weight a mode; zeros when none is given."""
    return one_each(name, None if np.size(given) == 0 else given, count)


def _kicks(
    poles: NDArray[np.complex128], command: Profile, starts: NDArray[np.float64], order: int
) -> NDArray[np.complex128] | None:
    """What jumps of the command and its lower derivatives add to phasors driven by its derivative of `order`."""
    if order == 0:
        return None
    kicks = np.zeros((poles.size, starts.size), dtype=complex)
    for time, jump, kind in zip(command.times, command.jumps, command.orders, strict=True):
        if kind < order:
            at = int(np.searchsorted(starts, time, side="right")) - 1
            # An impulse adds its area; the doublet, an impulse's derivative, s times that.
            kicks[:, at] += jump * poles ** (order - 1 - int(kind))
    return kicks


def _twice_integrated(starts: NDArray[np.float64], taylor: NDArray[np.float64]) -> NDArray[np.float64]:
    """Derivatives of the command's double integral at the start of each segment, shape (segment, order + 2)."""
    result = np.concatenate([np.zeros((starts.size, 2)), taylor], axis=1)
    if starts.size > 1:
        gaps = np.diff(starts)
        moved = taylor_shifted(result[:-1], gaps)
        result[1:, 1] = np.cumsum(moved[1])
        result[1:, 0] = np.cumsum(moved[0] + result[:-1, 1] * gaps)
    return result
