"""MATLAB's `.mat` of version 5 to 7: arrays with names, read by SciPy. Version 7.3 is another format, and refused."""

from __future__ import annotations

import math
import warnings
import zlib

from preshape.errors import MeasurementError
from preshape.identify.measurement import TimeSeries
from preshape.identify.named_arrays import series_of
from preshape.identify.source_file import MAXIMUM_FILE_SIZE, SourceFile
from preshape.identify.wanted import Wanted

__all__ = ["FORMAT", "read", "recognises"]

FORMAT = "MATLAB file"
VERSION_5 = b"MATLAB 5.0"
VERSION_7_3 = b"MATLAB 7.3"
HDF = b"\x89HDF\r\n\x1a\n"
NUMBERS = frozenset({"double", "single", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64"})
MOST_ARRAYS = 64
HEADER = 128
COMPRESSED = 15
"""Type of a compressed element."""


def recognises(file: SourceFile) -> bool:
    """True for the file headers that MATLAB, Octave and SciPy write."""
    return file.begin.startswith((VERSION_5, VERSION_7_3, HDF))


def read(file: SourceFile, wanted: Wanted) -> TimeSeries:
    """Read the numeric arrays; structures, cells, strings and objects are passed over."""
    if not file.begin.startswith(VERSION_5):
        raise MeasurementError(
            f"{file.name}: this is MATLAB's version 7.3 or other HDF5, which is not read; in MATLAB say "
            "save('file.mat', '-v7', ...), or export CSV."
        )
    from scipy.io import loadmat, whosmat

    _check_compressed(file.data(), file.name)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")  # it warns of what it cannot read
            listed = whosmat(file.name, appendmat=False)
            names = [name for name, _, kind in listed if kind in NUMBERS]
            entries = sum(math.prod(shape) for name, shape, kind in listed if kind in NUMBERS)
            if len(names) > MOST_ARRAYS or 8 * entries >= MAXIMUM_FILE_SIZE or any(min(s) < 0 for _, s, _ in listed):
                raise MeasurementError(
                    f"{file.name}: {len(names)} arrays with {entries} numbers are too many; save only the record."
                )
            loaded = loadmat(file.name, appendmat=False, variable_names=names, squeeze_me=False, chars_as_strings=False)
    except MeasurementError:
        raise
    except Exception as error:  # whatever a damaged file makes SciPy raise; it has no exception of its own for it
        words = (str(error).split("\n") or [""])[0][:80] or type(error).__name__
        raise MeasurementError(f"{file.name}: the MATLAB file is damaged ({words}); save it again.") from None
    arrays = {name: loaded[name] for name in names if name in loaded and loaded[name].dtype.kind in "biuf"}
    return series_of(arrays, file.name, wanted, FORMAT)


def _check_compressed(data: bytes, source: str) -> None:
    """Raise when the compressed elements unpack to more than a file may have; nothing of them is kept."""
    order = "little" if data[126:128] == b"IM" else "big"
    at, total = HEADER, 0
    while at + 8 <= len(data):
        kind = int.from_bytes(data[at : at + 4], order)  # type: ignore[arg-type]
        size = int.from_bytes(data[at + 4 : at + 8], order)  # type: ignore[arg-type]
        if kind == COMPRESSED:
            packed = data[at + 8 : at + 8 + size]
            unpack = zlib.decompressobj()
            try:
                while packed:
                    total += len(unpack.decompress(packed, MAXIMUM_FILE_SIZE // 100))
                    if total >= MAXIMUM_FILE_SIZE:
                        raise MeasurementError(
                            f"{source}: decompressed it has {MAXIMUM_FILE_SIZE / 1e6:.0f} MB or more; "
                            "cut the part that holds the vibration."
                        )
                    packed = unpack.unconsumed_tail
            except zlib.error as error:
                raise MeasurementError(f"{source}: the MATLAB file is damaged ({error}); save it again.") from None
        at += 8 + size
