"""What a chart is: a fixed frame with named series, filled from a picture."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.workflow.workbench import DESIGN_NAMES, DesignView, Measured, View, WorkbenchTradeOff

__all__ = [
    "DESIGNS",
    "DUST",
    "Axis",
    "Chart",
    "Drawing",
    "Picture",
    "Points",
    "frame",
    "gapped",
    "length_unit",
    "line",
    "listed",
    "percent",
    "scatter",
    "time_unit",
]

DESIGNS = DESIGN_NAMES

Points = tuple[NDArray[np.float64], NDArray[np.float64]]
"""x and y, shape (point,) each; NaN in y is a gap."""

TOOLTIP_NUMBER = "v => typeof v === 'number' ? String(Number(v.toPrecision(4))) : v"

DUST = 1e-9
"""Parts below this are the rounding of the arithmetic."""

SHORT_TIME = 0.5
"""Times up to this [s] are shown in milliseconds."""


@dataclass(frozen=True)
class Picture:
    """All that charts draw from.

    Parameters
    ----------
    view : View
        Modes, designs, responses.
    top : float
        End of the frequency axes [Hz]; it stays while a mode is dragged.
    measured : Measured or None
        What was dropped.
    trade_off : WorkbenchTradeOff or None
        None until it is computed.
    """

    view: View
    top: float
    measured: Measured | None = None
    trade_off: WorkbenchTradeOff | None = None

    @property
    def designs(self) -> Mapping[str, DesignView]:
        """By name."""
        return {design.asked.name: design for design in self.view.designs}


@dataclass(frozen=True)
class Drawing:
    """What a chart shows of a picture.

    Parameters
    ----------
    series : mapping of str to Points or None
        By the series' names; None empties one.
    label : str
        The chart in words, for who cannot see it.
    detail : str
        Beside the title.
    note, trouble : str
        In the chart's place, and below it.
    option : mapping
        Settings of ECharts that go with these numbers, such as an axis' name.
    names : mapping of str to sequence of str
        By series, what each of its points is called, where they have names.
    """

    series: Mapping[str, Points | None]
    label: str
    detail: str = ""
    note: str = ""
    trouble: str = ""
    option: Mapping[str, Any] = field(default_factory=dict)
    names: Mapping[str, Sequence[str]] = field(default_factory=dict)


@dataclass(frozen=True)
class Chart:
    """A place on the page.

    Parameters
    ----------
    name, title : str
        In messages, and above the chart.
    option : mapping
        The frame, as ECharts takes it: axes and series without numbers.
    drawing : callable
        From a picture to what is shown.
    """

    name: str
    title: str
    option: Mapping[str, Any]
    drawing: Callable[[Picture], Drawing]


@dataclass(frozen=True)
class Axis:
    """One axis: its name with unit, and further settings of ECharts."""

    name: str
    settings: Mapping[str, Any] = field(default_factory=dict)


def frame(x: Axis, y: Axis, series: Sequence[Mapping[str, Any]], trigger: str = "axis") -> Mapping[str, Any]:
    """A chart's option without numbers."""
    common: dict[str, Any] = {
        "type": "value",
        "nameLocation": "middle",
        "nameTextStyle": {"fontSize": 11},
        "axisLabel": {"fontSize": 11, "hideOverlap": True},
        "axisLine": {"show": True, "onZero": False},
        "splitNumber": 4,
    }
    return {
        "animation": False,
        "grid": {"left": 50, "right": 14, "top": 10, "bottom": 36},
        "tooltip": {
            "trigger": trigger,
            "confine": True,
            "transitionDuration": 0,
            ":valueFormatter": TOOLTIP_NUMBER,
            "textStyle": {"fontSize": 12},
        },
        "xAxis": [{**common, "name": x.name, "nameGap": 22, "splitLine": {"show": False}, **x.settings}],
        "yAxis": [{**common, "name": y.name, "nameGap": 36, **y.settings}],
        "series": [dict(one) for one in series],
    }


def line(identity: str, name: str, **settings: object) -> dict[str, Any]:
    """A curve."""
    return {"type": "line", "id": identity, "name": name, "symbol": "none", "data": [], "silent": True, **settings}


def scatter(identity: str, name: str, **settings: object) -> dict[str, Any]:
    """Points."""
    return {"type": "scatter", "id": identity, "name": name, "symbolSize": 8, "data": [], **settings}


def gapped(pieces: Sequence[Sequence[tuple[float, float]]]) -> Points:
    """Several polygons as one line with gaps."""
    points = [point for piece in pieces for point in (*piece, (piece[-1][0], np.nan))]
    x, y = np.array(points).reshape(-1, 2).T
    return x, y


def time_unit(end: float) -> tuple[float, str]:
    """Factor and name of the unit in which times up to `end` [s] read well."""
    return (1e3, "ms") if end <= SHORT_TIME else (1.0, "s")


def length_unit(largest: float) -> tuple[float, str]:
    """Factor and name of the unit in which lengths up to `largest` [m] read well."""
    if not 0.0 < largest < 0.5:
        return 1.0, "m"
    return (1e3, "mm") if largest >= 5e-4 else (1e6, "µm")


def percent(part: float) -> str:
    """A part as percent; rounding dust is zero."""
    return "0" if part < DUST else f"{100.0 * part:.3g}"


def listed(parts: Sequence[str]) -> str:
    """Some clauses as one sentence."""
    return "; ".join(parts) + "." if parts else ""
