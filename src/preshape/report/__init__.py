"""Figures and the HTML report."""

from preshape.report.calibration import FREQUENCY_ERROR, Calibration, Candidate, MeasuredFile, SimulatedMove
from preshape.report.calibration_figure import calibration_figure
from preshape.report.campaign import CampaignPanel, CampaignSummary, Cloud, Curves, Field
from preshape.report.campaign_figure import campaign_figure
from preshape.report.comparison import Comparison, Contender, Kind, LeftOut
from preshape.report.comparison_figure import comparison_figure
from preshape.report.comparison_table import (
    comparison_sentences,
    comparison_table,
    length_unit,
    move_sentence,
    table_sentence,
)
from preshape.report.contour_figure import contour_figure
from preshape.report.figures import as_svg, figure_bytes, figure_format
from preshape.report.move_figure import move_figure
from preshape.report.page import calibration_page, klipper_sentence
from preshape.report.shaped_simulation import OutputMotion, ShapedSimulation
from preshape.report.simulation_figure import simulation_figure
from preshape.report.stabilisation_figure import stabilisation_figure
from preshape.report.tables import TextTable, candidate_table, exclusion_sentence, mode_table, pick_table
from preshape.report.trade_off import TradeOff, TradePoint, gain_sentences
from preshape.report.trade_off_figure import trade_off_figure
from preshape.report.verification import (
    AS_PREDICTED,
    DOUBTFUL,
    LESS,
    MORE,
    NOISE,
    Estimate,
    ModeVerdict,
    Ringing,
    Verification,
)
from preshape.report.verification_figure import verification_figure
from preshape.report.verification_table import residual_table, verification_table

__all__ = [
    "AS_PREDICTED",
    "DOUBTFUL",
    "LESS",
    "MORE",
    "NOISE",
    "Curves",
    "Estimate",
    "Field",
    "ModeVerdict",
    "Ringing",
    "Verification",
    "FREQUENCY_ERROR",
    "Calibration",
    "CampaignPanel",
    "CampaignSummary",
    "Candidate",
    "Cloud",
    "Comparison",
    "Contender",
    "Kind",
    "LeftOut",
    "MeasuredFile",
    "OutputMotion",
    "ShapedSimulation",
    "SimulatedMove",
    "TextTable",
    "TradeOff",
    "TradePoint",
    "as_svg",
    "calibration_figure",
    "calibration_page",
    "campaign_figure",
    "candidate_table",
    "comparison_figure",
    "comparison_sentences",
    "comparison_table",
    "exclusion_sentence",
    "contour_figure",
    "figure_bytes",
    "figure_format",
    "gain_sentences",
    "klipper_sentence",
    "length_unit",
    "mode_table",
    "move_sentence",
    "simulation_figure",
    "stabilisation_figure",
    "table_sentence",
    "move_figure",
    "pick_table",
    "trade_off_figure",
    "residual_table",
    "verification_figure",
    "verification_table",
]
