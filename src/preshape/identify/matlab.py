"""MATLAB's `.mat` of version 5 to 7: the numeric arrays with names in it. Version 7.3 is another format, and refused.

SciPy's reader is not used, because a damaged file makes it stop the whole process: with SciPy 1.17.1, `savemat` of
`{"x": numpy.arange(12.0)}` gives 280 bytes; change byte 177, the upper byte of the type of the numbers, from 0 to 1,
and `loadmat` ends Python with signal 11, to 0x80 with signal 7 (it looks the type up beyond its table): ADR 0012.
The format is MathWorks' own description, "MAT-File Format", of the elements that hold numbers; structures, cells,
strings and objects are passed over.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

from preshape.errors import MeasurementError
from preshape.identify.measurement import TimeSeries
from preshape.identify.named_arrays import series_of
from preshape.identify.source_file import MAXIMUM_FILE_SIZE, SourceFile
from preshape.identify.text import printable
from preshape.identify.wanted import Wanted

__all__ = ["FORMAT", "read", "recognises"]

FORMAT = "MATLAB file"
VERSION_5 = b"MATLAB 5.0"
VERSION_7_3 = b"MATLAB 7.3"
HDF = b"\x89HDF\r\n\x1a\n"
HEADER = 128
TAG = 8
MOST_ARRAYS = 64
MOST_AXES = 8
ARRAY, COMPRESSED = 14, 15
"""Types of elements: an array, and an element that is compressed."""

NUMBERS = {1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"}
"""Types of elements that hold numbers; MATLAB stores an array in the shortest one."""

NUMERIC_CLASSES = range(6, 16)
"""Classes of arrays that are numeric: double, single, and the integers."""

COMPLEX = 0x0800
_Element = tuple[int, memoryview]


def recognises(file: SourceFile) -> bool:
    """True for the file headers that MATLAB, Octave and SciPy write."""
    return file.begin.startswith((VERSION_5, VERSION_7_3, HDF))


def read(file: SourceFile, wanted: Wanted) -> TimeSeries:
    """Read the numeric arrays, and take them as a record, its time and its rate."""
    if not file.begin.startswith(VERSION_5):
        raise MeasurementError(
            f"{file.name}: this is MATLAB's version 7.3 or other HDF5, which is not read; in MATLAB say "
            "save('file.mat', '-v7', ...), or export CSV."
        )
    data = memoryview(file.data())
    order = "<" if bytes(data[126:128]) == b"IM" else ">"
    arrays: dict[str, NDArray[Any]] = {}
    try:
        for kind, content in _unpacked(data[HEADER:], order):
            found = _array(content, order) if kind == ARRAY else None
            if found is not None:
                arrays[found[0]] = found[1]
            if len(arrays) > MOST_ARRAYS:
                raise ValueError(f"more than {MOST_ARRAYS} arrays")
    except (ValueError, zlib.error) as error:
        raise MeasurementError(
            f"{file.name}: the MATLAB file is damaged or too large ({printable(str(error)[:80])}); "
            "save only the record, again."
        ) from None
    return series_of(arrays, file.name, wanted, FORMAT)


def _elements(data: memoryview, order: str) -> Iterator[_Element]:
    """Type and content of each element; a tag that promises more than there is raises."""
    at = 0
    while at + TAG <= len(data):
        first, size = (int(number) for number in np.frombuffer(data[at : at + TAG], f"{order}u4"))
        begin = at + TAG
        if first >> 16:  # type and size in four bytes, the content in the other four
            first, size, begin = first & 0xFFFF, first >> 16, at + 4
            if size > 4:
                raise ValueError(f"a small element of {size} bytes")
        if begin + size > len(data):
            raise ValueError("an element is longer than the file")
        yield first, data[begin : begin + size]
        # elements begin at multiples of eight bytes, but behind a compressed one
        at = begin + size if first == COMPRESSED else begin + size + (-(begin + size)) % 8


def _unpacked(data: memoryview, order: str) -> Iterator[_Element]:
    """The elements, compressed ones unpacked; all of them together below the limit for files."""
    left = MAXIMUM_FILE_SIZE
    for kind, content in _elements(data, order):
        if kind != COMPRESSED:
            yield kind, content
            continue
        unpack = zlib.decompressobj()
        inner = unpack.decompress(content, left)
        left -= len(inner)
        if left <= 0 or unpack.unconsumed_tail:
            raise ValueError(f"decompressed it has {MAXIMUM_FILE_SIZE / 1e6:.0f} MB or more")
        yield from _elements(memoryview(inner), order)


def _array(content: memoryview, order: str) -> tuple[str, NDArray[Any]] | None:
    """Name and numbers of an array; None where it does not hold real numbers."""
    parts = _elements(content, order)
    flags = next(parts, (0, content[:0]))[1]
    shape = tuple(int(length) for length in _numbers(next(parts, (0, content[:0])), order))
    name = bytes(next(parts, (0, content[:0]))[1]).decode("utf-8", errors="replace")
    if len(flags) != 8:
        raise ValueError("an array has no flags")
    properties = int(np.frombuffer(flags[:4], f"{order}u4")[0])
    if properties & 0xFF not in NUMERIC_CLASSES or properties & COMPLEX:
        return None
    if len(shape) > MOST_AXES or any(length < 0 for length in shape):
        raise ValueError(f"an array of shape {shape[:MOST_AXES]}")
    values = _numbers(next(parts, (0, content[:0])), order)
    if math.prod(shape) != len(values):
        raise ValueError(f"an array of shape {shape} has {len(values)} numbers")
    return name, values.reshape(shape, order="F")


def _numbers(element: _Element, order: str) -> NDArray[Any]:
    kind, content = element
    if kind not in NUMBERS:
        raise ValueError(f"an element of type {kind} where numbers belong")
    return np.frombuffer(content, f"{order}{NUMBERS[kind]}")
