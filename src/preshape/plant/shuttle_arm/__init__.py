"""The Shuttle's Remote Manipulator arm in three dimensions, its joints with all that is not linear in them."""

from preshape.plant.shuttle_arm.arm import ShuttleArm
from preshape.plant.shuttle_arm.calibration import (
    CALIBRATED_JOINTS,
    CALIBRATION_POSE,
    HYDE_FREQUENCIES,
    STIFFNESSES,
    FitRow,
    calibrate,
    calibration_table,
)
from preshape.plant.shuttle_arm.geometry import ANGLE_LIMITS, JOINTS, RATE_LIMITS, SHUTTLE_LINKS, Links, Payload
from preshape.plant.shuttle_arm.inertia import end_points
from preshape.plant.shuttle_arm.joints import IMPERFECTIONS, JointHardware, Servo

__all__ = [
    "ANGLE_LIMITS",
    "CALIBRATED_JOINTS",
    "CALIBRATION_POSE",
    "HYDE_FREQUENCIES",
    "IMPERFECTIONS",
    "JOINTS",
    "RATE_LIMITS",
    "SHUTTLE_LINKS",
    "STIFFNESSES",
    "FitRow",
    "JointHardware",
    "Links",
    "Payload",
    "Servo",
    "ShuttleArm",
    "calibrate",
    "calibration_table",
    "end_points",
]
