"""From measurement files to modes: readers, spectra, ring-downs."""

from preshape.identify.decay_modes import ring_down
from preshape.identify.find import find_modes
from preshape.identify.identification import Identification, IdentifiedMode
from preshape.identify.measurement import Measurement, PrintedSpectrum, Spectrum, TimeSeries
from preshape.identify.readers import read
from preshape.identify.source_file import MAXIMUM_FILE_SIZE
from preshape.identify.welch import spectrum

__all__ = [
    "MAXIMUM_FILE_SIZE",
    "Identification",
    "IdentifiedMode",
    "Measurement",
    "PrintedSpectrum",
    "Spectrum",
    "TimeSeries",
    "find_modes",
    "read",
    "ring_down",
    "spectrum",
]
