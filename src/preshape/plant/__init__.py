"""What vibrates, one machine a file, simulated exactly."""

from preshape.kernel import Extremum
from preshape.plant.beam import Beam
from preshape.plant.beam_parts import BeamCoordinate, HingedPayload, Lump
from preshape.plant.changing_modes import ChangingModes
from preshape.plant.control_modes import modes_of
from preshape.plant.deflection import (
    DeflectionSensitivity,
    Plant,
    deflection_sensitivity,
    transient_deflection,
)
from preshape.plant.diverged import Diverged
from preshape.plant.exact import Motion, Output, exact_motion
from preshape.plant.flexible_body import FlexibleBody
from preshape.plant.flexible_structure import FlexibleStructure
from preshape.plant.floating_oscillator import FloatingOscillator
from preshape.plant.function import FunctionPlant
from preshape.plant.mace_linear import (
    linear_mace,
    linear_mace_beam,
    linear_mace_torque,
    peak_to_peak,
    torque_pulses,
)
from preshape.plant.matrices import from_matrices
from preshape.plant.modal import ModalPlant
from preshape.plant.plant_file import load_plant
from preshape.plant.positioned_mass import PositionedMass
from preshape.plant.protocol import SimulatedPlant, simulated
from preshape.plant.reduction import StructureModes
from preshape.plant.response import Response
from preshape.plant.shuttle_arm import ShuttleArm
from preshape.plant.simulation import Simulation
from preshape.plant.simulator import SampledPlant, SimulatorPlant
from preshape.plant.state_space import LinearPlant

__all__ = [
    "Beam",
    "BeamCoordinate",
    "ChangingModes",
    "DeflectionSensitivity",
    "Diverged",
    "Extremum",
    "FlexibleBody",
    "FlexibleStructure",
    "FloatingOscillator",
    "FunctionPlant",
    "HingedPayload",
    "LinearPlant",
    "Lump",
    "ModalPlant",
    "Motion",
    "Output",
    "Plant",
    "PositionedMass",
    "Response",
    "SampledPlant",
    "ShuttleArm",
    "SimulatedPlant",
    "Simulation",
    "SimulatorPlant",
    "StructureModes",
    "deflection_sensitivity",
    "exact_motion",
    "from_matrices",
    "linear_mace",
    "linear_mace_beam",
    "linear_mace_torque",
    "load_plant",
    "modes_of",
    "peak_to_peak",
    "simulated",
    "torque_pulses",
    "transient_deflection",
]
