"""From a measurement to the spectrum that shapers are scored on."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.export import klipper
from preshape.identify import Identification, Measurement, Spectrum

__all__ = ["scored_spectrum"]


def scored_spectrum(
    measurement: Measurement, identification: Identification
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Frequencies [Hz] and power, both shape (frequency,), summed over the axes.

    A sweep's spectrum is divided by frequency as Klipper does (its acceleration grows with frequency), so that
    Klipper's numbers come out; what rang down by itself or by a move is taken as it is.
    """
    if isinstance(measurement, Spectrum):
        if measurement.normalised:
            return measurement.frequencies, measurement.total
        return measurement.frequencies, klipper.normalise_to_frequencies(measurement.frequencies, measurement.total)
    if measurement.format.startswith("Klipper"):
        spectrum = klipper.power_spectral_density(measurement.times, measurement.values)
        return spectrum.frequencies, klipper.normalise_to_frequencies(spectrum.frequencies, spectrum.total)
    return identification.spectrum.frequencies, identification.spectrum.total
