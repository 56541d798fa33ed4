"""The figure of a simulation: the command, and every output, unshaped beside shaped."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from preshape.report.figures import ACCENT, MUTED, SECOND, new_figure, tidy
from preshape.report.shaped_simulation import ShapedSimulation

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["simulation_figure"]

MOST_OUTPUTS = 5
"""Panels below the commands; of more outputs the first are drawn."""

DRAWN = 4000
"""Points of a curve; of longer ones every point of the envelope is kept."""

NOTHING = 1e-6
"""A residual below this part of the unshaped peak is none."""

STILL = 1e-12
"""An output that moves by less than this part of another one of the same unit does not move."""

PREFIXED = ("m", "rad", "s", "N", "N m")
"""Units that take a prefix."""

PREFIXES = ((1.0, ""), (1e-3, "m"), (1e-6, "u"), (1e-9, "n"))


def simulation_figure(result: ShapedSimulation) -> Figure:
    """Left the commands and every output over time, right what vibrates after the commands, on the same scale.

    Parameters
    ----------
    result : ShapedSimulation
        From :func:`preshape.workflow.simulate_plant`.

    Returns
    -------
    matplotlib.figure.Figure
    """
    names = list(result.motions)[:MOST_OUTPUTS]
    figure = new_figure(11.0, 0.5 + 1.9 * (len(names) + 1))
    panels = figure.subplots(len(names) + 1, 2, sharex="col", squeeze=False, width_ratios=[1.7, 1.0])
    _commands(panels[0, 0], result)
    for row, name in zip(panels[1:], names, strict=True):
        _output(row[0], result, name)
        _vibration(row[1], result, name)
    for axes in panels[:, 0]:
        for end, colour in ((result.command_end, SECOND), (result.shaped_end, ACCENT)):
            axes.axvline(end, color=colour, linewidth=1.1, linestyle=":")
        axes.margins(y=0.1)
    panels[-1, 0].set_xlabel("time [s]", fontsize=9.5)
    panels[-1, 1].set_xlabel("time since the end of the command [s]", fontsize=9.5)
    panels[0, 0].set_xlim(0.0, float(result.unshaped.times[-1]))
    panels[1, 1].set_xlim(0.0, float(result.unshaped.times[-1] - result.shaped_end))
    panels[0, 1].set_axis_off()
    handles, labels = panels[0, 0].get_legend_handles_labels()
    handles += panels[0, 0].plot([], [], color=MUTED, linewidth=1.1, linestyle=":")
    shown = [*labels[:2], "where each command ends"]
    panels[0, 1].legend([*handles[:2], handles[-1]], shown, loc="center left", frameon=False, fontsize=9.5)
    return figure


def _commands(axes: Axes, result: ShapedSimulation) -> None:
    many = len(result.inputs) > 1
    for row, name in enumerate(result.inputs):
        width = 1.6 if row == 0 else 1.0
        unshaped, shaped = (_drawn(run.times, run.command[row]) for run in (result.unshaped, result.shaped))
        axes.step(*unshaped, where="post", color=SECOND, linestyle="--", linewidth=width, label="unshaped")
        axes.step(*shaped, where="post", color=ACCENT, linewidth=width, label=f"shaped ({_shaper(result)})")
        if many:
            at = int(np.argmax(np.abs(result.unshaped.command[row])))
            axes.annotate(name, (result.unshaped.times[at], result.unshaped.command[row, at]), fontsize=9)
    unit = next(iter(result.inputs.values()))
    same = len(set(result.inputs.values())) == 1
    label = "commands" if many else next(iter(result.inputs))
    later = result.shaped_end - result.command_end
    tidy(axes, "", _labelled(label, unit if same else ""), f"The command, {_number(later, 's')} longer when shaped")


def _output(axes: Axes, result: ShapedSimulation, name: str) -> None:
    unit = result.unshaped.units[name]
    axes.plot(
        *_drawn(result.unshaped.times, result.unshaped.outputs[name]), color=SECOND, linestyle="--", linewidth=1.3
    )
    axes.plot(*_drawn(result.shaped.times, result.shaped.outputs[name]), color=ACCENT, linewidth=1.9)
    tidy(axes, "", _labelled(name, unit), _sentence(result, name))
    if not _moves(result, name):
        axes.set_ylim(-_scale(result, name), _scale(result, name))


def _vibration(axes: Axes, result: ShapedSimulation, name: str) -> None:
    from matplotlib.ticker import EngFormatter

    looks = (
        (result.unshaped, result.command_end, SECOND, "--", 1.3),
        (result.shaped, result.shaped_end, ACCENT, "-", 1.9),
    )
    for (run, end, colour, style, width), motion in zip(looks, result.motions[name], strict=True):
        first = int(np.searchsorted(run.times, end - 0.5 * result.dt))
        since = run.times[first:] - run.times[first]
        trend = np.polynomial.polynomial.polyval(since, motion.trend)
        axes.plot(*_drawn(since, run.outputs[name][first:] - trend), color=colour, linestyle=style, linewidth=width)
    axes.margins(y=0.1)
    unit = result.unshaped.units[name]
    prefixed = unit in PREFIXED
    tidy(axes, "", "vibration" if prefixed else _labelled("vibration", unit), "")
    if prefixed:
        axes.yaxis.set_major_formatter(EngFormatter(unit))
    least = NOTHING * (_scale(result, name) if not _moves(result, name) else _peak(result, name))
    if np.abs(axes.get_ylim()).max() < least:
        axes.set_ylim(-least, least)


def _sentence(result: ShapedSimulation, name: str) -> str:
    """How far an output vibrates after the command, and how far unshaped."""
    if not _moves(result, name):
        return f"{name}: does not move"
    unit = result.unshaped.units[name]
    before, after = (
        "" if motion.residual < NOTHING * _peak(result, name) else _number(motion.residual, unit)
        for motion in result.motions[name]
    )
    now = f"vibrates by {after} afterwards" if after else "does not vibrate afterwards"
    return f"{name}: {now}, unshaped by {before}" if before else f"{name}: {now}"


def _peak(result: ShapedSimulation, name: str) -> float:
    return max(motion.peak for motion in result.motions[name])


def _scale(result: ShapedSimulation, name: str) -> float:
    """The largest peak of the outputs of this unit; 1 if nothing moves at all."""
    unit = result.unshaped.units[name]
    return max(_peak(result, other) for other in result.motions if result.unshaped.units[other] == unit) or 1.0


def _moves(result: ShapedSimulation, name: str) -> bool:
    return _peak(result, name) > STILL * _scale(result, name)


def _shaper(result: ShapedSimulation) -> str:
    family = result.shaper.design.family.replace("_", " ")
    return f"{family}, {_number(result.shaper.duration, 's')}"


def _labelled(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name


def _number(value: float, unit: str) -> str:
    """Three digits; of metres, radians, newtons and seconds with a prefix where that is shorter."""
    if unit not in PREFIXED or value == 0.0 or not np.isfinite(value):
        return f"{value:.3g} {unit}".rstrip()
    factor, prefix = next(((f, p) for f, p in PREFIXES if abs(value) >= f), PREFIXES[-1])
    return f"{value / factor:.3g} {prefix.replace('u', chr(0xB5))}{unit}"


def _drawn(times: NDArray[np.float64], values: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A curve as short as a drawing needs it: of each stretch the lowest and the highest point, in their order."""
    stretch = values.size // (DRAWN // 2)
    if stretch < 3:
        return times, values
    count = values.size // stretch
    blocks = values[: count * stretch].reshape(count, stretch)
    picked = np.sort(np.stack([blocks.argmin(axis=1), blocks.argmax(axis=1)], axis=1), axis=1)
    kept = np.unique(np.append((picked + stretch * np.arange(count)[:, np.newaxis]).ravel(), [0, values.size - 1]))
    return times[kept], values[kept]
