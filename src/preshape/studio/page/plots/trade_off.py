"""What a shorter shaper costs: duration against the vibration left when every frequency is off by 5 %."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from preshape.studio.page.plots.chart import (
    DESIGNS,
    Axis,
    Chart,
    Drawing,
    Picture,
    Points,
    frame,
    line,
    listed,
    scatter,
)
from preshape.workflow.workbench import TradePoint

__all__ = ["TRADE_OFF"]

LABEL = {"show": True, "formatter": "{b}", "position": "right", "fontSize": 10}

LEAST_SHOWN = 0.01
"""[%]; what leaves less is drawn here."""


def _points(found: Sequence[TradePoint]) -> Points | None:
    if not found:
        return None
    return np.array([1e3 * point.duration for point in found]), np.array(
        [max(100.0 * point.left, LEAST_SHOWN) for point in found]
    )


def _drawing(picture: Picture) -> Drawing:
    empty: dict[str, Points | None] = {"optimum": None, "families": None, **dict.fromkeys(DESIGNS)}
    found = picture.trade_off
    if found is None:
        return Drawing(empty, "Trade-off: being computed.", note="Being computed; everything else goes on …")
    series = {**empty, "optimum": _points(found.optimum), "families": _points(found.families)}
    for point in found.designs:
        series[point.name] = _points([point])
    rows = [(f"design {point.name}", point) for point in found.designs]
    rows += [(point.name, point) for point in found.optimum]
    clauses = [
        f"{who} takes {1e3 * point.duration:.3g} milliseconds and leaves {100.0 * point.left:.2g} %"
        for who, point in rows
    ]
    return Drawing(
        series,
        label=f"Trade-off of duration and vibration left at 5 percent frequency error: {listed(clauses)}",
        detail="grey: families; line: shortest there is",
        trouble=" ".join(found.remarks[-1:]),
        names={
            "families": [point.name for point in found.families],
            "optimum": [point.name for point in found.optimum],
        },
    )


TRADE_OFF = Chart(
    "trade_off",
    "Trade-off",
    {
        **frame(
            Axis("duration [ms]", {"min": 0}),
            Axis("left at ±5 % [%]", {"type": "log", "min": LEAST_SHOWN, "max": 100}),
            [
                line("optimum", "shortest there is", symbol="circle", symbolSize=5),
                scatter(
                    "families", "family", symbolSize=6, symbol="circle", label=LABEL, labelLayout={"hideOverlap": True}
                ),
                *(scatter(name, f"design {name}", symbolSize=12) for name in DESIGNS),
            ],
            trigger="item",
        ),
        "grid": {"left": 50, "right": 90, "top": 10, "bottom": 36},
    },
    _drawing,
)
