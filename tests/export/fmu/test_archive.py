"""The FMU as a file: reproducible, complete, read back with limits, and honest when there is no compiler."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from fmpy.validation import validate_fmu
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.export.fmu.slaves import DT, SHAPERS, exported, rendered, written

from preshape import Shaper
from preshape.errors import InputError
from preshape.export import fmu
from preshape.export.fmu import archive, binary


def content(name: str = "zvd", **wishes: str) -> bytes:
    return bytes(exported(name, **wishes).files["axis.fmu"])  # type: ignore[arg-type]


def changed(change: Callable[[str, bytes], bytes | None], source: bytes) -> bytes:
    """The FMU with every entry as `change` makes it."""
    whole = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(source)) as old, zipfile.ZipFile(whole, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            data = change(name, old.read(name))
            if data is not None:
                new.writestr(name, data)
    return whole.getvalue()


@pytest.mark.parametrize("precision", ["double", "single"])
@pytest.mark.parametrize("name", SHAPERS)
def test_what_was_written_reads_back(name: str, precision: str) -> None:
    export = exported(name, precision=precision)
    said = fmu.FMU.parse(export.files)
    np.testing.assert_array_equal(said.delays, export.placed.delays)
    np.testing.assert_array_equal(said.weights, export.placed.weights)
    assert (said.dt, said.precision) == (DT, precision)


def test_the_same_shaper_gives_the_same_bytes_and_another_another_token() -> None:
    assert rendered().files == rendered().files
    with zipfile.ZipFile(io.BytesIO(content())) as opened:
        assert opened.namelist() == sorted(opened.namelist())
        assert {info.date_time for info in opened.infolist()} == {(1980, 1, 1, 0, 0, 0)}
    tokens = set()
    for source in (content(), content("negative"), content(precision="single")):
        with zipfile.ZipFile(io.BytesIO(source)) as opened:
            tokens.add(opened.read("sources/preshape_table.h").split(b'"')[1])
            assert opened.read("modelDescription.xml").count(sorted(tokens)[-1]) <= 1
    assert len(tokens) == 3


def test_the_kernel_is_the_one_that_python_runs() -> None:
    with zipfile.ZipFile(io.BytesIO(content())) as opened:
        for name in ("preshape_kernel.h", "preshape_kernel.c"):
            assert opened.read(f"sources/{name}") == (files("preshape.kernel") / "c" / name).read_bytes()


@pytest.mark.parametrize("missing", ["no compiler", "a compiler that fails", "another system"])
def test_without_a_binary_the_user_is_told(missing: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    if missing == "no compiler":
        monkeypatch.setattr(binary, "COMPILERS", ("no-such-compiler",))
    elif missing == "a compiler that fails":
        monkeypatch.setattr(binary, "COMPILERS", ("false",))
    else:
        monkeypatch.setattr(binary.platform, "machine", lambda: "mips")
    export = rendered()
    (note,) = export.notes
    assert "sources only" in note and "gcc" in note
    with zipfile.ZipFile(written(export, tmp_path)) as opened:
        assert not any(name.startswith("binaries/") for name in opened.namelist())
    assert validate_fmu(str(tmp_path / "axis.fmu")) == []
    assert fmu.FMU.execute(export.files) == export.placed.shaper


def test_what_cannot_be_read_is_refused_with_a_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    good = content()
    table, taps = "sources/preshape_table.h", "sources/preshape_taps.h"

    def edited(entry: str, old: bytes, new: bytes) -> bytes:
        return changed(lambda name, data: data.replace(old, new) if name == entry else data, good)

    many = io.BytesIO()
    with zipfile.ZipFile(many, "w") as opened:
        for index in range(1001):
            opened.writestr(str(index), "")
    damaged = {
        "0 of 0 files": None,
        "is damaged": b"PK no zip at all",
        "damaged": good[:-100],
        "holds no": changed(lambda name, data: None if name == taps else data, good),
        "1001 entries": many.getvalue(),
        "longer than": changed(lambda name, data: data + b" " * 10_000_000 if name == taps else data, good),
        "not preshape's": edited(taps, b"DELAYS", b"LATENESSES"),
        "not numbers": edited(taps, b" 0u, ", b" 0u, __import__, "),
        "delays and": edited(taps, b" 0u, ", b" "),
        "not 1": edited(taps, b"e-01", b"e-02"),
        "above 0": edited(table, b"4.0000000000000001e-03", b"0.0e+00"),
    }
    for sentence, source in damaged.items():
        with pytest.raises(InputError, match=sentence):
            fmu.FMU.parse({} if source is None else {"axis.fmu": source})
    monkeypatch.setattr("preshape.export.fmu.archive.MOST_PACKED", 100)
    with pytest.raises(InputError, match="up to 100 are read"):
        fmu.FMU.parse({"axis.fmu": good})


def test_a_damaged_weight_does_not_read_back_as_the_shaper() -> None:
    export = exported()
    digits = f"{export.placed.weights[1]:.16e}"
    other = f"{np.nextafter(export.placed.weights[1], 1.0):.16e}"
    source = changed(lambda name, data: data.replace(digits.encode(), other.encode()), content())
    assert digits != other and fmu.FMU.execute({"axis.fmu": source}) != export.placed.shaper


@given(st.integers(0, 2**32 - 1), st.integers(1, 40))
@settings(max_examples=150, deadline=None)
def test_whatever_the_bytes_are_they_are_a_shaper_or_an_input_error(seed: int, flips: int) -> None:
    random = np.random.default_rng(seed)
    damaged = bytearray(content())
    ends = len(damaged) - 1500  # the directory, which says what is where
    for at in random.integers(ends if seed % 2 else 0, len(damaged), flips).tolist():
        damaged[at] = int(random.integers(256))
    try:
        assert isinstance(fmu.FMU.execute({"axis.fmu": bytes(damaged)}), Shaper)
    except InputError:
        pass


def test_each_bit_and_each_end_of_a_small_archive() -> None:
    """Every exception that zipfile has for them becomes a sentence: 150 random changes did not find them all."""
    good = archive.packed({"sources/a.h": "xy" * 20, "sources/b.h": "hello" * 10})
    flipped = [good[:at] + bytes([good[at] ^ 1 << bit]) + good[at + 1 :] for at in range(len(good)) for bit in range(8)]
    ends = [good[:at] for at in range(len(good))] + [good[at:] for at in range(1, len(good))]
    refused = 0
    for damaged in [*flipped, *ends]:
        try:
            archive.unpacked(damaged, "sources/a.h", "sources/b.h")
        except InputError as error:
            assert str(error).endswith(".")
            refused += 1
    assert archive.unpacked(good, "sources/b.h") == ["hello" * 10] and refused > len(flipped) / 4


@pytest.mark.parametrize("method", [zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA])
def test_other_ways_of_packing_are_not_read(method: int) -> None:
    whole = io.BytesIO()
    with zipfile.ZipFile(whole, "w", method) as other:
        other.writestr("sources/a.h", "xy" * 20)
    with pytest.raises(InputError, match=r"sources/a\.h in the FMU is packed in a way that preshape does not use"):
        archive.unpacked(whole.getvalue(), "sources/a.h")
