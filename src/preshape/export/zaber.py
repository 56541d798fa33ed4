"""Zaber: a subclass of the stream generator of zaber-examples (motion_input_shaping), with impulses of its own.

The generator convolves steps of acceleration with the impulses exactly, at any time; a move then has as many stream
segments as steps of acceleration times impulses, less one.
"""

from __future__ import annotations

import re

from preshape.errors import InputError
from preshape.export.settings_target import Configured, SettingsTarget, Written
from preshape.export.target import Limits
from preshape.provenance import Design
from preshape.shaper import Shaper

__all__ = ["ZABER"]

TEMPLATE = '''from plant import Plant
from zero_vibration_stream_generator import ZeroVibrationStreamGenerator

AMPLITUDES = [
{amplitudes}
]
TIMES = [  # seconds
{times}
]


class PreshapeStreamGenerator(ZeroVibrationStreamGenerator):
    """Streams shaped by the impulses above; plant and shaper type of the base class are not used."""

    def __init__(self, plant: Plant | None = None) -> None:
        super().__init__(Plant(1.0, 0.0) if plant is None else plant)

    def get_impulse_amplitudes(self) -> list[float]:
        """Get shaper impulse magnitudes."""
        return list(AMPLITUDES)

    def get_impulse_times(self) -> list[float]:
        """Get shaper impulse times."""
        return list(TIMES)
'''

LIST = r"^{name} = \[[^\n]*\n([-+0-9.e, \n]*)\]$"
MOST = 1000


def _write(shaper: Shaper, version: str, axes: tuple[str, ...]) -> Written:
    amplitudes, times = (
        "\n".join(f"    {value!r}," for value in numbers.tolist()) for numbers in (shaper.amplitudes, shaper.times)
    )
    return Written(TEMPLATE.format(amplitudes=amplitudes, times=times))


def _run(text: str, version: str, axis: str | None = None) -> Shaper:
    if axis is not None:
        raise InputError("the generator is made for one axis: leave the axis out.")
    amplitudes, times = (_numbers(name, text) for name in ("AMPLITUDES", "TIMES"))
    if len(amplitudes) != len(times):
        raise InputError(f"AMPLITUDES holds {len(amplitudes)} numbers and TIMES {len(times)}: they need as many.")
    return Shaper(times, amplitudes, Design("custom", settings={"executed_by": "Zaber stream"}))


def _numbers(name: str, text: str) -> list[float]:
    found = re.findall(LIST.format(name=name), text.replace("\r\n", "\n"), re.MULTILINE)
    if len(found) != 1:
        raise InputError(f"the file holds {len(found)} lists {name}: give one that preshape export wrote.")
    words = [word.strip() for word in found[0].split(",")]
    words = words[:-1] if words[-1] == "" else words
    if not 1 <= len(words) <= MOST:
        raise InputError(f"{name} holds {len(words)} numbers: give 1 to {MOST}.")
    try:
        return [float(word) for word in words]
    except ValueError:
        raise InputError(f"{name} holds something that is no number.") from None


def _next_step(configured: Configured) -> tuple[str, ...]:
    return (
        f"Put {configured.name}.py beside zero_vibration_stream_generator.py of zaber-examples, and after",
        "  axis = ShapedAxisStream(zaber_axis, plant)",
        f"say  axis.shaper = {configured.name}.PreshapeStreamGenerator()  before it moves (firmware 7.25 or newer).",
    )


ZABER = SettingsTarget(
    "zaber",
    "a subclass of zaber-examples' stream generator",
    ("zaber-motion",),
    Limits(taps=MOST, resolution="every bit"),
    _write,
    _run,
    ".py",
    "#",
    next_step=_next_step,
)
