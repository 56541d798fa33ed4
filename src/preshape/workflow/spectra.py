"""From a measurement to the spectrum that shapers are scored on."""

from __future__ import annotations

from preshape.export import klipper
from preshape.identify import Identification, Measurement, PrintedSpectrum, Spectrum

__all__ = ["scored_spectrum"]


def scored_spectrum(measurement: Measurement, identification: Identification) -> PrintedSpectrum:
    """Frequencies [Hz] and power, summed over the axes, one row a dataset.

    A spectrum file counts as it is printed, as Klipper takes it. A sweep's spectrum is divided by frequency as Klipper
    does (its acceleration grows with frequency); what rang down by itself or by a move is taken as it is.
    """
    if isinstance(measurement, Spectrum):
        spectrum = measurement.printed or PrintedSpectrum(measurement.frequencies, measurement.total[None, :])
        return spectrum if measurement.normalised else _normalised(spectrum)
    if measurement.format.startswith("Klipper"):
        recorded = klipper.power_spectral_density(measurement.times, measurement.values)
        return _normalised(PrintedSpectrum(recorded.frequencies, recorded.total[None, :]))
    return PrintedSpectrum(identification.spectrum.frequencies, identification.spectrum.total[None, :])


def _normalised(spectrum: PrintedSpectrum) -> PrintedSpectrum:
    return PrintedSpectrum(spectrum.frequencies, klipper.normalise_to_frequencies(spectrum.frequencies, spectrum.power))
