"""Kind: what a campaign computes, point by point, and what it says of all of them. The contract of this room.

A kind knows its points by number. The same number gives the same row in any process, in any order: what is random is
drawn from `numpy.random.SeedSequence(seed)`'s child of that number. Adding a kind is a file and a line in `kinds.py`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np
from numpy.typing import NDArray

from preshape.report import CampaignPanel

__all__ = ["Column", "Kind", "Results", "Row", "Told", "random_of"]

Row: TypeAlias = Mapping[str, float | str]
"""What a point gives, by column."""


@dataclass(frozen=True)
class Column:
    """A column of the results: its name, its unit, and whether it holds text instead of numbers."""

    name: str
    unit: str
    text: bool = False


@dataclass(frozen=True, eq=False)
class Results:
    """The finished points of a campaign.

    Attributes
    ----------
    points : ndarray of int, shape (point,)
        Their numbers, increasing.
    numbers : mapping of str to ndarray, shape (point,)
        By column [its unit].
    texts : mapping of str to list of str
        By column.
    failed : mapping of int to str
        What was wrong, by the number of the point; those are in none of the others.
    """

    points: NDArray[np.int64]
    numbers: Mapping[str, NDArray[np.float64]]
    texts: Mapping[str, list[str]]
    failed: Mapping[int, str]


@dataclass(frozen=True, eq=False)
class Told:
    """What a kind says of its results.

    Attributes
    ----------
    numbers : tuple of (str, str)
        What, and its value with unit: the rows of a table.
    panels : tuple of CampaignPanel
        Of the figure.
    files : mapping of str to bytes
        More to be written, by name.
    notes : tuple of str
        What must be known to read it.
    """

    numbers: tuple[tuple[str, str], ...]
    panels: tuple[CampaignPanel, ...]
    files: Mapping[str, bytes]
    notes: tuple[str, ...] = ()


class Kind(Protocol):
    """One kind of campaign, ready to compute.

    Attributes
    ----------
    title : str
        What it is, in a few words.
    count : int
        How many points it has.
    columns : tuple of Column
        Of its results, in order.
    """

    @property
    def title(self) -> str: ...

    @property
    def count(self) -> int: ...

    @property
    def columns(self) -> tuple[Column, ...]: ...

    def row(self, point: int) -> Row:
        """What a point gives, 0 <= point < count; whatever it raises is recorded as that point's failure."""

    def told(self, results: Results) -> Told:
        """What the results say; at least one point is finished."""


def random_of(seed: int, point: int) -> np.random.Generator:
    """The random numbers of a point: child `point` of the seed, whoever computes it.

    Examples
    --------
    >>> child = np.random.SeedSequence(7).spawn(3)[2]
    >>> bool(random_of(7, 2).random() == np.random.default_rng(child).random())
    True
    """
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(point,)))
