"""One style for all figures: units, colours that stay apart in grey print and for the colour-blind, no global state."""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import TYPE_CHECKING, TypeAlias

from preshape.errors import InputError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = [
    "ACCENT",
    "GREEN",
    "INK",
    "MUTED",
    "PALE",
    "SECOND",
    "SERIES",
    "SOFT",
    "WINE",
    "as_svg",
    "figure_bytes",
    "figure_format",
    "new_figure",
    "tidy",
]

Line: TypeAlias = str | tuple[int, tuple[int, ...]]
"""A line style of matplotlib: its name, or the lengths of dashes and gaps."""

FORMATS = ("svg", "png", "pdf")

DOTS_PER_INCH = 150

INK = "#1a1a1a"
ACCENT = "#0b5fa5"
"""The shaper that was chosen: dark blue, dark grey in print."""
SECOND = "#d1690e"
"""What it is compared with: orange, mid grey in print; always dashed as well."""
GREEN, WINE = "#1ca55d", "#722955"
MUTED = "#8a8a8a"
SOFT = "#d9d9d9"
PALE = "#f3f3f3"
"""Behind curves: a stretch of time or of frequency that is spoken of."""

SERIES: tuple[tuple[str, Line, float], ...] = (
    (ACCENT, "-", 2.2),
    (SECOND, "--", 1.8),
    (INK, ":", 1.9),
    (GREEN, "-.", 1.8),
    (WINE, (0, (6, 1, 1, 1, 1, 1)), 1.6),
    (MUTED, (0, (8, 2)), 1.4),
)
"""Colour, line and width of the curves of one figure, in order: each has a line of its own, for grey print, and the
colours were chosen to stay apart for people who do not see red, green or blue (tests/report/test_figure_style.py)."""


def new_figure(width: float, height: float) -> Figure:
    """An empty figure, width and height in inches, that belongs to nobody."""
    from matplotlib.figure import Figure

    return Figure(figsize=(width, height), layout="constrained", facecolor="white")


def tidy(axes: Axes, x_label: str, y_label: str, title: str) -> None:
    """Labels, light grid, no box."""
    axes.set_title(title, loc="left", fontsize=10.5, color=INK, fontweight="bold")
    axes.set_xlabel(x_label, fontsize=9.5, color=INK)
    axes.set_ylabel(y_label, fontsize=9.5, color=INK)
    axes.tick_params(labelsize=9, colors=INK)
    axes.grid(True, color="#ececec", linewidth=0.8)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def as_svg(figure: Figure) -> str:
    """The figure as one <svg> element, a file by itself; the same bytes for the same figure."""
    from matplotlib import rc_context

    buffer = io.StringIO()
    with rc_context({"svg.hashsalt": "preshape"}):
        figure.savefig(buffer, format="svg", metadata={"Date": None})
    text = buffer.getvalue()
    return text[text.index("<svg") :]


def figure_format(path: str | os.PathLike[str]) -> str:
    """The kind of figure that a file name asks for, "svg", "png" or "pdf"; InputError for another."""
    kind = Path(path).suffix.lower().removeprefix(".")
    if kind not in FORMATS:
        raise InputError(f"{path} names no kind of figure: end it in .svg, .png or .pdf.")
    return kind


def figure_bytes(figure: Figure, kind: str) -> bytes:
    """The figure as a file of a kind that :func:`figure_format` names; the same bytes for the same figure."""
    if kind == "svg":
        return as_svg(figure).encode()
    buffer = io.BytesIO()
    metadata = {"CreationDate": None} if kind == "pdf" else {"Software": None}
    figure.savefig(buffer, format=kind, dpi=DOTS_PER_INCH, metadata=metadata)
    return buffer.getvalue()
