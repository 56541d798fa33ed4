"""What reproducing a paper gives: rows of printed and computed values with a verdict, and the figures.

A verdict is computed, never typed in: rows are made by the functions of :mod:`preshape.papers.rows`, which compare. A
row is never left out because it differs; it says why, and a difference that nothing explains is a fault, of the
paper's reader or of this library.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeAlias

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Drawing

__all__ = ["VERDICTS", "Figure", "Paper", "Reproduction", "Row", "Verdict"]

Verdict: TypeAlias = Literal["reproduced", "differs", "beyond the paper"]

VERDICTS: tuple[Verdict, ...] = ("reproduced", "differs", "beyond the paper")


@dataclass(frozen=True)
class Row:
    """One checkable statement of a paper.

    Parameters
    ----------
    source : str
        Where it stands: equation, figure, table or section of the paper.
    what : str
        What is stated.
    printed, computed : str
        The paper's value or words, and ours, with units.
    verdict : str
        "reproduced"; "differs", which needs an explanation; or "beyond the paper", where the paper is silent.
    explanation : str
        Why it differs; of another row, what was assumed.
    """

    source: str
    what: str
    printed: str
    computed: str
    verdict: Verdict
    explanation: str = ""

    @property
    def explained(self) -> bool:
        """False for a difference without its explanation."""
        return self.verdict != "differs" or bool(self.explanation.strip())


@dataclass(frozen=True)
class Figure:
    """A figure of a paper, drawn anew from what its caption and the text say.

    Parameters
    ----------
    number : str
        The paper's number of it, such as "3.12"; part of the file name.
    caption : str
        The paper's caption, shortened where it is long, and in square brackets what we chose because it does not say.
    draw : callable
        Returns the matplotlib figure.
    """

    number: str
    caption: str
    draw: Callable[[], Drawing]


@dataclass(frozen=True)
class Reproduction:
    """A paper recomputed.

    Parameters
    ----------
    paper : str
        Its short name, which also names the files.
    title : str
        Authors, title, year.
    rows : tuple of Row
        In the order of the paper.
    figures : tuple of Figure
        In the order of the paper.
    """

    paper: str
    title: str
    rows: tuple[Row, ...]
    figures: tuple[Figure, ...]

    @property
    def explained(self) -> bool:
        """Whether every difference has its explanation."""
        return all(row.explained for row in self.rows)

    def count(self, verdict: Verdict) -> int:
        """How many rows have this verdict."""
        return sum(row.verdict == verdict for row in self.rows)

    def file_name(self, figure: Figure) -> str:
        """Name of the file that holds a figure."""
        return f"{self.paper}-{figure.number}.svg"


@dataclass(frozen=True)
class Paper:
    """A paper that can be reproduced: its short name, its title, and the function that does it."""

    name: str
    title: str
    contents: Callable[[], tuple[list[Row], list[Figure]]]

    def reproduce(self) -> Reproduction:
        """Recompute every row; the figures are drawn when they are asked for."""
        rows, figures = self.contents()
        return Reproduction(self.name, self.title, tuple(rows), tuple(figures))
