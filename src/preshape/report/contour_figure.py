"""The figure of a shaped path: where it runs, how it leaves the curve at the worst place, and along the way."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from preshape.errors import InputError
from preshape.report.figures import INK, MUTED, SERIES, SOFT, new_figure, tidy

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from preshape.command.path import ContourError, ShapedPath

__all__ = ["contour_figure"]

MOST_PATHS = 3

AROUND = 2.5
"""Half the width of the enlarged place, over the largest error."""

ROUNDING = 1e-9
"""Errors below this part of the path's size are none."""


def contour_figure(paths: Mapping[str, ShapedPath], *, names: Sequence[str] = ("x", "y"), unit: str = "") -> Figure:
    """The whole path, the place of the largest contour error enlarged, and the error along the path.

    Parameters
    ----------
    paths : mapping of str to ShapedPath
        Up to three shaped versions of the same commanded path, by what they are called.
    names : sequence of str
        Of the axes; the first two are drawn.
    unit : str
        Of all axes.

    Raises
    ------
    InputError
        If there are none or more than three, or a path has a single axis.
    """
    if not 1 <= len(paths) <= MOST_PATHS:
        raise InputError(f"{len(paths)} paths were given: the figure shows one to {MOST_PATHS}.")
    if min(len(path.commanded) for path in paths.values()) < 2:
        raise InputError("a path of one axis is no curve to draw: give two axes or more.")
    errors = {label: path.contour_error() for label, path in paths.items()}
    worst = max(errors.values(), key=lambda error: error.largest)
    figure = new_figure(10.0, 7.0)
    grid = figure.add_gridspec(2, 2, height_ratios=[1.5, 1.0])
    whole, close, along = (figure.add_subplot(place) for place in (grid[0, 0], grid[0, 1], grid[1, :]))
    commanded = next(iter(paths.values())).commanded
    whole.plot(commanded[0], commanded[1], color=INK, linewidth=1.4)
    whole.set_aspect("equal", adjustable="datalim")
    _paths(close, paths)
    close.set_aspect("equal", adjustable="box")
    size = float(np.ptp(commanded, axis=1).max())
    width = AROUND * worst.largest if worst.largest > ROUNDING * size else 0.1 * size
    centre = worst.nearest[:2, worst.index]
    close.set_xlim(centre[0] - width, centre[0] + width)
    close.set_ylim(centre[1] - width, centre[1] + width)
    whole.plot(*centre, "o", color=INK, markersize=9, fillstyle="none", markeredgewidth=1.4)
    across, up = (_with_unit(name, unit) for name in names[:2])
    tidy(whole, across, up, "The path; a ring where the error is largest")
    tidy(close, across, up, f"There, {_factor(size / (2.0 * width))} times enlarged")
    for (label, path), (colour, line, thick) in zip(paths.items(), SERIES, strict=False):
        way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(path.shaped, axis=1), axis=0))])
        text = f"{label}: at most {_amount(errors[label], unit, size)}"
        along.plot(way, errors[label].distances, color=colour, linestyle=line, linewidth=thick, label=text)
    along.margins(x=0.0)
    along.set_ylim(bottom=0.0, top=1.35 * worst.largest if worst.largest > ROUNDING * size else ROUNDING * size)
    along.legend(fontsize=9, frameon=False, loc="upper center", ncols=len(paths))
    tidy(
        along, _with_unit("way along the path", unit), _with_unit("contour error", unit), "How far it leaves the curve"
    )
    return figure


def _paths(axes: Axes, paths: Mapping[str, ShapedPath]) -> None:
    commanded = next(iter(paths.values())).commanded
    axes.plot(commanded[0], commanded[1], color=SOFT, linewidth=6.0, solid_capstyle="round")
    axes.plot(commanded[0], commanded[1], color=MUTED, linewidth=0.8)
    for path, (colour, line, thick) in zip(paths.values(), SERIES, strict=False):
        axes.plot(path.shaped[0], path.shaped[1], color=colour, linestyle=line, linewidth=thick)


def _amount(error: ContourError, unit: str, size: float) -> str:
    return f"{error.largest:.3g} {unit}".rstrip() if error.largest > ROUNDING * size else "nothing"


def _factor(value: float) -> str:
    return f"{value:.2g}" if value < 100.0 else f"{value:.0f}"


def _with_unit(name: str, unit: str) -> str:
    return f"{name} [{unit}]" if unit else name
