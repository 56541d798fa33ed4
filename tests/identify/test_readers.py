"""Each format is told by its content, and the numbers come out as they went in."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from preshape.errors import InputError
from preshape.identify import Spectrum, TimeSeries, find_modes, read

AXES = "freq,psd_x,psd_y,psd_z,psd_xyz"


def write(folder, text, name="odd name.bin"):
    """Names carry no hint: content decides."""
    path = folder / name
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def spectrum_rows(spacing, count, extra=""):
    lines = []
    for k in range(count):
        x, y, z = 1.0 + k, 2.0, 0.5 * k
        lines.append(f"{k * spacing:.1f},{x:.3e},{y:.3e},{z:.3e},{x + y + z:.3e}{extra}\n")
    return "".join(lines)


def test_klipper_raw(tmp_path):
    rng = np.random.default_rng(3)
    times = 7.0 + np.arange(4000) / 3206.4 + rng.uniform(-1e-5, 1e-5, 4000)
    values = rng.normal(0.0, 500.0, (4000, 3))
    rows = "".join(f"{t:.6f},{a:.6f},{b:.6f},{c:.6f}\n" for t, (a, b, c) in zip(times, values, strict=True))
    series = read(write(tmp_path, "#time,accel_x,accel_y,accel_z\n" + rows))
    assert isinstance(series, TimeSeries)
    assert series.format == "Klipper raw data"
    assert (series.channels, series.unit, series.remarks) == (("x", "y", "z"), "mm/s^2", ())
    np.testing.assert_allclose(series.values, values.T, atol=5e-7)
    assert series.start == pytest.approx(times[0], abs=5e-7)
    # Klipper's own rule: N over the time from the first to the last sample, not N - 1
    assert series.sample_rate == pytest.approx(4000 / (round(times[-1], 6) - round(times[0], 6)), rel=1e-12)


def test_klipper_raw_gap_is_remarked(tmp_path):
    times = np.arange(100) / 1000.0
    times[50:] += 0.02
    rows = "".join(f"{t:.6f},1.0,2.0,3.0\n" for t in times)
    series = read(write(tmp_path, "#time,accel_x,accel_y,accel_z\n" + rows))
    assert any("1 gap" in remark for remark in series.remarks)


@pytest.mark.parametrize(
    ("header", "extra", "normalised"),
    [
        (AXES, "", False),
        (AXES + ",zv(51.2),mzv(31.0),2hump_ei(39.2)", ",1.000,0.900,0.800", True),
        (AXES + ",shapers:,zv(57.8),mzv(31.0)", ",,1.000,0.900", True),
        (AXES + ',shapers:,zv(57.8),"mzv(n=5,t=1.1)(31.0)"', ",,1.000,0.900", True),
        (AXES + ",accel_per_hz", ",75.0", False),
        (AXES + ",accel_per_hz,zv(57.8)", ",75.0,1.000", True),
        (AXES + ",mzv", ",0.500", True),
    ],
    ids=["resonances", "old", "shapers", "quoted", "kalico", "kalico+shapers", "prusa"],
)
def test_klipper_spectrum_variants(tmp_path, header, extra, normalised):
    spectrum = read(write(tmp_path, header + "\n" + spectrum_rows(1.5625, 120, extra)))
    assert isinstance(spectrum, Spectrum)
    assert spectrum.normalised is normalised
    assert spectrum.channels == ("x", "y", "z")
    assert spectrum.excitation_exponent == (1.0 if normalised else 2.0)
    np.testing.assert_allclose(spectrum.density[2], 0.5 * np.arange(120), rtol=5e-4)
    np.testing.assert_allclose(spectrum.total, 3.0 + 1.5 * np.arange(120), rtol=5e-4)


@given(st.floats(1.2, 1.7), st.integers(80, 170))
def test_true_grid_is_recovered(tmp_path_factory, spacing, count):
    text = AXES + "\n" + spectrum_rows(spacing, count)
    spectrum = read(write(tmp_path_factory.mktemp("grid"), text))
    # each rounded value confines df to 0.1 Hz / k, so the last one alone to this:
    assert abs(spectrum.frequencies[1] - spacing) <= 0.1 / (count - 1) + 1e-12
    np.testing.assert_allclose(np.diff(spectrum.frequencies), spectrum.frequencies[1], rtol=1e-9)
    assert spectrum.window_duration == pytest.approx(1.0 / spacing, rel=2e-3)


@pytest.mark.parametrize("shapers", ["", ',shapers:,"zv(57.8)"'])
def test_several_datasets(tmp_path, shapers):
    header = 'freq,"x at 10,10","x at 90,90"' + shapers
    extra = ",,1.000" if shapers else ""
    rows = "".join(f"{0.2 * k:.1f},{k}.5,{2 * k}.25{extra}\n" for k in range(50))
    spectrum = read(write(tmp_path, header + "\n" + rows))
    assert spectrum.channels == ("x at 10,10", "x at 90,90")
    assert spectrum.normalised is bool(shapers)
    np.testing.assert_array_equal(spectrum.density[1], 2.0 * np.arange(50) + 0.25)
    np.testing.assert_allclose(spectrum.frequencies, 0.2 * np.arange(50), atol=1e-9)
    assert 0.5 <= spectrum.window_duration <= 1.0  # an interpolated grid says nothing of the window


@pytest.mark.parametrize(
    ("trailer", "lost"),
    [("Rate 1342, overflows 0", 0), ("Rate 1342 overflows 0", 0), ("Rate: 1342, overflows: 2", 2)],
)
def test_rrf_capture(tmp_path, trailer, lost):
    rows = "".join(f"{k},{0.001 * k:.3f},-0.{k % 7},1.{k % 5}\n" for k in range(100))
    series = read(write(tmp_path, f"Sample,X,Y,Z\r\n{rows}{trailer}\r\n\r\n"))
    assert (series.sample_rate, series.unit, series.channels) == (1342.0, "g", ("x", "y", "z"))
    np.testing.assert_allclose(series.values[0], 0.001 * np.arange(1, 100))  # sample 0 is dropped
    assert series.times[0] == pytest.approx(1.0 / 1342.0)
    assert bool(series.remarks) is bool(lost)


def test_rrf_capture_of_one_axis_with_given_rate(tmp_path):
    path = write(tmp_path, "Sample,Z\n" + "".join(f"{k},{k}\n" for k in range(10)))
    series = read(path, sample_rate=1000.0)
    assert (series.sample_rate, series.channels) == (1000.0, ("z",))


@given(
    rate=st.floats(10.0, 1e4),
    rows=st.integers(3, 40),
    delimiter=st.sampled_from([",", ";", "\t", " "]),
    end=st.sampled_from(["\n", "\r\n"]),
    seed=st.integers(0, 99),
)
def test_generic_table_round_trip(tmp_path_factory, rate, rows, delimiter, end, seed):
    values = np.random.default_rng(seed).normal(size=(rows, 2))
    lines = [delimiter.join(["time", "a", "b"])]
    lines += [delimiter.join(repr(float(v)) for v in (k / rate, *row)) for k, row in enumerate(values)]
    series = read(write(tmp_path_factory.mktemp("g"), end.join(lines) + end))
    assert series.sample_rate == pytest.approx(rate, rel=1e-9)
    assert series.channels == ("a", "b")
    np.testing.assert_array_equal(series.values, values.T)


@pytest.mark.parametrize(
    ("text", "rate"),
    [
        ("time [ms],ax [g]\n0,1\n2,5\n4,3\n", None),
        ("t;ax [g]\n0;1\n0.002;5\n0.004;3\n", None),
        ("0.000,1\n0.002,5\n0.004,3\n", None),
        ("# a comment\n# sample_rate: 500\nax [g]\n1\n5\n3\n", None),
        ("# sample_rate: 500 Hz\n1\n5\n3", None),
        ("1\n5\n3\n", 500.0),
        ("sample,ax [g]\n0,1\n1,5\n2,3\n", 500.0),
        ("\ufefftime,ax\n0,1\n0.002,5\n0.004,3\n", None),
    ],
)
def test_generic_ways_to_give_the_rate(tmp_path, text, rate):
    series = read(write(tmp_path, text), sample_rate=rate)
    assert series.sample_rate == pytest.approx(500.0)
    np.testing.assert_array_equal(series.values, [[1.0, 5.0, 3.0]])
    assert series.unit == ("g" if "[g]" in text else "")


def test_small_jitter_is_resampled(tmp_path):
    rng = np.random.default_rng(5)
    times = np.arange(2000) / 1000.0
    times[1:-1] += rng.uniform(-2e-4, 2e-4, 1998)
    signal = np.sin(2 * np.pi * 20.0 * times)
    rows = "".join(f"{t!r},{v!r}\n" for t, v in zip(times.tolist(), signal.tolist(), strict=True))
    series = read(write(tmp_path, "time,x\n" + rows))
    # linear interpolation over at most 1.4 steps: h^2 w^2 / 8
    bound = (1.4e-3 * 2 * np.pi * 20.0) ** 2 / 8
    assert np.max(np.abs(series.values[0] - np.sin(2 * np.pi * 20.0 * series.times))) < bound
    assert np.max(np.abs(signal - np.sin(2 * np.pi * 20.0 * series.times))) > 5 * bound  # what ignoring it would cost


def test_rounded_time_stamps_are_no_jitter(tmp_path):
    rows = "".join(f"{k / 3200:.4f},{k % 7}\n" for k in range(500))
    series = read(write(tmp_path, "time,x\n" + rows))
    np.testing.assert_array_equal(series.values[0], np.arange(500) % 7)


def test_a_long_file_streams_through_without_a_copy(tmp_path):
    """Memory while reading stays below twice the file (benchmarks/read_raw.py has the figures for 100 MB)."""
    import tracemalloc

    rows = "".join(f"{k / 3200:.6f},{k % 911}.123456,-{k % 677}.654321,980{k % 7}.650000\n" for k in range(200_000))
    path = write(tmp_path, "#time,accel_x,accel_y,accel_z\n" + rows)
    read(path)  # imports
    tracemalloc.start()
    series = read(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 2 * path.stat().st_size
    assert series.values.base is not None  # a view of the table, which nobody can write to
    assert not series.values.flags.writeable


def test_sample_rate_must_be_a_rate(tmp_path):
    with pytest.raises(InputError, match="sample_rate"):
        read(write(tmp_path, "1\n2\n"), sample_rate=-1.0)


def test_samples_that_a_capture_skips_are_remarked(tmp_path):
    rows = "".join(f"{k},0.{k % 7}\n" for k in range(100) if k not in (40, 41, 70))
    series = read(write(tmp_path, f"Sample,X\n{rows}Rate 1000, overflows 0\n"))
    assert series.remarks == ("samples are missing: the sample numbers skip 3 in 2 places.",)


def test_what_is_wrong_with_the_sensor_is_remarked(tmp_path):
    """A record in mm/s^2 whose header says g; the sentence reaches who looks for modes."""
    wave = 2000.0 * np.exp(-0.01 * np.arange(1000)) * np.sin(0.3 * np.arange(1000))
    noise = np.random.default_rng(0).normal(size=1000)
    rows = "".join(
        f"{k / 1000:.3f},{a:.3f},{9806.65 + b:.3f}\n" for k, (a, b) in enumerate(zip(wave, noise, strict=True))
    )
    series = read(write(tmp_path, "time [s],x [g],z [g]\n" + rows))
    (sentence,) = series.remarks
    assert "gravity in mm/s^2 and not in g" in sentence
    assert sentence in find_modes(series).trouble
