"""What the terminal shows: tables with units, the choice marked."""

from __future__ import annotations

import math

from rich.console import Console
from rich.table import Table
from rich.text import Text

from preshape.report import Calibration, klipper_sentence
from preshape.shaper import Shaper
from preshape.workflow import Analysis

__all__ = ["analysis_screen", "calibration_screen", "console", "shaper_screen"]

FULL_WIDTH = 110
"""Columns assumed when the output is not a terminal, so that a table in a log file is not folded."""


def console(stderr: bool = False) -> Console:
    """A console on standard output or standard error."""
    screen = Console(stderr=stderr, highlight=False, markup=False)
    return screen if screen.is_terminal else Console(stderr=stderr, highlight=False, markup=False, width=FULL_WIDTH)


def calibration_screen(calibration: Calibration) -> None:
    """Modes, troubles, candidates with the choice marked, the reason."""
    screen = console()
    modes = Table(title="Modes found", title_justify="left", title_style="bold", box=None, pad_edge=False)
    for title in ("natural frequency", "95 % interval", "damping ratio", "95 % interval", "share"):
        modes.add_column(title, justify="right")
    for mode in calibration.modes:
        modes.add_row(
            f"{mode.mode.frequency:.4g} Hz",
            f"{mode.frequency_interval[0]:.4g} - {mode.frequency_interval[1]:.4g}",
            f"{mode.mode.damping:.4f}",
            f"{mode.damping_interval[0]:.4f} - {mode.damping_interval[1]:.4f}",
            f"{100.0 * mode.share:.0f} %",
        )
    screen.print(modes if calibration.modes else Text("No mode stands out of the measurement.", style="bold"))
    for sentence in calibration.trouble:
        screen.print(Text(f"! {sentence}", style="bold yellow"))
    table = Table(
        title="\nCandidates, the best first", title_justify="left", title_style="bold", box=None, pad_edge=False
    )
    table.add_column("")
    table.add_column("shaper", no_wrap=True)
    for title in ("impulses", "duration\n[ms]", "vibration left at\n5 % error [%]"):
        table.add_column(title, justify="right")
    if calibration.klipper is not None:
        for title in ("by Klipper's\nmeasure [%]", "smoothing\n[mm]", "max_accel\n[mm/s²]"):
            table.add_column(title, justify="right")
    table.add_column("")
    for candidate in calibration.candidates:
        chosen = candidate is calibration.chosen
        score = candidate.score
        cells = [
            candidate.name,
            f"{len(candidate.shaper)}",
            f"{1e3 * candidate.shaper.duration:.1f}",
            f"{100.0 * candidate.left:.1f}",
        ]
        if calibration.klipper is not None:
            cells += [
                f"{100.0 * score.remaining_vibration:.1f}",
                f"{score.smoothing:.3f}",
                f"{score.maximum_acceleration:.0f}",
            ]
        style = "bold cyan" if chosen else "dim" if candidate.excluded else None
        table.add_row(">" if chosen else "", *cells, candidate.excluded, style=style)
    screen.print(table)
    screen.print()
    screen.print(Text(calibration.reason, style="bold"))
    if calibration.klipper is not None:
        screen.print(Text(klipper_sentence(calibration)))


def shaper_screen(shaper: Shaper) -> None:
    """The impulses and where they come from."""
    screen = console()
    design = shaper.design
    screen.print(
        Text(f"{design.family}: {len(shaper)} impulses in {shaper.duration:.6g} s ({design.status})", style="bold")
    )
    screen.print(_impulses(shaper))
    if design.modes is not None and design.residual is not None:
        names = "; ".join(str(mode) for mode in design.modes)
        screen.print(f"largest residual vibration at {names}: {100.0 * design.residual:.3g} %")
    if design.certificate is not None:
        screen.print("proved shortest: no positive shaper with these constraints is shorter (certificate in the JSON)")
    elif "gap" in design.settings:
        screen.print(f"not proved shortest: a shorter one could save at most {100.0 * design.settings['gap']:.2g} %")


def analysis_screen(analysis: Analysis) -> None:
    """The impulses, and the numbers at each mode."""
    screen = console()
    shaper_screen(analysis.shaper)
    screen.print(
        f"delay at constant speed (centroid) {1e3 * analysis.shaper.centroid:.4g} ms; Klipper's smoothing "
        f"{analysis.smoothing:.3f} mm at 5000 mm/s², max_accel {analysis.maximum_acceleration:.0f} mm/s²"
    )
    percent = f"{100.0 * analysis.tolerance:g} %"
    table = Table(title=f"\nAt {percent} tolerance", title_justify="left", title_style="bold", box=None, pad_edge=False)
    for title in ("mode", "residual [%]", "band [Hz]", "insensitivity", "total insensitivity"):
        table.add_column(title, justify="left" if title == "mode" else "right")
    for row in analysis.modes:
        band = row.insensitivity
        high = "open" if math.isinf(band.high) else f"{band.high:.4g}"
        table.add_row(
            str(row.mode),
            f"{100.0 * row.residual:.3g}",
            f"{band.low:.4g} - {high}" if band.value > 0.0 else "none",
            f"{band.value:.4f}",
            f"{row.total_insensitivity:.4f}",
        )
    screen.print(table)


def _impulses(shaper: Shaper) -> Table:
    table = Table(box=None, pad_edge=False)
    table.add_column("time [s]", justify="right")
    table.add_column("amplitude [-]", justify="right")
    for time, amplitude in zip(shaper.times, shaper.amplitudes, strict=True):
        table.add_row(f"{time:.9f}", f"{amplitude:.9f}")
    return table
