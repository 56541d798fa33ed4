"""Response: what every plant returns, the motion of its modes and outputs, and the vibration left at the end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["Response", "response_of"]


@dataclass(frozen=True, eq=False, slots=True)
class Response:
    """The motion of a plant under a command.

    Attributes
    ----------
    times : ndarray, shape (sample,)
        Times [s].
    displacement, velocity, acceleration : ndarray, shape (mode, sample)
        Modal coordinates and their derivatives: of the unit of the command, per s, per s^2 (for a plant driven by
        acceleration: m, m/s, m/s^2 when the command is in m/s^2). Where the command jumps, the acceleration is the one
        after the jump.
    output : ndarray, shape (sample,) or (output, sample)
        The modal displacements weighted with the plant's gains.
    residual_amplitudes : ndarray, shape (mode,)
        Amplitude of the vibration of each modal coordinate about where it will settle, once the command has ended: the
        envelope sqrt(e^2 + ((e' + z w e) / w_d)^2) of the free oscillation e, taken at `residual_time`. It decays as
        exp(-z w t) from there. No peak is searched: this is the state, in closed form.
    output_residual : ndarray, shape () or (output,)
        Sum over the modes of \\|gain\\| times residual amplitude: the most that the output can deviate from where it
        settles after `residual_time`; for one mode, the amplitude itself.
    residual_time : float
        When the command ended [s]: the last sample, or the last impulse or step.
    """

    times: NDArray[np.float64]
    displacement: NDArray[np.float64]
    velocity: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    output: NDArray[np.float64]
    residual_amplitudes: NDArray[np.float64]
    output_residual: NDArray[np.float64]
    residual_time: float


def response_of(
    times: NDArray[np.float64],
    phasor: NDArray[np.complex128],
    levels: NDArray[np.float64],
    last: NDArray[np.complex128],
    end_time: float,
    *,
    poles: NDArray[np.complex128],
    plant: tuple[NDArray[np.float64], NDArray[np.float64]],
) -> Response:
    """The response that phasors describe.

    Parameters
    ----------
    times, levels : ndarray, shape (sample,)
        Times [s], and the command there.
    phasor : ndarray of complex, shape (mode, sample)
        q = x' - conj(s) x.
    last : ndarray of complex, shape (mode,)
        The free vibration after the command's end, at `end_time` [s].
    end_time : float
        When the command ended [s].
    poles : ndarray of complex, shape (mode,)
        s [1/s].
    plant : pair of ndarray
        What a unit command adds to each mode's right-hand side, shape (mode,), and the gains of the outputs.
    """
    forces, gains = plant
    s = poles[:, np.newaxis]
    displacement = phasor.imag / s.imag
    velocity = phasor.real + s.real * displacement
    residual = np.abs(last) / poles.imag
    return Response(
        times=times,
        displacement=displacement,
        velocity=velocity,
        acceleration=(s * phasor).real + s.real * velocity + forces[:, np.newaxis] * levels,
        output=gains @ displacement,
        residual_amplitudes=residual,
        output_residual=np.asarray(np.abs(gains) @ residual),
        residual_time=end_time,
    )
