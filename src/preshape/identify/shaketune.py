"""Shake&Tune's `.stdata`: zstd-compressed lines of JSON, each a named measurement of Klipper's accelerometer.

Versions before the lines of JSON compressed a Python pickle, which is a program. It is never run: such a file is
refused with a sentence.
"""

from __future__ import annotations

import io
from typing import IO, Any

import msgspec
import numpy as np

from preshape.errors import MeasurementError
from preshape.identify import klipper_raw
from preshape.identify.measurement import TimeSeries
from preshape.identify.source_file import MAXIMUM_FILE_SIZE, SourceFile
from preshape.identify.text import printable
from preshape.identify.wanted import Wanted, pick_part

__all__ = ["FORMAT", "read", "recognises"]

FORMAT = f"{klipper_raw.FORMAT} (Shake&Tune)"
MAGIC = b"\x28\xb5\x2f\xfd"
PICKLE = b"\x80"
"""First byte of a pickle of protocol 2 and later; no JSON begins so."""

LARGEST_WINDOW = 1 << 27
"""Memory [bytes] that a frame may ask for while it is decompressed, what `zstd` itself allows by default."""

CHUNK = 1 << 20


class _Named(msgspec.Struct):
    name: str


class _Recorded(msgspec.Struct):
    name: str
    samples: list[tuple[float, float, float, float]]


def recognises(file: SourceFile) -> bool:
    """True for zstd-compressed data."""
    return file.begin.startswith(MAGIC)


def read(file: SourceFile, wanted: Wanted) -> TimeSeries:
    """Read the measurement that is wanted, or the only one."""
    lines = [line for line in _decompressed(file).split(b"\n") if line.strip()]
    if lines and lines[0].startswith(PICKLE):
        raise MeasurementError(
            f"{file.name}: this .stdata was written by an older Shake&Tune as a Python pickle, which is a program "
            "and is never run here; record again with a newer Shake&Tune, or give Klipper's raw_data CSV."
        )
    names = [_decoded(line, number, file.name, _Named).name for number, line in enumerate(lines, start=1)]
    index = pick_part(names, wanted.part, file.name)
    recorded = _decoded(lines[index], index + 1, file.name, _Recorded)
    table = np.array(recorded.samples, dtype=np.float64).reshape(-1, 4)
    if not np.all(np.isfinite(table)):
        raise MeasurementError(f"{file.name}: {recorded.name!r} holds numbers that are not finite; record it again.")
    return klipper_raw.accelerations(table, file.name, wanted.sample_rate, FORMAT, None)


def _decoded(line: bytes, number: int, source: str, kind: Any) -> Any:
    try:
        return msgspec.json.decode(line, type=kind, strict=False)
    except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
        raise MeasurementError(
            f"{source}: line {number} of the decompressed file is not a measurement of Shake&Tune "
            f"({printable(str(error)[:80])}); copy the file again."
        ) from None


def _decompressed(file: SourceFile) -> bytes:
    """The whole content, or a sentence when it is larger than a file may be."""
    try:
        import zstandard
    except ImportError:
        raise MeasurementError(
            f"{file.name}: reading .stdata needs the package zstandard; pip install 'preshape[formats]'."
        ) from None
    content = io.BytesIO()
    unpack = zstandard.ZstdDecompressor(max_window_size=LARGEST_WINDOW)
    try:
        with file.open() as packed, unpack.stream_reader(packed, read_across_frames=True) as stream:
            while chunk := _chunk(stream):
                if content.tell() + len(chunk) >= MAXIMUM_FILE_SIZE:
                    raise MeasurementError(
                        f"{file.name}: decompressed it has {MAXIMUM_FILE_SIZE / 1e6:.0f} MB or more; "
                        "record fewer measurements in one file."
                    )
                content.write(chunk)
    except zstandard.ZstdError as error:
        raise MeasurementError(f"{file.name}: the compressed data is damaged ({error}); copy the file again.") from None
    return content.getvalue()


def _chunk(stream: IO[bytes]) -> bytes:
    return stream.read(CHUNK)
