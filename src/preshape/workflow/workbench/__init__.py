"""The workbench of the studio, without a face: its state, what is drawn of it, measurements and exports."""

from preshape.workflow.workbench.curves import Response
from preshape.workflow.workbench.link import from_plain, from_text, to_plain, to_text
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
from preshape.workflow.workbench.view import INSENSITIVITY_AT, DesignView, Drawn, ModeView, View, view_of

__all__ = [
    "DESIGN_NAMES",
    "INSENSITIVITY_AT",
    "MOST_MODES",
    "AskedDesign",
    "Controller",
    "DesignView",
    "Drawn",
    "ModeView",
    "Move",
    "Plant",
    "Response",
    "View",
    "Workbench",
    "bands_asked",
    "from_plain",
    "from_text",
    "shaper_named",
    "to_plain",
    "to_text",
    "view_of",
]
