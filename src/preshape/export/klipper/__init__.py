"""Klipper: its shapers as it executes them, its spectrum, its score of any shaper, and its recommendation."""

from preshape.export.klipper.families import (
    DEFAULT_DAMPING,
    FAMILIES,
    KlipperFamily,
    ei,
    mzv,
    three_hump_ei,
    two_hump_ei,
    zv,
    zvd,
)
from preshape.export.klipper.optimum import Optimiser, ScoredShaper, scaled_to_smoothing
from preshape.export.klipper.polish import Asked, Room
from preshape.export.klipper.recommend import KlipperRecommendation, fit, recommend
from preshape.export.klipper.scoring import (
    TESTED_DAMPINGS,
    KlipperScore,
    combined,
    maximum_acceleration,
    remaining_vibration,
    score,
    smoothing,
)
from preshape.export.klipper.spectra import Spectrum, as_spectra
from preshape.export.klipper.spectrum import (
    AccelerationSpectrum,
    normalise_to_frequencies,
    power_spectral_density,
)
from preshape.export.klipper.tuning import KlipperFit

__all__ = [
    "TESTED_DAMPINGS",
    "DEFAULT_DAMPING",
    "FAMILIES",
    "AccelerationSpectrum",
    "Asked",
    "KlipperFamily",
    "KlipperFit",
    "KlipperRecommendation",
    "KlipperScore",
    "Optimiser",
    "Room",
    "ScoredShaper",
    "Spectrum",
    "as_spectra",
    "combined",
    "ei",
    "fit",
    "maximum_acceleration",
    "mzv",
    "normalise_to_frequencies",
    "power_spectral_density",
    "recommend",
    "remaining_vibration",
    "scaled_to_smoothing",
    "score",
    "smoothing",
    "three_hump_ei",
    "two_hump_ei",
    "zv",
    "zvd",
]
