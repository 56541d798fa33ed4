"""How much vibration a shaper leaves, as an amplitude, when the frequencies are not quite the measured ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.export import klipper
from preshape.identify import IdentifiedMode
from preshape.report import FREQUENCY_ERROR
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = [
    "DEFAULT_DAMPING",
    "Lines",
    "lines_of_modes",
    "lines_of_spectra",
    "lines_to_still",
    "remaining_amplitude",
    "remaining_amplitudes",
]

DEFAULT_DAMPING = 0.1
"""What is assumed [-] when no mode was found and none is given; Klipper assumes the same."""

FLOOR = 1.0 / 20.0
"""Power below this fraction of the highest peak is noise or motion of the whole machine, and does not count."""

SHIFTS = 1.0 + FREQUENCY_ERROR * np.array([-1.0, -0.5, 0.0, 0.5, 1.0])
"""By these factors all frequencies may be off; the worst counts."""


@dataclass(frozen=True)
class Lines:
    """What vibrates: frequencies [Hz] with damping ratios [-] and weights (their power), each of shape (line,)."""

    frequencies: NDArray[np.float64]
    dampings: NDArray[np.float64]
    weights: NDArray[np.float64]


def lines_to_still(
    spectra: Sequence[klipper.Spectrum], modes: Sequence[IdentifiedMode], clear: bool, damping: float | None = None
) -> list[Lines]:
    """What a shaper has to still: the modes where they can be trusted, or else everything that was measured."""
    if clear and modes:
        return lines_of_modes(modes)
    return lines_of_spectra(spectra, DEFAULT_DAMPING if damping is None else damping)


def lines_of_modes(modes: Sequence[IdentifiedMode]) -> list[Lines]:
    """What rings on after a move: the modes, each by its share; dampings at the middle and ends of their intervals."""
    frequencies = np.array([mode.mode.frequency for mode in modes])
    shares = np.array([mode.share for mode in modes])
    variants = zip(*((mode.mode.damping, *mode.damping_interval) for mode in modes), strict=True)
    return [Lines(frequencies, np.minimum(np.array(variant), 0.99), shares) for variant in variants]


def lines_of_spectra(spectra: Sequence[klipper.Spectrum], damping: float) -> list[Lines]:
    """Where no mode can be trusted: every frequency by its measured power, all at one damping ratio."""
    found = []
    for spectrum in spectra:
        weights = np.maximum(spectrum.psd - FLOOR * spectrum.psd.max(), 0.0)
        loud = weights > 0.0
        found.append(Lines(spectrum.frequencies[loud], np.full(int(loud.sum()), damping), weights[loud]))
    return found


def remaining_amplitude(shaper: Shaper, lines: Sequence[Lines]) -> float:
    """:func:`remaining_amplitudes` of the shaper as it is."""
    return float(remaining_amplitudes(shaper, lines, np.ones(1))[0])


def remaining_amplitudes(shaper: Shaper, lines: Sequence[Lines], speeds: NDArray[np.float64]) -> NDArray[np.float64]:
    """Root mean square of V over what vibrates, the worst over shifted frequencies and over the sets of lines.

    Klipper's own measure subtracts a twentieth of the highest peak after shaping too, and so calls a mode of which 5 %
    is left perfectly still; this one calls it 5 %.

    Parameters
    ----------
    shaper : Shaper
        Its times count for a speed of one.
    lines : sequence of Lines
        The worst of them counts.
    speeds : ndarray, shape (speed,)
        The shaper is sped up by each of these factors: a shaper for 1 Hz becomes one for that frequency.

    Returns
    -------
    ndarray, shape (speed,)
        [-], 0 to 1 for positive impulses.
    """
    worst = np.zeros(speeds.size)
    for one in lines:
        actual = np.multiply.outer(SHIFTS, one.frequencies)
        v = residual_vibration(shaper, actual[:, None, :] / speeds[None, :, None], one.dampings)
        worst = np.maximum(worst, np.sqrt((v**2 @ one.weights) / one.weights.sum()).max(axis=0))
    return worst
