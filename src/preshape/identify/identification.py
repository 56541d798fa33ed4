"""What was found in a measurement: modes with their uncertainty, and what is wrong with it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.identify.measurement import Spectrum
from preshape.identify.stabilisation import Stabilisation
from preshape.mode import Mode

__all__ = [
    "FREQUENCY_RESPONSE",
    "IdentifiedMode",
    "KNOWN_INPUT",
    "Identification",
    "OPERATIONAL",
    "RING_DOWN",
    "SPECTRUM_FIT",
    "mode_of_logarithms",
]

RING_DOWN = "ring-down"
SPECTRUM_FIT = "spectrum fit"
FREQUENCY_RESPONSE = "frequency response"
KNOWN_INPUT = "known input"
OPERATIONAL = "operational"


@dataclass(frozen=True, slots=True)
class IdentifiedMode:
    """One mode and how well it is known.

    Attributes
    ----------
    mode : Mode
        Undamped natural frequency [Hz] and damping ratio.
    frequency_interval : tuple of float
        95 % confidence interval of the natural frequency [Hz].
    damping_interval : tuple of float
        95 % confidence interval of the damping ratio.
    share : float
        Part of the vibration energy that is this mode's, 0 to 1.
    """

    mode: Mode
    frequency_interval: tuple[float, float]
    damping_interval: tuple[float, float]
    share: float

    def __str__(self) -> str:
        low, high = self.damping_interval
        return (
            f"{self.mode.frequency:.4g} Hz ({self.frequency_interval[0]:.4g} to {self.frequency_interval[1]:.4g}), "
            f"damping {self.mode.damping:.4f} ({low:.4f} to {high:.4f}), {100.0 * self.share:.0f} % of the vibration"
        )


@dataclass(frozen=True, eq=False, slots=True)
class Identification:
    """The modes behind a measurement.

    Attributes
    ----------
    modes : tuple of IdentifiedMode
        The most important first; empty when nothing resonates.
    spectrum : Spectrum
        One channel `sum`: what was fitted, as a power spectral density summed over the channels.
    fitted : ndarray, shape (frequency,)
        The model's curve at `spectrum.frequencies`; NaN outside the band that was fitted.
    method : str
        'ring-down', 'spectrum fit', 'frequency response', 'known input' or 'operational'; of several measurements, all
        that were used.
    trouble : tuple of str
        Sentences on what is wrong with the measurement or the machine; empty when healthy.
    clear : bool
        False when the modes should not be trusted.
    stabilisation : Stabilisation or None
        Poles over model orders, of an operational identification.
    each : tuple of Identification
        What each of several measurements shows; empty for a single one.
    """

    modes: tuple[IdentifiedMode, ...]
    spectrum: Spectrum
    fitted: NDArray[np.float64]
    method: str
    trouble: tuple[str, ...]
    clear: bool
    stabilisation: Stabilisation | None = None
    each: tuple[Identification, ...] = ()


def mode_of_logarithms(mode: Mode, half: float, damping_half: float, share: float) -> IdentifiedMode:
    """A mode whose 95 % intervals are symmetric in the logarithms of frequency and damping, with these half-widths."""
    spread, ratio_spread = float(np.exp(half)), float(np.exp(min(damping_half, 20.0)))
    frequencies = mode.frequency / spread, mode.frequency * spread
    ratios = mode.damping / ratio_spread, min(mode.damping * ratio_spread, 1.0)
    return IdentifiedMode(mode, frequencies, ratios, share)
