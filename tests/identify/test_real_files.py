"""Real measurements, where they are present (../shared/data; not ours to ship)."""

import numpy as np
import pytest
from tests.identify.simulation import REAL

from preshape.identify import find_modes, read

FILES = sorted(REAL.glob("*.csv"))


def identified(name):
    path = REAL / name
    if not path.exists():
        pytest.skip(f"the real measurements are not here: {path}")
    return find_modes(read(path))


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_every_file_gives_modes(path):
    found = find_modes(read(path))
    assert 1 <= len(found.modes) <= 4
    shares = [mode.share for mode in found.modes]
    assert shares == sorted(shares, reverse=True)
    assert sum(shares) <= 1.0 + 1e-9
    for mode in found.modes:
        assert 10.0 <= mode.mode.frequency <= 131.0
        assert mode.frequency_interval[0] < mode.mode.frequency < mode.frequency_interval[1]
        assert mode.damping_interval[0] < mode.mode.damping < mode.damping_interval[1]
    assert np.isfinite(found.fitted).any()


def test_the_one_clean_mode():
    found = identified("katodo_resonances_y_20220403_180145.csv")
    assert found.clear
    assert len(found.modes) == 1
    assert found.modes[0].mode.frequency == pytest.approx(55.0, abs=1.5)
    assert 0.02 < found.modes[0].mode.damping < 0.06


def test_the_first_crossbeam():
    """Two humps at 74 and 90 Hz in the file, and the edge of the sweep at 133 Hz."""
    found = identified("katodo_resonances_x_20220226.csv")
    assert found.clear
    strongest = sorted(mode.mode.frequency for mode in found.modes[:2])
    assert strongest == pytest.approx([77.0, 91.0], abs=3.0)


@pytest.mark.parametrize(
    "name",
    [
        "sammcj_calibration_data_x_20230321_165958.csv",
        "sammcj_calibration_data_y_20230321_165958.csv",
        "sammcj_resonances_x_20230321_171058.csv",
        "sammcj_resonances_y_20230321_171849.csv",
    ],
)
def test_the_rattling_machine_is_in_trouble(name):
    found = identified(name)
    assert not found.clear
    assert found.trouble


@pytest.mark.parametrize("axis", ["X", "Y"])
def test_unshaped_captures_ring_where_the_owner_tuned(axis):
    """The owner's shaper stands at 39.65 Hz; the motor line at 149 Hz is no mode of the structure."""
    found = identified(f"rrf_argolein_29-{axis}73-200-121.0-none.csv")
    assert found.method == "ring-down"
    assert any(35.0 < mode.mode.frequency < 47.0 for mode in found.modes)
    assert all(mode.mode.frequency < 140.0 for mode in found.modes)
