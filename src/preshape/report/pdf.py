"""A report as PDF, set by Typst: vector figures, Typst's own fonts, the record attached.

The sheet is a fixed text (sheet.typ). What a report says goes to it as data, and no text in it becomes markup.
"""

from __future__ import annotations

import os
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import msgspec

from preshape.errors import InputError
from preshape.report.document import Document, Heading, Paragraph, Part, Picture, Table, Verbatim, printable
from preshape.report.html import as_html

__all__ = ["as_pdf", "can_make_pdf", "report_bytes", "report_format"]

FORMATS = ("html", "pdf")

RECORD_NAME = "preshape-report.json"
"""Of the attachment that holds the record."""


def can_make_pdf() -> bool:
    """Whether Typst is installed."""
    return find_spec("typst") is not None


def report_format(path: str | os.PathLike[str]) -> str:
    """The kind of report that a file name asks for, "html" or "pdf"; InputError for another, or without Typst."""
    kind = Path(path).suffix.lower().removeprefix(".")
    if kind not in FORMATS:
        raise InputError(f"{path} names no kind of report: end it in .html or .pdf.")
    if kind == "pdf":
        _check_typst()
    return kind


def report_bytes(document: Document, kind: str) -> bytes:
    """The report as a file of a kind that :func:`report_format` names."""
    return as_html(document).encode() if kind == "html" else as_pdf(document)


def as_pdf(document: Document) -> bytes:
    """The report as PDF, A4, the same bytes for the same document.

    Parameters
    ----------
    document : Document
        From :func:`preshape.workflow.design_report` or :func:`preshape.report.calibration_document`.

    Raises
    ------
    InputError
        If Typst is not installed.
    """
    _check_typst()
    import typst

    data = {
        "title": printable(document.title),
        "subject": printable(document.subject),
        "foot": printable(document.foot),
        "made": document.record.made,
        "record": RECORD_NAME,
        "parts": [_part(part) for part in document.parts],
    }
    return typst.compile(
        files("preshape.report").joinpath("sheet.typ").read_bytes(),
        format="pdf",
        ignore_system_fonts=True,
        sys_inputs={"document": msgspec.json.encode(data).decode(), "record": document.record.json()},
    )


def _check_typst() -> None:
    if not can_make_pdf():
        raise InputError("a PDF needs Typst, which is not installed: pip install 'preshape[pdf]', or take HTML.")


def _part(part: Part) -> dict[str, Any]:
    """A part as the sheet takes it."""
    match part:
        case Heading(text):
            return {"kind": "heading", "text": printable(text)}
        case Paragraph(text, role):
            return {"kind": role, "text": printable(text)}
        case Picture(svg, description):
            return {"kind": "picture", "svg": svg, "text": printable(description)}
        case Verbatim(text):
            return {"kind": "verbatim", "text": printable(text)}
        case Table(table, _, left):
            return {
                "kind": "table",
                "left": left,
                "titles": [printable("\n".join(title)) for title in table.titles],
                "rows": [{"kind": kind, "cells": [printable(cell) for cell in row]} for kind, row in part.rows()],
            }
