"""A report as PDF, set by Typst: vector figures, Typst's own fonts, the record attached.

The sheet is a fixed text (sheet.typ). What a report says goes to it as data, and no text in it becomes markup.
"""

from __future__ import annotations

from importlib.resources import files
from importlib.util import find_spec
from typing import Any

import msgspec

from preshape.errors import InputError
from preshape.report.document import Document, Heading, Paragraph, Part, Picture, Table, Verbatim, printable

__all__ = ["RECORD_NAME", "as_pdf", "can_make_pdf"]

RECORD_NAME = "preshape-report.json"
"""Of the attachment that holds the record."""


def can_make_pdf() -> bool:
    """Whether Typst is installed."""
    return find_spec("typst") is not None


def as_pdf(document: Document) -> bytes:
    """The report as PDF, A4, the same bytes for the same document.

    Parameters
    ----------
    document : Document
        From :func:`preshape.workflow.design_report` or :func:`preshape.workflow.calibration_report`.

    Raises
    ------
    InputError
        If Typst is not installed.
    """
    if not can_make_pdf():
        raise InputError("a PDF needs Typst, which is not installed: pip install 'preshape[pdf]', or take HTML.")
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
