"""What a machine does with its settings, and what that leaves of a measurement."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from preshape import design
from preshape.errors import InputError
from preshape.export import klipper
from preshape.workflow import executed_shaper, left_of_spectrum

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
        ("x.g", "c", {}, "'c' takes no settings that could be looked at: it is one of klipper"),
        ("x.g", "nothing", {}, "'nothing' takes no settings"),
        ("x.g", "rrf", {"version": "3.3"}, "version '3.3' is not known for rrf: it is 3.6 or 3.5"),
        ("x.g", "rrf", {}, "x.g: there is no line with M593"),
        ("big.g", "rrf", {}, "larger than a megabyte"),
        (".", "rrf", {}, "cannot read"),
    ],
)
def test_what_cannot_be_read(name: str, target: str, options: dict[str, str], sentence: str, tmp_path: Path) -> None:
    (tmp_path / "x.g").write_text("G28\n")
    (tmp_path / "big.g").write_text(";" * 1_000_001)
    with pytest.raises(InputError, match=sentence):
        executed_shaper(tmp_path / name, target, **options)
