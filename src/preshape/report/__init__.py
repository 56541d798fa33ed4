"""Figures and the HTML report."""

from preshape.report.calibration import FREQUENCY_ERROR, Calibration, Candidate, MeasuredFile, SimulatedMove
from preshape.report.calibration_figure import calibration_figure
from preshape.report.figures import as_svg
from preshape.report.page import calibration_page, klipper_sentence
from preshape.report.tables import TextTable, candidate_table, exclusion_sentence, mode_table

__all__ = [
    "FREQUENCY_ERROR",
    "Calibration",
    "Candidate",
    "MeasuredFile",
    "SimulatedMove",
    "TextTable",
    "as_svg",
    "calibration_figure",
    "calibration_page",
    "candidate_table",
    "exclusion_sentence",
    "klipper_sentence",
    "mode_table",
]
