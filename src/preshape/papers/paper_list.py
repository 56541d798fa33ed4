"""The papers that can be reproduced: adding one is a file, or a folder, and a line here."""

from __future__ import annotations

from collections.abc import Iterable

from preshape.errors import InputError
from preshape.papers.hyde import HYDE
from preshape.papers.reproduction import Paper
from preshape.papers.robertson import ROBERTSON
from preshape.papers.singer import SINGER
from preshape.papers.singh import SINGH
from preshape.papers.slides import SLIDES

__all__ = ["PAPERS", "papers_named"]

PAPERS: tuple[Paper, ...] = (HYDE, SINGER, SINGH, SLIDES, ROBERTSON)
"""The papers, in the order in which `preshape reproduce` shows them."""


def papers_named(names: Iterable[str] = ()) -> list[Paper]:
    """The papers of these names, each once and in the order of the list; all of them when no name is given.

    Raises
    ------
    InputError
        If a name is unknown; the sentence lists the names there are.

    Examples
    --------
    >>> [paper.name for paper in papers_named(["slides", "hyde"])]
    ['hyde', 'slides']
    """
    wanted = list(names)
    known = [paper.name for paper in PAPERS]
    for name in wanted:
        if name not in known:
            raise InputError(
                f"there is no paper {name!r} to reproduce: name one of {', '.join(known)}, or none for all."
            )
    return [paper for paper in PAPERS if not wanted or paper.name in wanted]
