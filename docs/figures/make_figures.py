"""The figures of the documentation, into docs/images; run by `make figures`."""

from __future__ import annotations

import json
import math
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.patches import Rectangle

from preshape import Modes, design, identify
from preshape.campaign import run_campaign
from preshape.command.path import shaped_path
from preshape.command.rest_to_rest import deflection_limiting
from preshape.engine.basis import Basis
from preshape.engine.polynomial import Polynomial
from preshape.engine.projection import project
from preshape.files import write_atomically
from preshape.identify import TimeSeries, operational_modes
from preshape.papers.hyde.chapter6_figures import swept_figure
from preshape.papers.hyde.chapter6_sweep import sweep
from preshape.plant import FloatingOscillator, load_plant
from preshape.report import (
    campaign_figure,
    comparison_figure,
    contour_figure,
    move_figure,
    simulation_figure,
    stabilisation_figure,
)
from preshape.report.figures import ACCENT, INK, MUTED, SECOND, SOFT, as_svg, new_figure, tidy
from preshape.vibration import residual_vibration, tolerated_bands
from preshape.workflow import compare, simulate_plant

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HERE = Path(__file__).resolve().parent
IMAGES = HERE.parent / "images"

SHUTTLE_ARM = [(0.20, 0.0), (0.26, 0.0), (0.45, 0.0), (0.59, 0.0)]


def certificate() -> Figure:
    """Left: the dual polynomial of the shortest shaper over its impulses; right: an interval 5 % shorter."""
    shaper = design.direct(SHUTTLE_ARM)
    proof = shaper.design.certificate
    assert proof is not None
    end, short = shaper.duration, 0.95 * shaper.duration
    basis = Basis(Modes(SHUTTLE_ARM), (1, 1, 1, 1), short)
    apart = project(basis, np.linspace(0.0, short, 400), short)
    assert apart.infeasible
    figure = new_figure(10.0, 5.0)
    axes = figure.subplots(2, 2, sharex="col", height_ratios=[2.0, 1.0])
    t = np.linspace(0.0, end, 2001)
    p = proof.polynomial(t)
    axes[0, 0].plot(t, p / p.max(), color=ACCENT, linewidth=1.8)
    axes[0, 0].plot(shaper.times, np.zeros(len(shaper)), "o", color=INK, markersize=5, clip_on=False, zorder=3)
    tidy(axes[0, 0], "", "polynomial p, over its largest [-]", f"T* = {end:.3f} s: p touches zero at nine times")
    axes[0, 0].tick_params(labelbottom=True)
    axes[1, 0].vlines(shaper.times, 0.0, shaper.amplitudes, color=ACCENT, linewidth=2.0)
    axes[1, 0].plot(shaper.times, shaper.amplitudes, "o", color=INK, markersize=5)
    tidy(axes[1, 0], "time [s]", "amplitude [-]", "... and there are the nine impulses")
    for axis in axes[:, 0]:
        for time in shaper.times[:-1]:
            axis.axvline(time, color=SOFT, linewidth=0.8, linestyle=":", zorder=0)
    for axis in (*axes[:, 0], axes[0, 1]):
        axis.axvline(end, color=MUTED, linewidth=1.0, linestyle="--")
    for axis in axes[0]:
        axis.text(end + 0.12, 0.55, "T*", fontsize=9.5, color=INK)
    axes[1, 0].set_ylim(0.0, 1.25 * shaper.amplitudes.max())
    t = np.linspace(0.0, short, 2001)
    p = Polynomial(basis, apart.multipliers)(short - t)
    axes[0, 1].plot(t, p / p.max(), color=SECOND, linewidth=1.8)
    axes[0, 1].axhline(p.min() / p.max(), color=INK, linewidth=1.0, linestyle=":")
    axes[0, 1].text(0.5 * short, p.min() / p.max() - 0.02, "never below this line", ha="center", va="top", fontsize=9)
    axes[0, 1].axhline(0.0, color=MUTED, linewidth=1.0)
    tidy(axes[0, 1], "", "", f"{short:.3f} s, 5 % shorter: a p above zero everywhere")
    axes[1, 1].text(
        0.5,
        0.5,
        "positive impulses would give  $\\sum a_i\\,p(t_i) > 0$,\nbut zero vibration means  $\\sum a_i\\,p(t_i) = 0$:\n"
        "there is no shaper",
        transform=axes[1, 1].transAxes,
        ha="center",
        va="center",
        fontsize=10.5,
        color=INK,
    )
    axes[1, 1].set_axis_off()
    axes[0, 1].tick_params(labelbottom=True)
    axes[0, 1].set_xlabel("time [s]", fontsize=9.5, color=INK)
    for axis in axes[0]:
        axis.set_ylim(-0.06, 1.05)
    axes[0, 1].set_xlim(axes[0, 0].get_xlim())
    return figure


def growth() -> Figure:
    """Time over the number of modes, as benchmarks/many_modes.py measured it."""
    found = json.loads((HERE / "growth.json").read_text())
    figure = new_figure(7.0, 4.2)
    axes = figure.subplots()
    styles = {"evenly spaced": (ACCENT, "o", "-"), "log-spaced": (INK, "s", "--"), "random": (SECOND, "^", "-.")}
    peer = found.pop("peer", [])
    for kind, rows in found.items():
        colour, mark, line = styles[kind]
        proved = [row for row in rows if row["status"] == "optimal"]
        others = [row for row in rows if row["status"] != "optimal"]
        axes.plot(
            [row["modes"] for row in proved],
            [row["seconds"] for row in proved],
            color=colour,
            marker=mark,
            linestyle=line,
            label=f"{kind}, 1 to 20 Hz",
        )
        axes.plot(
            [row["modes"] for row in others],
            [row["seconds"] for row in others],
            color=colour,
            marker=mark,
            linestyle="none",
            fillstyle="none",
            markersize=8,
            label=f"{kind}: feasible, with a gap" if others else None,
        )
    if peer:
        axes.plot(
            [row["modes"] for row in peer],
            [row["seconds"] for row in peer],
            "x",
            color=MUTED,
            markersize=8,
            label="HiGHS bisection to 1e-3, log-spaced, no proof",
        )
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xticks([1, 2, 4, 10, 20, 40], labels=["1", "2", "4", "10", "20", "40"])
    axes.set_xticks([], minor=True)
    tidy(axes, "modes (order 1, damping 0.01)", "time of one core [s]", "Design and proof, cold")
    axes.legend(fontsize=9, frameon=False)
    return figure


def insensitivity() -> Figure:
    """V over frequency for two bands; duration over the width of one band, with the EI family."""
    shaper = design.specified_insensitivity([(0.9, 1.1), (2.7, 3.3)], 0.05)
    proof = shaper.design.certificate
    assert proof is not None
    figure = new_figure(10.0, 3.8)
    left, right = figure.subplots(1, 2)
    f = np.linspace(0.0, 4.0, 2001)
    left.plot(f, 100.0 * residual_vibration(shaper, f), color=ACCENT, linewidth=1.8)
    left.axhline(5.0, color=INK, linewidth=1.0, linestyle=":")
    for low, high in ((0.9, 1.1), (2.7, 3.3)):
        left.axvspan(low, high, color="#e8e8e8", zorder=0)
    left.plot([p.frequency for p in proof.points], [5.0] * len(proof.points), "o", color=INK, markersize=5, zorder=3)
    left.set_ylim(0.0, 30.0)
    left.text(0.0, 5.5, "tolerance", fontsize=9, color=INK)
    for low, high in ((0.9, 1.1), (2.7, 3.3)):
        left.text(0.5 * (low + high), 28.3, f"{low:g} to\n{high:g} Hz", ha="center", va="top", fontsize=9, color=INK)
    tidy(
        left, "natural frequency [Hz]", "residual vibration [%]", f"Two bands, {shaper.duration:.4f} s, proved shortest"
    )
    widths = np.concatenate([np.linspace(0.07, 0.4, 12), np.linspace(0.42, 1.13, 24)])
    durations = [design.specified_insensitivity((1.0 - w / 2.0, 1.0 + w / 2.0), 0.05).duration for w in widths]
    right.plot(widths, durations, color=ACCENT, linewidth=1.8, label="shortest, proved")
    for humps, name in ((1, "EI"), (2, "two-hump EI"), (3, "three-hump EI")):
        ei = design.k_hump_ei((1.0, 0.0), humps, 0.05)
        low, high = next(band for band in tolerated_bands(ei, 0.05, 0.0, 0.0, 2.0) if band[0] <= 1.0 <= band[1])
        # the closed form is tuned to its mode, the band to its middle: durations in periods of the middle
        middle = 0.5 * (low + high)
        width, duration = (high - low) / middle, ei.duration * middle
        right.plot([width], [duration], "o", color=SECOND, markersize=7)
        right.annotate(name, (width, duration), (width - 0.02, duration + 0.1), fontsize=9, color=INK, ha="right")
    right.plot([], [], "o", color=SECOND, label="closed forms")
    right.legend(fontsize=9, frameon=False, loc="lower right")
    tidy(
        right,
        "insensitivity I: width of the band over its middle [-]",
        "duration [periods]",
        "One undamped band at 5 %",
    )
    right.set_ylim(0.0, 1.1 * math.ceil(max(durations)))
    return figure


def swinging() -> Figure:
    """The move of the tutorial: two masses and a spring, ten metres, 0.3 m of deflection."""
    plant = FloatingOscillator(first_mass=1.0, second_mass=1.0, stiffness=1.0)
    return move_figure(deflection_limiting(plant, 10.0, maximum_force=1.0, deflection_limit=0.3))


def comparison() -> Figure:
    """Every kind of command for one move of a mode of 1.2 Hz."""
    return comparison_figure(compare((1.2, 0.01), 0.5, maximum_speed=1.0, maximum_acceleration=5.0))


def own_machine() -> Figure:
    """The gantry of the tutorial, moved by 0.2 m, unshaped beside shaped."""
    gantry = load_plant(HERE.parents[1] / "examples" / "data" / "machine.toml")
    shaper = design.direct(gantry.modes(), order=0)
    return simulation_figure(simulate_plant(gantry, np.minimum(np.arange(250) * 1e-3, 0.2), 1e-3, shaper))


def campaign() -> Figure:
    """The robustness campaign of the examples."""
    with TemporaryDirectory() as folder:
        file = HERE.parents[1] / "examples" / "data" / "gantry-robustness.toml"
        return campaign_figure(run_campaign(file, folder, workers=0).summary)


def contours() -> Figure:
    """The part of the examples, shaped in three ways."""
    part = identify.read(HERE.parents[1] / "examples" / "data" / "part.csv")
    assert isinstance(part, identify.TimeSeries)
    dt, modes = 1.0 / part.sample_rate, [(38.0, 0.05), (61.0, 0.05)]
    own = [design.zvd(mode) for mode in modes]
    paths = {
        "equal delays": shaped_path(part.values, own, dt),
        "own delays": shaped_path(part.values, own, dt, delays="own"),
        "one shaper": shaped_path(part.values, design.direct(modes), dt),
    }
    return contour_figure(paths, names=part.channels, unit=part.unit)


def adaptive() -> Figure:
    """What shapers that stay and that follow leave, as `preshape reproduce hyde` measures it."""
    return swept_figure(sweep(1), sweep(2))


def stabilisation() -> Figure:
    """Two modes that white noise shakes for ten minutes, seen by two sensors."""
    from scipy.signal import lfilter

    rate, generator = 50.0, np.random.default_rng(1)
    motion = np.zeros((2, 30_000))
    for frequency, damping, shape in ((1.5, 0.01, (1.0, 0.6)), (4.2, 0.02, (0.8, -1.0))):
        omega = 2.0 * math.pi * frequency
        pole = np.exp(omega * (-damping + 1j * math.sqrt(1.0 - damping**2)) / rate)
        swing = lfilter([1.0], np.poly([pole, pole.conjugate()]).real, generator.normal(size=30_000))
        motion += np.outer(shape, swing / swing.std())
    motion += 0.05 * generator.normal(size=motion.shape)
    return stabilisation_figure(operational_modes(TimeSeries(rate, 0.0, motion, ("bus", "arm"))))


QUESTIONS = (
    (
        "Is the move known beforehand,\nand the actuator's force yours?",
        "time_optimal, deflection_limiting",
        "commands, not shapers",
    ),
    ("Must it not bend too far\non the way?", "sd_zv, deflection_limited", "a part of the swing, or metres"),
    ("Do the modes move\nwhile it works?", "Stream.track, Schedule", "around a family from below"),
    ("Do you know bands rather\nthan frequencies?", "specified_insensitivity", "shortest for the bands, proved"),
    ("Are there several modes?", "direct", "shortest for all of them, proved"),
    ("Is the frequency right\nto 3 %?", "zv", "half a period"),
    ("Is it right to 14 %,\nor to 20 %?", "zvd, ei", "one period"),
    ("Is it worse than that?", "two_hump_ei, three_hump_ei", "1½ and 2 periods: ±36 %, ±48 %"),
)
"""Question, what to call, and what that is; the first yes decides."""


def which_shaper() -> Figure:
    """The questions one under the other, the answers beside them; told apart by frame and place, not by colour."""
    figure = new_figure(7.4, 7.6)
    axes = figure.subplots()
    axes.set_axis_off()
    axes.set_xlim(0.0, 10.0)
    axes.set_ylim(-len(QUESTIONS) + 0.45, 0.55)
    arrow = {"arrowstyle": "-|>", "color": INK, "linewidth": 1.1, "shrinkA": 0.0, "shrinkB": 0.0}
    for row, (question, calls, what) in enumerate(QUESTIONS):
        y = -float(row)
        axes.add_patch(Rectangle((0.1, y - 0.33), 3.9, 0.66, facecolor="white", edgecolor=INK, linewidth=1.0))
        axes.text(2.05, y, question, ha="center", va="center", fontsize=10.0, color=INK)
        axes.add_patch(Rectangle((5.2, y - 0.33), 4.7, 0.66, facecolor="#eef3f8", edgecolor=ACCENT, linewidth=1.6))
        axes.text(7.55, y + 0.12, calls, ha="center", va="center", fontsize=10.5, color=ACCENT, fontweight="bold")
        axes.text(7.55, y - 0.15, what, ha="center", va="center", fontsize=9.5, color=INK)
        axes.annotate("", (5.2, y), (4.0, y), arrowprops=arrow)
        axes.text(4.6, y + 0.07, "yes", ha="center", va="bottom", fontsize=9.5, color=INK)
        if row + 1 < len(QUESTIONS):
            axes.annotate("", (2.05, y - 0.67), (2.05, y - 0.33), arrowprops=arrow)
            axes.text(2.17, y - 0.5, "no", ha="left", va="center", fontsize=9.5, color=INK)
    return figure


FIGURES = {
    "adaptive": adaptive,
    "campaign": campaign,
    "certificate": certificate,
    "comparison": comparison,
    "contours": contours,
    "growth": growth,
    "insensitivity": insensitivity,
    "own-machine": own_machine,
    "swinging": swinging,
    "stabilisation": stabilisation,
    "which-shaper": which_shaper,
}


def main() -> None:
    """Draw all of them."""
    IMAGES.mkdir(exist_ok=True)
    for name, draw in FIGURES.items():
        print(write_atomically(IMAGES / f"{name}.svg", as_svg(draw())))


if __name__ == "__main__":
    main()
