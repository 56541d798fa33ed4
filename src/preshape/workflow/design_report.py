"""The report of a shaper for modes that are known, without a measurement."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from preshape.band import Band
from preshape.design import convolved, direct
from preshape.errors import InputError
from preshape.export import paste_ready
from preshape.mode import Mode, Modes, ModesLike
from preshape.report import DesignJob, Document, Export, GivenJob, Record, ShapedSimulation, design_document
from preshape.shaper import Shaper
from preshape.workflow.record import new_record
from preshape.workflow.simulate import simulate_move

__all__ = ["asked_design_report", "design_report"]

USUAL = ("zv", "zvd", "ei")
"""Families that every shaper is compared with, of several modes one after the other."""

PRINTERS = (10.0, 200.0)
"""Frequencies [Hz] of machines that a firmware with settings for shapers may drive."""

MOST_MODES = 6
"""Of more modes nothing is designed only to be compared with: convolved, ZVD has three impulses for each mode's one."""


def design_report(
    modes: ModesLike,
    shaper: Shaper,
    *,
    exports: Iterable[Export] = (),
    remarks: Iterable[str] = (),
    command_line: str = "",
    others: Sequence[tuple[str, Shaper]] | None = None,
    simulation: ShapedSimulation | None = None,
    record: Record | None = None,
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
    record : Record, optional
        What the report is to say of its making; here and now, of a shaper that was handed over, unless given.

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
        record or new_record(GivenJob(), shaper, command_line=command_line),
        exports=exports,
        remarks=remarks,
        others=_usual_shapers(wanted, shaper) if others is None else others,
        simulation=simulation,
    )


def asked_design_report(
    job: DesignJob, shaper: Shaper, *, command_line: str = "", record: Record | None = None
) -> Document:
    """The report of a shaper that options asked for, with what every firmware makes of it where one may drive the
    machine; it can be run again.

    Parameters
    ----------
    job : DesignJob
        The options.
    shaper : Shaper
        From :func:`preshape.workflow.designed`.
    command_line : str
        As it was typed.
    record : Record, optional
        What the report is to say of its making; here and now unless given.
    """
    bands = [Band(*band) for band in job.bands]
    middles = [Mode(0.5 * (band.low + band.high), band.least_damping or job.damping or 0.0) for band in bands]
    modes = Modes(middles or [Mode(*mode) for mode in job.modes])
    printer = all(PRINTERS[0] <= mode.frequency <= PRINTERS[1] for mode in modes)
    return design_report(
        modes,
        shaper,
        exports=paste_ready(shaper) if printer else (),
        remarks=[f"Designed for {band}; the report names its middle as the mode." for band in bands],
        record=record or new_record(job, shaper, command_line=command_line),
    )


def _usual_shapers(modes: Modes, shaper: Shaper) -> tuple[tuple[str, Shaper], ...]:
    """ZV, ZVD and EI for the same modes, and the shortest for all at once; without what `shaper` is already."""
    if len(modes) > MOST_MODES:
        return ()
    found = [(name, family) for name in USUAL if (family := _if_any(modes, name)) is not None]
    if len(modes) > 1:
        found.append(("shortest for all modes at once", direct(modes, order=0)))
    return tuple((name, one) for name, one in found if one != shaper)


def _if_any(modes: Modes, name: str) -> Shaper | None:
    """A family at these modes, None where it does not exist: EI has a limit of damping."""
    try:
        return convolved(modes, name)
    except InputError:
        return None
