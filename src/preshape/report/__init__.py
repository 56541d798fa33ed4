"""Figures and the HTML report."""

from preshape.report.calibration import FREQUENCY_ERROR, Calibration, Candidate, MeasuredFile, SimulatedMove
from preshape.report.calibration_figure import calibration_figure
from preshape.report.figures import as_png, as_svg
from preshape.report.page import calibration_page, klipper_sentence

__all__ = [
    "FREQUENCY_ERROR",
    "Calibration",
    "Candidate",
    "MeasuredFile",
    "SimulatedMove",
    "as_png",
    "as_svg",
    "calibration_figure",
    "calibration_page",
    "klipper_sentence",
]
