"""The modes of several measurements of one machine as one list."""

from __future__ import annotations

from collections.abc import Sequence

from preshape.identify.identification import Identification, IdentifiedMode
from preshape.mode import Mode

__all__ = ["merged_modes"]

SAME_MODE = 0.05
"""Modes of two files that differ by less than this fraction of their frequency are one mode."""

SMALLEST_SHARE = 0.01
"""A mode with less of the vibration's power than this (a tenth of its amplitude) is not worth impulses of its own."""


def merged_modes(identifications: Sequence[Identification], maximum: int = 4) -> tuple[IdentifiedMode, ...]:
    """Modes over all files, the most important first, at most `maximum`.

    Modes near each other are averaged, weighted by their share, and their intervals joined: a machine that changes
    between measurements is known no better than that. Shares are averaged over all files.
    """
    found = sorted(
        (mode for identification in identifications for mode in identification.modes),
        key=lambda mode: mode.mode.frequency,
    )
    groups: list[list[IdentifiedMode]] = []
    for mode in found:
        if (
            groups
            and mode.mode.frequency <= groups[-1][-1].mode.frequency * (1.0 + SAME_MODE)
            and _other_file(identifications, groups[-1], mode)
        ):
            groups[-1].append(mode)
        else:
            groups.append([mode])
    merged = [_average(group, len(identifications)) for group in groups]
    merged.sort(key=lambda mode: -mode.share)
    return tuple(mode for mode in merged if mode.share >= SMALLEST_SHARE)[:maximum]


def _other_file(identifications: Sequence[Identification], group: list[IdentifiedMode], mode: IdentifiedMode) -> bool:
    """Whether `mode` comes from another file than all of the group: two close modes of one file stay two."""
    home = next(i for i in identifications if any(mode is other for other in i.modes))
    return not any(member is other for member in group for other in home.modes)


def _average(group: list[IdentifiedMode], files: int) -> IdentifiedMode:
    total = sum(mode.share for mode in group)
    weights = [mode.share / total if total > 0.0 else 1.0 / len(group) for mode in group]
    return IdentifiedMode(
        mode=Mode(
            sum(w * mode.mode.frequency for w, mode in zip(weights, group, strict=True)),
            sum(w * mode.mode.damping for w, mode in zip(weights, group, strict=True)),
        ),
        frequency_interval=(
            min(mode.frequency_interval[0] for mode in group),
            max(mode.frequency_interval[1] for mode in group),
        ),
        damping_interval=(
            min(mode.damping_interval[0] for mode in group),
            max(mode.damping_interval[1] for mode in group),
        ),
        share=total / files,
    )
