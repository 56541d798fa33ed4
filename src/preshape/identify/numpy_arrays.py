"""NumPy's `.npy` and `.npz`: one array, or several with names. Pickled objects in them are never loaded."""

from __future__ import annotations

import io
import math
import zipfile
import zlib
from typing import IO, Any

import numpy as np
from numpy.typing import NDArray

from preshape.errors import MeasurementError
from preshape.identify.measurement import TimeSeries
from preshape.identify.named_arrays import series_of
from preshape.identify.source_file import MAXIMUM_FILE_SIZE, SourceFile
from preshape.identify.text import printable
from preshape.identify.wanted import Wanted

__all__ = ["FORMAT", "read", "recognises"]

FORMAT = "NumPy array"
ARRAY = b"\x93NUMPY"
ARCHIVE = b"PK\x03\x04"
SUFFIX = ".npy"
UNNAMED = "record"
MOST_ARRAYS = 64
"""Arrays that an archive may hold."""

LONGEST_HEADER = 10_000
"""Characters of an array's header; NumPy's own limit for files that are not trusted."""


def recognises(file: SourceFile) -> bool:
    """True for an array, and for a zip archive that begins with one."""
    if file.begin.startswith(ARRAY):
        return True
    length = int.from_bytes(file.begin[26:28], "little")
    return file.begin.startswith(ARCHIVE) and file.begin[30 : 30 + length].endswith(SUFFIX.encode())


def read(file: SourceFile, wanted: Wanted) -> TimeSeries:
    """Read an array (the sample rate is `wanted`, or its first channel is the time), or an archive of arrays."""
    if file.begin.startswith(ARRAY):
        with file.open() as stream:
            arrays = {UNNAMED: _array(stream, file.size, UNNAMED, file.name)}
    else:
        arrays = _archive(file)
    structured = [array for array in arrays.values() if array.dtype.names]
    if len(arrays) == 1 and structured:
        arrays = {name: structured[0][name] for name in structured[0].dtype.names or ()}
    for name, array in arrays.items():
        if array.dtype.kind not in "biuf":
            raise MeasurementError(
                f"{file.name}: {name[:40]!r} holds {array.dtype} and not real numbers; save a numeric array."
            )
    return series_of(arrays, file.name, wanted, FORMAT)


def _archive(file: SourceFile) -> dict[str, NDArray[Any]]:
    """The arrays in an archive, all below the limit together."""
    try:
        with file.open() as stream, zipfile.ZipFile(stream) as archive:
            members = [info for info in archive.infolist() if info.filename.endswith(SUFFIX)]
            if len(members) > MOST_ARRAYS:
                raise MeasurementError(
                    f"{file.name}: the archive holds {len(members)} arrays and at most {MOST_ARRAYS} are taken."
                )
            if sum(info.file_size for info in members) >= MAXIMUM_FILE_SIZE:
                raise MeasurementError(
                    f"{file.name}: decompressed it has {MAXIMUM_FILE_SIZE / 1e6:.0f} MB or more; "
                    "cut the part that holds the vibration."
                )
            arrays = {}
            for info in members:
                with archive.open(info) as member:
                    name = info.filename.removesuffix(SUFFIX)
                    arrays[name] = _array(member, info.file_size, name, file.name)
            return arrays
    except MeasurementError:
        raise
    except (
        zipfile.BadZipFile,  # no directory, a wrong checksum
        zlib.error,  # damaged compressed bytes
        EOFError,  # fewer bytes than the directory promises
        OSError,  # an offset before the file
        ValueError,  # a name or a date that is none
        RuntimeError,  # an encrypted member
        NotImplementedError,  # a method of compression, or a version, that Python does not have
    ) as error:
        raise MeasurementError(f"{file.name}: the archive is damaged ({_words(error)}); copy it again.") from None


def _array(stream: IO[bytes], size: int, name: str, source: str) -> NDArray[Any]:
    """One array; its header must promise no more than is there, so that nothing large is set aside for nothing."""
    try:
        data = stream.read(size)
        head = io.BytesIO(data)
        version = np.lib.format.read_magic(head)
        reader = np.lib.format.read_array_header_1_0 if version == (1, 0) else np.lib.format.read_array_header_2_0
        if version not in ((1, 0), (2, 0)):
            raise ValueError(f"format version {version}")
        shape, fortran, dtype = reader(head, max_header_size=LONGEST_HEADER)
        if dtype.hasobject:
            raise MeasurementError(
                f"{source}: {name[:40]!r} holds pickled Python objects, which are programs and never loaded; "
                "save a numeric array."
            )
        if min(shape, default=1) < 0 or math.prod(shape) * dtype.itemsize > size - head.tell():
            raise ValueError(f"an array of shape {shape} is longer than the file")
        flat = np.frombuffer(data, dtype, math.prod(shape), head.tell())
        return flat.reshape(shape, order="F" if fortran else "C")
    except MeasurementError:
        raise
    except Exception as error:  # whatever a damaged header makes NumPy raise; it parses it as Python literals
        raise MeasurementError(
            f"{source}: {name[:40]!r} is not a whole NumPy array ({_words(error)}); save it again."
        ) from None


def _words(error: Exception) -> str:
    """The first line of what went wrong."""
    return printable(str(error).split("\n")[0][:80]) or type(error).__name__
