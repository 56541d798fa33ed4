"""Sections that every report has: the impulses, what was predicted and simulated, robustness, settings, provenance."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TypeAlias

import msgspec
import numpy as np

from preshape.export import PasteText
from preshape.mode import Mode
from preshape.report.calibration import SimulatedMove
from preshape.report.document import Heading, Paragraph, Part, Picture, Table, Verbatim
from preshape.report.figures import as_svg
from preshape.report.record import Record
from preshape.report.robustness import mode_robustness, percent_cell, robustness_sentence, robustness_table
from preshape.report.robustness_figure import robustness_figure
from preshape.report.tables import TextTable, time_unit
from preshape.shaper import Shaper

__all__ = ["Export", "export_parts", "impulse_parts", "prediction_parts", "provenance_parts", "robustness_parts"]

Export: TypeAlias = PasteText | tuple[str, str]
"""What goes to a controller: a text to paste, or its title and its text."""

AGREE = 1e-9
"""Prediction and simulation that differ by less than this part of the unshaped vibration, a billionth, are the same."""

SHOWN_IMPULSES = 40
"""Of longer shapers the report shows the first."""

MEGA = 1e6


def impulse_parts(shaper: Shaper) -> tuple[Part, ...]:
    """The shaper in numbers."""
    unit = time_unit(shaper)
    rows = [
        (f"{i}", f"{unit.per_second * t:.{unit.decimals + 3}f}", f"{a:.6f}")
        for i, (t, a) in enumerate(zip(shaper.times, shaper.amplitudes, strict=True), start=1)
    ]
    table = TextTable((("impulse",), (f"time [{unit.name}]",), ("amplitude [-]",)), tuple(rows[:SHOWN_IMPULSES]))
    parts: list[Part] = [Heading("The shaper")]
    if shaper.design.status == "optimal":
        parts.append(Paragraph("Proved shortest: the certificate is in shaper.json, and in the record of this report."))
    parts.append(Table(table))
    if len(rows) > SHOWN_IMPULSES:
        parts.append(Paragraph(f"These are the first {SHOWN_IMPULSES} of {len(rows)} impulses; shaper.json has all."))
    parts += [
        Paragraph(f"Box from {box.start:.9g} s to {box.end:.9g} s: {box.mass:.6f} in all.") for box in shaper.boxes
    ]
    return tuple(parts)


def prediction_parts(move: SimulatedMove | None) -> tuple[Part, ...]:
    """What the formula says is left of each mode, and what is left in the simulated move."""
    if move is None:
        return ()
    titles = (
        ("mode",),
        ("natural frequency",),
        ("predicted:", "V by formula [%]"),
        ("simulated:", "left by the move [%]"),
    )
    rows = tuple(
        (str(mode) if column == 0 else "", _off(error), percent_cell(predicted), percent_cell(simulated))
        for mode, *pairs in zip(move.modes, move.predicted, move.simulated, strict=True)
        for column, (error, predicted, simulated) in enumerate(zip(move.errors, *pairs, strict=True))
    )
    return (
        Heading("Predicted and simulated"),
        Table(TextTable(titles, rows), left=2),
        Paragraph(_agreement(move)),
    )


def robustness_parts(shaper: Shaper, modes: Sequence[Mode], tolerance: float) -> tuple[Part, ...]:
    """The sensitivity of every mode, as a figure and in numbers."""
    rows = mode_robustness(shaper, modes)
    sentence = robustness_sentence(rows)
    return (
        Heading("Robustness"),
        Picture(as_svg(robustness_figure(shaper, modes, tolerance)), f"Vibration left over frequency. {sentence}"),
        Table(robustness_table(rows)),
        Paragraph(sentence),
    )


def export_parts(exports: Iterable[Export]) -> tuple[Part, ...]:
    """The settings to paste, and who cannot hold the shaper."""
    parts: list[Part] = []
    for one in exports:
        if isinstance(one, PasteText):
            said = [
                f"{one.target} {one.version}",
                *([] if one.fits else ["does not fit"]),
                *([one.note] * bool(one.note)),
            ]
            parts.append(Paragraph(": ".join(said), "label" if one.fits else "plain"))
            parts += [Verbatim(one.text)] if one.fits else []
        else:
            title, text = one
            parts += [Paragraph(title, "label"), Verbatim(text)]
    return (Heading("Settings to paste"), *parts) if parts else ()


def provenance_parts(record: Record) -> tuple[Part, ...]:
    """From what and by what the report was made, and how to do it again."""
    date, time = record.made.rstrip("Z").split("T")
    parts: list[Part] = [Heading("Where this comes from"), Paragraph(f"Made on {date} at {time} UTC.")]
    if record.command_line:
        parts += [Paragraph("Command line", "label"), Verbatim(record.command_line)]
    options = {name: value for name, value in msgspec.to_builtins(record.job).items() if value not in (None, ())}
    rows = tuple((name.replace("_", " "), _shown(value)) for name, value in options.items())
    versions = tuple(record.versions.items())
    parts += [Paragraph("Job and options", "label"), Table(TextTable((("option",), ("value",)), rows), left=2)]
    parts += [Paragraph("Versions", "label"), Table(TextTable((("part",), ("version",)), versions), left=2)]
    if record.inputs:
        lines = "\n".join(f"{one.sha256}  {one.name}" for one in record.inputs)
        parts += [Paragraph("SHA-256 of the inputs", "label"), Verbatim(lines)]
    return (*parts, *_again(record))


def _again(record: Record) -> list[Part]:
    """How to run it again from this report."""
    missing = [one for one in record.inputs if one.packed is None]
    sentences = [
        f"{one.name} ({one.size / MEGA:.0f} MB) is too large to travel in this report: keep it, and name it with "
        "--input; its SHA-256 tells whether it is the same file."
        for one in missing
    ]
    inside = "the options" if not record.inputs or len(missing) == len(record.inputs) else "the options and the inputs"
    return [
        Paragraph(f"This file holds {inside}. To run it again and to compare the shaper bit by bit:"),
        Verbatim("preshape rerun report.html --out again" + "".join(" --input FILE" for _ in missing)),
        *[Paragraph(sentence) for sentence in sentences],
    ]


def _agreement(move: SimulatedMove) -> str:
    """Whether the two columns say the same."""
    excited = ~np.isnan(move.simulated)
    total = f"In all the shaped move leaves {percent_cell(move.left)} % of what the unshaped one leaves."
    if not excited.any():
        return total
    largest = float(np.abs(move.simulated - move.predicted)[excited].max())
    if largest < AGREE:
        verdict = "The two agree: they differ by less than a billionth of the unshaped vibration."
    else:
        verdict = f"The two differ by up to {100.0 * largest:.2g} % of the unshaped vibration: trust neither."
    return f"{verdict} {total}"


def _off(error: float) -> str:
    return "as it is" if error == 0.0 else f"{100.0 * abs(error):g} % {'lower' if error < 0.0 else 'higher'}"


def _shown(value: object) -> str:
    if isinstance(value, list | tuple):
        return ", ".join(":".join(f"{part:g}" for part in one) for one in value)
    return {True: "yes", False: "no"}[value] if isinstance(value, bool) else str(value)
