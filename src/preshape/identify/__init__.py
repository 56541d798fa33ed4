"""From measurement files to modes: readers, sweeps, spectra, ring-downs, machines at work."""

from preshape.identify.decay_modes import ring_down
from preshape.identify.find import find_modes
from preshape.identify.identification import Identification, IdentifiedMode
from preshape.identify.klipper_sweep import Sweep
from preshape.identify.measurement import Measurement, PrintedSpectrum, Spectrum, TimeSeries
from preshape.identify.merge_modes import merged_modes
from preshape.identify.operational_modes import operational_modes
from preshape.identify.readers import read, read_bytes
from preshape.identify.source_file import MAXIMUM_FILE_SIZE
from preshape.identify.stabilisation import Stabilisation
from preshape.identify.welch import spectrum

__all__ = [
    "MAXIMUM_FILE_SIZE",
    "Identification",
    "IdentifiedMode",
    "Measurement",
    "PrintedSpectrum",
    "Spectrum",
    "Stabilisation",
    "Sweep",
    "TimeSeries",
    "find_modes",
    "merged_modes",
    "operational_modes",
    "read",
    "read_bytes",
    "ring_down",
    "spectrum",
]
