"""What the designs are tried on: the plant and its move; and what the controller can hold."""

from __future__ import annotations

from preshape.studio.page import fields
from preshape.studio.page.edits import fields_of
from preshape.workflow.workbench import Workbench

__all__ = ["trial_panel", "trial_shape"]

PLANTS = (("driven", "Tip of a driven axis"), ("carried", "Load on a carrier"))
MOVES = (("trapezoid", "Trapezoidal speed"), ("step", "Step"))


def trial_shape(workbench: Workbench) -> tuple[object, ...]:
    """What the panel's form depends on."""
    return len(workbench.modes), workbench.move.kind


def trial_panel(workbench: Workbench) -> str:
    """Plant, move and controller."""
    texts = fields_of(workbench)

    def number(field: str, label: str, none: str = "", step: str = "number") -> str:
        return fields.number(field, texts[field], label, none=none, step=step)

    count = len(workbench.modes)
    shares = "".join(
        number(f"plant.gain.{index}", f"Share of mode {index + 1} [-]", f"{1 / count:.3g}") for index in range(count)
    )
    limits = ""
    if workbench.move.kind == "trapezoid":
        limits = number("move.speed", "Speed [m/s]") + number("move.acceleration", "Acceleration [m/s²]")
    return (
        '<details id="trial-plant" open><summary>Plant and move</summary>'
        + fields.choice("plant.kind", texts["plant.kind"], "What vibrates", PLANTS, tall=True)
        + fields.choice("move.kind", texts["move.kind"], "Move", MOVES, tall=True)
        + number("move.distance", "Distance [m]")
        + limits
        + "</details>"
        + f'<details id="trial-shares"><summary>Shares of the modes</summary>{shares}</details>'
        + '<details id="trial-controller"><summary>Limits of the controller</summary>'
        + number("controller.most_impulses", "Most impulses", "no limit", "whole")
        + number("controller.longest", "Longest shaper [s]", "no limit")
        + fields.flag("controller.negative", texts["controller.negative"], "Takes negative impulses")
        + "</details>"
    )
