"""What vibrates, one machine a file, simulated exactly."""

from preshape.kernel import Extremum
from preshape.plant.deflection import (
    DeflectionSensitivity,
    Plant,
    deflection_sensitivity,
    transient_deflection,
)
from preshape.plant.exact import Motion, Output, exact_motion
from preshape.plant.flexible_body import FlexibleBody
from preshape.plant.floating_oscillator import FloatingOscillator
from preshape.plant.modal import ModalPlant
from preshape.plant.positioned_mass import PositionedMass
from preshape.plant.response import Response

__all__ = [
    "DeflectionSensitivity",
    "Extremum",
    "FlexibleBody",
    "FloatingOscillator",
    "ModalPlant",
    "Motion",
    "Output",
    "Plant",
    "PositionedMass",
    "Response",
    "deflection_sensitivity",
    "exact_motion",
    "transient_deflection",
]
