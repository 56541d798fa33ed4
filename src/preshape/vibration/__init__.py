"""What a shaper leaves: residual vibration, sensitivity curves and maps, insensitivity."""

from preshape.vibration.high_frequency import HighFrequencyGain, high_frequency_gain
from preshape.vibration.insensitivity import Insensitivity, insensitivity, tolerated_bands, total_insensitivity
from preshape.vibration.residual import (
    Sensitivity,
    damping_sensitivity_curve,
    residual_vibration,
    sensitivity_curve,
    sensitivity_map,
)

__all__ = [
    "HighFrequencyGain",
    "Insensitivity",
    "Sensitivity",
    "damping_sensitivity_curve",
    "high_frequency_gain",
    "insensitivity",
    "residual_vibration",
    "sensitivity_curve",
    "sensitivity_map",
    "tolerated_bands",
    "total_insensitivity",
]
