"""What a campaign says of its points: numbers, panels of a figure, failures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

__all__ = ["CampaignPanel", "CampaignSummary", "Cloud", "Curves", "Field"]

Samples: TypeAlias = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Curves:
    """Lines over a common axis.

    Attributes
    ----------
    title, x_label, y_label : str
        Labels with their units.
    curves : tuple of (str, ndarray, ndarray)
        Name, x and y, each of shape (point,).
    logarithmic : bool
        Whether the x axis is.
    """

    title: str
    x_label: str
    y_label: str
    curves: tuple[tuple[str, Samples, Samples], ...]
    logarithmic: bool = False


@dataclass(frozen=True, eq=False)
class Field:
    """A value over two parameters.

    Attributes
    ----------
    title, x_label, y_label : str
        Labels with their units; the title's is that of the values.
    x, y : ndarray, shapes (column,), (row,)
    values : ndarray, shape (row, column)
        NaN where there is none.
    """

    title: str
    x_label: str
    y_label: str
    x: Samples
    y: Samples
    values: Samples


@dataclass(frozen=True, eq=False)
class Cloud:
    """Points.

    Attributes
    ----------
    title, x_label, y_label : str
        Labels with their units.
    x, y : ndarray, shape (point,)
    """

    title: str
    x_label: str
    y_label: str
    x: Samples
    y: Samples


CampaignPanel: TypeAlias = Curves | Field | Cloud
"""One panel of a campaign's figure."""


@dataclass(frozen=True, eq=False)
class CampaignSummary:
    """A campaign, as far as it is done.

    Attributes
    ----------
    title : str
        What it computes.
    points, done : int
        How many there are, how many of them have a result.
    numbers : tuple of (str, str)
        What, and its value with its unit.
    panels : tuple of CampaignPanel
    failures : tuple of (str, int)
        What was wrong, and with how many points, the most frequent first.
    notes : tuple of str
        What must be known to read it.
    """

    title: str
    points: int
    done: int
    numbers: tuple[tuple[str, str], ...]
    panels: tuple[CampaignPanel, ...]
    failures: tuple[tuple[str, int], ...]
    notes: tuple[str, ...]

    @property
    def failed(self) -> int:
        """How many points failed."""
        return sum(count for _, count in self.failures)

    @property
    def sentence(self) -> str:
        """How far it is."""
        open_ones = self.points - self.done - self.failed
        left = [f"{self.failed} failed"] * bool(self.failed) + [f"{open_ones} are open"] * bool(open_ones)
        return f"{self.title}: {self.done} of {self.points} points done" + "".join(f", {one}" for one in left)
