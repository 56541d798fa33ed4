"""Marlin's two input shapers: M593, a ZV in fixed-point arithmetic, and M493, fixed-time motion with taps every 1 ms.

The classic one (M593) counts half of the undamped period, and its amplitudes are multiples of 1/128 from a polynomial
in the damping ratio. Fixed-time motion (M493) rounds the first delay to a sample and makes the others multiples of it;
its mzv decays by the half period although its pulses are closer, and its EI families are scaled undamped ones.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence

import numpy as np

from preshape.errors import InputError
from preshape.export.axes import of_axis
from preshape.export.family import Family, executed, undamped_humps
from preshape.export.gcode import commands, number_in
from preshape.export.nearest import nearest_setting
from preshape.export.settings_target import Configured, SettingsTarget, Written
from preshape.export.target import Limits
from preshape.mode import Mode
from preshape.shaper import Shaper

__all__ = ["FAMILIES", "MARLIN", "MARLIN_FT", "classic_zv"]

AXES = ("x", "y", "z")

ECHO = (64.44056192, -99.02008832, -7.58095488, 43.073216)
"""128 times the second amplitude over powers of the damping ratio."""

SAMPLES_PER_SECOND = 1000
LOWEST, HIGHEST = 10.0, 500.0
"""Base frequencies [Hz] of fixed-time motion; newer builds begin at 20."""

DAMPINGS = (0.01, 0.25)
TOLERANCES = (0.05, 0.02, 0.1, 0.15)


def classic_zv(frequency: float, damping: float = 0.15) -> Shaper:
    """What `M593 F D` executes.

    Parameters
    ----------
    frequency : float
        F [Hz].
    damping : float
        D [-], 0 to 1.

    Examples
    --------
    >>> (classic_zv(50.0, 0.1).amplitudes * 128).tolist(), classic_zv(50.0, 0.1).duration
    ([74.0, 54.0], 0.01)
    """
    mode = Mode(frequency, damping)
    second = 64 if damping <= 0.0 else math.floor(sum(c * damping**i for i, c in enumerate(ECHO)))
    return executed("Marlin", "zv", mode, [0.0, 0.5 / mode.frequency], [128 - second, second])


def _taps(name: str, spacing: float, weights: Callable[[float], Sequence[float]]) -> Family:
    """A family of fixed-time motion: weights of an undamped mode, times powers of the decay per half period."""

    def pulses(frequency: float, damping: float, Q: float = 0.05) -> Shaper:
        if not LOWEST <= frequency <= HIGHEST:
            raise InputError(f"A{frequency:g}: Marlin takes {LOWEST:g} to {HIGHEST:g} Hz.")
        if not DAMPINGS[0] <= damping <= DAMPINGS[1]:
            raise InputError(f"I{damping:g}: Marlin takes damping ratios from {DAMPINGS[0]} to {DAMPINGS[1]}.")
        mode = Mode(frequency, damping)
        # In single precision, as Marlin computes it: whether half a sample is rounded up depends on it.
        single = np.float32
        root = np.sqrt(single(1.0) - single(damping) ** 2)
        samples = math.floor(float(single(spacing) / single(frequency) / root * single(SAMPLES_PER_SECOND)) + 0.5)
        each = np.asarray(weights(Q))
        index = np.arange(each.size)
        times = samples / SAMPLES_PER_SECOND * index
        return executed("Marlin FT_MOTION", name, mode, times, each * mode.decay_per_half_period**index)

    return Family(name, pulses, DAMPINGS[1], _tolerances if name.endswith("ei") else lambda: ({},), scales=False)


def _tolerances() -> Iterator[dict[str, float]]:
    yield {}
    yield from ({"Q": value} for value in TOLERANCES[1:])


FAMILIES = {
    family.name: family
    for family in (
        _taps("zv", 0.5, lambda v: [1.0, 1.0]),
        _taps("zvd", 0.5, lambda v: [1.0, 2.0, 1.0]),
        _taps("zvdd", 0.5, lambda v: [1.0, 3.0, 3.0, 1.0]),
        _taps("zvddd", 0.5, lambda v: [1.0, 4.0, 6.0, 4.0, 1.0]),
        _taps("ei", 0.5, lambda v: undamped_humps(1, v)),
        _taps("2hei", 0.5, lambda v: undamped_humps(2, v)),
        _taps("3hei", 0.5, lambda v: undamped_humps(3, v)),
        _taps("mzv", 0.375, lambda v: [1.0, 2.0**0.5, 1.0]),
    )
}
"""In the order of the numbers behind C, from 1."""

NUMBERS = ["none", *FAMILIES]
OLD = {"zv": Family("zv", classic_zv)}


def _run_classic(text: str, version: str, axis: str | None = None) -> Shaper:
    state: dict[str, dict[str, float]] = {one: {} for one in AXES}
    for words in commands(text, "M593"):
        values = {letter: value for letter in "FD" if (value := number_in(words, letter)) is not None}
        if not 0.0 <= values.get("D", 0.0) <= 1.0:
            raise InputError(f"D{values['D']:g}: Marlin takes damping ratios from 0 to 1.")
        for one in [one for one in AXES if one.upper() in words] or list(AXES):
            state[one] |= values
    found = {}
    for one, values in state.items():
        if values.get("F") and axis in (None, one):  # F0 switches the axis' shaper off
            found[one] = classic_zv(values["F"], min(values.get("D", 0.15), 0.999))
    return of_axis(found, axis, AXES, "no shaper is set: F is 0 or missing.")


def _run_taps(text: str, version: str, axis: str | None = None) -> Shaper:
    state: dict[str, dict[str, float]] = {one: {} for one in AXES}
    on = 1.0
    for words in commands(text, "M493"):
        values = {letter: value for letter in "CAIQ" if (value := number_in(words, letter)) is not None}
        on = on if (switch := number_in(words, "S")) is None else switch
        for one in [one for one in AXES if one.upper() in words] or list(AXES[:2]):
            state[one] |= values
    found = {}
    for one, values in state.items():
        number = values.get("C", 0.0)
        if axis not in (None, one) or number == 0.0:
            continue
        if number not in range(len(NUMBERS)):
            raise InputError(f"C{number:g}: Marlin has 0 to {len(NUMBERS) - 1}, {', '.join(NUMBERS)}.")
        if "A" not in values:
            raise InputError(
                f"axis {one} has no frequency: give A with the settings, Marlin's default is its builder's."
            )
        name = NUMBERS[int(number)]
        parameters = {"Q": values["Q"]} if "Q" in values and name.endswith("ei") else {}
        found[one] = FAMILIES[name].pulses(values["A"], values.get("I", 0.1), **parameters)
    nothing = "no shaper is set: C is 0 or missing." if on else "S0 switches fixed-time motion off, and its shapers."
    return of_axis(found if on else {}, axis, AXES, nothing)


def _write_classic(shaper: Shaper, version: str, axes: tuple[str, ...]) -> Written:
    near = nearest_setting(
        shaper, OLD, "Marlin's M593", frequencies=(1.0, HIGHEST), dampings=(0.0, 0.9), instead="try target marlin-ft"
    )
    text = "".join(f"M593 {axis.upper()} F{near.frequency:.2f} D{near.damping:.4f}\n" for axis in axes)
    notes = ("8-bit boards, whose timer has 16 bits, take frequencies above about 15 Hz.",)
    return Written(text, (near.sentence("ZV", "Marlin's M593"), *notes), excess=near.excess)


def _write_taps(shaper: Shaper, version: str, axes: tuple[str, ...]) -> Written:
    near = nearest_setting(
        shaper,
        FAMILIES,
        "Marlin's fixed-time motion",
        frequencies=(LOWEST, HIGHEST),
        dampings=DAMPINGS,
        instead="choose a shaper for modes in this range",
    )
    name = near.family.name
    tolerance = near.parameters.get("Q", 0.05)
    ends = f" Q{tolerance:g}" if name.endswith("ei") else ""
    lines = [
        f"M493 {axis.upper()} C{NUMBERS.index(name)} A{near.frequency:.2f} I{near.damping:.4f}{ends}\n" for axis in axes
    ]
    defines = [
        f"{axis.upper()}: #define FTM_DEFAULT_SHAPER_{axis.upper()} ftMotionShaper_{name.upper()}, "
        f"FTM_SHAPING_DEFAULT_FREQ_{axis.upper()} {near.frequency:.2f}f, "
        f"FTM_SHAPING_ZETA_{axis.upper()} {near.damping:.4f}f in Configuration_adv.h are the same for good."
        for axis in axes
    ]
    note = "Taps lie on samples of 1 ms, so a small change of the frequency may change nothing, or half a sample."
    notes = (near.sentence(name, "Marlin's fixed-time motion"), note, *defines)
    return Written("M493 S1\n" + "".join(lines), notes, excess=near.excess)


def _next_step(configured: Configured) -> tuple[str, ...]:
    return (f"Send the lines of {configured.name}.g, look with M593 or M493 what is in force, and store it with M500.",)


MARLIN = SettingsTarget(
    "marlin",
    "M593 for Marlin's standard motion: a ZV",
    ("2.1",),
    Limits(taps=None, resolution="a ZV, amplitudes to 1/128, frequency to 0.01 Hz"),
    _write_classic,
    _run_classic,
    ".g",
    ";",
    AXES,
    next_step=_next_step,
)

MARLIN_FT = SettingsTarget(
    "marlin-ft",
    "M493 for Marlin's fixed-time motion: the nearest family",
    ("2.1",),
    Limits(taps=None, resolution="a family on samples of 1 ms"),
    _write_taps,
    _run_taps,
    ".g",
    ";",
    AXES,
    next_step=_next_step,
)
