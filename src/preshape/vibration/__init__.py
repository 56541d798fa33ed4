"""What a shaper or a command leaves: residual vibration, sensitivity curves and maps, insensitivity, settling."""

from preshape.vibration.command_insensitivity import CommandInsensitivity, command_insensitivity
from preshape.vibration.deflection_ratio import deflection_ratio, ramp_deflection
from preshape.vibration.high_frequency import HighFrequencyGain, high_frequency_gain
from preshape.vibration.insensitivity import Insensitivity, insensitivity, tolerated_bands, total_insensitivity
from preshape.vibration.residual import (
    Sensitivity,
    damping_sensitivity_curve,
    residual_vibration,
    sensitivity_curve,
    sensitivity_map,
)
from preshape.vibration.rest_to_rest import bang_bang_of_the_same_move, command_vibration
from preshape.vibration.settling import Settling, settling
from preshape.vibration.zeros import ShaperZero, zeros_near

__all__ = [
    "CommandInsensitivity",
    "HighFrequencyGain",
    "Insensitivity",
    "Sensitivity",
    "Settling",
    "ShaperZero",
    "bang_bang_of_the_same_move",
    "command_insensitivity",
    "command_vibration",
    "damping_sensitivity_curve",
    "deflection_ratio",
    "high_frequency_gain",
    "insensitivity",
    "ramp_deflection",
    "residual_vibration",
    "sensitivity_curve",
    "sensitivity_map",
    "settling",
    "tolerated_bands",
    "total_insensitivity",
    "zeros_near",
]
