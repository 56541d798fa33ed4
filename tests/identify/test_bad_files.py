"""Every bad file gets one sentence that says what is wrong and where."""

import numpy as np
import pytest

from preshape.errors import MeasurementError
from preshape.identify import MAXIMUM_FILE_SIZE, find_modes, read

RAW = "#time,accel_x,accel_y,accel_z\n"
RAW_ROWS = "".join(f"{k / 1000:.6f},{k}.000000,2.000000,3.000000\n" for k in range(30))
PSD = "freq,psd_x,psd_y,psd_z,psd_xyz\n"
PSD_ROWS = "".join(f"{1.6 * k:.1f},1.000e+00,1.000e+00,1.000e+00,3.000e+00\n" for k in range(30))
RRF = "Sample,X,Y,Z\n"
RRF_ROWS = "".join(f"{k},0.1,0.2,1.0\n" for k in range(30))
LONG = "x" * 300

BAD = {
    "empty": ("", "is empty"),
    "blank": ("\n \n", "is empty"),
    "NUL bytes": (b"\x00\x01\x02\x03" * 10, "binary"),
    "not UTF-8": (b"time,x\n0,\xff\xfe\n", "not text"),
    "one line, raw": (RAW, "only one line"),
    "one line, spectrum": (PSD, "only one line"),
    "one line, capture": (RRF, "only one line"),
    "one line, text": ("hello", "only one line"),
    "prose": ("hello world\nhow are you\n", "not that of a known measurement"),
    "raw, one row": (RAW + "0.0,1.0,2.0,3.0\n", "1 data row"),
    "raw, cut line": (RAW + RAW_ROWS + "0.030000,1.00", "line 32 has 2 columns.*truncated"),
    "raw, cut number": (RAW + RAW_ROWS + "0.030000,1.000000,2.000000,3.0", r"\(32\) is cut.*truncated"),
    "spectrum, cut number": (PSD + PSD_ROWS + "48.0,1.000e+00,1.000e+00,1.000e+00,3.00", "truncated"),
    "raw, word": (RAW + RAW_ROWS.replace("7.000000,2", "7.0oops,2", 1), r"line 9 holds '7.0oops'"),
    "raw, long word": (RAW + RAW_ROWS.replace("7.000000,2", LONG + ",2", 1), r"'x{24}\.\.\.'"),
    "raw, empty cell": (RAW + RAW_ROWS.replace("7.000000,2", ",2", 1), "line 9 holds ''"),
    "raw, nan": (RAW + RAW_ROWS.replace("7.000000,2", "nan,2", 1), "line 9 holds 'nan'.*not a finite"),
    "raw, inf": (RAW + RAW_ROWS.replace("7.000000,2", "-inf,2", 1), "line 9 holds '-inf'.*not a finite"),
    "raw, overflow": (RAW + RAW_ROWS.replace("7.000000,2", "1e999,2", 1), "line 9 holds '1e999'.*finite"),
    "raw, missing column": ("#time,accel_x,accel_y\n0,1,2\n1,1,2\n", "header.*must be"),
    "raw, uneven columns": (RAW + RAW_ROWS.replace("7.000000,2", "7.0,1.0,2", 1), "line 9 has 5 columns"),
    "raw, repeated time": (RAW + RAW_ROWS.replace("0.007000", "0.006000", 1), "time repeats.*line 9"),
    "raw, unsorted time": (RAW + RAW_ROWS.replace("0.007000", "0.001000", 1), "time goes back.*line 9"),
    "raw, absurd": (RAW + RAW_ROWS.replace("7.000000,2", "1e300,2", 1), "above 1e[+]100, which no sensor gives"),
    "spectrum, word": (PSD + PSD_ROWS.replace("16.0", "abc", 1), "line 12 holds 'abc'"),
    "spectrum, nan": (PSD + PSD_ROWS.replace("16.0,1.000e+00", "16.0,nan", 1), "line 12 holds 'nan'"),
    "spectrum, repeated": (PSD + PSD_ROWS.replace("16.0", "14.4", 1), "frequency repeats"),
    "spectrum, unsorted": (PSD + PSD_ROWS.replace("16.0", "1.0", 1), "frequency goes back"),
    "spectrum, missing axis": ("freq,psd_x,psd_z\n" + "0.0,1,1\n1.6,1,1\n", "psd_y are missing"),
    "spectrum, no density": ("freq\n0.0\n1.6\n", "no density column"),
    "spectrum, negative": (PSD + PSD_ROWS.replace("16.0,1.", "16.0,-1.", 1), "line 12.*below zero"),
    "spectrum, short": (PSD + PSD_ROWS.split("8.0,")[0], "at least 8"),
    "spectrum, uneven columns": (PSD + PSD_ROWS.replace("16.0,", "16.0,1.0,", 1), "line 12 has 6 columns"),
    "capture, no rate": (RRF + RRF_ROWS, "'Rate ..., overflows ...' is missing"),
    "capture, rate 0": (RRF + RRF_ROWS + "Rate 0, overflows 0\n", "rate of 0"),
    "capture, failed": (RRF + RRF_ROWS + "Failed to collect data from accelerometer\n", "repeat the capture"),
    "capture, cut": (RRF + RRF_ROWS + "30,0.1,", "line 32 has 3 columns.*truncated"),
    "capture, too short": (RRF + "0,1,1,1\nRate 1000, overflows 0\n", "has 1 samples"),
    "capture, unsorted": (RRF + RRF_ROWS.replace("\n7,", "\n3,", 1) + "Rate 9, overflows 0", "goes back"),
    "capture, no axis": ("Sample\n0\n1\n", "no axis column"),
    "table, no time": ("a,b\n1,2\n3,4\n", "no column is named 'time'"),
    "table, lone hash": ("#\na,b\n1,2\n3,4\n", "no column is named 'time'"),
    "table, only time": ("time\n1\n2\n", "besides the time"),
    "table, uneven": ("time,x\n0,1\n1,1\n2,1\n3,1\n9,1\n", "from 1 s to 6 s.*line 6.*mean of 2.25 s"),
    "table, word": ("time,x\n0,1\n1,two\n2,3\n", "line 3 holds 'two'"),
    "table, formula": ("time,x\n0,1\n1,__import__('os')\n2,3\n", "line 3 holds '__import__"),
    "table, digit groups": ("time,x\n0,1\n1,1_0\n2,3\n", "line 3 holds '1_0'"),
    "table, unsorted": ("time,x\n0,1\n2,1\n1,1\n", "goes back"),
    "table, repeated": ("time,x\n0,1\n1,1\n1,1\n", "repeats"),
    "table, bad rate": ("# sample_rate: fast\n1\n2\n", "no usable rate"),
    "table, one row": ("time,x\n0,1\n", "1 rows"),
}


@pytest.mark.parametrize("case", BAD)
def test_one_sentence(tmp_path, case):
    content, expected = BAD[case]
    path = tmp_path / "file.csv"
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(MeasurementError, match=expected) as caught:
        read(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    assert message.endswith(".")
    assert len(message) - len(str(path)) < 260


def test_missing_file(tmp_path):
    with pytest.raises(MeasurementError, match="no such file"):
        read(tmp_path / "nothing.csv")


def test_impossible_path():
    with pytest.raises(MeasurementError, match="cannot be opened"):
        read("nul\0byte.csv")


def test_directory(tmp_path):
    with pytest.raises(MeasurementError, match="directory"):
        read(tmp_path)


def test_device():
    with pytest.raises(MeasurementError, match="not a regular file"):
        read("/dev/null")


def test_unreadable(tmp_path, monkeypatch):
    path = tmp_path / "file.csv"
    path.write_text(RAW + RAW_ROWS)

    def refuse(self, *arguments, **keywords):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("pathlib.Path.open", refuse)  # chmod does not bind the superuser
    with pytest.raises(MeasurementError, match="cannot be read .permission denied"):
        read(path)


def test_large_file_is_refused_without_reading(tmp_path, monkeypatch):
    path = tmp_path / "large.csv"
    with path.open("wb") as file:
        file.truncate(MAXIMUM_FILE_SIZE)  # sparse: no disk is used
    monkeypatch.setattr("pathlib.Path.open", lambda *_, **__: pytest.fail("the file was read"))
    with pytest.raises(MeasurementError, match="200 MB"):
        read(path)


@pytest.mark.parametrize(
    ("text", "rate"),
    [(RAW + RAW_ROWS, 2000.0), (RRF + RRF_ROWS + "Rate 1000, overflows 0\n", 2000.0), ("t,x\n0,1\n1,2\n2,1\n", 3.0)],
)
def test_contradicting_rate(tmp_path, text, rate):
    path = tmp_path / "file.csv"
    path.write_text(text)
    with pytest.raises(MeasurementError, match=f"sample_rate={rate:g}"):
        read(path, sample_rate=rate)


def test_rate_for_a_spectrum(tmp_path):
    path = tmp_path / "file.csv"
    path.write_text(PSD + PSD_ROWS)
    with pytest.raises(MeasurementError, match="no sample rate"):
        read(path, sample_rate=1000.0)


def test_nothing_to_identify(tmp_path):
    path = tmp_path / "file.csv"
    path.write_text(RAW + RAW_ROWS)
    with pytest.raises(MeasurementError, match="30 samples are too few"):
        find_modes(read(path))
    path.write_text("# sample_rate: 100\n" + "1.5\n" * 200)
    with pytest.raises(MeasurementError, match="all samples are the same"):
        find_modes(read(path))
    path.write_text(PSD + PSD_ROWS.replace("1.000e+00", "0.000e+00").replace("3.000e+00", "0.000e+00"))
    with pytest.raises(MeasurementError, match="lie in the band|zero everywhere"):
        find_modes(read(path))


def test_any_prefix_of_a_file_reads_or_says_why(tmp_path):
    """Truncation anywhere: a measurement or a MeasurementError, never another exception."""
    path = tmp_path / "file.csv"
    rng = np.random.default_rng(2)
    for whole in (RAW + RAW_ROWS, PSD + PSD_ROWS, RRF + RRF_ROWS + "Rate 1000, overflows 0\n"):
        for cut in rng.integers(0, len(whole), 150):
            path.write_text(whole[:cut])
            try:
                read(path)
            except MeasurementError as error:
                assert "\n" not in str(error)


@pytest.mark.parametrize(
    "text",
    [
        "freq,w(" + "=" * 60_000 + "\n" + "0.0,1\n1.6,1\n" * 9,
        "# sample_rate: x" + " " * 60_000 + "y\n1\n2\n3\n",
        "time," + "(" * 60_000 + "\n0,1\n1,2\n2,1\n",
        "time," + " " * 30_000 + "(a" * 10_000 + "\n0,1\n1,2\n2,1\n",
        "Sample,X" + " " * 60_000 + "\n0,1\n1,2\n2,1\nRate 9" + " " * 3_000 + "x\n",
        '"' * 60_000 + "\n1,2\n3,4\n",
        "time,x\n0,1\n1," + "9" * 150_000 + "\n2,1\n",
        "time,x\n0,1\n1," + '"' + "9" * 150_000 + "\n2,1\n",
    ],
)
def test_absurdly_long_names_do_not_hang(tmp_path, text):
    """Patterns that search them would need minutes: a failure here is a test that does not end."""
    path = tmp_path / "file.csv"
    path.write_text(text)
    try:
        read(path)
    except MeasurementError as error:
        assert len(str(error)) - len(str(path)) < 300
