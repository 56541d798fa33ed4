"""What the plant does: the move, a unit step, and the deflection during the move; unshaped and under each design."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.studio.page.plots.chart import (
    DESIGNS,
    Axis,
    Chart,
    Drawing,
    Picture,
    Points,
    frame,
    length_unit,
    line,
    listed,
    percent,
    time_unit,
)
from preshape.workflow.workbench import Drawn, Response

__all__ = ["DEFLECTION", "MOVE", "STEP"]


def _curves(
    picture: Picture,
    times: NDArray[np.float64],
    unshaped: Response,
    of: Callable[[Drawn], Response],
    value: Callable[[Response], NDArray[np.float64]],
    length: float = 1.0,
) -> tuple[dict[str, Points | None], str]:
    factor, unit = time_unit(float(times[-1]))
    scaled = factor * times
    series: dict[str, Points | None] = {"unshaped": (scaled, length * value(unshaped))}
    for name in DESIGNS:
        drawn = picture.designs[name].drawn if name in picture.designs else None
        series[name] = None if drawn is None else (scaled, length * value(of(drawn)))
    return series, unit


def _position(response: Response) -> NDArray[np.float64]:
    return response.position


def _deflection(response: Response) -> NDArray[np.float64]:
    return response.deflection


def _step_of(drawn: Drawn) -> Response:
    return drawn.step


def _move_of(drawn: Drawn) -> Response:
    return drawn.move


def _ends(picture: Picture, of: Callable[[Drawn], Response], unshaped: Response, size: float) -> str:
    """When each command ends and what vibrates on."""
    rows = [("unshaped", unshaped)]
    rows += [(f"design {name}", of(one.drawn)) for name, one in picture.designs.items() if one.drawn is not None]
    return listed(
        [
            f"{who} ends at {one.end_time:.4g} seconds and vibrates on by at most "
            f"{percent(one.residual / size)} percent of the distance"
            for who, one in rows
        ]
    )


def _move(picture: Picture) -> Drawing:
    view = picture.view
    size = abs(view.workbench.move.distance)
    ends = _ends(picture, _move_of, view.unshaped_move, size)
    length, length_name = length_unit(size)
    series, unit = _curves(picture, view.move_times, view.unshaped_move, _move_of, _position, length)
    series["command"] = time_unit(float(view.move_times[-1]))[0] * view.move_times, length * view.unshaped_move.command
    return Drawing(
        series,
        label=f"Response to the move, position over time: {ends}",
        detail="thin dashes: command",
        option={"xAxis": [{"name": f"time [{unit}]"}], "yAxis": [{"name": f"position [{length_name}]"}]},
    )


def _step(picture: Picture) -> Drawing:
    view = picture.view
    series, unit = _curves(picture, view.step_times, view.unshaped_step, _step_of, _position)
    ends = _ends(picture, _step_of, view.unshaped_step, 1.0)
    return Drawing(
        series,
        label=f"Response to a unit step, position over time: {ends}",
        option={"xAxis": [{"name": f"time [{unit}]"}]},
    )


def _deflections(picture: Picture) -> Drawing:
    view = picture.view
    length, length_name = length_unit(float(np.abs(view.unshaped_move.deflection).max()))
    series, unit = _curves(picture, view.move_times, view.unshaped_move, _move_of, _deflection, length)
    rows = [("unshaped", view.unshaped_move)]
    rows += [(f"design {name}", one.drawn.move) for name, one in picture.designs.items() if one.drawn is not None]
    clauses = [f"{who} at most {one.peak_deflection:.3g} metres" for who, one in rows]
    return Drawing(
        series,
        label=f"Deflection during the move, over time: {listed(clauses)}",
        detail="from the command",
        option={"xAxis": [{"name": f"time [{unit}]"}], "yAxis": [{"name": f"deflection [{length_name}]"}]},
    )


def _frame(y: str, *extra: dict[str, Any]) -> Mapping[str, Any]:
    return frame(
        Axis(
            "time [s]",
            {"min": 0, "max": "dataMax", "axisLabel": {"fontSize": 11, "hideOverlap": True, "showMaxLabel": False}},
        ),
        Axis(y),
        [*extra, line("unshaped", "unshaped"), *(line(name, f"design {name}") for name in DESIGNS)],
    )


MOVE = Chart("move", "Move", _frame("position [m]", line("command", "command")), _move)
STEP = Chart("step", "Step", _frame("position [-]"), _step)
DEFLECTION = Chart("deflection", "Deflection in the move", _frame("deflection [m]"), _deflections)
