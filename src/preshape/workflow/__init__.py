"""The jobs people come for, composed of everything below: calibrate, analyze, compare, shape a file."""

from preshape.workflow.analyze import Analysis, ModeAnalysis, analyze
from preshape.workflow.calibrate import calibrate
from preshape.workflow.compare import compare
from preshape.workflow.design_report import asked_design_report, design_report
from preshape.workflow.design_within import design_within
from preshape.workflow.designed import designed
from preshape.workflow.executed import SpectrumLeft, executed_shaper, left_of_spectrum
from preshape.workflow.gcode import ShapedGcode, shape_gcode
from preshape.workflow.identify_plant import identify_plant
from preshape.workflow.read_command import read_command
from preshape.workflow.record import new_record
from preshape.workflow.rerun import Rerun, rerun
from preshape.workflow.save import SavedCalibration, save_calibration
from preshape.workflow.save_export import SavedExport, save_export
from preshape.workflow.save_move import save_force
from preshape.workflow.save_simulation import save_partial, save_simulation
from preshape.workflow.shape_file import ShapedFile, shape_file
from preshape.workflow.simulate_plant import simulate_plant
from preshape.workflow.stream_pipe import PipedStream, stream_pipe
from preshape.workflow.verification_recipe import recipe
from preshape.workflow.verify import verify

__all__ = [
    "Analysis",
    "ModeAnalysis",
    "PipedStream",
    "Rerun",
    "SavedCalibration",
    "SavedExport",
    "ShapedFile",
    "ShapedGcode",
    "SpectrumLeft",
    "analyze",
    "asked_design_report",
    "calibrate",
    "compare",
    "design_report",
    "design_within",
    "designed",
    "executed_shaper",
    "identify_plant",
    "left_of_spectrum",
    "new_record",
    "read_command",
    "recipe",
    "rerun",
    "save_calibration",
    "save_export",
    "save_force",
    "save_partial",
    "save_simulation",
    "shape_file",
    "shape_gcode",
    "simulate_plant",
    "stream_pipe",
    "verify",
]
