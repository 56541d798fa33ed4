"""The jobs people come for, composed of everything below: calibrate, analyze, compare, shape a file."""

from preshape.workflow.analyze import Analysis, ModeAnalysis, analyze
from preshape.workflow.calibrate import calibrate
from preshape.workflow.compare import compare
from preshape.workflow.save import SavedCalibration, save_calibration
from preshape.workflow.save_move import save_force
from preshape.workflow.shape_file import ShapedFile, shape_file

__all__ = [
    "Analysis",
    "ModeAnalysis",
    "SavedCalibration",
    "ShapedFile",
    "analyze",
    "calibrate",
    "compare",
    "save_calibration",
    "save_force",
    "shape_file",
]
