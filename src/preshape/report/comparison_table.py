"""A comparison in words and cells: the same on the terminal, in the figure's title and in the documentation."""

from __future__ import annotations

import math
from dataclasses import dataclass

from preshape.report.comparison import Comparison, Contender
from preshape.report.tables import TextTable

__all__ = ["LengthUnit", "comparison_sentences", "comparison_table", "length_unit", "move_sentence", "table_sentence"]

NOTHING = 1e-7
"""Vibration below this part of the reference is rounding or interpolation, and shown as 0."""

SHOWN_FROM = 1e-3
"""What is less, in the unit that was chosen, is said to be less."""

SMALLER = {
    "m": (("m", 1.0), ("mm", 1e3), ("µm", 1e6), ("nm", 1e9)),
    "mm": (("mm", 1.0), ("µm", 1e3), ("nm", 1e6)),
}
"""Units of length in which a small deflection reads well."""


@dataclass(frozen=True)
class LengthUnit:
    """The unit in which deflections are shown, how many of it make the comparison's unit, and what is nothing."""

    name: str
    per_unit: float
    nothing: float

    def number(self, length: float) -> str:
        """Three digits, without the unit."""
        if length < self.nothing:
            return "0"
        value = self.per_unit * length
        if value < SHOWN_FROM and self.nothing * self.per_unit >= NOTHING:
            return f"<{SHOWN_FROM:g}"
        return f"{value:.3g}" if value < 1e3 else f"{value:.0f}"

    def show(self, length: float) -> str:
        """With the unit."""
        return f"{self.number(length)} {self.name}"


def length_unit(comparison: Comparison) -> LengthUnit:
    """The largest unit in which the reference is at least 1; the comparison's own if it is none of metres."""
    nothing = NOTHING * comparison.reference
    units = SMALLER.get(comparison.unit, ((comparison.unit, 1.0),))
    for name, per_unit in units:
        if per_unit * comparison.reference >= 1.0:
            return LengthUnit(name, per_unit, nothing)
    return LengthUnit(*units[-1], nothing)


def move_sentence(comparison: Comparison) -> str:
    """Modes, distance, limits."""
    unit = comparison.unit
    modes = "; ".join(str(mode) for mode in comparison.modes)
    limits = [f"{comparison.maximum_acceleration:g} {unit}/s²"]
    if comparison.maximum_speed is not None:
        limits.insert(0, f"{comparison.maximum_speed:g} {unit}/s")
    if comparison.maximum_jerk is not None:
        limits.append(f"{comparison.maximum_jerk:g} {unit}/s³")
    return f"{comparison.distance:g} {unit} within {', '.join(limits)}, carrying {modes}"


def comparison_sentences(comparison: Comparison) -> tuple[str, str]:
    """Who settles first when the modes are as modelled, and who ends first whatever they are within the error."""
    shown, error = length_unit(comparison), f"±{100.0 * comparison.frequency_error:g} %"
    if not comparison.contenders:
        return "No command can make this move.", ""
    first, robust = comparison.first_to_settle, comparison.first_robust
    if math.isfinite(first.settling_time):
        lead = (
            f"First to settle: {first.name}, {first.settling_time:.4g} s; with frequencies off by {error} it leaves up "
            f"to {shown.show(first.worst_residual)}."
        )
    else:
        lead = f"Nothing settles; {first.name} leaves least, {shown.show(first.residual)}."
    window = shown.show(comparison.within)
    if robust is None:
        return lead, f"Nothing leaves less than {window} wherever the frequencies are within {error}."
    return lead, (
        f"First within {window} wherever the frequencies are within {error}: {robust.name}, {robust.move_time:.4g} s."
    )


def comparison_table(comparison: Comparison) -> TextTable:
    """One row a contender, in their order."""
    shown, error = length_unit(comparison), f"±{100.0 * comparison.frequency_error:g} %"
    titles = (
        ("", "command"),
        ("ends", "[s]"),
        ("settled", "[s]"),
        ("left", f"[{shown.name}]"),
        ("of way", "[%]"),
        (error, f"[{shown.name}]"),
        ("of way", "[%]"),
        ("bends", f"[{shown.name}]"),
        ("acc.", f"[{comparison.unit}/s²]"),
    )
    return TextTable(titles, tuple(_cells(comparison, contender, shown) for contender in comparison.contenders))


def table_sentence(comparison: Comparison) -> str:
    """What the columns mean."""
    shown, error = length_unit(comparison), f"±{100.0 * comparison.frequency_error:g} %"
    return (
        f"settled: the command has ended and the deflection stays within {shown.show(comparison.within)} (a step of "
        f"acceleration, speed or way leaves at least {shown.show(comparison.reference)}); left: vibration at the "
        "command's end; "
        f"{error}: the worst of it with all frequencies off by up to that; bends: peak deflection; acc.: peak "
        "acceleration"
    )


def _cells(comparison: Comparison, one: Contender, shown: LengthUnit) -> tuple[str, ...]:
    way = abs(comparison.distance)
    return (
        one.name,
        f"{one.move_time:.4g}",
        f"{one.settling_time:.4g}" if math.isfinite(one.settling_time) else "never",
        shown.number(one.residual),
        _percent(one.residual / way, one.residual < shown.nothing),
        shown.number(one.worst_residual),
        _percent(one.worst_residual / way, one.worst_residual < shown.nothing),
        shown.number(one.peak_deflection),
        f"{one.peak_acceleration:.4g}",
    )


def _percent(fraction: float, nothing: bool) -> str:
    if nothing:
        return "0"
    return "<0.01" if fraction < 1e-4 else f"{100.0 * fraction:.2g}" if fraction < 1.0 else f"{100.0 * fraction:.0f}"
