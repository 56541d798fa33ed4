"""The workbench of the studio, without a face: its state, what is drawn of it, measurements and exports."""

from preshape.workflow.workbench.curves import Response
from preshape.workflow.workbench.exports import ExportFile, ExportTarget, Package, export_targets, packaged
from preshape.workflow.workbench.link import from_plain, from_text, to_plain, to_text
from preshape.workflow.workbench.measurement import LARGEST_FILE, Measured, measured
from preshape.workflow.workbench.open_file import Opened, opened_file
from preshape.workflow.workbench.plain import plain_measured, plain_trade_off, plain_view
from preshape.workflow.workbench.solve import bands_asked, shaper_named
from preshape.workflow.workbench.state import (
    DESIGN_NAMES,
    MOST_MODES,
    AskedDesign,
    Controller,
    Move,
    Plant,
    Workbench,
)
from preshape.workflow.workbench.trade_off import TradePoint, WorkbenchTradeOff, left_at_error, trade_off_of
from preshape.workflow.workbench.view import INSENSITIVITY_AT, DesignView, Drawn, ModeView, View, view_of

__all__ = [
    "DESIGN_NAMES",
    "INSENSITIVITY_AT",
    "LARGEST_FILE",
    "MOST_MODES",
    "AskedDesign",
    "Controller",
    "DesignView",
    "Drawn",
    "ExportFile",
    "ExportTarget",
    "Measured",
    "ModeView",
    "Move",
    "Opened",
    "Package",
    "Plant",
    "Response",
    "TradePoint",
    "View",
    "Workbench",
    "WorkbenchTradeOff",
    "bands_asked",
    "export_targets",
    "from_plain",
    "from_text",
    "left_at_error",
    "measured",
    "opened_file",
    "packaged",
    "plain_measured",
    "plain_trade_off",
    "plain_view",
    "shaper_named",
    "to_plain",
    "to_text",
    "trade_off_of",
    "view_of",
]
