"""Klipper's `[input_shaper]`: the nearest of its families, and what it executes."""

from __future__ import annotations

import re
from collections.abc import Mapping

from preshape.errors import InputError
from preshape.export.axes import of_axis
from preshape.export.config_text import number_of, section_of
from preshape.export.family import Family, family_of
from preshape.export.klipper.families import DEFAULT_DAMPING
from preshape.export.klipper.versions import VERSIONS
from preshape.export.nearest import nearest_setting
from preshape.export.settings_target import Configured, SettingsTarget, Written
from preshape.export.target import Limits
from preshape.shaper import Shaper

__all__ = ["AXES", "KLIPPER", "execute_families", "family_lines"]

AXES = ("x", "y", "z")
"""z since 2025-09."""

HIGHEST_FREQUENCY = 500.0
LOWEST_FREQUENCY = 0.5
"""[Hz]; Klipper itself takes any frequency, the search for the nearest setting stays within these."""

PARAMETRISED = re.compile(r"(\w+)\s*\((.*)\)$")
ARGUMENT = re.compile(r"(?:(\w+)\s*=\s*)?(\d*\.?\d+|\d+\.)")
NAMES = {"mzv": ("n", "t", "tau"), "ei": ("v_tol",)}
DEFAULT_TYPE = "mzv"


def _run(text: str, version: str, axis: str | None = None) -> Shaper:
    """What Klipper does with `[input_shaper]`; see :class:`preshape.export.settings_target.Run`."""
    axes = AXES if version != "old" else AXES[:2]
    return execute_families(section_of(text, "input_shaper"), VERSIONS[version], axes, axis)


def execute_families(
    settings: Mapping[str, str], families: Mapping[str, Family], axes: tuple[str, ...], axis: str | None
) -> Shaper:
    """The family that the settings name for an axis."""
    found = {}
    for one in axes:
        frequency = number_of(settings, (f"shaper_freq_{one}",), 0.0)
        if frequency == 0.0 or axis not in (None, one):  # a frequency of 0 switches the axis' shaper off
            continue
        damping = number_of(settings, (f"damping_ratio_{one}",), DEFAULT_DAMPING)
        name = settings.get(f"shaper_type_{one}", settings.get("shaper_type", DEFAULT_TYPE)).lower().strip()
        found[one] = _pulses(name, families, frequency, damping)
    return of_axis(found, axis, axes, "no shaper is set: shaper_freq_x is 0 or missing.")


def _pulses(name: str, families: Mapping[str, Family], frequency: float, damping: float) -> Shaper:
    """`mzv` or `mzv(n=5, t=1.1)` at a frequency."""
    if (call := PARAMETRISED.fullmatch(name)) is None:
        return family_of(families, name, "this Klipper").pulses(frequency, damping)
    family = family_of(families, call[1], "this Klipper")
    if call[1] not in NAMES or len(list(family.parameters())) < 2:
        raise InputError(f"{call[1]} takes no parameters in this Klipper: write {call[1]}.")
    parameters: dict[str, float] = {}
    for index, word in enumerate(call[2].split(",")):
        argument = ARGUMENT.fullmatch(word.strip())
        if argument is None or index >= len(NAMES[call[1]]):
            raise InputError(f"{name[:60]!r} is not understood: write it like mzv(n=5,t=1.1) or ei(v_tol=0.02).")
        key = argument[1] or NAMES[call[1]][index]
        if key not in NAMES[call[1]] or key in parameters:
            raise InputError(f"{call[1]} takes {' and '.join(NAMES[call[1]])}, each once, and not {key[:20]!r}.")
        value = argument[2]
        parameters[key] = float(value) if "." in value else int(value)
    if "tau" in parameters:
        n, tau = parameters.get("n", 3), parameters.pop("tau")
        if "t" in parameters:
            raise InputError("mzv takes t or tau, not both.")
        parameters["t"] = tau * (n - 1) / (n + 2.0 * tau - 2.0)
    return family.pulses(frequency, damping, **parameters)


def family_lines(
    shaper: Shaper, families: Mapping[str, Family], firmware: str, axes: tuple[str, ...], instead: str
) -> Written:
    """The nearest family as lines of `[input_shaper]`, with what was chosen."""
    frequencies = (LOWEST_FREQUENCY, HIGHEST_FREQUENCY)
    near = nearest_setting(shaper, families, firmware, frequencies=frequencies, instead=instead)
    name = near.family.name
    if near.parameters:
        name += f"({','.join(f'{key}={_word(value)}' for key, value in near.parameters.items())})"
    lines = ["[input_shaper]"]
    for axis in axes:
        lines += [
            f"shaper_type_{axis}: {name}",
            f"shaper_freq_{axis}: {near.frequency:.2f}",
            f"damping_ratio_{axis}: {near.damping:.4f}",
        ]
    return Written("\n".join(lines) + "\n", (near.sentence(name, firmware),), excess=near.excess)


def _word(value: float) -> str:
    """Klipper takes a number for whole exactly when it has no decimal point."""
    return f"{value}" if isinstance(value, int) else f"{value:.6g}" if value % 1.0 else f"{value:.1f}"


def _write(shaper: Shaper, version: str, axes: tuple[str, ...]) -> Written:
    instead = "export it to klipper-plugin, which takes impulses, or give the modes with its design"
    return family_lines(shaper, VERSIONS[version], f"Klipper ({version})", axes, instead)


def _next_step(configured: Configured) -> tuple[str, ...]:
    return (
        f"Put the lines of {configured.name}.cfg into [input_shaper] of printer.cfg, and restart Klipper.",
        "SHAPER_CALIBRATE does not save damping_ratio: keep these lines when you run it again.",
    )


KLIPPER = SettingsTarget(
    "klipper",
    "[input_shaper] for Klipper: the nearest of its families",
    tuple(VERSIONS),
    Limits(taps=None, negative=True, resolution="a family, frequency to 0.01 Hz, damping to 0.0001"),
    _write,
    _run,
    ".cfg",
    "#",
    AXES,
    next_step=_next_step,
)
