"""What a workbench shows, as plain data: numbers rounded to what can be seen, nothing that JSON cannot say."""

from __future__ import annotations

import math
from dataclasses import asdict
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.identify import IdentifiedMode
from preshape.workflow.workbench.curves import Response
from preshape.workflow.workbench.link import to_plain, to_text
from preshape.workflow.workbench.measurement import Measured
from preshape.workflow.workbench.trade_off import TradePoint, WorkbenchTradeOff
from preshape.workflow.workbench.view import DesignView, Drawn, View

__all__ = ["plain_measured", "plain_trade_off", "plain_view"]

DIGITS = 6
"""Of a curve, relative to its largest value; single numbers keep all of theirs."""

SENSITIVITY_DIGITS = 9
"""Of a sensitivity curve, which is drawn on a logarithmic axis too."""


def plain_view(view: View) -> dict[str, Any]:
    """The view as plain data; times [s], frequencies [Hz], poles and zeros [1/s] as (real, imaginary).

    What is infinite (a band without an upper end) is None.
    """
    return {
        "workbench": to_plain(view.workbench),
        "link": to_text(view.workbench),
        "frequencies": _curve(view.frequencies),
        "dampings": _curve(view.dampings),
        "poles": [[pole.real, pole.imag] for pole in view.poles],
        "step_times": _curve(view.step_times),
        "move_times": _curve(view.move_times),
        "unshaped_step": _response(view.unshaped_step),
        "unshaped_move": _response(view.unshaped_move),
        "designs": [_design(one) for one in view.designs],
    }


def plain_trade_off(found: WorkbenchTradeOff) -> dict[str, Any]:
    """The trade-off as plain data; durations [s], vibration left [-]."""

    def points(given: tuple[TradePoint, ...]) -> list[dict[str, Any]]:
        return [asdict(point) for point in given]

    return {
        "families": points(found.families),
        "designs": points(found.designs),
        "optimum": points(found.optimum),
        "remarks": list(found.remarks),
    }


def plain_measured(found: Measured) -> dict[str, Any]:
    """A measurement as plain data; where nothing was fitted the curve is None."""
    return {
        "name": found.name,
        "format": found.format,
        "frequencies": _curve(found.frequencies),
        "density": _curve(found.density, SENSITIVITY_DIGITS),
        "fitted": _curve(found.fitted, SENSITIVITY_DIGITS),
        "unit": found.unit,
        "modes": [_mode(mode) for mode in found.modes],
        "method": found.method,
        "clear": found.clear,
        "trouble": list(found.trouble),
    }


def _mode(found: IdentifiedMode) -> dict[str, Any]:
    return {
        "frequency": found.mode.frequency,
        "damping": found.mode.damping,
        "frequency_interval": [_number(edge) for edge in found.frequency_interval],
        "damping_interval": [_number(edge) for edge in found.damping_interval],
        "share": _number(found.share),
    }


def _design(view: DesignView) -> dict[str, Any]:
    return {
        "name": view.asked.name,
        "family": view.asked.family,
        "trouble": view.trouble,
        "drawn": None if view.drawn is None else _drawn(view.drawn),
    }


def _drawn(drawn: Drawn) -> dict[str, Any]:
    shaper = drawn.shaper
    return {
        "times": shaper.times.tolist(),
        "amplitudes": shaper.amplitudes.tolist(),
        "boxes": [list(box) for box in shaper.boxes],
        "duration": shaper.duration,
        "status": drawn.status,
        "proved": drawn.proved,
        "vibration": _curve(drawn.vibration, SENSITIVITY_DIGITS),
        "modes": [{"residual": mode.residual, "low": mode.low, "high": _number(mode.high)} for mode in drawn.modes],
        "zeros": [[zero.place.real, zero.place.imag, zero.order] for zero in drawn.zeros],
        "step": _response(drawn.step),
        "move": _response(drawn.move),
        "misfit": drawn.misfit,
    }


def _response(given: Response) -> dict[str, Any]:
    return {
        "command": _curve(given.command),
        "position": _curve(given.position),
        "deflection": _curve(given.deflection),
        "peak_deflection": _number(given.peak_deflection),
        "residual": _number(given.residual),
        "end_time": given.end_time,
    }


def _curve(values: NDArray[np.float64], digits: int = DIGITS) -> list[float | None]:
    """The numbers, rounded relative to the largest; None for what is not finite."""
    finite = np.isfinite(values)
    largest = float(np.abs(values[finite]).max(initial=0.0))
    places = digits - math.ceil(math.log10(largest)) if largest > 0.0 else 0
    rounded: list[float] = np.round(values, places).tolist() if -300 < places < 300 else values.tolist()
    if finite.all():
        return list(rounded)
    return [value if known else None for value, known in zip(rounded, finite.tolist(), strict=True)]


def _number(value: float) -> float | None:
    return value if math.isfinite(value) else None
