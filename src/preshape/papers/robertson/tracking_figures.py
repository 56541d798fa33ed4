"""Robertson, figures 13 to 18: shapers for a specified deflection."""

from __future__ import annotations

from typing import TYPE_CHECKING

from preshape import design
from preshape.papers.drawing import Curve, curves_figure, sampled, vibration_figure
from preshape.papers.reproduction import Figure
from preshape.papers.robertson.carried import (
    MASS,
    RATIOS,
    TRAPEZOID,
    limit,
    over_damping,
    over_frequency,
    shaper,
)
from preshape.papers.robertson.move_figures import deflection_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

__all__ = ["figures"]

DAMPINGS = (0.0, 0.05, 0.1)
"""Of figures 13 and 14, which name none; with more SD = 0.3 takes a fourth impulse."""

END = 7.0
"""Of the time axis of figures 15 and 16 [s]."""


def figures() -> list[Figure]:
    """In the order of the paper."""
    chosen = "[z = 0, 0.05, 0.1 chosen, each with the shaper for it]"
    errors = "[limit relative to what one unshaped ramp causes; model 10 % above and below the actual frequency]"
    return [
        Figure(
            "13",
            f"SD-ZV Sensitivity Plots (SD = 0.4) {chosen}",
            lambda: _vibration(0.4, "SD = 0.4: centred on the modelled frequency"),
        ),
        Figure(
            "14",
            f"SD-ZV Sensitivity Plots (SD = 0.3) {chosen}",
            lambda: _vibration(0.3, "SD = 0.3: the more damping, the more one-sided"),
        ),
        Figure("15", f"Deflection Profile for SD = 0.4 {errors}", lambda: _profile(0.4)),
        Figure("16", f"Deflection Profile for SD = 0.3 {errors}", lambda: _profile(0.3)),
        Figure("17", "Transient Deflection Sensitivity Plot [z = 0.1, the trapezoid]", _over_frequency),
        Figure(
            "18", "Transient Deflection Sensitivity Plot for Damping Ratio Error [designed for z = 0.1]", _over_damping
        ),
    ]


def _vibration(ratio: float, title: str) -> Drawing:
    shapers = [(f"z = {z:g}", design.sd_zv((1.0, z), ratio), z) for z in DAMPINGS]
    return vibration_figure(title, shapers, sampled(0.8, 1.35, 401), modes=[1.0], top=20.0)


def _profile(ratio: float) -> Drawing:
    t, command = sampled(0.0, END), TRAPEZOID.shaped(shaper(ratio))
    curves = [
        Curve(words, t, MASS.retuned(r).motion(command)("deflection", t))
        for r, words in ((1.0, "as modelled"), (1.0 / 1.1, "model 10 % too high"), (1.0 / 0.9, "10 % too low"))
    ]
    return deflection_figure(f"SD = {ratio:g}: a model 10 % too high exceeds the limit", curves, limit(ratio))


def _over_frequency() -> Drawing:
    r = sampled(0.8, 1.7, 301)
    return curves_figure(
        "An actual frequency below the model's exceeds the limit",
        "actual / modelled frequency [-]",
        "peak deflection [% of limit]",
        [Curve(f"SD-{ratio:g}", r, 100.0 * over_frequency(ratio, r)) for ratio in RATIOS],
        level=100.0,
        legend="upper right",
        marks=[(1.0, "as modelled")],
    )


def _over_damping() -> Drawing:
    z = sampled(0.0, 0.3, 151)
    return curves_figure(
        "Less damping than modelled exceeds the limit, more damping hardly",
        "actual damping ratio [-]",
        "peak deflection [% of limit]",
        [Curve(f"SD-{ratio:g}", z, 100.0 * over_damping(ratio, z)) for ratio in RATIOS],
        level=100.0,
        legend="upper right",
        marks=[(0.1, "designed for")],
    )
