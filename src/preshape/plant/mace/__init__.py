"""MACE in the plane with all kinematic non-linearity: a flexible bus, two gimballed payloads, an attitude unit."""

from preshape.plant.mace.calibration import FitRow, calibrate, calibration_table
from preshape.plant.mace.mace import Mace
from preshape.plant.mace.structure import CALIBRATED, CALIBRATED_GAINS, GimbalLimits, MaceGains, MaceStructure

__all__ = [
    "CALIBRATED",
    "CALIBRATED_GAINS",
    "FitRow",
    "GimbalLimits",
    "Mace",
    "MaceGains",
    "MaceStructure",
    "calibrate",
    "calibration_table",
]
