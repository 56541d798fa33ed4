"""`preshape stream`: pipes of lines and of raw numbers, bad lines, killed pipes, as a user meets them."""

from __future__ import annotations

import contextlib
import io
import os
import pty
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from preshape import design
from preshape.errors import InputError
from preshape.workflow import stream_pipe

SHAPER = design.zvd((10.0, 0.02))
COMMAND = [sys.executable, "-m", "preshape", "stream"]
X, Y = np.cumsum(np.random.default_rng(0).normal(size=(2, 300)), axis=1)


@pytest.fixture
def shaper(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> str:
    """A file; the one warning of an installation without a compiler is not what is tested here."""
    monkeypatch.setenv("PYTHONWARNINGS", "ignore:preshape was installed without a C compiler:RuntimeWarning")
    return str(SHAPER.save(tmp_path / "shaper.json"))


def piped(data: bytes, **options: Any) -> bytes:
    sink = io.BytesIO()
    stream_pipe(SHAPER, io.BytesIO(data), sink, rate=1000.0, **options)
    return sink.getvalue()


def lines(*columns: np.ndarray) -> bytes:
    return "".join(",".join(map(repr, row)) + "\n" for row in np.array(columns).T.tolist()).encode()


def expected(*columns: np.ndarray) -> np.ndarray:
    u = np.array(columns)
    return SHAPER.shape(u, 0.001, initial=u[:, :1])


@pytest.mark.parametrize("unbuffered", [False, True])
@pytest.mark.parametrize("rest", [False, True])
def test_lines_and_raw_are_what_shape_gives_to_the_last_bit(unbuffered: bool, rest: bool) -> None:
    whole = expected(X, Y)
    wanted = whole if rest else whole[:, :300]
    text = piped(b"x [mm],y [mm]\r\n" + lines(X, Y), unbuffered=unbuffered, rest=rest)
    assert text == b"x [mm],y [mm]\n" + lines(*wanted)
    raw = piped(np.array([X, Y]).T.tobytes(), raw=True, axes=2, unbuffered=unbuffered, rest=rest)
    assert raw == np.ascontiguousarray(wanted.T).tobytes()


def test_blanks_between_numbers_empty_lines_and_a_last_line_without_end_are_taken() -> None:
    assert piped(b"\n 1 2\n\n1.5\t 3.0\n2 , 4") == lines(*expected([1.0, 1.5, 2.0], [2.0, 3.0, 4.0])[:, :3])
    assert piped(b"") == piped(b"", rest=True) == piped(b"", raw=True) == b""


@pytest.mark.parametrize(
    ("data", "options", "sentence"),
    [
        (b"1\n2\nthree\n", {}, "line 3 is 'three': give numbers"),
        (b"x\ny\n", {}, "line 2 is 'y'"),
        (b"1 x\n", {}, "line 1 is '1 x'"),
        (b"1,2\n1\n", {}, "line 2 has 1 numbers: give 2"),
        (b"1,2\n", {"axes": 3}, "line 1 has 2 numbers: give 3"),
        (b"1\nnan\n", {}, "line 2 is 'nan': .*finite"),
        (b"1\n\n1e999\n", {}, "line 3 is '1e999'"),
        (b"1,,2\nx", {}, "line 2 is 'x'"),
        (b"time,x\n0,1\n", {}, "names a column of times"),
        (b"\xff\xfe\x00\n", {}, "line 1"),
        (b"7" * (1 << 20), {}, "longer than a megabyte"),
        (b"\0" * 12, {"raw": True}, "ends within sample 1: 4 bytes of 8"),
        (np.array([1.0, np.nan]).tobytes(), {"raw": True}, "raw input, from sample 0 on: sample 1 of axis 0 is nan"),
        (b"1\n", {"axes": 0}, "axes is 0"),
    ],
)
def test_what_cannot_be_used_is_said_with_its_place(data: bytes, options: dict[str, object], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        piped(data, **options)


def test_what_came_before_a_bad_line_is_written() -> None:
    sink = io.BytesIO()
    with pytest.raises(InputError, match="line 3"):
        stream_pipe(SHAPER, io.BytesIO(b"1\n2\nx\n"), sink, rate=1000.0)
    assert sink.getvalue() == lines(*expected([1.0, 2.0])[:, :2])


def test_bad_samples_may_pass() -> None:
    out = piped(b"1\nnan\n1\ninf\n", not_finite="pass", rest=True).split()
    assert out[1] == b"nan" and out[3] == b"inf" and set(out) == {b"1.0", b"nan", b"inf"}


def test_the_command_says_what_is_wrong_in_one_sentence_with_exit_code_2(shaper: str) -> None:
    cases = [([shaper, "--rate", "1000"], b"1\nbad\n", b"line 2"), ([shaper, "--rate", "0"], b"", b"rate is 0 Hz"),
             ([shaper], b"", b"--rate"), (["none.json", "--rate", "1"], b"", b"cannot read")]  # fmt: skip
    for arguments, data, sentence in cases:
        done = subprocess.run([*COMMAND, *arguments], input=data, capture_output=True, check=False)
        assert done.returncode == 2 and sentence in done.stderr and b"Traceback" not in done.stderr
    done = subprocess.run([*COMMAND, shaper, "--rate", "1000"], input=lines(X), capture_output=True, check=True)
    assert done.stdout == lines(*expected(X)[:, :300]) and done.stderr == b""  # no throughput: not a terminal


@pytest.mark.parametrize("unbuffered", [[], ["--unbuffered"]])
def test_a_killed_pipe_ends_cleanly(shaper: str, unbuffered: list[str]) -> None:
    """`preshape stream ... | head -1`: no traceback, no complaint, although the input goes on."""
    process = subprocess.Popen(
        [*COMMAND, shaper, "--rate", "1000", *unbuffered],
        stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip
    assert process.stdin and process.stdout and process.stderr
    os.write(process.stdin.fileno(), b"1\n" * 20_000)
    process.stdout.readline()
    process.stdout.close()
    with contextlib.suppress(BrokenPipeError):
        for _ in range(200):
            os.write(process.stdin.fileno(), b"1\n" * 1000)
    process.stdin.close()
    assert process.wait(timeout=20) == 0
    assert process.stderr.read() == b""
    process.stderr.close()


def test_unbuffered_answers_each_sample_before_the_next_is_sent(shaper: str) -> None:
    process = subprocess.Popen(
        [*COMMAND, shaper, "--rate", "1000", "--unbuffered"], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    )
    assert process.stdin and process.stdout
    for u, y in zip(X[:5].tolist(), expected(X)[0, :5].tolist(), strict=True):
        process.stdin.write(f"{u!r}\n".encode())
        process.stdin.flush()
        assert float(process.stdout.readline()) == y
    process.stdin.close()
    assert process.wait(timeout=20) == 0
    process.stdout.close()


@pytest.mark.skipif(sys.platform == "win32", reason="a pseudo-terminal is needed")
def test_throughput_shows_on_a_terminal(shaper: str) -> None:
    ours, theirs = pty.openpty()
    done = subprocess.run(
        [*COMMAND, shaper, "--rate", "1000"], input=lines(X), stdout=subprocess.PIPE, stderr=theirs, check=True
    )
    os.close(theirs)
    assert b"300 samples" in os.read(ours, 1000) and done.stdout == lines(*expected(X)[:, :300])
    os.close(ours)
