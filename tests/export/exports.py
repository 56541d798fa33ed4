"""What the tests of exports share: shapers of every family, an export in a folder, how near and how damaged it is."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
from hypothesis import strategies as st
from tests.laws import FAMILIES

from preshape import Modes, Shaper
from preshape.export import TARGETS, Exported, Limits, SettingsTarget
from preshape.export.target import EPSILON
from preshape.vibration import residual_vibration

MODES = Modes([(10.0, 0.02), (27.0, 0.05)])
NAMES = [family.name for family in FAMILIES]
DT = 0.0013

AROUND = np.array([0.9, 0.95, 1.0, 1.05, 1.1])
"""A mode may be off by these factors."""

ROUNDING = 1e-13
"""Of a residual vibration [-], in double."""


@cache
def shaper_of(name: str) -> Shaper:
    """The family's shaper for two modes, made once."""
    return next(family for family in FAMILIES if family.name == name).build(MODES)


def written(exported: Exported, folder: Path) -> Path:
    """The files of an export in `folder`."""
    folder.mkdir(exist_ok=True)
    for name, content in exported.files.items():
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())
    return folder


def assert_executed_as_asked(
    does: Shaper, asked: Shaper, limits: Limits, precision: str = "double", excess: float = 0.0
) -> None:
    """Impulses, and what they leave at the modes, are as near as the target says.

    Rounding the numbers that are written moves an amplitude by their resolution, and by more where it is what others
    leave of the sum. Vibration is a sum over the impulses, whose derivative by one's time is the frequency.
    """
    off = len(asked) * asked.magnitude * (limits.amplitude + EPSILON[precision])
    if limits.taps is not None:
        np.testing.assert_allclose(does.times, asked.times, rtol=1e-15, atol=limits.seconds)
        np.testing.assert_allclose(does.amplitudes, asked.amplitudes, rtol=0, atol=off)
    for mode in asked.design.modes or ():
        around = mode.frequency * AROUND
        more = residual_vibration(does, around, mode.damping) - residual_vibration(asked, around, mode.damping)
        rounding = len(asked) * off + 4.0 * np.pi * around * limits.seconds * asked.magnitude + ROUNDING
        assert (more <= excess + rounding).all(), (mode, more)
        if limits.taps is not None:
            assert (-more <= rounding).all(), (mode, more)


def damaged(data: st.DataObject, content: str | bytes, inserts: list[bytes], longest_cut: int) -> bytes:
    """The content with a byte changed, something cut out, put in or doubled, one to five times."""
    raw = bytearray(content if isinstance(content, bytes) else content.encode())
    for _ in range(data.draw(st.integers(1, 5))):
        at = data.draw(st.integers(0, len(raw)))
        kind = data.draw(st.sampled_from(["byte", "cut", "insert", "double"]))
        if kind == "byte" and at < len(raw):
            raw[at] = data.draw(st.integers(0, 255))
        elif kind == "cut":
            del raw[at : at + data.draw(st.integers(1, longest_cut))]
        elif kind == "insert":
            raw[at:at] = data.draw(st.sampled_from(inserts))
        else:
            raw += raw[at:]
    return bytes(raw)


def executed(target: str, text: str, version: str | None = None, axis: str | None = None) -> Shaper:
    """What a target that takes settings does with a text."""
    chosen = TARGETS[target]
    assert isinstance(chosen, SettingsTarget)
    return chosen.execute(text, version, axis)
