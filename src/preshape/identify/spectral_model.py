"""What a spectrum of a machine with known modes looks like through Klipper's analysis window."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from preshape.identify.welch import KAISER_BETA

if TYPE_CHECKING:
    from scipy.sparse import csr_array

__all__ = ["SpectralModel", "transmissibility"]

FINE_STEPS = 16
"""Points of the fine grid in one bin (1 / window length) of the estimate."""

KERNEL_REACH = 4
"""Bins on either side over which the window smears power; its side lobes beyond are 50 dB down."""

_Array = NDArray[np.float64]
_Complex = NDArray[np.complex128]


def transmissibility(frequencies: _Array, natural: _Array, damping: _Array) -> tuple[_Complex, _Complex, _Complex]:
    """Acceleration of a mode's mass for one of its base, and the derivatives to log natural frequency and damping.

    T = (1 + 2 z r i) / (1 - r^2 + 2 z r i), r = f / natural. All have the shape (mode, frequency).
    """
    ratio = frequencies / natural[:, None]
    twice = 2.0j * damping[:, None] * ratio
    below = 1.0 - ratio**2 + twice
    response = (1.0 + twice) / below
    # d/dr of T, times dr / dlog(natural) = -r; d/dz of T
    by_ratio = (twice / ratio - response * (twice / ratio - 2.0 * ratio)) / below
    by_damping = 2.0j * ratio * (1.0 - response) / below
    return response, -ratio * by_ratio, by_damping


@dataclass(frozen=True, eq=False)
class SpectralModel:
    """S(f) = floor + window * ( f^p |direct + sum_j g_j T_j(f)|^2 ), sampled at the frequencies of an estimate.

    The modes share one excitation, a sweep with density f^p, so their responses add coherently: between two of them
    there is an antiresonance or a shoulder, as in real machines. `direct` stands for modes above the band.

    Parameters
    ----------
    frequencies : ndarray, shape (frequency,)
        Where the estimate is known [Hz].
    window_duration : float
        Length of its analysis window [s].
    exponent : float
        The p of the excitation.
    """

    frequencies: _Array
    window_duration: float
    exponent: float

    @cached_property
    def _fine(self) -> _Array:
        """Fine frequencies [Hz] on which the smearing is summed, shape (fine,)."""
        step = 1.0 / (self.window_duration * FINE_STEPS)
        reach = KERNEL_REACH / self.window_duration
        low = max(self.frequencies[0] - reach, step)
        return np.arange(low, self.frequencies[-1] + reach + step, step)

    @cached_property
    def _kernel(self) -> csr_array:
        """Squared transform of the window, shape (frequency, fine), sparse; each row sums to 1 over the full reach."""
        from scipy.sparse import csr_array

        bins = (self._fine - self.frequencies[:, None]) * self.window_duration
        root = np.sqrt((np.pi * bins) ** 2 - KAISER_BETA**2 + 0.0j)
        transform = np.real(np.sinc(root / np.pi))  # sin(root) / root, of real or imaginary argument
        power = np.where(np.abs(bins) <= KERNEL_REACH, transform**2, 0.0)
        full = np.arange(-KERNEL_REACH * FINE_STEPS, KERNEL_REACH * FINE_STEPS + 1) / FINE_STEPS
        whole = np.real(np.sinc(np.sqrt((np.pi * full) ** 2 - KAISER_BETA**2 + 0.0j) / np.pi)) ** 2
        return csr_array(power / whole.sum())

    @cached_property
    def _excitation(self) -> _Array:
        return np.asarray((self._fine / self.frequencies[-1]) ** self.exponent)

    def density(
        self, natural: _Array, damping: _Array, gains: _Array, direct: float, floor: float
    ) -> tuple[_Array, _Array]:
        """Density at the frequencies, and its derivatives.

        Returns
        -------
        density : ndarray, shape (frequency,)
        jacobian : ndarray, shape (3 * mode + 2, frequency)
            To log natural frequency of each mode, to its damping, to its gain; to `direct`; to `floor`.
        """
        response, by_frequency, by_damping = transmissibility(self._fine, natural, damping)
        total = direct + gains @ response
        slopes = np.concatenate(
            [gains[:, None] * by_frequency, gains[:, None] * by_damping, response, np.ones((1, self._fine.size))]
        )
        fine = (
            np.concatenate([(np.abs(total) ** 2)[None, :], 2.0 * np.real(np.conj(total) * slopes)]) * self._excitation
        )
        smeared = np.asarray(self._kernel @ fine.T).T
        return smeared[0] + floor, np.concatenate([smeared[1:], np.ones((1, self.frequencies.size))])
