"""Segments as lines of G-code, in the units and modes that hold at their place of the program."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.workflow.gcode.program import AXES, Run

__all__ = ["DWELLS", "written"]

DWELLS = {"seconds": 1.0, "milliseconds": 1000.0}
EXTRUSION_DIGITS = 5


def written(
    run: Run,
    places: NDArray[np.float64],
    times: NDArray[np.float64],
    begins: NDArray[np.float64],
    delay: float,
    dwell: str,
) -> list[str]:
    """The lines of a run, and what brings back the program's feed and kind of motion.

    Parameters
    ----------
    run : Run
        Where it stands in the program.
    places : ndarray, shape (4, segment + 1)
        x, y, z, rounded, and what has been extruded since the run began [mm].
    times : ndarray, shape (segment + 1,)
        When each segment begins and ends [s].
    begins : ndarray, shape (move,)
        When each move of the program begins [s]: its comments stand before the first segment that is due then.
    delay : float
        By how much the shaped motion is later [s].
    dwell : str
        What P counts after G4.
    """
    unit, writing = run.writing.unit, run.writing
    digits = 4 if unit == 1.0 else 6
    units = places[:3] / unit
    extrusion = np.round((run.start_extrusion * writing.absolute_extrusion + places[3]) / unit, EXTRUSION_DIGITS)
    due = [(float(begins[k]) + delay if k < begins.size else np.inf, text) for k, text in run.comments]
    lines: list[str] = []
    for k in range(times.size - 1):
        while due and due[0][0] <= times[k]:
            lines.append(f"; {due.pop(0)[1]}")
        steps = units[:, k + 1] - units[:, k]
        words = [
            f"{axis}{_number(units[i, k + 1] if writing.absolute else steps[i], digits)}"
            for i, axis in enumerate(AXES)
            if abs(steps[i]) > 0.5 * 10.0**-digits
        ]
        lasts = float(times[k + 1] - times[k])
        way = float(np.linalg.norm(steps)) if words else 0.0
        e = float(extrusion[k + 1] - extrusion[k])
        if abs(e) > 0.5 * 10.0**-EXTRUSION_DIGITS:
            words.append(f"E{_number(extrusion[k + 1] if writing.absolute_extrusion else e, EXTRUSION_DIGITS)}")
        if words:  # the feed of a move of the extruder alone is the extruder's
            lines.append(f"G1 {' '.join(words)} F{_feed(60.0 * (way or abs(e)) / lasts)}")
        else:
            lines.append(f"G4 P{_number(lasts * DWELLS[dwell], 6)}")
    lines += [f"; {text}" for _, text in due]
    if run.feed is not None:
        lines.append(f"G1 F{_feed(60.0 * run.feed / unit)}")
    if run.rapid:
        lines.append("G0")
    return lines


def _number(value: float, digits: int) -> str:
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _feed(value: float) -> str:
    """Seven significant digits, without an exponent."""
    digits = max(0, 6 - int(np.floor(np.log10(value))))
    return _number(value, min(digits, 12))
