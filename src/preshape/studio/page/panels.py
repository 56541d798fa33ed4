"""Which panels there are, and which of them must be written anew after a change."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

from preshape.errors import InputError
from preshape.studio.page.designs_panel import design_shape, designs_panel, legend
from preshape.studio.page.export_panel import ExportChoice, export_panel, export_preview, export_shape, packaged_for
from preshape.studio.page.fields import sentence
from preshape.studio.page.measurements import ADDRESS
from preshape.studio.page.modes_panel import drop_zone, modes_panel
from preshape.studio.page.numbers_panel import numbers_panel
from preshape.studio.page.plots.chart import percent
from preshape.studio.page.trial_panel import trial_panel, trial_shape
from preshape.workflow.workbench import Measured, View, Workbench

if TYPE_CHECKING:
    from preshape.studio.page.session import Session

__all__ = ["PANELS", "changed", "preview", "shapes", "summary", "troubles", "with_measured", "written"]

PANELS = ("drop", "modes", "designs", "trial", "legend", "numbers", "export", "preview")

FIELDLESS = ("numbers",)
"""Panels that hold no fields: they are written anew with every picture."""


def written(session: Session, name: str) -> str:
    """One panel as HTML."""
    bench = session.workbench
    if name == "drop":
        return drop_zone(session.measured, ADDRESS, session.shared.measurements.largest, session.drop_trouble)
    if name == "modes":
        return modes_panel(bench)
    if name == "designs":
        return designs_panel(bench, session.active)
    if name == "trial":
        return trial_panel(bench)
    if name == "legend":
        return legend(bench)
    if name == "numbers":
        return "" if session.view is None else numbers_panel(session.view)
    if name == "export":
        return export_panel(bench, session.export)
    return ""


def preview(workbench: Workbench, choice: ExportChoice) -> str:
    """What the export gives, or why it gives nothing."""
    try:
        return export_preview(packaged_for(workbench, choice), "")
    except InputError as error:
        return export_preview(None, str(error))


def shapes(session: Session) -> Mapping[str, object]:
    """What each panel's form depends on; a change of a value alone does not change it."""
    bench = session.workbench
    return {
        "drop": (session.measurement, session.drop_trouble),
        "modes": len(bench.modes),
        "designs": design_shape(bench, session.active),
        "trial": trial_shape(bench),
        "legend": [(design.name, design.family) for design in bench.designs],
        "export": export_shape(bench, session.export),
    }


def changed(session: Session, old: Mapping[str, object], new: Mapping[str, object], redrawn: bool) -> dict[str, str]:
    """The panels to write anew."""
    return {
        name: written(session, name)
        for name in PANELS
        if (redrawn and name in FIELDLESS) or (name in new and old.get(name) != new[name])
    }


def troubles(view: View | None) -> dict[str, str]:
    """What is wrong with each design, for the place in its tab."""
    if view is None:
        return {}
    return {
        f"design.{design.asked.name}": sentence(design.trouble or (design.drawn.misfit if design.drawn else ""))
        for design in view.designs
    }


def summary(view: View | None, active: str) -> str:
    """The design in front in one sentence, for who hears the page."""
    found = [] if view is None else [one for one in view.designs if one.asked.name == active]
    if not found:
        return ""
    drawn = found[0].drawn
    if drawn is None:
        return f"Design {active} has no shaper: {found[0].trouble}"
    left = percent(max(mode.residual for mode in drawn.modes))
    size = f"{len(drawn.shaper)} impulses in {drawn.shaper.duration:.4g} s"
    return f"Design {active}: {size}, at most {left} % left at the modes."


def with_measured(workbench: Workbench, measured: Measured | None, *, only_clear: bool = True) -> Workbench:
    """With the modes of a measurement, if there are any to be trusted; the shares of the old ones go with them."""
    if measured is None or not measured.modes or (only_clear and not measured.clear):
        return workbench
    found = sorted((one.mode for one in measured.modes), key=lambda mode: mode.frequency)
    return replace(workbench, modes=tuple(found), plant=replace(workbench.plant, gains=()))
