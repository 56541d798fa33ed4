"""Commands of pandas and xarray: the same numbers as arrays give, with the labels kept and the times gone on."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np
import pytest

from preshape import Shaper, design
from preshape.errors import InputError

pd = pytest.importorskip("pandas")
xr = pytest.importorskip("xarray")

DT = 0.004
SHAPER = design.zvd((20.0, 0.05))
MOVE = np.clip(np.linspace(-0.5, 1.5, 101), 0.0, 1.0)
PAIR = np.stack([MOVE, 3.0 - 2.0 * MOVE])
LENGTH = SHAPER.shape(MOVE, DT).size

INDICES = {
    "seconds": pd.Index(5.0 + DT * np.arange(101), name="t"),
    "durations": pd.to_timedelta(DT * np.arange(101), unit="s"),
    "dates": pd.date_range("2026-03-01 12:00", periods=101, freq="4ms", name="when"),
    "zone": pd.date_range("2026-03-29 00:59:59.9", periods=101, freq="4ms", tz="UTC"),
}


@pytest.mark.parametrize("index", INDICES.values(), ids=INDICES)
def test_a_series_keeps_its_name_and_its_index_goes_on(index: Any) -> None:
    series = pd.Series(MOVE, index=index, name="x [mm]")
    series.attrs["machine"] = "gantry"
    shaped = SHAPER.shape(series)
    assert isinstance(shaped, pd.Series) and shaped.name == "x [mm]" and shaped.attrs == {"machine": "gantry"}
    assert shaped.index.name == index.name and shaped.index.dtype == index.dtype
    np.testing.assert_allclose(shaped.to_numpy(), SHAPER.shape(MOVE, DT), atol=1e-12)
    assert shaped.index[:101].equals(index)
    steps = (shaped.index - shaped.index[0]) / (index[1] - index[0])
    np.testing.assert_allclose(np.asarray(steps, dtype=float), np.arange(LENGTH), atol=1e-6)


def test_a_data_frame_is_shaped_column_by_column() -> None:
    frame = pd.DataFrame(PAIR.T, index=INDICES["seconds"], columns=["x", "shaped"])  # the name of a method
    shaped = SHAPER.shape(frame, initial=[[0.0], [3.0]])
    assert list(shaped.columns) == ["x", "shaped"]
    for k, name in enumerate(frame.columns):
        np.testing.assert_allclose(shaped[name], SHAPER.shape(PAIR[k], DT, initial=3.0 * k), atol=1e-12)


def test_an_index_that_counts_needs_the_sample_time() -> None:
    series = pd.Series(MOVE, index=pd.RangeIndex(10, 212, 2))
    with pytest.raises(InputError, match="index only counts: give dt"):
        SHAPER.shape(series)
    shaped = SHAPER.shape(series, DT)
    np.testing.assert_allclose(shaped, SHAPER.shape(MOVE, DT), atol=1e-12)
    assert shaped.index.tolist() == list(range(10, 10 + 2 * LENGTH, 2))


def test_dates_in_coarse_units_are_even_within_their_resolution() -> None:
    """3 kHz in microseconds: 333, 333, 334 ..."""
    microseconds = np.round(1e6 / 3000.0 * np.arange(101)).astype("timedelta64[us]")
    series = pd.Series(MOVE, index=pd.TimedeltaIndex(microseconds))
    expected = SHAPER.shape(MOVE, 1.0 / 3000.0)
    np.testing.assert_allclose(SHAPER.shape(series).to_numpy()[: expected.size], expected, atol=1e-4)


@pytest.mark.parametrize(
    ("index", "options", "says"),
    [
        (np.cumsum(np.linspace(1.0, 1.1, 101)), {}, "not evenly spaced"),
        (-DT * np.arange(101), {}, "not evenly spaced and increasing"),
        (DT * np.arange(101), {"dt": 0.005}, "says 0.004 s"),
        ([f"row {k}" for k in range(101)], {"dt": DT}, "is no time"),
        ([*range(100), 7], {"dt": DT}, "does not count evenly"),
        (pd.MultiIndex.from_product([[0], range(101)]), {"dt": DT}, "several levels"),
        (pd.DatetimeIndex([*INDICES["dates"][:100], pd.NaT]), {}, "NaT"),
        (pd.period_range("2026-01", periods=101, freq="M"), {}, "is no time"),
    ],
)
def test_an_index_that_is_no_even_time_is_refused(index: Any, options: dict[str, float], says: str) -> None:
    with pytest.raises(InputError, match=says):
        SHAPER.shape(pd.Series(MOVE, index=index), **options)


def test_what_is_no_number_is_refused() -> None:
    frame = pd.DataFrame({"x": MOVE, "tool": ["a"] * 101}, index=INDICES["seconds"])
    with pytest.raises(InputError, match="no number"):
        SHAPER.shape(frame)
    with pytest.raises(InputError, match="no samples"):
        SHAPER.shape(pd.Series([], dtype=float, index=pd.Index([], dtype=float)))
    with pytest.raises(InputError, match="NaN"):
        SHAPER.shape(pd.Series(np.append(MOVE[:-1], np.nan), index=INDICES["seconds"]))


@pytest.mark.parametrize("first", ["axis", "time"])
def test_a_data_array_keeps_its_dimensions_and_coordinates(first: str) -> None:
    array = xr.DataArray(
        PAIR, dims=("axis", "time"), name="position", attrs={"unit": "mm"},
        coords={"axis": ["x", "y"], "time": ("time", DT * np.arange(101), {"units": "s"}), "mass": 3.0},
    )  # fmt: skip
    shaped = SHAPER.shape(array.transpose(first, ...))
    assert shaped.dims[0] == first and shaped.name == "position" and shaped.attrs == {"unit": "mm"}
    assert list(shaped["axis"].values) == ["x", "y"] and float(shaped["mass"]) == 3.0
    assert shaped["time"].attrs == {"units": "s"}
    np.testing.assert_allclose(shaped["time"], DT * np.arange(LENGTH), atol=1e-12)
    np.testing.assert_allclose(shaped.transpose("axis", "time"), SHAPER.shape(PAIR, DT), atol=1e-12)


def test_a_data_array_without_that_name_or_without_times() -> None:
    dates = xr.DataArray(MOVE, dims="t", coords={"t": INDICES["dates"].to_numpy()})
    shaped = SHAPER.shape(dates)
    assert (np.diff(shaped["t"].values) == np.timedelta64(4, "ms")).all() and shaped.sizes["t"] == LENGTH
    bare = xr.DataArray(PAIR.T, dims=("t", "axis"))
    np.testing.assert_allclose(SHAPER.shape(bare, DT, axis=0).values.T, SHAPER.shape(PAIR, DT), atol=1e-12)
    with pytest.raises(InputError, match="only counts"):
        SHAPER.shape(bare, axis=0)


def test_a_data_array_that_cannot_be_continued_is_refused() -> None:
    array = xr.DataArray(MOVE, dims="time", coords={"time": DT * np.arange(101)})
    with pytest.raises(InputError, match="'phase' along 'time' cannot be continued"):
        SHAPER.shape(array.assign_coords(phase=("time", MOVE)))
    with pytest.raises(InputError, match="is in 'ms'"):
        SHAPER.shape(array.assign_coords(time=("time", 4.0 * np.arange(101), {"units": "ms"})))
    with pytest.raises(InputError, match="Dataset is shaped array by array"):
        SHAPER.shape(array.to_dataset(name="x"))
    with pytest.raises(InputError, match="axis 3 is none"):
        SHAPER.shape(array.rename(time="t"), axis=3)
    with pytest.raises(InputError, match="no dimension"):
        SHAPER.shape(xr.DataArray(1.0))
    whole = array.to_dataset(name="x").map(SHAPER.shape)
    assert whole["x"].sizes["time"] == LENGTH


def test_shaping_arrays_imports_neither_package() -> None:
    code = "import sys, preshape; preshape.design.zv((5.0, 0.0)).shape([0.0, 1.0], 0.01); "
    code += "assert not {'pandas', 'xarray', 'control'} & set(sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)


def test_the_identity_changes_nothing() -> None:
    series = pd.Series(MOVE, index=INDICES["seconds"])
    pd.testing.assert_series_equal(Shaper([0.0], [1.0]).shape(series), series)
