"""What a reproduction leaves in a folder: each figure as SVG, and the page that shows table and figures."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from importlib.metadata import version
from pathlib import Path

from preshape.errors import InputError
from preshape.files import write_atomically
from preshape.papers.page import reproduction_page
from preshape.papers.reproduction import Reproduction
from preshape.report import as_svg

__all__ = ["save_reproductions"]


def save_reproductions(
    reproductions: Sequence[Reproduction],
    folder: str | os.PathLike[str],
    progress: Callable[[str], None] = lambda words: None,
) -> Path:
    """Draw the figures and write them and the page into `folder`, which is made if it does not exist.

    Parameters
    ----------
    reproductions : sequence of Reproduction
        The papers.
    folder : path-like
        Where to.
    progress : callable
        Told what is being drawn.

    Returns
    -------
    Path
        The page, index.html.

    Raises
    ------
    InputError
        If the folder cannot be made or written.
    """
    target = Path(folder)
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(
            f"cannot make the folder {target}: {error.strerror or error}; choose another with --out."
        ) from error
    for reproduction in reproductions:
        for figure in reproduction.figures:
            progress(f"{reproduction.paper}: drawing figure {figure.number} ...")
            write_atomically(target / reproduction.file_name(figure), as_svg(figure.draw()))
    return write_atomically(target / "index.html", reproduction_page(reproductions, version("preshape")))
