"""What a report says, before it is a page or sheets of paper: its parts in their order, and what it was made from.

Two renderers take it: :func:`preshape.report.as_html` and :func:`preshape.report.as_pdf`.
"""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass
from typing import Literal, TypeAlias

from preshape.report.record import Record
from preshape.report.tables import TextTable

__all__ = ["Document", "Heading", "Paragraph", "Part", "Picture", "RowKind", "Table", "Verbatim", "printable"]

Role: TypeAlias = Literal["plain", "lead", "label", "warning"]

RowKind: TypeAlias = Literal["", "chosen", "excluded", "fragile"]


UNPRINTABLE = ("Cc", "Cf", "Cs")
"""Controls, marks of format, and halves of characters."""


@dataclass(frozen=True)
class Heading:
    """Of a section."""

    text: str


@dataclass(frozen=True)
class Paragraph:
    """Text; the lead stands larger under the title, a label is bold, a warning is marked."""

    text: str
    role: Role = "plain"


@dataclass(frozen=True)
class Table:
    """A table; its first `left` columns are text, the others numbers, and some rows stand out."""

    table: TextTable
    kinds: tuple[RowKind, ...] = ()
    left: int = 1

    def rows(self) -> list[tuple[RowKind, tuple[str, ...]]]:
        """Each row after its kind."""
        plain: tuple[RowKind, ...] = ("",)
        kinds = self.kinds or plain * len(self.table.rows)
        return list(zip(kinds, self.table.rows, strict=True))


@dataclass(frozen=True)
class Picture:
    """A figure as one <svg> element (:func:`preshape.report.as_svg`), and what it shows in words."""

    svg: str
    description: str


@dataclass(frozen=True)
class Verbatim:
    """Text to be copied as it is."""

    text: str


Part: TypeAlias = Heading | Paragraph | Table | Picture | Verbatim


@dataclass(frozen=True)
class Document:
    """A report.

    Parameters
    ----------
    title : str
        The one thing to take away.
    subject : str
        What the report is about, for the title of the window and of the file.
    parts : tuple of Part
        In their order.
    foot : str
        Small print at the end.
    record : Record
        From what and by what it was made; it travels in the file.
    """

    title: str
    subject: str
    parts: tuple[Part, ...]
    foot: str
    record: Record


def printable(text: str) -> str:
    """`text` without what no page can show: controls, marks that turn the direction of writing, halves of characters.

    File names may hold all of these; each is shown as a replacement character.
    """
    return "".join(
        "\N{REPLACEMENT CHARACTER}"
        if character not in "\n\t" and unicodedata.category(character) in UNPRINTABLE
        else character
        for character in text
    )
