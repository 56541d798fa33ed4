"""The tables of a calibration as text, the same on the page and on the terminal."""

from __future__ import annotations

from dataclasses import dataclass

from preshape.report.calibration import Calibration, Candidate
from preshape.report.trade_off import TradeOff
from preshape.shaper import Shaper

__all__ = [
    "TextTable",
    "TimeUnit",
    "candidate_table",
    "exclusion_sentence",
    "limit_sentence",
    "mode_table",
    "pick_table",
    "time_unit",
]

CHOSEN, EXCLUDED = ">", "x"
"""Marks before a candidate's name."""

SECONDS_FROM = 0.5
"""A shaper of this duration [s] or more is shown in seconds, a shorter one in milliseconds."""


@dataclass(frozen=True)
class TextTable:
    """Column titles, each of one or two lines, and rows of cells."""

    titles: tuple[tuple[str, ...], ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class TimeUnit:
    """Units in a second, and the name of one."""

    per_second: float
    name: str
    decimals: int

    def show(self, seconds: float) -> str:
        """A duration with its unit."""
        return f"{self.per_second * seconds:.{self.decimals}f} {self.name}"


def time_unit(shaper: Shaper) -> TimeUnit:
    """Seconds for a crane, milliseconds for a printer."""
    return TimeUnit(1.0, "s", 3) if shaper.duration >= SECONDS_FROM else TimeUnit(1e3, "ms", 1)


def exclusion_sentence(calibration: Calibration) -> str:
    """What the mark of an excluded candidate means; empty when there is none."""
    if not any(candidate.excluded for candidate in calibration.candidates):
        return ""
    return f"{EXCLUDED}: more than the {calibration.maximum_impulses} impulses that the controller holds."


def limit_sentence(trade: TradeOff, asked: int | None) -> str:
    """How many impulses the picks have at most, and why so many; `asked` is what the user said."""
    if asked is None:
        why = "what every firmware that takes impulses holds; --max-impulses asks for another number"
    elif asked == trade.impulses:
        why = "as was asked"
    else:
        why = f"not {asked}: more are not looked for, as no known firmware holds them"
    return f"The picks have at most {trade.impulses} impulses: {why}."


def mode_table(calibration: Calibration) -> TextTable:
    """Frequencies, dampings, their intervals and shares."""
    titles = (
        ("natural", "frequency [Hz]"),
        ("95 % interval",),
        ("damping", "ratio"),
        ("95 % interval",),
        ("share of", "vibration"),
    )
    rows = tuple(
        (
            f"{mode.mode.frequency:.4g}",
            f"{mode.frequency_interval[0]:.4g} - {mode.frequency_interval[1]:.4g}",
            f"{mode.mode.damping:.4f}",
            f"{mode.damping_interval[0]:.4f} - {mode.damping_interval[1]:.4f}",
            f"{100.0 * mode.share:.0f} %",
        )
        for mode in calibration.modes
    )
    return TextTable(titles, rows)


def candidate_table(calibration: Calibration) -> TextTable:
    """The candidates, the best first, the choice marked; Klipper's measures only where they mean something."""
    unit = time_unit(calibration.shaper)
    titles: list[tuple[str, ...]] = [
        ("",),
        ("shaper",),
        ("impulses",),
        ("duration", f"[{unit.name}]"),
        ("vibration", "left [%]"),
    ]
    if calibration.klipper is not None:
        titles += [("Klipper", "[%]"), ("smooth-", "ing [mm]"), ("max_accel", "[mm/s²]")]
    rows = tuple(_cells(calibration, candidate, unit) for candidate in calibration.candidates)
    return TextTable(tuple(titles), rows)


def pick_table(trade: TradeOff) -> TextTable:
    """The stock choice and the picks."""
    unit = time_unit(trade.stock.shaper)
    titles: tuple[tuple[str, ...], ...] = (
        ("pick",),
        ("impulses",),
        ("duration", f"[{unit.name}]"),
        ("Klipper", "[%]"),
        ("smooth-", "ing [mm]"),
        ("max_accel", "[mm/s²]"),
        ("left when", "5 % off [%]"),
    )
    rows = tuple(
        (
            f"stock: {one.name.removeprefix('Klipper ')}" if one is trade.stock else one.name,
            f"{len(one.shaper)}",
            f"{unit.per_second * one.shaper.duration:.{unit.decimals}f}",
            f"{100.0 * one.score.remaining_vibration:.2f}",
            f"{one.score.smoothing:.3f}",
            f"{one.score.maximum_acceleration:.0f}",
            f"{100.0 * one.left:.1f}",
        )
        for one in (trade.stock, *trade.picks)
    )
    return TextTable(titles, rows)


def _cells(calibration: Calibration, candidate: Candidate, unit: TimeUnit) -> tuple[str, ...]:
    mark = CHOSEN if candidate is calibration.chosen else EXCLUDED if candidate.excluded else ""
    cells = [
        mark,
        candidate.name,
        f"{len(candidate.shaper)}",
        f"{unit.per_second * candidate.shaper.duration:.{unit.decimals}f}",
        f"{100.0 * candidate.left:.1f}",
    ]
    if calibration.klipper is not None:
        score = candidate.score
        cells += [
            f"{100.0 * score.remaining_vibration:.1f}",
            f"{score.smoothing:.3f}",
            f"{score.maximum_acceleration:.0f}",
        ]
    return tuple(cells)
