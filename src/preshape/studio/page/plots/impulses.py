"""The shapers themselves: impulses over time, and boxes for what a shaper spreads."""

from __future__ import annotations

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
    scatter,
    time_unit,
)

__all__ = ["IMPULSES"]


def _drawing(picture: Picture) -> Drawing:
    shapers = {name: one.drawn.shaper for name, one in picture.designs.items() if one.drawn is not None}
    factor, unit = time_unit(max([shaper.duration for shaper in shapers.values()], default=0.0))
    series: dict[str, Points | None] = {}
    clauses = []
    for name in DESIGNS:
        shaper = shapers.get(name)
        series[name] = series[f"{name}.stems"] = series[f"{name}.area"] = None
        if shaper is None:
            continue
        if len(shaper.times):
            series[name] = factor * shaper.times, shaper.amplitudes
            stems = [[(factor * t, 0.0), (factor * t, a)] for t, a in zip(shaper.times, shaper.amplitudes, strict=True)]
            series[f"{name}.stems"] = gapped(stems)
        if shaper.boxes:
            shown = [
                [
                    (factor * box.start, 0.0),
                    (factor * box.start, box.mass),
                    (factor * box.end, box.mass),
                    (factor * box.end, 0.0),
                ]
                for box in shaper.boxes
            ]
            series[f"{name}.area"] = gapped(shown)
        boxes = f" and {len(shaper.boxes)} boxes" if shaper.boxes else ""
        clauses.append(f"design {name} has {len(shaper)} impulses{boxes} within {shaper.duration:.4g} seconds")
    spread = any(shaper.boxes for shaper in shapers.values())
    return Drawing(
        series,
        label=f"Impulses, amplitude over time: {listed(clauses)}",
        detail="boxes: height is their share" if spread else "",
        option={"xAxis": [{"name": f"time [{unit}]"}]},
    )


IMPULSES = Chart(
    "impulses",
    "Impulses",
    frame(
        Axis("time [s]", {"min": 0}),
        Axis("amplitude [-]"),
        [
            series
            for name in DESIGNS
            for series in (
                line(f"{name}.area", f"design {name}", areaStyle={}, tooltip={"show": False}),
                line(f"{name}.stems", f"design {name}", tooltip={"show": False}),
                scatter(name, f"design {name}"),
            )
        ],
        trigger="item",
    ),
    _drawing,
)
