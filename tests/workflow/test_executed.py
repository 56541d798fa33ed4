"""What a machine does with its settings, and what that leaves of a measurement."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from preshape import design
from preshape.errors import InputError
from preshape.export import TARGETS, AnyTarget, Target, klipper, render
from preshape.workflow import executed_shaper, left_of_spectrum, save_export

GANTRY = Path(__file__).resolve().parents[2] / "examples" / "data" / "gantry_x.csv"


def test_settings_in_a_file(tmp_path: Path) -> None:
    path = tmp_path / "config.g"
    path.write_text('M593 P"mzv" F50 S0.1\n')
    wrong, right = executed_shaper(path, "rrf"), design.mzv((50.0, 0.1))
    np.testing.assert_allclose(wrong.amplitudes, right.amplitudes[::-1], rtol=1e-12)
    assert wrong.design.residual == pytest.approx(0.162, abs=5e-4) and str(wrong.design.modes) == str(
        right.design.modes
    )
    (tmp_path / "printer.cfg").write_text("[input_shaper]\nshaper_freq_x: 41\nshaper_freq_y: 50\n")
    assert executed_shaper(tmp_path / "printer.cfg", "klipper", axis="y") == klipper.mzv(50.0, 0.1)
    assert executed_shaper(tmp_path / "printer.cfg", "klipper", version="old", axis="x") == klipper.mzv(41.0, 0.1)


@pytest.mark.parametrize("target", TARGETS.values(), ids=list(TARGETS))
def test_an_export_in_its_folder(target: AnyTarget, tmp_path: Path) -> None:
    asked = design.zvd((41.0, 0.05))
    grid = {"dt": 0.001} if isinstance(target, Target) else {}
    exported = render(asked, target.name, **grid)  # type: ignore[arg-type]
    saved = save_export(exported, tmp_path / "out")
    assert executed_shaper(tmp_path / "out", target.name) == exported.placed.shaper
    if len(saved.files) == 1:
        assert executed_shaper(saved.files[0], target.name) == exported.placed.shaper


def test_what_is_left_of_a_measurement() -> None:
    """A shaper for its modes leaves little, one for elsewhere much, by both measures."""
    fitting, elsewhere = design.direct([(47.0, 0.03), (79.0, 0.03)]), design.zv((150.0, 0.05))
    good, bad = left_of_spectrum(fitting, GANTRY), left_of_spectrum(elsewhere, GANTRY)
    assert good.by_klipper < 0.02 and good.amplitude < 0.1
    assert bad.by_klipper > 0.3 and bad.amplitude > 0.3
    assert good.name == "gantry_x.csv"


@pytest.mark.parametrize(
    ("name", "target", "options", "sentence"),
    [
        ("none.g", "rrf", {}, "cannot read"),
        ("x.g", "c", {}, "x.g: 0 of 1 files are named \\*.h: give those of one export"),
        ("x.g", "c", {"axis": "x"}, "target c shapes one axis: leave the axis out"),
        ("x.g", "nothing", {}, "target 'nothing' is not known: it is c, linuxcnc"),
        ("x.g", "rrf", {"version": "3.3"}, "version '3.3' is not known for target rrf: it is 3.6 or 3.5"),
        ("x.g", "rrf", {}, "x.g: there is no line with M593"),
        ("big.g", "rrf", {}, "big.g is larger than 1 MB"),
        (".", "rrf", {}, "2 of 2 files are named \\*.g: give those of one export"),
        ("many", "rrf", {}, "more than 100 files or 50 MB"),
    ],
)
def test_what_cannot_be_read(name: str, target: str, options: dict[str, str], sentence: str, tmp_path: Path) -> None:
    (tmp_path / "x.g").write_text("G28\n")
    (tmp_path / "big.g").write_text(";" * 1_000_001)
    (tmp_path / "many").mkdir()
    for index in range(101):
        (tmp_path / "many" / f"{index}.g").touch()
    with pytest.raises(InputError, match=sentence):
        executed_shaper(tmp_path / name, target, **options)
