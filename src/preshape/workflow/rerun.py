"""A report made anew from itself: its inputs and options, taken out of it, run again, and compared."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np

from preshape.errors import InputError
from preshape.files import write_atomically
from preshape.report import (
    CalibrationJob,
    DesignJob,
    Document,
    GivenJob,
    Record,
    calibration_document,
    can_make_pdf,
    printable,
    read_record,
    report_bytes,
    unpacked,
)
from preshape.shaper import Shaper
from preshape.workflow.calibrate import calibrate
from preshape.workflow.design_report import asked_design_report
from preshape.workflow.designed import designed
from preshape.workflow.record import current_versions, recorded_files
from preshape.workflow.save import make_folders, save_calibration, save_design

__all__ = ["Rerun", "rerun"]

INPUTS = "inputs"
"""Folder of the inputs that were in the report, each in a folder of its number, so that equal names stay apart."""


@dataclass(frozen=True)
class Rerun:
    """What came of it.

    Attributes
    ----------
    record : Record
        What the report says of its making.
    shaper : Shaper
        That came out now; the recorded one if that was handed over as it is, so that there is nothing to run.
    identical : bool
        Whether the shaper is the recorded one to the last bit, with where it comes from.
    difference : tuple of float or None
        The largest of the times over the duration and of the amplitudes [-]; None where the numbers of impulses differ.
    page : bool or None
        Whether the report is, byte for byte, what this version writes of the record; None where this cannot be told.
    versions : tuple of (str, str, str)
        What is not as it was: name, then, now.
    folder : Path
        Where everything was written.
    """

    record: Record
    shaper: Shaper
    identical: bool
    difference: tuple[float, float] | None
    page: bool | None
    versions: tuple[tuple[str, str, str], ...]
    folder: Path


def rerun(
    report: str | os.PathLike[str],
    folder: str | os.PathLike[str],
    *,
    inputs: Iterable[str | os.PathLike[str]] = (),
    command_line: str = "",
) -> Rerun:
    """Run again what a report records, write everything into `folder`, and compare the shaper bit by bit.

    Parameters
    ----------
    report : path
        A report.html or report.pdf.
    folder : path
        Where to; made if it does not exist.
    inputs : paths
        Files that were too large to travel in the report; they are known by their SHA-256.
    command_line : str
        As it was typed, for the new report.

    Raises
    ------
    InputError
        If the report is damaged or was changed, an input is missing, or the folder cannot be written.
    """
    record, whole = read_record(report)
    was, target, versions = record.found(), Path(folder), _changed(record.versions)
    match record.job:
        case CalibrationJob():
            contents = _contents(record, inputs)
            with tempfile.TemporaryDirectory() as place:
                calibration = calibrate(_write_inputs(contents, Path(place)), **msgspec.structs.asdict(record.job))
            again = calibration.shaper
            page = _same_page(calibration_document(calibration, record), whole, versions)
            save_calibration(calibration, target, command_line=command_line)
            _write_inputs(contents, target / INPUTS)
        case DesignJob():
            again = designed(record.job)
            page = _same_page(asked_design_report(record.job, again, record=record), whole, versions)
            save_design(again, asked_design_report(record.job, again, command_line=command_line), target)
        case GivenJob():
            again, page = was, None
            save_design(again, None, target)
    return Rerun(
        record=record,
        shaper=again,
        identical=again.to_dict() == was.to_dict(),
        difference=_difference(was, again),
        page=page,
        versions=versions,
        folder=target,
    )


def _contents(record: Record, given: Iterable[str | os.PathLike[str]]) -> list[tuple[str, bytes]]:
    """Name and bytes of every input, from the report or from the files that were named beside it."""
    beside = {one.sha256: Path(path) for path in given for one in recorded_files([path])}
    found = []
    for one in record.inputs:
        content = unpacked(one)
        if content is None and one.sha256 not in beside:
            raise InputError(
                f"{one.name} ({one.size} bytes, SHA-256 {one.sha256}) was too large to travel in the report: name the "
                "file with --input."
            )
        found.append((one.name, beside[one.sha256].read_bytes() if content is None else content))
    return found


def _write_inputs(contents: Iterable[tuple[str, bytes]], folder: Path) -> list[Path]:
    places = [(folder / str(number) / name, content) for number, (name, content) in enumerate(contents, start=1)]
    make_folders(path.parent for path, _ in places)
    return [write_atomically(path, content) for path, content in places]


def _difference(was: Shaper, now: Shaper) -> tuple[float, float] | None:
    if len(was) != len(now) or len(was.boxes) != len(now.boxes):
        return None
    scale = max(was.duration, now.duration) or 1.0
    ends = [
        abs(a - b)
        for one, other in zip(was.boxes, now.boxes, strict=True)
        for a, b in zip(one[:2], other[:2], strict=True)
    ]
    masses = [abs(one.mass - other.mass) for one, other in zip(was.boxes, now.boxes, strict=True)]
    return (
        max([float(np.abs(was.times - now.times).max()), *ends]) / scale,
        max([float(np.abs(was.amplitudes - now.amplitudes).max()), *masses]),
    )


def _same_page(anew: Document, whole: bytes, versions: tuple[tuple[str, str, str], ...]) -> bool | None:
    """Whether the report is what is written of its record; other versions may write it otherwise."""
    kind = "pdf" if whole.startswith(b"%PDF-") else "html"
    if kind == "pdf" and not can_make_pdf():
        return None
    if report_bytes(anew, kind) == whole:
        return True
    return None if versions else False


def _changed(then: dict[str, str]) -> tuple[tuple[str, str, str], ...]:
    now = current_versions()
    names = dict.fromkeys([*then, *now])
    rows = [(name, then.get(name, "none"), now.get(name, "none")) for name in names]
    return tuple((printable(name), printable(old), new) for name, old, new in rows if old != new)
