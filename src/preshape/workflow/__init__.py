"""The jobs people come for, composed of everything below: calibrate, analyze, shape a file."""

from preshape.workflow.analyze import Analysis, ModeAnalysis, analyze
from preshape.workflow.calibrate import calibrate
from preshape.workflow.save import SavedCalibration, save_calibration
from preshape.workflow.shape_file import ShapedFile, shape_file

__all__ = [
    "Analysis",
    "ModeAnalysis",
    "SavedCalibration",
    "ShapedFile",
    "analyze",
    "calibrate",
    "save_calibration",
    "shape_file",
]
