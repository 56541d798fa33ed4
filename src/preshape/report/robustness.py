"""How far a machine may be from its modes before the shaper leaves more than is allowed."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from preshape.mode import Mode
from preshape.report.calibration import FREQUENCY_ERROR
from preshape.report.tables import TextTable
from preshape.shaper import Shaper
from preshape.vibration import Insensitivity, insensitivity, residual_vibration

__all__ = ["ModeRobustness", "mode_robustness", "percent_cell", "robustness_sentence", "robustness_table", "worst_left"]

TOLERATED = 0.05
"""Residual vibration at which insensitivity is told [-], as the literature does."""

SAMPLES = 401
"""Of the frequencies within the error, its ends and the mode itself among them."""


@dataclass(frozen=True)
class ModeRobustness:
    """A shaper around one mode, at that mode's damping ratio.

    Parameters
    ----------
    mode : Mode
        As it was measured or given.
    at_mode : float
        Residual vibration V there [-].
    worst : float
        The largest V with the natural frequency up to :data:`preshape.report.FREQUENCY_ERROR` off [-].
    band : Insensitivity
        Natural frequencies around the mode at which V stays within 5 %.
    """

    mode: Mode
    at_mode: float
    worst: float
    band: Insensitivity


def mode_robustness(shaper: Shaper, modes: Iterable[Mode]) -> tuple[ModeRobustness, ...]:
    """Of every mode, in the order given."""
    return tuple(
        ModeRobustness(
            mode,
            float(residual_vibration(shaper, mode.frequency, mode.damping)),
            worst_left(shaper, [mode]),
            insensitivity(shaper, mode, TOLERATED),
        )
        for mode in modes
    )


def worst_left(shaper: Shaper, modes: Iterable[Mode]) -> float:
    """The largest V of any mode with its frequency up to :data:`preshape.report.FREQUENCY_ERROR` off [-]."""
    ratios = np.linspace(1.0 - FREQUENCY_ERROR, 1.0 + FREQUENCY_ERROR, SAMPLES)
    return max(float(residual_vibration(shaper, mode.frequency * ratios, mode.damping).max()) for mode in modes)


def robustness_table(rows: Iterable[ModeRobustness]) -> TextTable:
    """V at the mode and off it, and the band of insensitivity."""
    error = f"{100.0 * FREQUENCY_ERROR:g} % off"
    titles = (
        ("mode",),
        ("left at the", "mode [%]"),
        ("left, at worst", f"{error} [%]"),
        (f"within {100.0 * TOLERATED:g} %", "from [Hz]"),
        ("", "to [Hz]"),
        ("insensitivity", "[% of the frequency]"),
    )
    return TextTable(titles, tuple(_cells(row) for row in rows))


def robustness_sentence(rows: tuple[ModeRobustness, ...]) -> str:
    """What the narrowest band allows."""
    narrow = min(rows, key=lambda row: row.band.value)
    if narrow.band.value == 0.0:
        return (
            f"At {narrow.mode} more than {100.0 * TOLERATED:g} % is left already as it is: the shaper gives this mode "
            "no room."
        )
    down = 1.0 - narrow.band.low / narrow.mode.frequency
    up = narrow.band.high / narrow.mode.frequency - 1.0
    least = 100.0 * min(down, up)
    return (
        f"Least room has {narrow.mode}: from {least:.1f} % off on, on one side, more than {100.0 * TOLERATED:g} % of "
        "its vibration is left."
    )


def _cells(row: ModeRobustness) -> tuple[str, ...]:
    band = row.band
    ends = (f"{band.low:.4g}", "open" if math.isinf(band.high) else f"{band.high:.4g}") if band.value else ("none", "")
    width = "open" if math.isinf(band.value) else f"{100.0 * band.value:.1f}"
    return (str(row.mode), percent_cell(row.at_mode), percent_cell(row.worst), *ends, width)


def percent_cell(part: float) -> str:
    """A part in percent, rounding errors as what they are."""
    return "not moved" if math.isnan(part) else "< 0.001" if part < 1e-5 else f"{100.0 * part:.3g}"
