"""What a calibration leaves in a folder: shapers, figures, report, settings to paste. All of it, or a clear refusal."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from preshape.errors import InputError
from preshape.files import write_atomically
from preshape.report import (
    Calibration,
    Document,
    Record,
    as_html,
    as_pdf,
    as_svg,
    calibration_document,
    calibration_figure,
    can_make_pdf,
    trade_off_figure,
)
from preshape.shaper import Shaper
from preshape.workflow.outdated import set_aside
from preshape.workflow.record import new_record

__all__ = ["SavedCalibration", "make_folders", "save_calibration", "save_design"]

SETTINGS = "settings"
"""The folder below which each firmware has its own."""

PDF = "report.pdf"
TRADE_OFF = "trade_off.svg"
PICKS = ("performance", "quality", "improved")


@dataclass(frozen=True)
class SavedCalibration:
    """Where the files are.

    Parameters
    ----------
    shaper, figure, report : Path
        shaper.json, calibration.svg, report.html.
    pdf : Path or None
        report.pdf, if it was made.
    trade_off : Path or None
        trade_off.svg, if there is a trade-off.
    picks : tuple of Path
        performance.json, quality.json, improved.json, those that exist.
    settings : tuple of Path
        Of every firmware that holds the chosen shaper, each in a folder of its name under settings.
    """

    shaper: Path
    figure: Path
    report: Path
    pdf: Path | None = None
    trade_off: Path | None = None
    picks: tuple[Path, ...] = ()
    settings: tuple[Path, ...] = ()


def save_calibration(
    calibration: Calibration,
    folder: str | os.PathLike[str],
    *,
    command_line: str = "",
    pdf: bool | None = None,
    record: Record | None = None,
) -> SavedCalibration:
    """Write the results into `folder`, which is made if it does not exist.

    Everything is rendered before the first file is written, and each file replaces an older one only when complete.

    Parameters
    ----------
    calibration : Calibration
        From :func:`preshape.workflow.calibrate`.
    folder : path
        Where to.
    command_line : str
        As it was typed, for the report.
    pdf : bool, optional
        Whether to write report.pdf too, which needs Typst; unless given, where that is installed.
    record : Record, optional
        What the report is to say of its making; here and now unless given.

    Raises
    ------
    InputError
        If the folder cannot be made or written, or a PDF is asked for without Typst.
    """
    target = Path(folder)
    trade = calibration.trade_off
    figure = as_svg(calibration_figure(calibration))
    second = None if trade is None else as_svg(trade_off_figure(trade))
    known = record or new_record(calibration.job, calibration.shaper, calibration.inputs, command_line)
    report = calibration_document(calibration, known, figure, second)
    page, sheets = as_html(report), as_pdf(report) if (can_make_pdf() if pdf is None else pdf) else None
    settings = {target / SETTINGS / name: content for text in calibration.texts for name, content in text.files.items()}
    make_folders([target, *sorted({path.parent for path in settings})])
    saved = SavedCalibration(
        shaper=calibration.shaper.save(target / "shaper.json"),
        figure=write_atomically(target / "calibration.svg", figure),
        report=write_atomically(target / "report.html", page),
        pdf=None if sheets is None else write_atomically(target / PDF, sheets),
        trade_off=None if second is None else write_atomically(target / TRADE_OFF, second),
        picks=() if trade is None else tuple(pick.shaper.save(target / f"{pick.name}.json") for pick in trade.picks),
        settings=tuple(write_atomically(path, content) for path, content in settings.items()),
    )
    names = (PDF, TRADE_OFF, *(f"{name}.json" for name in PICKS))
    set_aside(target, names, target / SETTINGS, (saved.pdf, saved.trade_off, *saved.picks, *saved.settings))
    return saved


def save_design(shaper: Shaper, report: Document | None, folder: str | os.PathLike[str]) -> None:
    """Write shaper.json, and report.html and, where Typst is installed, report.pdf, into `folder`, which is made.

    Raises
    ------
    InputError
        If the folder cannot be made or written.
    """
    target = Path(folder)
    pages: dict[str, bytes] = {}
    if report is not None:
        pages["report.html"] = as_html(report).encode()
        if can_make_pdf():
            pages[PDF] = as_pdf(report)
    make_folders([target])
    shaper.save(target / "shaper.json")
    for name, content in pages.items():
        write_atomically(target / name, content)


def make_folders(folders: Iterable[Path]) -> None:
    """Make those that are not there; InputError when one cannot be made."""
    for folder in folders:
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise InputError(
                f"cannot make the folder {folder}: {error.strerror or error}; choose another with --out."
            ) from error
