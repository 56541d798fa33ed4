"""Whatever a file holds: a measurement, or a MeasurementError of one sentence; never anything else, nor a warning.

tests/fuzz/fuzz_readers.py does the same for hours, guided by coverage.
"""

import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from tests.identify.valid_files import valid_files

from preshape.errors import MeasurementError
from preshape.identify import read

FILES = valid_files()
TOKENS = [b",", b"\n", b";", b"\t", b" ", b"-", b"1e308", b"1e-308", b"nan", b"inf", b"0", b"-1", b"\0", b'"', b"\xff",
          b"\r", b"#", b"9" * 30, b"time", b"freq", b"fs", b"\x7f\xff\xff\xff", b"    -1\n", b"    58\n"]  # fmt: skip


def reads_or_says_why(folder, content, rate=None, part=None):
    path = folder / "file"
    path.write_bytes(content)
    try:
        return read(path, sample_rate=rate, part=part)
    except MeasurementError as error:
        message = str(error)
        assert message.startswith(f"{path}: ")
        assert message.endswith(".")
        assert message.isprintable(), message
        return None


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("fuzz")


@pytest.mark.parametrize("name", FILES)
def test_the_valid_files_are_valid(folder, name):
    assert reads_or_says_why(folder, FILES[name], part="axis_Y" if name == "stdata of two" else None) is not None


@pytest.mark.parametrize("name", FILES)
@settings(max_examples=40, deadline=None)
@given(data=st.data())
def test_damaged_files(folder, name, data):
    """A valid file with bytes replaced, taken out, repeated and put in."""
    content = bytearray(FILES[name])
    for _ in range(data.draw(st.integers(1, 4), label="changes")):
        # headers are where the decisions are: half of the changes fall there
        end = data.draw(st.sampled_from([min(len(content), 200), len(content)]))
        at = data.draw(st.integers(0, max(end - 1, 0)), label="at")
        kind = data.draw(st.sampled_from(["byte", "cut", "drop", "token", "repeat"]), label="kind")
        if kind == "byte" and content:
            content[at] = data.draw(st.integers(0, 255))
        elif kind == "cut":
            del content[at:]
        elif kind == "drop":
            del content[at : at + data.draw(st.integers(1, 60))]
        elif kind == "token":
            content[at:at] = data.draw(st.sampled_from(TOKENS))
        else:
            content[at:at] = content[at : at + data.draw(st.integers(1, 60))]
    reads_or_says_why(folder, bytes(content), data.draw(st.sampled_from([None, 1000.0])))


@settings(max_examples=100, deadline=None)
@given(
    st.integers(0, 300),
    st.sampled_from(
        [b"", b"[", b"null", b"1e999", b"NaN", b'"', b"\xff", b"\n", b"[[0,1,2]]", b"\x80\x04", b'{"name":1}']
    ),
    st.integers(0, 30),
)
def test_damaged_lines_of_json(folder, at, put, dropped):
    """A .stdata whose compression is sound and whose content is not."""
    zstandard = pytest.importorskip("zstandard")
    content = bytearray(zstandard.ZstdDecompressor().decompressobj().decompress(FILES["stdata"]))
    content[at : at + dropped] = put
    reads_or_says_why(folder, zstandard.ZstdCompressor().compress(bytes(content)))


@settings(max_examples=150, deadline=None)
@given(st.binary(max_size=400), st.sampled_from(sorted({content[:12] for content in FILES.values()} | {b""})))
@example(b"0,1\n0,2\n", b"")
def test_garbage(folder, content, begin):
    """Garbage, and garbage behind the magic bytes of each format."""
    reads_or_says_why(folder, begin + content)


@settings(max_examples=150, deadline=None)
@given(st.lists(st.sampled_from(TOKENS + [b"0.1", b"2", b"sample", b"x"]), max_size=40))
def test_nearly_tables(folder, tokens):
    reads_or_says_why(folder, b"".join(tokens), 100.0)
