"""A dropped file in memory gives what the same file on a disk gives, and no bytes do more than be refused."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.identify.valid_files import valid_files

from preshape import identify
from preshape.errors import InputError, MeasurementError
from preshape.workflow.workbench import measured, plain_measured

FILES = valid_files()
GANTRY = Path(__file__).resolve().parents[3] / "examples" / "data" / "gantry_x.csv"


@pytest.mark.parametrize("kind", FILES)
def test_a_file_in_memory_is_read_as_from_a_disk(kind: str, tmp_path: Path) -> None:
    path = tmp_path / "dropped"
    path.write_bytes(FILES[kind])
    part = "axis_X" if "two" in kind else None
    there = identify.read(path, part=part)
    here = identify.read_bytes(FILES[kind], str(path), part=part)
    assert type(here) is type(there) and here.remarks == there.remarks and here.format == there.format
    for field in ("values", "density", "frequencies", "sample_rate", "start"):
        if hasattr(there, field):
            np.testing.assert_array_equal(getattr(here, field), getattr(there, field))


def test_the_modes_are_those_of_the_command_line() -> None:
    found = measured(GANTRY.read_bytes(), "C:\\fakepath\\gantry_x.csv")
    expected = identify.find_modes(identify.read(GANTRY))
    assert found.name == "gantry_x.csv"
    assert found.modes == expected.modes and found.clear == expected.clear
    shown = plain_measured(found)
    assert json.dumps(shown, allow_nan=False)
    peak = found.frequencies[int(np.argmax(found.density))]
    assert peak == pytest.approx(found.modes[0].mode.frequency, rel=0.05)


def test_no_peak_is_lost_where_a_long_spectrum_is_thinned() -> None:
    rate, count = 2000.0, 60_000
    times = np.arange(count) / rate
    ringing = np.exp(-2.0 * times) * np.sin(2.0 * np.pi * 123.4 * times)
    rows = "".join(f"{t:.6f},{x:.9e}\n" for t, x in zip(times, ringing, strict=True))
    content = ("time,x [g]\n" + rows).encode()
    found = measured(content, "long.csv")
    whole = identify.find_modes(identify.read_bytes(content, "long.csv")).spectrum
    assert found.frequencies.size <= 2000
    assert found.density.max() == whole.total.max()
    assert (np.diff(found.frequencies) > 0.0).all()


@settings(max_examples=60)
@given(st.binary(max_size=400), st.text(max_size=40))
def test_no_bytes_do_more_than_be_refused_in_a_sentence(content: bytes, name: str) -> None:
    try:
        measured(content, name)
    except MeasurementError as error:
        assert str(error).endswith(".") and "\n" not in str(error)


@settings(max_examples=60)
@given(st.sampled_from(sorted(FILES)), st.data())
def test_a_damaged_file_is_read_or_refused_in_a_sentence(kind: str, data: st.DataObject) -> None:
    content = bytearray(FILES[kind])
    for _ in range(data.draw(st.integers(1, 8))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    cut = data.draw(st.integers(0, len(content)))
    try:
        measured(bytes(content[:cut]), "damaged")
    except InputError as error:
        assert "\n" not in str(error)


def test_a_larger_file_than_allowed_is_refused_unread() -> None:
    with pytest.raises(MeasurementError, match=r"big.csv: the file has 0.002 MB and the limit is 0.001 MB"):
        measured(b"x" * 2000, "big.csv", largest=1000)


@pytest.mark.parametrize("maximum", [0, 13])
def test_more_modes_than_the_workbench_holds_are_not_looked_for(maximum: int) -> None:
    with pytest.raises(InputError, match="1 to 12"):
        measured(GANTRY.read_bytes(), "gantry_x.csv", maximum=maximum)
