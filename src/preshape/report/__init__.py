"""Figures and reports: what is shown, as HTML and as PDF."""

from preshape.report.calibration import FREQUENCY_ERROR, Calibration, Candidate, MeasuredFile, SimulatedMove
from preshape.report.calibration_document import calibration_document, klipper_sentence
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
from preshape.report.design_document import design_document
from preshape.report.document import Document, Heading, Paragraph, Part, Picture, Table, Verbatim, printable
from preshape.report.figures import as_svg, figure_bytes, figure_format
from preshape.report.html import as_html
from preshape.report.move_figure import move_figure
from preshape.report.pdf import as_pdf, can_make_pdf, report_bytes, report_format
from preshape.report.record import CalibrationJob, DesignJob, GivenJob, Job, Record, RecordedFile
from preshape.report.record_file import read_record, unpacked
from preshape.report.robustness import ModeRobustness, mode_robustness, robustness_table
from preshape.report.robustness_figure import robustness_figure
from preshape.report.sections import Export
from preshape.report.shaped_simulation import ROUNDING, OutputMotion, ShapedSimulation
from preshape.report.simulation_figure import simulation_figure
from preshape.report.stabilisation_figure import stabilisation_figure
from preshape.report.tables import (
    TextTable,
    candidate_table,
    exclusion_sentence,
    limit_sentence,
    mode_table,
    pick_table,
)
from preshape.report.trade_off import TradeOff, TradePoint, gain_sentences, robustness_sentence
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
    "Calibration",
    "CalibrationJob",
    "CampaignPanel",
    "CampaignSummary",
    "Candidate",
    "Cloud",
    "Comparison",
    "Contender",
    "Curves",
    "DOUBTFUL",
    "DesignJob",
    "Document",
    "Estimate",
    "Export",
    "FREQUENCY_ERROR",
    "Field",
    "GivenJob",
    "Heading",
    "Job",
    "Kind",
    "LESS",
    "LeftOut",
    "MORE",
    "MeasuredFile",
    "ModeRobustness",
    "ModeVerdict",
    "NOISE",
    "OutputMotion",
    "Paragraph",
    "Part",
    "Picture",
    "ROUNDING",
    "Record",
    "RecordedFile",
    "Ringing",
    "ShapedSimulation",
    "SimulatedMove",
    "Table",
    "TextTable",
    "TradeOff",
    "TradePoint",
    "Verbatim",
    "Verification",
    "as_html",
    "as_pdf",
    "as_svg",
    "calibration_document",
    "calibration_figure",
    "campaign_figure",
    "can_make_pdf",
    "candidate_table",
    "comparison_figure",
    "comparison_sentences",
    "comparison_table",
    "contour_figure",
    "design_document",
    "exclusion_sentence",
    "figure_bytes",
    "figure_format",
    "gain_sentences",
    "klipper_sentence",
    "length_unit",
    "limit_sentence",
    "mode_robustness",
    "mode_table",
    "move_figure",
    "move_sentence",
    "pick_table",
    "printable",
    "read_record",
    "report_bytes",
    "report_format",
    "residual_table",
    "robustness_figure",
    "robustness_sentence",
    "robustness_table",
    "simulation_figure",
    "stabilisation_figure",
    "table_sentence",
    "trade_off_figure",
    "unpacked",
    "verification_figure",
    "verification_table",
]
