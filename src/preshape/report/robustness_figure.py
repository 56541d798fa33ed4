"""The figure of robustness: what is left of every mode when its frequency is not what it was thought to be."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from preshape.mode import Mode
from preshape.report.calibration import FREQUENCY_ERROR
from preshape.report.figures import PALE, SERIES, new_figure, tidy
from preshape.report.panels import mark_tolerance
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["robustness_figure"]

REACH = 0.3
"""The frequencies are drawn so far off, as a part."""

SAMPLES = 601

LEAST_HEIGHT = 0.1
"""The vertical axis reaches at least so far [-]."""


def robustness_figure(shaper: Shaper, modes: Sequence[Mode], tolerance: float) -> Figure:
    """V of each mode over the error of its frequency, from -30 % to 30 %.

    Parameters
    ----------
    shaper : Shaper
        Any.
    modes : sequence of Mode
        The first six are drawn, each at its own damping ratio.
    tolerance : float
        What may remain [-]; drawn as a line.
    """
    figure = new_figure(10.0, 3.8)
    axes = figure.add_subplot()
    errors = np.linspace(-REACH, REACH, SAMPLES)
    axes.axvspan(-100.0 * FREQUENCY_ERROR, 100.0 * FREQUENCY_ERROR, color=PALE, linewidth=0)
    top = LEAST_HEIGHT
    for mode, (colour, line, width) in zip(modes, SERIES, strict=False):
        left = residual_vibration(shaper, mode.frequency * (1.0 + errors), mode.damping)
        top = max(top, float(left.max()))
        axes.plot(100.0 * errors, 100.0 * left, color=colour, linestyle=line, linewidth=width, label=str(mode))
    axes.set_xlim(-100.0 * REACH, 100.0 * REACH)
    axes.set_ylim(0.0, 135.0 * top)
    mark_tolerance(axes, 100.0 * tolerance, 100.0 * REACH, f"{100.0 * tolerance:g} %")
    more = f"; the first {len(SERIES)} of {len(modes)} modes" if len(modes) > len(SERIES) else ""
    tidy(
        axes,
        "actual natural frequency off by [%]",
        "vibration left [%]",
        f"What is left when the machine is not as thought{more}",
    )
    axes.legend(fontsize=8.5, loc="upper center", frameon=True, framealpha=0.9, edgecolor="white", ncols=2)
    return figure
