"""A stream as bytes: what it is, what its rings remember, and a checksum over both."""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from preshape.errors import InputError
from preshape.kernel import Taps

__all__ = ["StreamState", "read_state", "write_state"]

MAGIC = b"preshape stream\n"
VERSION = 1
HEAD = struct.Struct("<16sIQ")
"""Magic, version, bytes of the description."""
CHECK = struct.Struct("<I")


@dataclass(frozen=True)
class StreamState:
    """A stream without its kernel.

    Parameters
    ----------
    dt : float
        Sample time [s].
    axes : int
        Signals.
    not_finite : str
        "refuse" or "pass".
    stages : tuple of Taps
        Delays and weights of the shapers in a row.
    rings : list of list of (bool, bytes)
        For each axis and stage whether it scatters, and the float64 values it remembers.
    shaper : mapping, optional
        The one shaper as plain data, for a stream that can track.
    """

    dt: float
    axes: int
    not_finite: str
    stages: tuple[Taps, ...]
    rings: list[list[tuple[bool, bytes]]]
    shaper: Mapping[str, Any] | None = None


def write_state(state: StreamState) -> bytes:
    """The bytes, little-endian: head, description (JSON), taps and rings (float64), CRC-32 of all that."""
    description = {
        "dt": state.dt,
        "axes": state.axes,
        "not_finite": state.not_finite,
        "taps": [int(delays.size) for delays, _ in state.stages],
        "rings": [[[scattering, len(values) // 8] for scattering, values in axis] for axis in state.rings],
        "shaper": state.shaper,
    }
    text = json.dumps(description).encode()
    numbers = [np.concatenate([delays.astype(float), weights]) for delays, weights in state.stages]
    numbers += [np.frombuffer(values) for axis in state.rings for _, values in axis]
    body = HEAD.pack(MAGIC, VERSION, len(text)) + text + np.concatenate(numbers).astype("<f8").tobytes()
    return body + CHECK.pack(zlib.crc32(body))


def read_state(data: bytes) -> StreamState:
    """What :func:`write_state` wrote; InputError when it did not."""
    if not isinstance(data, bytes | bytearray | memoryview) or bytes(data[: len(MAGIC)]) != MAGIC:
        raise InputError("these bytes are not the state of a stream: give what Stream.state returned.")
    body, check = bytes(data[: -CHECK.size]), bytes(data[-CHECK.size :])
    if len(body) < HEAD.size or CHECK.unpack(check)[0] != zlib.crc32(body):
        raise InputError("the state of the stream is cut or damaged (its checksum differs): save it again.")
    _, version, length = HEAD.unpack(body[: HEAD.size])
    if version != VERSION:
        raise InputError(f"the state of the stream has version {version}: this preshape reads version {VERSION}.")
    try:
        description = json.loads(body[HEAD.size : HEAD.size + length])
        numbers = np.frombuffer(body[HEAD.size + length :], dtype="<f8").astype(float)
        sizes = [2 * taps for taps in description["taps"]]
        sizes += [size for axis in description["rings"] for _, size in axis]
        parts = np.split(numbers, np.cumsum(sizes)[:-1])
        if sum(sizes) != numbers.size:
            raise ValueError
        pairs = [np.split(part, 2) for part in parts[: len(description["taps"])]]
        values = iter(parts[len(pairs) :])
        return StreamState(
            float(description["dt"]),
            int(description["axes"]),
            str(description["not_finite"]),
            tuple((delays.astype(np.uint32), weights) for delays, weights in pairs),
            [[(bool(scattering), next(values).tobytes()) for scattering, _ in axis] for axis in description["rings"]],
            description["shaper"],
        )
    except (KeyError, TypeError, ValueError, StopIteration):
        raise InputError("the state of the stream does not describe one: give what Stream.state returned.") from None
