"""WAV: samples as parts of full scale, read by SciPy. What full scale means, only who recorded it knows."""

from __future__ import annotations

import io
import warnings

import numpy as np

from preshape.errors import MeasurementError
from preshape.identify.measurement import TimeSeries
from preshape.identify.source_file import MOST_NUMBERS, SourceFile
from preshape.identify.text import check_rate, printable
from preshape.identify.wanted import Wanted

__all__ = ["FORMAT", "read", "recognises"]

FORMAT = "WAV"
MOST_CHANNELS = 64
MINIMUM_SAMPLES = 2


def recognises(file: SourceFile) -> bool:
    """True for the RIFF family of containers with a WAVE in it."""
    return file.begin[:4] in (b"RIFF", b"RIFX", b"RF64") and file.begin[8:12] == b"WAVE"


def read(file: SourceFile, wanted: Wanted) -> TimeSeries:
    """Read PCM of 8 to 32 bits or floating point; values are parts of full scale, -1 to 1."""
    from scipy.io import wavfile

    data = file.data()
    channels = int.from_bytes(data[22:24], "big" if data[:4] == b"RIFX" else "little")
    if channels > MOST_CHANNELS and data[12:16] == b"fmt ":
        raise MeasurementError(f"{file.name}: the file says {channels} channels and at most {MOST_CHANNELS} are taken.")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", wavfile.WavFileWarning)  # chunks of cue points and comments
            rate, samples = wavfile.read(io.BytesIO(data))
    except Exception as error:  # whatever a damaged file makes SciPy raise; it has no exception of its own for it
        words = printable(str(error).split("\n")[0][:80]) or type(error).__name__
        raise MeasurementError(
            f"{file.name}: the WAV file is damaged or compressed ({words}); save it as PCM."
        ) from None
    if samples.size > MOST_NUMBERS:
        raise MeasurementError(
            f"{file.name}: the file holds {samples.size / 1e6:.0f} million samples and at most "
            f"{MOST_NUMBERS / 1e6:.0f} are taken; cut the part that holds the vibration."
        )
    values = np.atleast_2d(samples.T).astype(np.float64)
    if values.ndim != 2 or not 1 <= len(values) <= MOST_CHANNELS or values.shape[-1] < MINIMUM_SAMPLES or rate <= 0:
        raise MeasurementError(
            f"{file.name}: the WAV file has {values.shape[-1]} samples at {rate} Hz; record it again."
        )
    if samples.dtype.kind == "u":
        values = (values - 128.0) / 128.0
    elif samples.dtype.kind == "i":
        values = values / -float(np.iinfo(samples.dtype).min)
    check_rate(wanted.sample_rate, float(rate), file.name)
    names = ("channel",) if len(values) == 1 else tuple(f"channel {i + 1}" for i in range(len(values)))
    return TimeSeries(float(rate), 0.0, values, names, "full scale", file.name, FORMAT)
