"""The fewest subsets of the modes that each have an antiperiod, and of these the shortest in sum.

With exact frequencies "has an antiperiod with" sorts the modes into classes (the ratio of two odd fractions is one
again), and the classes are the answer. Within a tolerance it does not: so up to ten modes every partition is
considered; with more, pairs without an antiperiod are kept apart first, and each group of linked modes is then divided
in the same way, or one mode after the other when it is still too large.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from preshape.design.antiperiod.analysis import antiperiodic
from preshape.design.antiperiod.common_frequency import CommonFrequency
from preshape.mode import Mode

__all__ = ["Partition", "Subset", "fewest_subsets"]

EVERY_PARTITION = 10
"""Up to this many modes every subset is tested: 1023 of them take about 0.2 s."""


@dataclass(frozen=True)
class Subset:
    """Modes that have an antiperiod: their positions in the list of all modes, and their common frequency."""

    indices: tuple[int, ...]
    common: CommonFrequency


@dataclass(frozen=True)
class Partition:
    """All modes, sorted into subsets.

    Parameters
    ----------
    subsets : tuple of Subset
        In the order of their first modes.
    search : str
        "all modes" when one subset holds them all, "every partition" when the number of subsets is the smallest
        possible, "linked pairs" when there were too many modes to be sure of that.
    """

    subsets: tuple[Subset, ...]
    search: str


def fewest_subsets(modes: Sequence[Mode], frequency_tolerance: float, duration: Callable[[Subset], float]) -> Partition:
    """Sort `modes` into subsets with an antiperiod; of equal counts the smallest sum of `duration` [s] wins."""
    everything = tuple(range(len(modes)))

    def subset(indices: tuple[int, ...]) -> Subset | None:
        common = antiperiodic([modes[i] for i in indices], frequency_tolerance)
        return None if common is None else Subset(indices, common)

    together = subset(everything)
    if together is not None:
        return Partition((together,), "all modes")
    if len(modes) <= EVERY_PARTITION:
        return Partition(_best_partition(everything, subset, duration), "every partition")
    found: list[Subset] = []
    for group in _linked(everything, subset):
        whole = subset(group)
        if whole is not None:
            found.append(whole)
        elif len(group) <= EVERY_PARTITION:
            found += _best_partition(group, subset, duration)
        else:
            found += _one_after_the_other(group, subset)
    return Partition(tuple(sorted(found, key=lambda one: one.indices)), "linked pairs")


def _best_partition(
    indices: tuple[int, ...],
    subset: Callable[[tuple[int, ...]], Subset | None],
    duration: Callable[[Subset], float],
) -> tuple[Subset, ...]:
    """Fewest subsets, then shortest: over all sets of modes, the smaller ones first."""
    count = len(indices)
    blocks: dict[int, tuple[Subset, float]] = {}
    for mask in range(1, 1 << count):
        one = subset(tuple(indices[i] for i in range(count) if mask >> i & 1))
        if one is not None:
            blocks[mask] = (one, duration(one))
    best: dict[int, tuple[int, float, tuple[Subset, ...]]] = {0: (0, 0.0, ())}
    for mask in range(1, 1 << count):
        first = mask & -mask
        choices = []
        part = mask
        while part:
            if part & first and part in blocks:
                one, length = blocks[part]
                number, total, rest = best[mask ^ part]
                choices.append((number + 1, total + length, (one, *rest)))
            part = (part - 1) & mask
        best[mask] = min(choices, key=lambda choice: choice[:2])
    return best[(1 << count) - 1][2]


def _linked(indices: tuple[int, ...], subset: Callable[[tuple[int, ...]], Subset | None]) -> list[tuple[int, ...]]:
    """Groups of modes that are linked by pairs with an antiperiod, directly or through others."""
    groups: list[list[int]] = []
    for index in indices:
        near = [group for group in groups if any(subset((other, index)) is not None for other in group)]
        groups = [group for group in groups if group not in near]
        groups.append(sorted([index, *(other for group in near for other in group)]))
    return [tuple(group) for group in groups]


def _one_after_the_other(group: tuple[int, ...], subset: Callable[[tuple[int, ...]], Subset | None]) -> list[Subset]:
    """Each mode joins the first subset that still has an antiperiod with it."""
    found: list[Subset] = []
    for index in group:
        for place, one in enumerate(found):
            joined = subset((*one.indices, index))
            if joined is not None:
                found[place] = joined
                break
        else:
            alone = subset((index,))
            if alone is not None:  # a mode alone always has one
                found.append(alone)
    return found
