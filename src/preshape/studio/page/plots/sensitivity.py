"""Sensitivity: what vibration each design leaves when the true frequency is another one."""

from __future__ import annotations

import numpy as np

from preshape.studio.page.plots.chart import (
    DESIGNS,
    Axis,
    Chart,
    Drawing,
    Picture,
    Points,
    frame,
    gapped,
    line,
    listed,
    percent,
)
from preshape.workflow.workbench import INSENSITIVITY_AT

__all__ = ["SENSITIVITY"]

HIGHEST_SHOWN = 200.0
"""[%]; shapers with large negative impulses go above it far from their modes."""


def _drawing(picture: Picture) -> Drawing:
    view = picture.view
    clauses, top = [], 100.0
    series: dict[str, Points | None] = {}
    for name in DESIGNS:
        drawn = picture.designs[name].drawn if name in picture.designs else None
        series[name] = None if drawn is None else (view.frequencies, 100.0 * drawn.vibration)
        if drawn is not None:
            top = max(top, 100.0 * float(drawn.vibration.max()))
            left = ", ".join(f"{percent(mode.residual)} %" for mode in drawn.modes)
            clauses.append(f"design {name} leaves {left} at the modes")
    highest = min(float(np.ceil(top / 25.0 - 1e-6) * 25.0), HIGHEST_SHOWN)
    ends = np.array([0.0, picture.top])
    series["limit"] = ends, np.full(2, 100.0 * INSENSITIVITY_AT)
    series["command.modes"] = gapped(
        [[(mode.frequency, 0.0), (mode.frequency, HIGHEST_SHOWN)] for mode in view.workbench.modes]
    )
    return Drawing(
        series,
        label=f"Sensitivity curves, vibration left in percent of the unshaped, over frequency: {listed(clauses)}",
        detail=f"dashed: modes, and {100 * INSENSITIVITY_AT:g} %",
        option={
            "xAxis": [{"max": picture.top}],
            "yAxis": [{"max": highest, "interval": 25.0 if highest <= 125.0 else 50.0}],
        },
    )


SENSITIVITY = Chart(
    "sensitivity",
    "Sensitivity",
    frame(
        Axis("frequency [Hz]", {"min": 0}),
        Axis("vibration left [%]", {"min": 0}),
        [
            line("command.modes", "modes", tooltip={"show": False}),
            line("limit", "5 %", tooltip={"show": False}),
            *(line(name, f"design {name}") for name in DESIGNS),
        ],
    ),
    _drawing,
)
