"""Texts to paste: each firmware that gets one does what the shaper does, and the others are told why not."""

from __future__ import annotations

import numpy as np
import pytest

import preshape
from preshape.export import TARGETS, SettingsTarget, paste_ready
from preshape.vibration import residual_vibration

FIRMWARES = ["klipper", "klipper-plugin", "kalico", "rrf", "marlin", "marlin-ft", "prusa"]
SHAPERS = {
    "zv": preshape.design.zv((45.0, 0.08)),
    "ei": preshape.design.ei((45.0, 0.08)),
    "two modes": preshape.design.convolved([(42.0, 0.05), (71.0, 0.06)], "zv"),
    "many impulses": preshape.design.convolved([(42.0, 0.05), (71.0, 0.06)], "zvd"),
    "too fast for Prusa": preshape.design.mzv((140.0, 0.05)),
}


@pytest.mark.parametrize("axis", [None, "x", "y"])
@pytest.mark.parametrize("name", SHAPERS)
def test_the_firmware_does_what_the_shaper_does(name: str, axis: str | None) -> None:
    """The text is read back as the firmware reads it, and its pulses are measured around the modes."""
    shaper = SHAPERS[name]
    texts = paste_ready(shaper, axis)
    assert sorted(text.target for text in texts) == sorted(FIRMWARES)
    assert shaper.design.modes is not None
    for text in texts:
        target = TARGETS[text.target]
        assert isinstance(target, SettingsTarget)
        if not text.fits:
            assert text.note and not text.text and len(text.note) <= 120
            continue
        does = target.execute(text.text, text.version, axis if target.axes else None)
        for mode in shaper.design.modes:
            around = mode.frequency * np.linspace(0.9, 1.1, 9)
            more = residual_vibration(does, around, mode.damping) - residual_vibration(shaper, around, mode.damping)
            assert more.max() <= 0.05 + 1e-9
            if not text.note:  # nothing is said to be lost
                assert more.max() <= 0.0051


def test_who_cannot_hold_a_shaper_is_told_why() -> None:
    fast = {text.target: text for text in paste_ready(SHAPERS["too fast for Prusa"])}
    assert not fast["prusa"].fits and "10 to 100 Hz" in fast["prusa"].note
    many = {text.target: text for text in paste_ready(SHAPERS["many impulses"])}
    assert not many["rrf"].fits and "9 impulses" in many["rrf"].note
    assert not many["marlin"].fits and "% more of the vibration" in many["marlin"].note
    assert many["klipper-plugin"].fits


def test_the_text_is_the_file_without_its_comments() -> None:
    for text in paste_ready(SHAPERS["zv"], "x"):
        if text.fits:
            content = next(str(one) for name, one in text.files.items() if name.endswith((".cfg", ".g")))
            assert all(line in content.splitlines() for line in text.text.splitlines())
            assert "preshape export" in content and "preshape export" not in text.text
            assert all(name.startswith(f"{text.target}/") for name in text.files)


def test_an_axis_that_a_firmware_lacks_is_its_reason() -> None:
    texts = {text.target: text for text in paste_ready(SHAPERS["zv"], "z")}
    assert texts["klipper"].fits and "shaper_type_z" in texts["klipper"].text
    assert not texts["kalico"].fits and "axis" in texts["kalico"].note
