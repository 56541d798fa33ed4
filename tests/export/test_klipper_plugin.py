"""The module for klippy/extras, run in a stand-in for Klipper's host whose kernel keeps the real one's rules."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.export.klippy import Config, InputShaper, Printer, Refused

from preshape import design
from preshape.export import render
from preshape.export.config_text import section_of

MOST = {"2026-03": 10, "old": 5, "kalico": 25}


def loaded(source: str, settings: dict[str, str], printer: Printer) -> Any:
    names: dict[str, Any] = {}
    exec(compile(source, "preshape_shaper.py", "exec"), names)
    return names["load_config"](Config(printer, settings))


def module(version: str = "2026-03") -> str:
    return str(render(design.zv((40.0, 0.1)), "klipper-plugin", version=version).files["preshape_shaper.py"])


@pytest.mark.parametrize("version", MOST)
def test_klipper_executes_the_impulses(version: str) -> None:
    """Through the section that was written, the module that was written, and the kernel's rules."""
    shaper = design.direct([(41.0, 0.05), (66.0, 0.04)]) if version == "kalico" else design.zvdd((41.0, 0.05))
    exported = render(shaper, "klipper-plugin", version=version, axis="x")
    input_shaper = InputShaper(MOST[version], "xy")
    printer = Printer(input_shaper)
    settings = section_of(str(exported.files["shaper.cfg"]), "preshape_shaper")
    loaded(str(exported.files["preshape_shaper.py"]), dict(settings), printer)
    assert not input_shaper.kernel, "until Klipper is ready"
    printer.events["klippy:ready"]()
    amplitudes, times = input_shaper.kernel["x"]
    np.testing.assert_allclose(times, shaper.times, atol=1e-12)
    np.testing.assert_allclose(amplitudes, shaper.amplitudes, atol=1e-11)
    does = exported.placed.shaper
    np.testing.assert_allclose(times, does.times, rtol=1e-15)
    np.testing.assert_allclose(amplitudes, does.amplitudes, rtol=1e-15)
    assert input_shaper.kernel["y"][1] == [0.0, 0.01], "the other axis keeps its own"
    printer.commands["PRESHAPE_SHAPER"](printer)
    assert printer.said == [f"preshape_shaper: x: {len(shaper)} impulses in {shaper.duration:.6f} s"]


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"amplitudes_x": "1,1"}, "as many numbers"),
        ({"amplitudes_x": "1,1", "times_x": "0"}, "as many numbers"),
        ({"amplitudes_x": "1,1", "times_x": "0,0"}, "must increase"),
        ({"amplitudes_x": "1,-1", "times_x": "0,1"}, "positive sum"),
        ({"amplitudes_x": "1,nan", "times_x": "0,1"}, "finite"),
        ({"amplitudes_x": ",".join("1" * 11), "times_x": ",".join(map(str, range(11)))}, "this firmware holds 10"),
    ],
)
def test_the_module_refuses_what_the_kernel_would(settings: dict[str, str], sentence: str) -> None:
    with pytest.raises(Refused, match=sentence):
        loaded(module(), settings, Printer(InputShaper(10, "xy")))


def test_the_module_says_what_is_missing() -> None:
    settings = {"amplitudes_z": "1,1", "times_z": "0,0.01"}
    printer = Printer(InputShaper(10, "xy"))
    loaded(module(), settings, printer)
    with pytest.raises(Refused, match="this firmware shapes no z"):
        printer.events["klippy:ready"]()
    printer = Printer(None)
    loaded(module(), settings, printer)
    with pytest.raises(Refused, match="needs a section \\[input_shaper\\]"):
        printer.events["klippy:ready"]()


def test_a_negative_shaper_goes_to_klipper() -> None:
    """Its kernel does not look at signs."""
    shaper = design.um_zvd((40.0, 0.05))
    assert (render(shaper, "klipper-plugin").placed.shaper.amplitudes < 0.0).any()
