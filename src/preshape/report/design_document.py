"""The report of a design without a measurement: modes, shapers compared, what the shaper does, settings, origin."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from preshape.mode import Modes
from preshape.report.calibration import FREQUENCY_ERROR, SimulatedMove
from preshape.report.document import Document, Heading, Paragraph, Part, Picture, Table
from preshape.report.figures import as_svg
from preshape.report.panels import shown_part, simulated_figure
from preshape.report.record import Record
from preshape.report.robustness import worst_left
from preshape.report.sections import (
    Export,
    export_parts,
    impulse_parts,
    prediction_parts,
    provenance_parts,
    robustness_parts,
)
from preshape.report.shaped_simulation import ShapedSimulation
from preshape.report.simulation_figure import simulation_figure
from preshape.report.tables import TextTable, time_unit
from preshape.shaper import Shaper

__all__ = ["design_document"]

TOLERANCE = 0.05
"""Vibration left that is drawn as a line, unless the design has its own."""


def design_document(
    modes: Modes,
    shaper: Shaper,
    move: SimulatedMove,
    record: Record,
    *,
    exports: Iterable[Export] = (),
    remarks: Iterable[str] = (),
    others: Sequence[tuple[str, Shaper]] = (),
    simulation: ShapedSimulation | None = None,
) -> Document:
    """The report of a shaper for modes that are known.

    Parameters
    ----------
    modes : Modes
        Of the machine.
    shaper : Shaper
        What was chosen.
    move : SimulatedMove
        The modes under a quick move, unshaped and shaped.
    record : Record
        What it was made from.
    exports : iterable of PasteText or (str, str)
        Settings to paste.
    remarks : iterable of str
        Whatever else must be known, as sentences.
    others : sequence of (str, Shaper)
        Other shapers for the same modes, by name.
    simulation : ShapedSimulation, optional
        A machine under the shaper.
    """
    name = shaper.design.family.replace("_", " ")
    unit = time_unit(shaper)
    names = "; ".join(str(mode) for mode in modes)
    sentence = _choice(name, modes, shaper, others)
    figure = Picture(as_svg(simulated_figure(shaper, move)), f"The impulses, and a move of {names}. {sentence}")
    asked = shaper.design.settings.get("tolerance")
    tolerance = float(asked) if isinstance(asked, float) and 0.0 < asked < 1.0 else TOLERANCE
    parts: list[Part] = [Paragraph(sentence, "lead"), *[Paragraph(remark, "warning") for remark in remarks], figure]
    parts += [Heading("Modes"), Table(_modes(modes))]
    parts += [Heading("Shapers for these modes"), _compared(name, modes, shaper, others)] if others else []
    parts += impulse_parts(shaper)
    parts += prediction_parts(move)
    parts += robustness_parts(shaper, modes, tolerance)
    parts += _simulated(simulation)
    parts += export_parts(exports)
    parts += provenance_parts(record)
    return Document(
        title=f"{name}: {shaper.parts} in {unit.show(shaper.duration)}",
        subject=f"preshape: {name} for {names}",
        parts=tuple(parts),
        foot=f"Made by preshape {record.versions['preshape']}. The modes were given, not measured: the report holds as "
        "far as they do.",
        record=record,
    )


def _choice(name: str, modes: Modes, shaper: Shaper, others: Sequence[tuple[str, Shaper]]) -> str:
    """What the shaper leaves, and what a shorter one would."""
    unit, left = time_unit(shaper), worst_left(shaper, modes)
    said = (
        f"{name} takes {unit.show(shaper.duration)} and leaves at most {shown_part(left)} of a mode's vibration with "
        f"its frequency up to {100.0 * FREQUENCY_ERROR:g} % off."
    )
    rivals = [(other, one.duration, worst_left(one, modes)) for other, one in others]
    better = [rival for rival in rivals if rival[1] <= shaper.duration and rival[2] < left]
    if better:
        other, duration, theirs = min(better, key=lambda rival: rival[2])
        return f"{said} {other} is no longer ({unit.show(duration)}) and leaves less, {shown_part(theirs)}."
    shorter = [rival for rival in rivals if rival[1] < shaper.duration]
    if shorter:
        other, duration, theirs = min(shorter, key=lambda rival: rival[2])
        return f"{said} Of the shorter ones {other} leaves least, {shown_part(theirs)} in {unit.show(duration)}."
    return f"{said} None of the shapers it is compared with is shorter." if others else said


def _modes(modes: Modes) -> TextTable:
    titles = (("natural", "frequency [Hz]"), ("damping", "ratio"), ("damped", "period [ms]"))
    return TextTable(
        titles, tuple((f"{one.frequency:.6g}", f"{one.damping:.4g}", f"{1e3 * one.damped_period:.4g}") for one in modes)
    )


def _compared(name: str, modes: Modes, shaper: Shaper, others: Sequence[tuple[str, Shaper]]) -> Table:
    """The shaper among the others, the shortest first."""
    unit = time_unit(shaper)
    rows = sorted([(name, shaper), *others], key=lambda row: row[1].duration)
    titles = (
        ("shaper",),
        ("impulses",),
        ("duration", f"[{unit.name}]"),
        ("left, at worst", f"{100.0 * FREQUENCY_ERROR:g} % off [%]"),
    )
    cells = tuple(
        (
            label,
            f"{len(one)}",
            f"{unit.per_second * one.duration:.{unit.decimals}f}",
            f"{100.0 * worst_left(one, modes):.1f}",
        )
        for label, one in rows
    )
    return Table(TextTable(titles, cells), tuple("chosen" if one is shaper else "" for _, one in rows))


def _simulated(simulation: ShapedSimulation | None) -> list[Part]:
    """A machine under the shaper."""
    if simulation is None:
        return []
    titles = (("output",), ("vibrates afterwards,", "unshaped"), ("vibrates afterwards,", "shaped"), ("left [%]",))
    rows = []
    for output, (before, after) in simulation.motions.items():
        unit = simulation.unshaped.units[output]
        part = simulation.remaining(output)
        left = "" if part != part else f"{100.0 * part:.3g}"
        rows.append((output, f"{before.residual:.3g} {unit}", f"{after.residual:.3g} {unit}", left))
    words = "; ".join(f"{output} {left} % left" for output, _, _, left in rows if left)
    return [
        Heading("The machine, simulated"),
        Picture(as_svg(simulation_figure(simulation)), f"Commands and outputs, unshaped and shaped: {words}."),
        Table(TextTable(titles, tuple(rows))),
        *[Paragraph(note) for note in simulation.notes],
    ]
