"""RepRapFirmware's M593: custom impulses in the syntax of each version, and what its own names execute.

H and T changed their meaning: to 3.5 they are cumulative sums and durations, since 3.6 amplitudes and delays. The mzv
of 3.4 to 3.6 has its amplitudes in reverse order, which leaves 16 % of a vibration with damping 0.1; a later source,
whose release we could not tell, mends that and limits the damping ratio ("later" here). One shaper serves all axes.
Up to 3.5 moves are planned around the shaper as one that only ever adds, so it gets no negative impulses from us.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial.polynomial import polyval

from preshape.errors import InputError
from preshape.export.damped_humps import (
    THREE_HUMP_AMPLITUDES,
    THREE_HUMP_TIMES,
    TWO_HUMP_AMPLITUDES,
    TWO_HUMP_TIMES,
)
from preshape.export.family import executed
from preshape.export.gcode import Words, commands, number_in, numbers_in
from preshape.export.settings_target import Configured, SettingsTarget, Written
from preshape.export.target import Limits
from preshape.mode import Mode
from preshape.shaper import Shaper

__all__ = ["RRF", "STEP_CLOCK", "named"]

STEP_CLOCK = 750_000.0
"""Ticks a second of the step clock of Duet 3; since 3.6 every delay is a whole number of them."""

MOST_EXTRA = 4
"""Values that H and T hold; the last impulse follows from the others."""

HIGHEST_FREQUENCY = 1000.0
LIMITS = Limits(
    taps=MOST_EXTRA + 1,
    resolution="amplitudes to 1e-6, times to 1.33 µs",
    seconds=1.0 / STEP_CLOCK,
    amplitude=1e-6,
)

DEFAULT_FREQUENCY = 40.0

Pulses = tuple[Sequence[float], Sequence[float]]
"""Weights of all impulses, and times [damped periods] of those after the first."""


@dataclass(frozen=True)
class Version:
    """What differs between releases: default damping [-], lowest frequency [Hz], sums or amplitudes, mzv, limits."""

    damping: float
    lowest: float
    cumulative: bool
    mirrored: bool
    dampings: tuple[float, float, float]  # most for ei2, ei3, and all others

    def maximum_damping(self, name: str) -> float:
        """The largest damping ratio [-] that M593 takes."""
        return {"ei2": self.dampings[0], "ei3": self.dampings[1]}.get(name, self.dampings[2])


VERSIONS = {
    "3.6": Version(0.05, 4.0, False, True, (0.99, 0.99, 0.99)),
    "3.5": Version(0.1, STEP_CLOCK / (2 * 65535), True, True, (0.99, 0.99, 0.99)),
    "later": Version(0.05, 4.0, False, False, (0.3, 0.2, 0.9)),
}


def _binomial(weights: Sequence[float]) -> Callable[[Mode], Pulses]:
    def pulses(mode: Mode) -> Pulses:
        decay = mode.decay_per_half_period
        return [w * decay**i for i, w in enumerate(weights)], [0.5 * i for i in range(1, len(weights))]

    return pulses


def _mzv(mode: Mode) -> Pulses:
    decay = mode.decay_per_half_period**0.75
    return [1.0 - 0.5**0.5, (2.0**0.5 - 1.0) * decay, (1.0 - 0.5**0.5) * decay**2], [0.375, 0.75]


def _humps(times: Sequence[Sequence[float]], amplitudes: Sequence[Sequence[float]]) -> Callable[[Mode], Pulses]:
    def pulses(mode: Mode) -> Pulses:
        weights = [float(polyval(mode.damping, row)) for row in amplitudes[:-1]]
        return [*weights, 1.0 - sum(weights)], [float(polyval(mode.damping, row)) for row in times]

    return pulses


FAMILIES: dict[str, Callable[[Mode], Pulses]] = {
    "zvd": _binomial([1.0, 2.0, 1.0]),
    "zvdd": _binomial([1.0, 3.0, 3.0, 1.0]),
    "zvddd": _binomial([1.0, 4.0, 6.0, 4.0, 1.0]),
    "mzv": _mzv,
    "ei2": _humps(TWO_HUMP_TIMES, TWO_HUMP_AMPLITUDES),
    "ei3": _humps(THREE_HUMP_TIMES, THREE_HUMP_AMPLITUDES),
}


def named(name: str, frequency: float, damping: float, version: str = "3.6") -> Shaper:
    """What `M593 P"name" F S` executes.

    Parameters
    ----------
    name : str
        "zvd", "zvdd", "zvddd", "mzv", "ei2" or "ei3"; there is no zv and no ei.
    frequency : float
        F, undamped natural frequency [Hz].
    damping : float
        S [-].
    version : str
        "3.6", "3.5" (also for 3.4) or "later".

    Raises
    ------
    InputError
        If the firmware would refuse this.

    Examples
    --------
    >>> zvd = named("zvd", 50.0, 0.1)
    >>> (zvd.times * 750000).round(6).tolist(), zvd.amplitudes.round(4).tolist()
    ([0.0, 7538.0, 15076.0], [0.3344, 0.4877, 0.1778])
    """
    release = VERSIONS[version]
    if name not in FAMILIES:
        raise InputError(f"RepRapFirmware has no shaper {name[:40]!r}: it has {', '.join(FAMILIES)} and custom.")
    mode = _mode(release, name, frequency, damping)
    weights, periods = FAMILIES[name](mode)
    if name == "mzv" and release.mirrored:
        weights = weights[::-1]
    if release.cumulative:
        times = np.array(periods) * mode.damped_period
    elif name in ("ei2", "ei3"):
        times = np.rint(np.array(periods) * _clocks(mode)) / STEP_CLOCK
    elif name == "mzv":  # whole clocks, rounded down; the second delay is twice the first
        times = np.array([1, 2]) * (3 * _clocks(mode) // 8) / STEP_CLOCK
    else:
        times = np.array([i * _clocks(mode) // 2 for i in range(1, len(weights))]) / STEP_CLOCK
    return executed("RepRapFirmware", name, mode, [0.0, *times], weights)


def _clocks(mode: Mode) -> int:
    """The damped period in whole step clocks."""
    return round(STEP_CLOCK * mode.damped_period)


def _mode(release: Version, name: str, frequency: float, damping: float) -> Mode:
    if not release.lowest <= frequency <= HIGHEST_FREQUENCY:
        raise InputError(f"F{frequency:g}: this RepRapFirmware takes {release.lowest:.3g} to {HIGHEST_FREQUENCY:g} Hz.")
    if not 0.0 <= damping <= (most := release.maximum_damping(name)):
        raise InputError(f"S{damping:g}: this RepRapFirmware takes damping ratios from 0 to {most:g} for {name}.")
    return Mode(frequency, damping)


def _run(text: str, version: str, axis: str | None = None) -> Shaper:
    if axis is not None:
        raise InputError("RepRapFirmware has one shaper for all axes: leave the axis out.")
    release = VERSIONS[version]
    frequency, damping, kind = DEFAULT_FREQUENCY, release.damping, "none"
    last: Words = {}
    for words in commands(text, "M593"):
        given = number_in(words, "F"), number_in(words, "S")
        frequency, damping = (old if new is None else new for new, old in zip(given, (frequency, damping), strict=True))
        if "P" in words:
            kind = words["P"].lower()
        elif kind == "none" and set(words) & set("FS"):
            kind = "zvd"
        last = words
    if kind == "none":
        raise InputError('no shaper is set: P"none" switches it off.')
    if kind != "custom":
        return named(kind, frequency, damping, version)
    return _custom(last, _mode(release, kind, frequency, damping), release)


def _custom(words: Words, mode: Mode, release: Version) -> Shaper:
    if "H" not in words:
        raise InputError('P"custom" needs H with the amplitudes: RepRapFirmware refuses it without.')
    given = numbers_in(words, "H")
    if len(given) > MOST_EXTRA:
        raise InputError(
            f"H holds {len(given)} values: RepRapFirmware takes {MOST_EXTRA}, for {MOST_EXTRA + 1} impulses."
        )
    apart = numbers_in(words, "T") if "T" in words else None
    if apart is not None and release.cumulative and len(apart) == 1:
        apart *= len(given)  # one duration counts for all
    if apart is not None and len(apart) != len(given):
        raise InputError(f"H holds {len(given)} values and T {len(apart)}: RepRapFirmware refuses that.")
    if apart is not None and (min(apart) <= 0.0 or (release.cumulative is False and apart != sorted(apart))):
        raise InputError("T must be above 0" + ("" if release.cumulative else " and increase") + ".")
    if release.cumulative:
        amplitudes = np.diff([0.0, *given, 1.0])
        times = np.cumsum(apart if apart is not None else [0.5 * mode.damped_period] * len(given))
    else:
        amplitudes = np.array([*given, 1.0 - sum(given)])
        clocks = np.rint(np.array(apart) * STEP_CLOCK) if apart is not None else _half_periods(mode, len(given))
        times = clocks / STEP_CLOCK
    return executed("RepRapFirmware", "custom", None if apart is not None else mode, [0.0, *times], amplitudes)


def _half_periods(mode: Mode, count: int) -> np.ndarray:
    return np.array([i * _clocks(mode) // 2 for i in range(1, count + 1)])


def _write(shaper: Shaper, version: str, axes: tuple[str, ...]) -> Written:
    amplitudes, delays = shaper.amplitudes, shaper.times[1:]
    if VERSIONS[version].cumulative:
        values, times = np.cumsum(amplitudes)[:-1], np.diff(shaper.times)
    else:
        values, times = amplitudes[:-1], delays
    if len(shaper) == 1:
        return Written('M593 P"none"\n', ("one impulse shapes nothing: input shaping is switched off.",))
    heights = ":".join(f"{value:.6f}" for value in values)
    return Written(f'M593 P"custom" H{heights} T{":".join(f"{value:.7f}" for value in times)}\n')


def _next_step(configured: Configured) -> tuple[str, ...]:
    return (
        f"Put the line of {configured.name}.g into config.g. M115 says which version you have: in another one H and T "
        "mean something else.",
    )


RRF = SettingsTarget(
    "rrf",
    'M593 P"custom" for RepRapFirmware, one for all axes',
    tuple(VERSIONS),
    LIMITS,
    _write,
    _run,
    ".g",
    ";",
    other_limits={"3.5": replace(LIMITS, negative=False)},
    next_step=_next_step,
)
