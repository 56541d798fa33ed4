"""What goes over the wire: numbers packed, and of the charts only what has changed since the last message."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

from preshape.studio.page.plots import CHARTS, TRADE_OFF, Drawing, Picture
from preshape.studio.page.plots.chart import Points

__all__ = ["Sent"]

Packed = tuple[str, str] | None


class Sent:
    """What a page has been told about its charts."""

    def __init__(self) -> None:
        self._series: dict[tuple[str, str], Packed] = {}
        self._said: dict[tuple[str, str], Any] = {}

    def changes(self, picture: Picture) -> dict[str, Any]:
        """What to tell now: by chart its new series, words and settings."""
        drawings = {chart.name: chart.drawing(picture) for chart in CHARTS}
        return {name: told for name, drawing in drawings.items() if (told := self._chart(name, drawing))}

    def trade_off(self, picture: Picture) -> dict[str, Any]:
        """The same for the chart that comes later."""
        return {TRADE_OFF.name: self._chart(TRADE_OFF.name, TRADE_OFF.drawing(picture))}

    def _chart(self, name: str, drawing: Drawing) -> dict[str, Any]:
        told: dict[str, Any] = {}
        series = {}
        for identity, points in drawing.series.items():
            packed = _packed(points)
            if self._series.get((name, identity)) != packed:
                self._series[name, identity] = series[identity] = packed
        if series:
            told["series"] = series
        said = {
            "label": drawing.label,
            "detail": drawing.detail,
            "note": drawing.note,
            "trouble": drawing.trouble,
            "option": dict(drawing.option),
            "names": {identity: list(names) for identity, names in drawing.names.items()},
        }
        for key, value in said.items():
            if self._said.get((name, key), "" if isinstance(value, str) else {}) != value:
                self._said[name, key] = told[key] = value
        return told


def _packed(points: Points | None) -> Packed:
    """x and y as 32-bit floats in base64: half the letters of decimal digits, and no parsing."""
    if points is None:
        return None
    x, y = (base64.b64encode(np.asarray(part, dtype="<f4").tobytes()).decode() for part in points)
    return x, y
