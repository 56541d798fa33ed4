"""Kalico: the impulses themselves in its bleeding-edge-v2, its families in main.

The smoothers of bleeding-edge-v2, polynomials in time instead of impulses, are neither written nor executed here.
"""

from __future__ import annotations

from preshape.errors import InputError
from preshape.export.axes import of_axis
from preshape.export.config_text import impulse_lines, numbers_of, section_of
from preshape.export.family import executed
from preshape.export.klipper.settings import execute_families, family_lines
from preshape.export.klipper.versions import VERSIONS as KLIPPER
from preshape.export.settings_target import Configured, SettingsTarget, Written
from preshape.export.target import Limits
from preshape.shaper import Shaper

__all__ = ["KALICO"]

AXES = ("x", "y")
CUSTOM = "bleeding-edge-v2"

FAMILIES = {CUSTOM: KLIPPER["2025-09"], "main": KLIPPER["old"]}

LIMITS = Limits(
    taps=5, shortest=0.001, longest=0.2, smallest=0.001, resolution="to 9 digits", seconds=1e-9, amplitude=1e-9
)
MAIN = Limits(taps=None, resolution="a family, frequency to 0.01 Hz, damping to 0.0001")


def _run(text: str, version: str, axis: str | None = None) -> Shaper:
    settings = section_of(text, "input_shaper")
    kinds = {one: settings.get(f"shaper_type_{one}", settings.get("shaper_type", "")).strip() for one in AXES}
    for one, kind in kinds.items():
        if version == CUSTOM and kind.startswith("smooth") and axis in (None, one):
            raise InputError(f"axis {one} has a smoother, {kind[:40]}: only impulses and families are executed here.")
    if version != CUSTOM or "custom" not in kinds.values():
        return execute_families(settings, FAMILIES[version], AXES, axis)
    found = {}
    for one, kind in kinds.items():
        if axis not in (None, one):
            continue
        if kind == "custom":
            found[one] = _custom(numbers_of(settings, f"shaper_a_{one}"), numbers_of(settings, f"shaper_t_{one}"))
        elif f"shaper_freq_{one}" in settings:
            found[one] = execute_families(settings, FAMILIES[version], AXES, one)
    return of_axis(found, axis, AXES, "no shaper is set.")


def _custom(amplitudes: list[float], times: list[float]) -> Shaper:
    """The impulses, if Kalico takes them."""
    if len(amplitudes) != len(times) or not 1 <= len(times) <= (LIMITS.taps or 0):
        raise InputError(f"{len(amplitudes)} amplitudes and {len(times)} times: give as many, up to {LIMITS.taps}.")
    if min(map(abs, amplitudes)) < LIMITS.smallest or sum(amplitudes) < LIMITS.smallest:
        raise InputError(f"Kalico takes amplitudes of size {LIMITS.smallest} or more, with a positive sum.")
    if times != sorted(times):
        raise InputError("shaper_t does not increase: Kalico refuses such impulses.")
    duration = times[-1] - times[0]
    if not (LIMITS.shortest <= duration <= LIMITS.longest or len(times) == 1):
        raise InputError(f"the impulses take {duration:g} s: Kalico takes 0.001 to 0.2 s.")
    return executed("Kalico", "custom", None, times, amplitudes)


def _write(shaper: Shaper, version: str, axes: tuple[str, ...]) -> Written:
    if version != CUSTOM:
        instead = "export it to klipper-plugin, version kalico, which takes impulses"
        return family_lines(shaper, FAMILIES[version], f"Kalico ({version})", axes, instead)
    lines = ["[input_shaper]"]
    for axis in axes:
        lines += [f"shaper_type_{axis}: custom", *impulse_lines(shaper, axis, "shaper_a", "shaper_t", ".9f")]
    return Written("\n".join(lines) + "\n")


def _next_step(configured: Configured) -> tuple[str, ...]:
    return (f"Put the lines of {configured.name}.cfg into [input_shaper] of printer.cfg, and restart Kalico.",)


KALICO = SettingsTarget(
    "kalico",
    "[input_shaper] for Kalico: impulses, or the nearest family",
    (CUSTOM, "main"),
    LIMITS,
    _write,
    _run,
    ".cfg",
    "#",
    AXES,
    {"main": MAIN},
    _next_step,
)
