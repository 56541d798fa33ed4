"""Poles of the machine and zeros of the shapers about them: a zero on a pole takes its vibration away."""

from __future__ import annotations

import numpy as np

from preshape.studio.page.plots.chart import DESIGNS, Axis, Chart, Drawing, Picture, Points, frame, listed, scatter

__all__ = ["POLES"]

TURN = 2.0 * np.pi


def _places(values: list[complex]) -> Points:
    array = np.array(values, dtype=complex)
    return array.real, array.imag / TURN


def _drawing(picture: Picture) -> Drawing:
    poles = list(picture.view.poles)
    series: dict[str, Points | None] = {"poles": _places(poles)}
    clauses = [f"{len(poles)} poles"]
    for name in DESIGNS:
        drawn = picture.designs[name].drawn if name in picture.designs else None
        zeros = [] if drawn is None else [zero for zero in drawn.zeros if 0.0 <= zero.place.imag <= TURN * picture.top]
        series[f"{name}.hollow"] = _places([zero.place for zero in zeros]) if zeros else None
        if drawn is not None:
            orders = sum(zero.order for zero in zeros)
            clauses.append(f"design {name} has {len(zeros)} zeros there, {orders} with their multiplicity")
    return Drawing(
        series,
        label=f"Poles and zeros in the upper half of the complex plane: {listed(clauses)}",
        detail="x poles, hollow: zeros",
        option={"yAxis": [{"max": picture.top}]},
    )


POLES = Chart(
    "poles",
    "Poles and zeros",
    frame(
        Axis("real part [1/s]", {"scale": True, "splitNumber": 3}),
        Axis("imaginary part / 2π [Hz]", {"min": 0}),
        [
            *(
                scatter(f"{name}.hollow", f"zero of {name}", symbol=symbol, symbolSize=size)
                for name, symbol, size in zip(
                    DESIGNS, ("circle", "rect", "triangle", "diamond"), (16, 13, 12, 10), strict=True
                )
            ),
            scatter("poles", "pole", symbol="path://M0,0L10,10M10,0L0,10", symbolSize=9),
        ],
        trigger="item",
    ),
    _drawing,
)
