"""Panels over a grid: a line over one axis, a map over the first two."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.campaign.grid import Grid
from preshape.report import CampaignPanel, Curves, Field

__all__ = ["grid_panel"]


def grid_panel(grid: Grid, points: NDArray[np.int64], values: NDArray[np.float64], title: str) -> CampaignPanel:
    """One result over the grid.

    Parameters
    ----------
    grid : Grid
        Of one axis or more; those after the second stand at their first values.
    points : ndarray of int, shape (point,)
        Whose values there are.
    values : ndarray, shape (point,)
        [As the title says.]
    title : str
        What they are, with their unit.
    """
    full = np.full(len(grid), np.nan)
    full[points] = values
    shaped = full.reshape(grid.shape)
    labels = [f"{name} [{unit}]" if unit else name for name, unit in grid.units.items()]
    axes = list(grid.axes.values())
    if len(axes) == 1:
        return Curves(title, labels[0], title, ((title.split(" [")[0], axes[0], shaped),))
    while shaped.ndim > 2:
        shaped = shaped[..., 0]
    return Field(title, labels[0], labels[1], axes[0], axes[1], shaped.T)
