"""A family of a firmware: a name, a frequency and a damping ratio, and the pulses that the firmware makes of them.

Most firmwares take no impulses, only these three words. Their pulses are not the exact designs of
:mod:`preshape.design`: use these to know what a machine does, those to design.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from preshape.checks import tolerance_of
from preshape.design.each_mode import recorded
from preshape.errors import InputError
from preshape.mode import Mode, Modes
from preshape.provenance import Design
from preshape.shaper import Shaper

__all__ = ["Family", "evenly_spaced", "executed", "family_of", "undamped_humps"]


@dataclass(frozen=True)
class Family:
    """A family of a firmware.

    Parameters
    ----------
    name : str
        What the firmware calls it.
    pulses : callable
        (frequency [Hz], damping [-], **parameters) -> Shaper, as executed; InputError where the firmware would refuse.
    maximum_damping : float
        Largest damping ratio [-] that the firmware takes.
    parameters : callable
        () -> settings of further parameters that are worth trying, the firmware's defaults first.
    scales : bool
        Whether twice the frequency gives the same pulses in half the time, as it does without a sample grid.
    """

    name: str
    pulses: Callable[..., Shaper]
    maximum_damping: float = 0.99
    parameters: Callable[[], Iterable[Mapping[str, float]]] = field(default=lambda: ({},))
    scales: bool = True


def family_of(families: Mapping[str, Family], name: str, firmware: str) -> Family:
    """The family of this name; InputError naming those that the firmware has."""
    if name not in families:
        raise InputError(f"{firmware} has no shaper {name[:40]!r}: it has {', '.join(families)}.")
    return families[name]


def executed(firmware: str, family: str, mode: Mode | None, times: ArrayLike, amplitudes: ArrayLike) -> Shaper:
    """The pulses with their record: by whom, of which family, for which mode, and what they leave of it."""
    modes = None if mode is None else Modes(mode)
    design = Design(family=family, modes=modes, settings={"executed_by": firmware})
    return recorded(Shaper.normalised(times, amplitudes, design), design)


def evenly_spaced(
    firmware: str,
    family: str,
    mode: Mode,
    weights: Sequence[float],
    *,
    spacing: float = 0.5,
    decay: float | None = None,
) -> Shaper:
    """Pulses `spacing` damped periods apart, each weight times the decay over the time before it.

    Parameters
    ----------
    firmware, family : str
        For the record.
    mode : Mode
        Frequency [Hz] and damping [-] that are set.
    weights : sequence of float
        For an undamped mode [-].
    spacing : float
        In damped periods.
    decay : float, optional
        A factor from one pulse to the next [-], by default what `spacing` periods leave of the vibration.
    """
    factor = mode.decay_per_half_period ** (2.0 * spacing) if decay is None else decay
    index = np.arange(len(weights))
    times = spacing * mode.damped_period * index
    return executed(firmware, family, mode, times, np.asarray(weights) * factor**index)


def undamped_humps(humps: int, tolerance: float) -> list[float]:
    """Weights of the EI shaper with 1, 2 or 3 humps for an undamped mode (LITERATURE 2.2).

    Firmwares scale them by the decay per half period, which is how EI shapers were made for damped modes before the
    exact ones were known: safe, less robust.
    """
    v = tolerance_of(tolerance)
    if humps == 1:
        return [0.25 * (1.0 + v), 0.5 * (1.0 - v), 0.25 * (1.0 + v)]
    if humps == 2:
        x = (v**2 * (math.sqrt(1.0 - v**2) + 1.0)) ** (1.0 / 3.0)
        outer = (3.0 * x**2 + 2.0 * x + 3.0 * v**2) / (16.0 * x)
        return [outer, 0.5 - outer, 0.5 - outer, outer]
    outer = (1.0 + 3.0 * v + 2.0 * math.sqrt(2.0 * v * (v + 1.0))) / 16.0
    inner = 0.25 * (1.0 - v)
    return [outer, inner, 1.0 - 2.0 * (outer + inner), inner, outer]
