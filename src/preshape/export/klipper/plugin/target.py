"""Klipper and Kalico: any impulses, by a module for klippy/extras and a section that holds them.

Klipper's kernel convolves positions with impulses at any time: nothing is rounded but the digits that are written.
"""

from __future__ import annotations

from dataclasses import replace

from preshape.errors import InputError
from preshape.export.axes import of_axis
from preshape.export.c_source import filled
from preshape.export.config_text import impulse_lines, numbers_of, section_of
from preshape.export.family import executed
from preshape.export.klipper.settings import AXES
from preshape.export.settings_target import Configured, SettingsTarget, Written
from preshape.export.target import Limits
from preshape.shaper import Shaper

__all__ = ["KLIPPER_PLUGIN"]

MODULE = "preshape_shaper.py"

LIMITS = Limits(taps=10, negative=True, resolution="to 12 digits", seconds=1e-11, amplitude=1e-12)
OTHER = {"old": replace(LIMITS, taps=5), "kalico": replace(LIMITS, taps=25)}


def _run(text: str, version: str, axis: str | None = None) -> Shaper:
    settings = section_of(text, "preshape_shaper")
    found = {}
    for one in AXES:
        if f"amplitudes_{one}" not in settings and f"times_{one}" not in settings:
            continue
        amplitudes, times = numbers_of(settings, f"amplitudes_{one}"), numbers_of(settings, f"times_{one}")
        most = OTHER.get(version, LIMITS).taps
        if len(amplitudes) != len(times) or not 1 <= len(times) <= (most or 0):
            raise InputError(
                f"axis {one} has {len(amplitudes)} amplitudes and {len(times)} times: give as many, up to {most}."
            )
        if any(late <= early for early, late in zip(times, times[1:], strict=False)):
            raise InputError(f"times_{one} do not increase: the firmware refuses such impulses.")
        found[one] = executed("Klipper", "custom", None, times, amplitudes)
    return of_axis(found, axis, AXES, "no impulses are set: amplitudes_x and times_x are missing.")


def _write(shaper: Shaper, version: str, axes: tuple[str, ...]) -> Written:
    lines = ["[preshape_shaper]"]
    for axis in axes:
        lines += impulse_lines(shaper, axis, "amplitudes", "times", ".12g")
    module = filled("preshape.export.klipper.plugin", f"{MODULE}.in", version=version)
    return Written("\n".join(lines) + "\n", beside={MODULE: module})


def _next_step(configured: Configured) -> tuple[str, ...]:
    return (
        f"Copy {MODULE} into klippy/extras, the section of {configured.name}.cfg into printer.cfg, which must have a "
        "section [input_shaper],",
        "and restart Klipper. PRESHAPE_SHAPER says what is in force, SET_INPUT_SHAPER puts Klipper's own back.",
    )


KLIPPER_PLUGIN = SettingsTarget(
    "klipper-plugin",
    "any impulses for Klipper or Kalico: a module for klippy",
    ("2026-03", "old", "kalico"),
    LIMITS,
    _write,
    _run,
    ".cfg",
    "#",
    AXES,
    OTHER,
    _next_step,
)
