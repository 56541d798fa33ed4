"""What the terminal shows: tables with units, the choice marked."""

from __future__ import annotations

import math
from collections.abc import Sequence

from rich.console import Console
from rich.padding import Padding
from rich.table import Table
from rich.text import Text

from preshape.band import Band
from preshape.engine import is_proved_shortest
from preshape.report import (
    Calibration,
    TextTable,
    TradeOff,
    candidate_table,
    exclusion_sentence,
    gain_sentences,
    klipper_sentence,
    limit_sentence,
    mode_table,
    pick_table,
    robustness_sentence,
)
from preshape.shaper import Shaper
from preshape.vibration import high_frequency_gain
from preshape.workflow import Analysis, SpectrumLeft

__all__ = ["analysis_screen", "calibration_screen", "console", "indented", "shaper_screen", "spectrum_screen"]

FULL_WIDTH = 110
"""Columns assumed when the output is not a terminal, so that a table in a log file is not folded."""


def console(stderr: bool = False) -> Console:
    """A console on standard output or standard error."""
    screen = Console(stderr=stderr, highlight=False, markup=False)
    return screen if screen.is_terminal else Console(stderr=stderr, highlight=False, markup=False, width=FULL_WIDTH)


def calibration_screen(calibration: Calibration) -> None:
    """Modes, troubles, candidates with the choice marked, the reason."""
    screen = console()
    if calibration.modes:
        screen.print(_rich_table("Modes found", mode_table(calibration), [None] * len(calibration.modes)))
    else:
        screen.print(Text("No mode stands out of the measurement.", style="bold"))
    for sentence in calibration.trouble:
        screen.print(Text(f"! {sentence}", style="bold yellow"))
    styles = [
        "bold cyan" if one is calibration.chosen else "dim" if one.excluded else None for one in calibration.candidates
    ]
    screen.print(_rich_table("\nCandidates, the best first", candidate_table(calibration), styles, left=2))
    if exclusion_sentence(calibration):
        screen.print(exclusion_sentence(calibration))
    screen.print()
    screen.print(Text(calibration.reason, style="bold"))
    if calibration.klipper is not None:
        screen.print(Text(klipper_sentence(calibration)))
    if calibration.trade_off is not None:
        _trade_off_screen(screen, calibration.trade_off, calibration.maximum_impulses)


def shaper_screen(shaper: Shaper) -> None:
    """The impulses and where they come from."""
    screen = console()
    design = shaper.design
    screen.print(Text(f"{design.family}: {shaper.parts} in {shaper.duration:.6g} s ({design.status})", style="bold"))
    screen.print(_impulses(shaper))
    for box in shaper.boxes:
        screen.print(
            f"box from {box.start:.9f} s to {box.end:.9f} s: {box.density:.9f} per second, {box.mass:.9f} in all"
        )
    if design.modes is not None and design.residual is not None:
        bands = [str(Band(*band)) for band in design.settings.get("bands", ())]
        names = "; ".join(bands or [str(mode) for mode in design.modes])
        screen.print(f"largest residual vibration at {names}: {100.0 * design.residual:.3g} %")
    if (shaper.amplitudes < 0.0).any():
        screen.print(Text(f"! {_excitation(shaper)}", style="bold yellow"))
    if design.certificate is not None:
        if is_proved_shortest(shaper):
            screen.print("proved shortest: no positive shaper with these constraints is shorter (certificate checked)")
        else:
            screen.print(Text("the certificate in this file does not hold: it proves nothing", style="bold yellow"))
    elif "proved" in design.settings:
        screen.print(f"proved: {design.settings['proved']}")
    elif design.settings.get("gap") is not None:
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


def indented(text: str | Text, by: int = 2) -> Padding:
    """A paragraph that is indented in all of its lines, however the terminal folds it."""
    return Padding(text, (0, 0, 0, by), expand=False)


def _trade_off_screen(screen: Console, trade: TradeOff, asked: int | None) -> None:
    """The picks beside the stock choice; those that bear frequency errors worse are marked."""
    styles = ["yellow" if one in trade.fragile else None for one in (trade.stock, *trade.picks)]
    screen.print(_rich_table("\nWhat smoothing buys, by Klipper's measures", pick_table(trade), styles))
    screen.print(limit_sentence(trade, asked))
    for sentence in gain_sentences(trade)[1:]:
        screen.print(indented(sentence))
    off = robustness_sentence(trade)
    if trade.fragile:
        screen.print(Text(f"! {off}", style="bold yellow"))
    elif off:
        screen.print(indented(off))


def spectrum_screen(left: Sequence[SpectrumLeft]) -> None:
    """What is left of measured vibration."""
    if not left:
        return
    table = Table(title="\nOf what was measured", title_justify="left", title_style="bold", box=None, pad_edge=False)
    for title in ("measurement", "left, by Klipper's measure [%]", "amplitude left, 5 % off [%]"):
        table.add_column(title, justify="left" if title == "measurement" else "right")
    for one in left:
        table.add_row(one.name, f"{100.0 * one.by_klipper:.1f}", f"{100.0 * one.amplitude:.1f}")
    console().print(table)


def _rich_table(title: str, table: TextTable, styles: list[str | None], left: int = 1) -> Table:
    """A table on the terminal; the first `left` columns are left-aligned."""
    drawn = Table(title=title, title_justify="left", title_style="bold", box=None, pad_edge=False, padding=(0, 1, 0, 0))
    for number, lines in enumerate(table.titles):
        column = "\n".join(lines)
        if number < left:
            drawn.add_column(column, justify="left", no_wrap=True, min_width=1)
        else:
            drawn.add_column(column, justify="right", no_wrap=True)
    for row, style in zip(table.rows, styles, strict=True):
        drawn.add_row(*row, style=style)
    return drawn


def _excitation(shaper: Shaper) -> str:
    """What negative impulses do to modes that the shaper was not designed for."""
    if shaper.design.modes is None:
        return f"negative impulses excite up to {shaper.magnitude:.3g} x what the command does: check unmodelled modes"
    known = [mode.frequency for mode in shaper.design.modes]
    gain = high_frequency_gain(shaper, min(known), 10.0 * max(known))
    return (
        f"negative impulses excite up to {gain.value:.3g} x at {gain.frequency:.4g} Hz "
        f"(searched {gain.low:.4g} - {gain.high:.4g} Hz): check unmodelled modes"
    )


def _impulses(shaper: Shaper) -> Table:
    table = Table(box=None, pad_edge=False)
    table.add_column("time [s]", justify="right")
    table.add_column("amplitude [-]", justify="right")
    for time, amplitude in zip(shaper.times, shaper.amplitudes, strict=True):
        table.add_row(f"{time:.9f}", f"{amplitude:.9f}")
    return table
