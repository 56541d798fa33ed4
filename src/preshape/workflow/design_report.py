"""The report of a shaper for modes that are known, without a measurement."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from preshape.design import convolved, direct
from preshape.mode import Modes, ModesLike
from preshape.report import DesignJob, Document, Export, GivenJob, ShapedSimulation, design_document
from preshape.shaper import Shaper
from preshape.workflow.record import new_record
from preshape.workflow.simulate import simulate_move

__all__ = ["design_report", "usual_shapers"]

USUAL = ("zv", "zvd", "ei")
"""Families that every shaper is compared with, of several modes one after the other."""

MOST_MODES = 6
"""Of more modes the shortest shaper is not designed only to be compared with."""


def design_report(
    modes: ModesLike,
    shaper: Shaper,
    *,
    exports: Iterable[Export] = (),
    remarks: Iterable[str] = (),
    command_line: str = "",
    others: Sequence[tuple[str, Shaper]] | None = None,
    simulation: ShapedSimulation | None = None,
    job: DesignJob | GivenJob | None = None,
) -> Document:
    """What :func:`preshape.report.as_html` and :func:`preshape.report.as_pdf` write of a design.

    Parameters
    ----------
    modes : Mode, (frequency, damping) pair, or several
        Natural frequencies [Hz] and damping ratios [-] of the machine.
    shaper : Shaper
        What was chosen for them.
    exports : iterable of PasteText or (str, str)
        Settings to paste: what :func:`preshape.export.paste_ready` gives, or title and text of each.
    remarks : iterable of str
        Whatever else the reader must know, as sentences; shown at the top.
    command_line : str
        As it was typed, for the provenance.
    others : sequence of (str, Shaper), optional
        Shapers to compare with, by name; the usual families for the same modes unless given.
    simulation : ShapedSimulation, optional
        A machine under the shaper, from :func:`preshape.workflow.simulate_plant`.
    job : DesignJob, optional
        The options of the design, so that the report can be run again.

    Returns
    -------
    Document

    Raises
    ------
    InputError
        If a mode is not one.

    Examples
    --------
    >>> import preshape
    >>> from preshape.report import as_html
    >>> report = design_report((47.3, 0.05), preshape.design.zvd((47.3, 0.05)))
    >>> report.title, as_html(report).startswith("<!doctype html>")
    ('zvd: 3 impulses in 21.2 ms', True)
    """
    wanted = modes if isinstance(modes, Modes) else Modes(modes)
    return design_document(
        wanted,
        shaper,
        simulate_move(shaper, wanted, [1.0] * len(wanted)),
        new_record(job or GivenJob(), shaper, command_line=command_line),
        exports=exports,
        remarks=remarks,
        others=usual_shapers(wanted, shaper) if others is None else others,
        simulation=simulation,
    )


def usual_shapers(modes: Modes, shaper: Shaper) -> tuple[tuple[str, Shaper], ...]:
    """ZV, ZVD and EI for the same modes, and the shortest for all at once; without what `shaper` is already."""
    found = [(name, convolved(modes, name)) for name in USUAL]
    if 1 < len(modes) <= MOST_MODES:
        found.append(("shortest for all modes at once", direct(modes, order=0)))
    return tuple((name, one) for name, one in found if one != shaper)
