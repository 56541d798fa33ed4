"""A modal plant: independent damped oscillators driven by one command, solved exactly.

Each mode x'' + 2 z w x' + w^2 x = f is carried by one complex number, its phasor q = x' - conj(s) x with the pole
s = -z w + i w_d, which obeys q' = s q + f: the eigenbasis of the 2x2 state matrix. So the matrix exponential over a
sample is exp(s dt), one complex coefficient; the recursion is as well conditioned as the mode itself, however fine the
samples (a second-order real difference equation loses digits as 1 / (w dt)^2); and |q| / w_d is the amplitude of the
vibration.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.mode import Modes, ModesLike
from preshape.plant.checks import finite_row, gain_matrix, one_each, same_length
from preshape.plant.response import Response, response_of

if TYPE_CHECKING:
    from preshape.plant.exact import Motion
    from preshape.profile import Profile

__all__ = ["ModalPlant"]


class ModalPlant:
    """Modes side by side, all driven by the same command.

    Parameters
    ----------
    modes : Mode, (frequency, damping) pair, or several
        Undamped natural frequencies [Hz] and damping ratios [-].
    gains : array_like, shape (mode,) or (output, mode), optional
        Participation: the weight of each modal coordinate in the output, or in each of several outputs. Equal shares
        that sum to 1 unless given, so that a position-driven plant settles on its command.
    drive : {"position", "acceleration"}
        What the command is. ``"position"``: x'' + 2 z w x' + w^2 x = w^2 u, so each modal coordinate settles on the
        command. ``"acceleration"``: d'' + 2 z w d' + w^2 d = -u, the deflection d relative to a carrier that moves with
        the acceleration u, the damper between the two; it settles on 0 when the carrier stops accelerating.

    Raises
    ------
    InputError
        If a mode is not one, the gains do not fit the modes or are not finite, or `drive` is unknown.

    Examples
    --------
    A zero-vibration shaper leaves nothing, a plain step of a mode without damping leaves an amplitude of its height:

    >>> plant = ModalPlant((50.0, 0.0))
    >>> plant.step_train([0.0], [1.0]).residual_amplitudes
    array([1.])
    >>> bool(plant.step_train([0.0, 0.01], [0.5, 0.5]).residual_amplitudes < 1e-12)
    True
    """

    __slots__ = ("drive", "gains", "modes")

    modes: Modes
    gains: NDArray[np.float64]
    drive: Literal["position", "acceleration"]

    def __init__(
        self,
        modes: ModesLike,
        gains: ArrayLike | None = None,
        *,
        drive: Literal["position", "acceleration"] = "position",
    ) -> None:
        self.modes = modes if isinstance(modes, Modes) else Modes(modes)
        if drive not in ("position", "acceleration"):
            raise InputError(f"drive is {drive!r}: give 'position' or 'acceleration'.")
        self.drive = drive
        self.gains = gain_matrix(gains, len(self.modes))

    def __repr__(self) -> str:
        return f"ModalPlant({self.modes!r}, {self.gains.tolist()!r}, drive={self.drive!r})"

    def response(
        self,
        command: ArrayLike,
        dt: float,
        *,
        hold: Literal["zero", "linear"] = "zero",
        displacement: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
    ) -> Response:
        """Response to a sampled command, exact at the samples (rounding grows by half an eps a sample at most).

        Parameters
        ----------
        command : array_like, shape (sample,)
            The command at 0, dt, 2 dt, ... [m, or m/s^2 for a plant driven by acceleration]; before 0 it is 0.
        dt : float
            Sample interval [s].
        hold : {"zero", "linear"}
            The command between samples: held, as a controller's output is, or the straight line to the next sample.
            After the last sample it stays at the last value either way.
        displacement, velocity : array_like, shape (mode,), optional
            Modal coordinates and velocities at time 0; at rest at 0 unless given.

        Returns
        -------
        Response
            At the samples; the residual amplitudes are those after the last sample.

        Raises
        ------
        InputError
            If the command is not a row of finite numbers, `dt` not above zero, or `hold` unknown.

        Examples
        --------
        >>> plant = ModalPlant((1.0, 0.0))
        >>> plant.response([1.0, 1.0, 1.0], dt=0.25).output.round(12)
        array([0., 1., 2.])
        """
        from scipy.linalg import expm
        from scipy.signal import lfilter

        values = finite_row("command", command)
        dt = positive("dt", dt, "s")
        if hold not in ("zero", "linear"):
            raise InputError(f"hold is {hold!r}: give 'zero' or 'linear'.")
        if values.size == 0:
            raise InputError("the command has no samples: give at least one.")
        count = len(self.modes)
        start = one_each("velocity", velocity, count) - self._poles.conj() * one_each(
            "displacement", displacement, count
        )

        phasor = np.empty((len(self.modes), values.size), dtype=complex)
        for row, pole, force, first in zip(phasor, self._poles, self._forces, start, strict=True):
            # exp of this matrix holds exp(s dt) and the integrals of the held (phi1) and of the ramping (phi2) input
            # without the cancellation that (exp(s dt) - 1 - s dt) / (s dt)^2 has on fine samples.
            chain = np.array([[pole * dt, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 0.0]])
            decay, phi1, phi2 = expm(chain)[0]
            if hold == "zero":
                now, before = 0.0j, dt * force * phi1
            else:
                now, before = dt * force * phi2, dt * force * (phi1 - phi2)
            row[:], _ = lfilter([now, before], [1.0, -decay], values, zi=[first - now * values[0]])
        return self._motion(dt * np.arange(values.size, dtype=float), phasor, values, (values.size - 1) * dt)

    def impulse_train(self, times: ArrayLike, amplitudes: ArrayLike, *, at: ArrayLike | None = None) -> Response:
        """Response to impulses, exact at any times: no grid.

        Parameters
        ----------
        times : array_like, shape (impulse,)
            When they come [s], in any order.
        amplitudes : array_like, shape (impulse,)
            Their areas [unit of the command x s].
        at : array_like, shape (sample,), optional
            When to look [s]; an impulse at that time has already come. The times of the impulses unless given.

        Returns
        -------
        Response
            The residual amplitudes are those right after the last impulse.

        Raises
        ------
        InputError
            If the rows are empty, not finite, or of different lengths.

        Examples
        --------
        >>> plant = ModalPlant((1.0, 0.0))
        >>> response = plant.impulse_train([0.0, 0.5], [1.0, 1.0], at=[0.0, 0.25])
        >>> response.output.round(6), bool(response.output_residual < 1e-12)
        (array([0.      , 6.283185]), True)
        """
        from preshape.plant.train import phasors

        instants, areas = same_length("times", times, "amplitudes", amplitudes)
        look = instants if at is None else finite_row("at", at)
        jumps = self._forces[:, np.newaxis] * areas
        free = phasors(self._poles, instants, jumps, look)
        return self._motion(look, free.at, np.zeros(look.size), free.end_time, ends=free.end)

    def step_train(self, times: ArrayLike, amplitudes: ArrayLike, *, at: ArrayLike | None = None) -> Response:
        """Response to a staircase command, exact at any times: no grid.

        A shaper driven by a unit step commands such a staircase: ``plant.step_train(shaper.times, shaper.amplitudes)``.

        Parameters
        ----------
        times : array_like, shape (step,)
            When the command steps [s], in any order.
        amplitudes : array_like, shape (step,)
            By how much it steps [unit of the command].
        at : array_like, shape (sample,), optional
            When to look [s]. The times of the steps unless given.

        Returns
        -------
        Response
            The residual amplitudes are those after the last step, about where the plant will settle.

        Raises
        ------
        InputError
            If the rows are empty, not finite, or of different lengths.

        Examples
        --------
        >>> plant = ModalPlant((1.0, 0.0))
        >>> plant.step_train([0.0, 0.5], [0.5, 0.5], at=[0.25, 0.5, 0.7, 9.0]).output.round(9)
        array([0.5, 1. , 1. , 1. ])
        """
        from preshape.plant.train import phasors

        instants, heights = same_length("times", times, "amplitudes", amplitudes)
        look = instants if at is None else finite_row("at", at)
        # A step moves the place to settle, so the deviation from it jumps the other way and then rings freely.
        free = phasors(self._poles, instants, -self._settled[:, np.newaxis] * heights, look)
        order = np.argsort(instants, kind="stable")
        stairs = np.concatenate([[0.0], np.cumsum(heights[order])])
        levels = stairs[np.searchsorted(instants[order], look, side="right")]
        phasor = free.at + self._settled[:, np.newaxis] * levels
        return self._motion(look, phasor, levels, free.end_time, ends=free.end)

    def impulse_residual(self, times: ArrayLike, amplitudes: ArrayLike) -> NDArray[np.float64]:
        """What a shaper leaves of each mode, by simulation: an independent witness for `preshape.vibration`.

        The state of each mode is carried from impulse to impulse by the real 2x2 matrix exponential; neither the closed
        form of the residual vibration nor the complex phasor of this file is used.

        Parameters
        ----------
        times, amplitudes : array_like, shape (impulse,)
            The shaper: times [s], and amplitudes [-].

        Returns
        -------
        ndarray, shape (mode,)
            Amplitude of the vibration right after the last impulse, relative to the amplitude right after one unit
            impulse (Robertson, eq. 1); the same for either drive.

        Raises
        ------
        InputError
            If the rows are empty, not finite, or of different lengths.

        Examples
        --------
        >>> ModalPlant([(1.0, 0.0), (2.0, 0.0)]).impulse_residual([0.0, 0.5], [0.5, 0.5]).round(12)
        array([0., 1.])
        """
        from preshape.plant.train import residual_by_state

        return residual_by_state(self.modes, *same_length("times", times, "amplitudes", amplitudes))

    def motion(self, command: Profile) -> Motion:
        """The exact motion under a Profile; its outputs: "output", or "output 1", ... when the gains name several."""
        from preshape.plant.modal_motion import modal_motion

        return modal_motion(self, command)

    def retuned(self, frequency_ratio: float = 1.0, damping_ratio: float | None = None) -> ModalPlant:
        """The plant with every frequency scaled by a ratio [-], and all damping ratios set to another if given [-]."""
        from preshape.plant.modal_motion import retuned_modes

        return ModalPlant(retuned_modes(self.modes, frequency_ratio, damping_ratio), self.gains, drive=self.drive)

    @property
    def _poles(self) -> NDArray[np.complex128]:
        return np.array([mode.pole for mode in self.modes])

    @property
    def _forces(self) -> NDArray[np.float64]:
        """What a unit command adds to the right-hand side of each mode."""
        if self.drive == "acceleration":
            return np.full(len(self.modes), -1.0)
        return np.array([mode.omega**2 for mode in self.modes])

    @property
    def _settled(self) -> NDArray[np.complex128]:
        """Phasor of each mode at rest where a unit command holds it."""
        return -self._forces / self._poles

    def _motion(
        self,
        times: NDArray[np.float64],
        phasor: NDArray[np.complex128],
        levels: NDArray[np.float64],
        end_time: float,
        *,
        ends: NDArray[np.complex128] | None = None,
    ) -> Response:
        """Turn phasors, shape (mode, sample), under the command `levels` into motion; `ends`: those of the residual."""
        last = phasor[:, -1] - self._settled * levels[-1] if ends is None else ends
        return response_of(times, phasor, levels, last, end_time, poles=self._poles, plant=(self._forces, self.gains))
