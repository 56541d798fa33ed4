"""Formats beside text tables: what went in comes out, and what is wrong is said."""

import io
import json
import pickle
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.io import savemat, wavfile
from tests.identify.test_readers import AXES, write

from preshape.errors import MeasurementError
from preshape.identify import Spectrum, TimeSeries, find_modes, read


def stdata(*measurements):
    """What Shake&Tune writes: a line of JSON a measurement, compressed."""
    zstandard = pytest.importorskip("zstandard")
    lines = "".join(json.dumps({"name": name, "samples": rows}) + "\n" for name, rows in measurements)
    return zstandard.ZstdCompressor(level=3).compress(lines.encode())


def samples(count, seed):
    values = np.random.default_rng(seed).normal(0.0, 500.0, (count, 3))
    return [[7.0 + k / 3200.0, *row] for k, row in enumerate(values.tolist())]


def test_stdata(tmp_path):
    rows = samples(500, 1)
    series = read(write(tmp_path, stdata(("axis_X_20250101_101010", rows))))
    assert isinstance(series, TimeSeries)
    assert (series.channels, series.unit) == (("x", "y", "z"), "mm/s^2")
    np.testing.assert_array_equal(series.values, np.array(rows)[:, 1:].T)
    assert series.format.startswith("Klipper raw data")  # it is scored as such


def test_stdata_with_several_measurements(tmp_path):
    first, second = samples(100, 1), samples(100, 2)
    path = write(tmp_path, stdata(("belt_A_20250101", first), ("belt_B_20250101", second)))
    with pytest.raises(MeasurementError, match="2 measurements .belt_A_20250101, belt_B_20250101.; say which one"):
        read(path)
    np.testing.assert_array_equal(read(path, part="belt_B").values, np.array(second)[:, 1:].T)
    with pytest.raises(MeasurementError, match="2 measurements in the file is called 'belt'|2 measurements.*'belt'"):
        read(path, part="belt")
    with pytest.raises(MeasurementError, match="no measurement in the file is called 'y'"):
        read(path, part="y")


def test_a_pickled_stdata_is_never_run(tmp_path):
    """Older versions of Shake&Tune compressed a pickle; one that writes a file when it is loaded shows that none is."""
    zstandard = pytest.importorskip("zstandard")
    proof = tmp_path / "proof"

    class Program:
        def __reduce__(self):
            return (Path.write_text, (proof, "it ran"))

    path = write(tmp_path, zstandard.ZstdCompressor().compress(pickle.dumps([Program()])))
    with pytest.raises(MeasurementError, match="pickle, which is a program and is never run"):
        read(path)
    assert not proof.exists()


def test_a_decompression_bomb_is_refused(tmp_path):
    zstandard = pytest.importorskip("zstandard")
    path = write(tmp_path, zstandard.ZstdCompressor(level=19).compress(b" " * 250_000_000))
    assert path.stat().st_size < 100_000
    with pytest.raises(MeasurementError, match="decompressed it has 200 MB or more"):
        read(path)
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        header = (
            b"\x93NUMPY\x01\x00v\x00{'descr': '<f8', 'fortran_order': False, 'shape': (31250000,), }".ljust(127) + b"\n"
        )
        archive.writestr("x.npy", header + bytes(250_000_000))
    with pytest.raises(MeasurementError, match="decompressed it has 200 MB or more"):
        read(write(tmp_path, buffer.getvalue()), sample_rate=1.0)


def test_a_package_that_is_missing_is_named(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "zstandard", None)
    with pytest.raises(MeasurementError, match=r"needs the package zstandard; pip install 'preshape\[formats\]'"):
        read(write(tmp_path, b"\x28\xb5\x2f\xfd" + bytes(100)))
    monkeypatch.setitem(sys.modules, "pyuff", None)
    with pytest.raises(MeasurementError, match=r"needs the package pyuff; pip install 'preshape\[formats\]'"):
        read(write(tmp_path, b"    -1\n    58\n" + b"x\n" * 20))


def prusa_report(frequencies, gains):
    """The firmware's lines: header, the sensor's rate, a row of five a frequency, and what it says at the end."""
    lines = [AXES + ",mzv", "Sample freq: 1344.27"]
    for frequency, (x, y, z) in zip(frequencies, gains, strict=True):
        lines.append(f"{frequency:.2f},{x:.5f},{y:.5f},{z:.5f},{x + y + z:.5f}")
    return "\n".join([*lines, "ZV tune: Maximum resonant gain: 3.21", "ok", ""])


def test_prusa_report(tmp_path):
    """Squared gains of a mass carried by a spring: the mode that made them is found."""
    frequencies = np.arange(5.0, 150.0, 1.0)
    ratio, damping = frequencies / 42.0, 0.08
    gain = (1 + (2 * damping * ratio) ** 2) / ((1 - ratio**2) ** 2 + (2 * damping * ratio) ** 2)
    text = prusa_report(frequencies, np.array([gain, 0.01 * gain, 0.001 * gain]).T)
    spectrum = read(write(tmp_path, text))
    assert isinstance(spectrum, Spectrum)
    assert (spectrum.channels, spectrum.excitation_exponent) == (("x", "y", "z"), 0.0)
    np.testing.assert_allclose(spectrum.density[0], gain, atol=6e-6)
    np.testing.assert_allclose(spectrum.printed.power[0], 1.011 * gain, atol=2e-5)
    mode = find_modes(spectrum).modes[0].mode
    assert mode.frequency == pytest.approx(42.0, rel=0.01)
    assert mode.damping == pytest.approx(0.08, rel=0.1)


def test_prusa_report_twice_in_one_log(tmp_path):
    text = prusa_report(np.arange(5.0, 50.0), np.ones((45, 3)))
    with pytest.raises(MeasurementError, match="second report begins at line 50"):
        read(write(tmp_path, text + text))
    with pytest.raises(MeasurementError, match="line 10 is not a frequency and four"):
        read(write(tmp_path, text.replace("12.00,1.00000,", "12.00,")))


@given(
    form=st.sampled_from(["npy", "npz", "mat", "mat compressed"]),
    rows=st.integers(3, 60),
    channels=st.integers(1, 3),
    column=st.booleans(),
    given_as=st.sampled_from(["fs", "dt", "t", "argument"]),
    seed=st.integers(0, 99),
)
def test_arrays_round_trip(tmp_path_factory, form, rows, channels, column, given_as, seed):
    """Either axis may be time where the other is shorter; the rate comes as fs, dt, a time vector or the argument."""
    folder = tmp_path_factory.mktemp("arrays")
    values = np.random.default_rng(seed).normal(size=(channels, rows))
    if rows <= channels:
        return
    arrays = {"acceleration": values.T if column else values}
    arrays |= {"fs": {"fs": 1000.0}, "dt": {"dt": 0.001}, "t": {"t": np.arange(rows) * 0.001}}.get(given_as, {})
    rate = 1000.0 if given_as == "argument" else None
    path = folder / "no hint"
    with path.open("wb") as stream:
        if form == "npy":
            np.save(stream, arrays["acceleration"])
            rate = 1000.0
        elif form == "npz":
            np.savez(stream, **arrays)
        else:
            savemat(stream, arrays, do_compression="compressed" in form)
    series = read(path, sample_rate=rate)
    assert series.sample_rate == pytest.approx(1000.0, rel=1e-9)
    np.testing.assert_array_equal(series.values, values)


def test_arrays_with_several_records(tmp_path):
    path = tmp_path / "several.npz"
    np.savez(path, x=np.ones((40, 2)), y=np.zeros((50, 2)), fs=500.0)
    with pytest.raises(MeasurementError, match="holds 2 measurements .x, y.; say which"):
        read(path)
    assert read(path, part="y").values.shape == (2, 50)
    np.savez(path, x=np.arange(40.0), y=np.ones(40), t=np.arange(40) / 500.0)  # vectors beside one time are channels
    series = read(path)
    assert (series.channels, series.sample_rate) == (("x", "y"), pytest.approx(500.0))


def test_first_channel_is_the_time_where_nothing_else_says(tmp_path):
    path = tmp_path / "table.npy"
    np.save(path, np.array([np.arange(40) / 250.0, np.sin(np.arange(40.0))]).T)
    series = read(path)
    assert (series.sample_rate, len(series.channels)) == (pytest.approx(250.0), 1)
    record = np.zeros(40, dtype=[("time", float), ("x", float)])
    record["time"], record["x"] = np.arange(40) / 250.0, np.arange(40)
    np.save(path, record)
    assert read(path).channels == ("x",)


ARRAYS_THAT_ARE_REFUSED = {
    "objects": (np.array([{}, []], dtype=object), "pickled Python objects, which are programs and never loaded"),
    "complex": (np.ones(20, complex), "not real numbers"),
    "text": (np.array(["a", "b"]), "not real numbers"),
    "three axes": (np.ones((3, 4, 5)), "has 3 axes"),
    "NaN": (np.array([1.0, np.nan, 2.0]), "NaN or infinity"),
    "square": (np.ones((5, 5)), "which axis .* cannot be told"),
    "channels": (np.ones((100, 200)), "100 channels and at most 64"),
    "empty": (np.ones((0, 3)), "holds no measurement"),
}


@pytest.mark.parametrize("case", ARRAYS_THAT_ARE_REFUSED)
def test_arrays_that_are_refused(tmp_path, case):
    array, expected = ARRAYS_THAT_ARE_REFUSED[case]
    np.save(tmp_path / "a.npy", array)
    with pytest.raises(MeasurementError, match=expected):
        read(tmp_path / "a.npy", sample_rate=100.0)


def test_an_array_that_promises_more_than_is_there(tmp_path):
    """Terabytes in the header must not be set aside."""
    header = b"\x93NUMPY\x01\x00v\x00{'descr': '<f8', 'fortran_order': False, 'shape': (1000000000000,), }".ljust(127)
    with pytest.raises(MeasurementError, match="longer than the file"):
        read(write(tmp_path, header + b"\n" + bytes(800)), sample_rate=1.0)


def test_matlab_7_3_is_refused(tmp_path):
    head = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512) + b"\x89HDF\r\n\x1a\n" + bytes(100)
    with pytest.raises(MeasurementError, match="'-v7'"):
        read(write(tmp_path, head))


@pytest.mark.parametrize("kind", ["uint8", "int16", "int32", "float32"])
def test_wav_is_in_parts_of_full_scale(tmp_path, kind):
    wave = 0.5 * np.sin(2 * np.pi * 50.0 * np.arange(2000) / 2000.0)
    scaled = {
        "uint8": np.round(128.0 * wave + 128.0),
        "int16": np.round(wave * 2**15),
        "int32": np.round(wave * 2**31),
    }.get(kind, wave)
    wavfile.write(tmp_path / "bump.wav", 2000, np.array([scaled, 0.0 * scaled + scaled[::-1]]).T.astype(kind))
    series = read(tmp_path / "bump.wav")
    assert (series.sample_rate, series.unit, len(series.channels)) == (2000.0, "full scale", 2)
    np.testing.assert_allclose(series.values[0], wave, atol=1.0 / 128.0 if kind == "uint8" else 2e-5)


def dataset(pyuff, kind, x, values, node, unit="m/s^2", binary=0):
    return pyuff.prepare_58(
        binary=binary, func_type=kind, rsp_node=node, rsp_dir=-3, ref_node=1, ref_dir=1, id1="bump",
        abscissa_spacing=1, num_pts=len(x), abscissa_min=float(x[0]), abscissa_inc=float(x[1] - x[0]), x=x, data=values,
        ord_data_type=4, ordinate_spec_data_type=12, ordinate_axis_units_lab=unit, z_axis_value=0.0,
        abscissa_spec_data_type=17, orddenom_spec_data_type=0, z_axis_spec_data_type=0,
    )  # fmt: skip


@pytest.mark.filterwarnings(  # pyuff's binary writer leaves its file open
    "ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning"
)
@pytest.mark.parametrize("binary", [0, 1])
def test_universal_file(tmp_path, binary):
    pyuff = pytest.importorskip("pyuff")
    times, rng = np.arange(200) / 800.0, np.random.default_rng(4)
    values = rng.normal(size=(2, 200))
    path = tmp_path / "bump.uff"
    content = pyuff.UFF(str(path))
    for node, channel in enumerate(values, start=11):
        content.write_sets(dataset(pyuff, 1, times, channel, node, binary=binary), "add")
    series = read(path)
    assert (series.channels, series.unit) == (("11-z", "12-z"), "m/s^2")
    assert series.sample_rate == pytest.approx(800.0)
    np.testing.assert_allclose(series.values, values, rtol=1e-11)


def test_universal_file_of_spectra_and_of_what_is_not_read(tmp_path):
    pyuff = pytest.importorskip("pyuff")
    path = tmp_path / "spectra.uff"
    frequencies = np.arange(100) * 0.5
    content = pyuff.UFF(str(path))
    content.write_sets(dataset(pyuff, 9, frequencies, 1.0 + frequencies, 5), "add")
    spectrum = read(path)
    assert isinstance(spectrum, Spectrum)
    np.testing.assert_allclose(spectrum.density[0], 1.0 + frequencies)
    content.write_sets(dataset(pyuff, 1, frequencies, frequencies, 6), "add")
    with pytest.raises(MeasurementError, match="2 measurements .set 1, set 2."):
        read(path)
    assert isinstance(read(path, part="set 2"), TimeSeries)
    response = pyuff.UFF(str(tmp_path / "frf.uff"))
    response.write_sets(dataset(pyuff, 6, frequencies, 1.0 + frequencies, 5), "overwrite")
    with pytest.raises(MeasurementError, match="holds coherences; a measurement needs time responses"):
        read(tmp_path / "frf.uff")


def test_a_part_of_what_has_none(tmp_path):
    with pytest.raises(MeasurementError, match="holds one measurement; leave part out"):
        read(write(tmp_path, "time,x\n0,1\n0.1,2\n0.2,1\n"), part="x")


def test_rates_that_contradict_each_other(tmp_path):
    np.savez(tmp_path / "a.npz", x=np.arange(50.0), fs=1000.0, dt=0.01)
    with pytest.raises(MeasurementError, match="1000 Hz was given, but the file itself says 100 Hz"):
        read(tmp_path / "a.npz")


def test_what_is_not_wanted_may_be_of_any_kind(tmp_path):
    np.savez(tmp_path / "a.npz", x=np.arange(50.0), picture=np.ones((3, 4, 5)), fs=1000.0)
    with pytest.raises(MeasurementError, match="'picture' has 3 axes"):
        read(tmp_path / "a.npz")
    assert read(tmp_path / "a.npz", part="x").values.shape == (1, 50)
    with pytest.raises(MeasurementError, match="called .nope.; there are x, picture"):
        read(tmp_path / "a.npz", part="nope")


def test_short_numbers_that_would_fill_the_memory(tmp_path):
    """A byte in the file is eight in memory: the limit counts numbers."""
    np.savez_compressed(tmp_path / "a.npz", x=np.zeros(25_000_001, dtype=np.int8), fs=1000.0)
    with pytest.raises(MeasurementError, match="25 million numbers and at most 25 are taken"):
        read(tmp_path / "a.npz")
