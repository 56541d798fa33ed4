"""Prusa's M593 (Buddy firmware: XL, MK4, CORE One, MINI): the nearest of its families, and what it executes.

The EI families are undamped ones, scaled by the decay per half period. Times are not rounded; pulses are computed in
single precision, a relative 1e-7, which is left out here.
"""

from __future__ import annotations

from collections.abc import Iterator

from preshape.errors import InputError
from preshape.export.axes import of_axis
from preshape.export.family import Family, evenly_spaced, undamped_humps
from preshape.export.gcode import commands, number_in
from preshape.export.nearest import nearest_setting
from preshape.export.settings_target import Configured, SettingsTarget, Written
from preshape.export.target import Limits
from preshape.mode import Mode
from preshape.shaper import Shaper

__all__ = ["FAMILIES", "PRUSA"]

FIRMWARE = "Prusa Buddy"
AXES = ("x", "y", "z")
RANGES = {"buddy": (10.0, 100.0), "mini": (10.0, 150.0)}
"""Frequencies [Hz]; what is outside is moved to the nearest end."""

REDUCTIONS = (20.0, 10.0, 5.0, 40.0, 100.0)
"""R, one over the tolerance, that the search tries; 20 is the default."""


def _mzv(frequency: float, damping: float) -> Shaper:
    outer, inner = 1.0 - 0.5**0.5, 2.0**0.5 - 1.0
    return evenly_spaced(FIRMWARE, "mzv", Mode(frequency, damping), [outer, inner, outer], spacing=0.375)


def _binomial(name: str, weights: list[float]) -> Family:
    return Family(name, lambda f, z: evenly_spaced(FIRMWARE, name, Mode(f, z), weights))


def _reductions() -> Iterator[dict[str, float]]:
    yield {}
    yield from ({"R": value} for value in REDUCTIONS[1:])


def _ei(name: str, humps: int) -> Family:
    def pulses(frequency: float, damping: float, R: float = REDUCTIONS[0]) -> Shaper:
        if not R > 1.0:
            raise InputError(f"R{R:g}: give a reduction above 1, such as 20 for a tolerance of 5 %.")
        return evenly_spaced(FIRMWARE, name, Mode(frequency, damping), undamped_humps(humps, 1.0 / R))

    return Family(name, pulses, 0.99, _reductions)


FAMILIES = {
    family.name: family
    for family in (
        _binomial("zv", [1.0, 1.0]),
        _binomial("zvd", [1.0, 2.0, 1.0]),
        Family("mzv", _mzv),
        _ei("ei", 1),
        _ei("2hump_ei", 2),
        _ei("3hump_ei", 3),
    )
}
"""In the order of the numbers behind T."""

NUMBERS = list(FAMILIES)


def _run(text: str, version: str, axis: str | None = None) -> Shaper:
    low, high = RANGES[version]
    state: dict[str, dict[str, float]] = {one: {} for one in AXES}
    for words in commands(text, "M593"):
        named = [one for one in AXES if one.upper() in words] or list(AXES)
        values = {letter: value for letter in "TFDR" if (value := number_in(words, letter)) is not None}
        for one in named:
            state[one] |= values
    found = {}
    for one, values in state.items():
        if not values.get("F", 0.0) or axis not in (None, one):  # F0 switches the axis' shaper off
            continue
        number, damping = values.get("T", 0.0), values.get("D", 0.1)
        if number not in range(len(NUMBERS)):
            raise InputError(f"T{number:g}: Prusa's firmware has 0 to {len(NUMBERS) - 1}, {', '.join(NUMBERS)}.")
        if values["F"] < 0.0 or not 0.0 <= damping < 1.0:
            raise InputError(f"F{values['F']:g} D{damping:g}: give a frequency of 0 Hz or more and a damping below 1.")
        family = FAMILIES[NUMBERS[int(number)]]
        parameters = {"R": values["R"]} if "R" in values and "ei" in family.name else {}
        found[one] = family.pulses(min(max(values["F"], low), high), damping, **parameters)
    return of_axis(found, axis, AXES, "no shaper is set: F is 0 or missing.")


def _write(shaper: Shaper, version: str, axes: tuple[str, ...]) -> Written:
    near = nearest_setting(
        shaper,
        FAMILIES,
        "Prusa's firmware",
        frequencies=RANGES[version],
        instead="shape the G-code instead, or look for a shaper that fits",
    )
    number = NUMBERS.index(near.family.name)
    reduction = f" R{near.parameters['R']:g}" if near.parameters else " R20" if "ei" in near.family.name else ""
    lines = [f"M593 {axis.upper()} T{number} F{near.frequency:.2f} D{near.damping:.4f}{reduction}\n" for axis in axes]
    return Written("".join(lines), (near.sentence(near.family.name, "Prusa's firmware"),), excess=near.excess)


def _next_step(configured: Configured) -> tuple[str, ...]:
    return (f"Put the lines of {configured.name}.g into the start G-code, after its own M593; W would store them.",)


PRUSA = SettingsTarget(
    "prusa",
    "M593 for Prusa's Buddy firmware: the nearest family",
    tuple(RANGES),
    Limits(taps=None, resolution="a family, frequency to 0.01 Hz, damping to 0.0001"),
    _write,
    _run,
    ".g",
    ";",
    AXES,
    next_step=_next_step,
)
