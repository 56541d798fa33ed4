"""A record with its input beside the outputs, from plants that SciPy simulates."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.signal import StateSpace, chirp, lsim

from preshape.errors import InputError, MeasurementError
from preshape.identify import TimeSeries, find_modes, read
from preshape.workflow import calibrate

RATE, SAMPLES = 500.0, 20_000


def driven(kind: str, modes: list[tuple[float, float, float]], out: str) -> tuple[NDArray[np.float64], ...]:
    """An input, and the acceleration or place of what it drives, with 3 % of noise; modes with their parts."""
    rng = np.random.default_rng(2)
    times = np.arange(SAMPLES) / RATE
    given = rng.normal(size=SAMPLES) if kind == "noise" else chirp(times, 8.0, times[-1], 160.0)
    output = np.zeros(SAMPLES)
    for frequency, damping, part in modes:
        w = 2.0 * np.pi * frequency
        row, direct = ([-(w**2), -2.0 * damping * w], 1.0) if out == "acceleration" else ([w**2, 0.0], 0.0)
        plant = StateSpace([[0.0, 1.0], [-(w**2), -2.0 * damping * w]], [[0.0], [1.0]], [row], [[direct]])
        output += part * lsim(plant, given, times)[1]
    return given, output + 0.03 * output.std() * rng.normal(size=SAMPLES)


@pytest.mark.parametrize("kind", ["noise", "sweep"])
@pytest.mark.parametrize("out", ["acceleration", "place"])
@pytest.mark.parametrize(
    "modes", [[(47.3, 0.045, 1.0)], [(40.0, 0.1, 1.0)], [(60.0, 0.02, 1.0)], [(47.3, 0.045, 0.6), (78.6, 0.06, 0.4)]]
)
def test_modes_come_from_the_response_to_the_input(
    kind: str, out: str, modes: list[tuple[float, float, float]]
) -> None:
    found = find_modes(TimeSeries(RATE, 0.0, np.array(driven(kind, modes, out)), ("force", "y")), excitation="force")
    assert found.method == "known input" and found.clear and len(found.modes) == len(modes)
    by_frequency = sorted(found.modes, key=lambda one: one.mode.frequency)
    for one, (frequency, damping, _) in zip(by_frequency, modes, strict=True):
        assert one.mode.frequency == pytest.approx(frequency, rel=3e-3)
        assert one.mode.damping == pytest.approx(damping, rel=0.1)


def test_a_table_with_the_input_in_a_column_is_calibrated(tmp_path: Path) -> None:
    given, output = driven("noise", [(47.3, 0.045, 1.0)], "place")
    table = np.column_stack([np.arange(SAMPLES) / RATE, given, output])
    path = tmp_path / "shaker.csv"
    np.savetxt(path, table, fmt="%.6g", delimiter=",", header="time,force,y", comments="")
    calibration = calibrate(path, excitation="force")
    assert calibration.modes[0].mode.frequency == pytest.approx(47.3, rel=3e-3)
    assert calibration.modes[0].mode.damping == pytest.approx(0.045, rel=0.1)
    assert calibration.clear and calibration.chosen.left <= calibration.tolerance


def test_an_input_that_does_not_drive_the_machine_is_said() -> None:
    _, output = driven("noise", [(47.3, 0.045, 1.0)], "place")
    other = np.random.default_rng(9).normal(size=SAMPLES)
    found = find_modes(TimeSeries(RATE, 0.0, np.array([other, output]), ("force", "y")), excitation="force")
    assert not found.clear and "explains only" in found.trouble[-1]


def test_what_is_no_input_is_refused() -> None:
    given, output = driven("noise", [(47.3, 0.045, 1.0)], "place")
    series = TimeSeries(RATE, 0.0, np.array([given, output]), ("force", "y"))
    with pytest.raises(InputError, match="there are force, y"):
        find_modes(series, excitation="torque")
    with pytest.raises(InputError, match="several channels"):
        find_modes(TimeSeries(RATE, 0.0, output[None, :], ("y",)), excitation="y")
    with pytest.raises(MeasurementError, match="constant"):
        find_modes(TimeSeries(RATE, 0.0, np.array([0.0 * given, output]), ("force", "y")), excitation="force")
    path = Path(__file__).parents[2] / "examples" / "data" / "gantry_x.csv"
    with pytest.raises(InputError, match="there are"):
        find_modes(read(path), excitation="force")
