"""The nearest of a firmware's families, for a shaper that was designed elsewhere.

What counts is what is left of the vibration within 10 % of the shaper's modes, beyond what the shaper itself leaves
there. Settings that leave at most 1 % more count as equal: of them the shaper's own family wins if the firmware has it,
otherwise the shortest. Where none is so good, the one that leaves the least more is taken. Frequencies and damping
ratios are those that will be written, rounding included.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.export.family import Family
from preshape.mode import Modes
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration

__all__ = ["Setting", "nearest_setting"]

AROUND = np.array([0.9, 0.95, 1.0, 1.05, 1.1])
"""A mode may be off by these factors."""

EQUAL = 0.01
"""More vibration [-] than the shaper leaves that does not matter."""

COARSE, FINE, FINEST = 0.02, 0.004, 0.0005
"""Relative steps of the frequency: over the whole range, and around what was best so far."""

ON_SAMPLES, MOST_DAMPINGS = 2, 2
"""Pulses on samples change in steps, and each is made anew: over the whole range only every second frequency is tried,
and of many damping ratios the lowest and the highest."""

KEPT = 6
"""Settings whose frequency is refined."""

OWN = {"two_hump_ei": "2hump_ei", "three_hump_ei": "3hump_ei"}
"""Where a design's name is not the firmware's."""


@dataclass(frozen=True)
class Setting:
    """What a firmware is told.

    Parameters
    ----------
    family : Family
        Of the firmware.
    frequency : float
        [Hz]
    damping : float
        [-]
    parameters : mapping of str to float
        Others that the family takes.
    shaper : Shaper
        As executed.
    excess : float
        The most that is left within 10 % of the modes beyond what the shaper asked for leaves [-].
    """

    family: Family
    frequency: float
    damping: float
    parameters: Mapping[str, float]
    shaper: Shaper
    excess: float

    def sentence(self, name: str, firmware: str) -> str:
        """What was chosen and what it costs, in a sentence; `name` is what the firmware calls it."""
        return (
            f"{firmware} takes no impulses; its nearest setting is {name} at {self.frequency:.2f} Hz, damping "
            f"{self.damping:.4g}: within 10 % of the modes at most {100.0 * self.excess:.2g} % more vibration is left "
            "than by the shaper itself."
        )


def nearest_setting(
    shaper: Shaper,
    families: Mapping[str, Family],
    firmware: str,
    *,
    frequencies: tuple[float, float],
    dampings: tuple[float, float] = (0.0, 0.99),
    instead: str,
) -> Setting:
    """The setting that comes nearest to `shaper`.

    Parameters
    ----------
    shaper : Shaper
        Must know its modes.
    families : mapping of str to Family
        What the firmware has.
    firmware : str
        For messages.
    frequencies, dampings : (float, float)
        Lowest and highest that the firmware takes [Hz], [-].
    instead : str
        What else to do with a shaper that does not know its modes.

    Raises
    ------
    InputError
        If the shaper does not know its modes, or no frequency is in the firmware's range.
    """
    if (modes := shaper.design.modes) is None:
        raise InputError(
            f"this shaper does not say its modes, and {firmware} takes families for a mode, no impulses: {instead}."
        )
    search = _Search(shaper, modes, families, frequencies, dampings)
    found = sorted(search.everywhere(), key=search.rank)[:KEPT]
    if not found:
        raise InputError(
            f"{firmware} takes frequencies from {frequencies[0]:g} to {frequencies[1]:g} Hz, and none of its settings "
            f"there fits modes at {', '.join(f'{mode.frequency:.4g}' for mode in modes)} Hz: {instead}."
        )
    for step, reach in ((FINE, 5), (FINEST, 8)):
        found += [near for one in found[:KEPT] for near in search.around(one, step, reach)]
        found.sort(key=search.rank)
    best = found[0]
    pulses = best.family.pulses(best.frequency, best.damping, **best.parameters)
    return Setting(best.family, best.frequency, best.damping, best.parameters, pulses, best.excess)


class _Tried(NamedTuple):
    """A setting and how it compares."""

    family: Family
    frequency: float
    damping: float
    parameters: Mapping[str, float]
    duration: float
    excess: float


class _Search:
    """The settings that are tried, and their order."""

    def __init__(
        self,
        shaper: Shaper,
        modes: Modes,
        families: Mapping[str, Family],
        frequencies: tuple[float, float],
        dampings: tuple[float, float],
    ) -> None:
        self.families, self.limits, self.dampings = families, frequencies, dampings
        own = shaper.design.family if len(modes) == 1 else ""
        self.own = OWN.get(own, own)
        self.modes = modes
        self.at = np.multiply.outer(np.array([mode.frequency for mode in modes]), AROUND)
        self.damped = np.array([[mode.damping] for mode in modes])
        self.allowed = residual_vibration(shaper, self.at, self.damped)

    def rank(self, one: _Tried) -> tuple[bool, bool, float, float]:
        good = one.excess <= EQUAL
        if good and one.family.name == self.own and not one.parameters:  # then as the shaper was designed
            return False, False, abs(one.frequency - self.modes[0].frequency), one.excess
        return not good, True, one.duration if good else one.excess, one.excess

    def everywhere(self) -> Iterator[_Tried]:
        """Every family, over the range of the modes' frequencies, with their damping ratios."""
        each = np.array([mode.frequency for mode in self.modes])
        low, high = float(each.min() * AROUND[0]), float(each.max() * AROUND[-1])
        count = math.ceil(math.log(high / low) / COARSE)
        frequencies = np.concatenate([each, low * np.exp(COARSE * np.arange(count + 1))])
        ratios = {round(min(max(mode.damping, self.dampings[0]), self.dampings[1]), 4) for mode in self.modes}
        sampled = np.concatenate([each, frequencies[each.size :: ON_SAMPLES]])
        few = ratios if len(ratios) <= MOST_DAMPINGS else {min(ratios), max(ratios)}
        for family in self.families.values():
            tried, at = (ratios, frequencies) if family.scales else (few, sampled)
            for parameters in family.parameters():
                for damping in sorted({min(ratio, family.maximum_damping) for ratio in tried}):
                    yield from self._tried(family, at, damping, parameters)

    def around(self, one: _Tried, step: float, reach: int) -> Iterator[_Tried]:
        """The same setting at frequencies close by."""
        offsets = np.arange(-reach, reach + 1, dtype=np.float64)
        frequencies = one.frequency * (1.0 + step * offsets)
        yield from self._tried(one.family, frequencies, one.damping, one.parameters)

    def _tried(
        self, family: Family, frequencies: NDArray[np.float64], damping: float, parameters: Mapping[str, float]
    ) -> Iterator[_Tried]:
        """Settings as they will be written, but those that the firmware refuses."""
        rounded = np.unique(np.round(frequencies, 2))
        rounded = rounded[(self.limits[0] <= rounded) & (rounded <= self.limits[1])]
        for group in [rounded] if family.scales else rounded[:, np.newaxis]:
            if not group.size:
                continue
            reference = 1.0 if family.scales else float(group[0])
            try:
                pulses = family.pulses(reference, damping, **parameters)
            except InputError:
                continue
            at = self.at * (reference / group[:, np.newaxis, np.newaxis])
            excess = (residual_vibration(pulses, at, self.damped) - self.allowed).max(axis=(1, 2))
            unit = pulses.duration * reference
            for frequency, more in zip(group.tolist(), excess.tolist(), strict=True):
                yield _Tried(family, frequency, damping, parameters, unit / frequency, max(more, 0.0))
