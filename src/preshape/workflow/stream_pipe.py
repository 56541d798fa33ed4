"""Shaping what comes through a pipe: lines of numbers or raw float64, as it comes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import BinaryIO, cast

import numpy as np
from numpy.typing import NDArray

from preshape.checks import positive, whole_number
from preshape.errors import InputError
from preshape.shaper import Shaper
from preshape.stream import Stream

__all__ = ["PipedStream", "stream_pipe"]

CHUNK = 1 << 16
"""Bytes read at once from raw input, at most: what a pipe holds."""

TOLD = 1024
"""Lines between two calls of `progress`."""

LONGEST_LINE = 1 << 20


@dataclass(frozen=True)
class PipedStream:
    """What went through.

    Parameters
    ----------
    samples : int
        Samples read.
    axes : int
        Numbers a sample.
    """

    samples: int
    axes: int


def stream_pipe(
    shaper: Shaper,
    source: BinaryIO,
    sink: BinaryIO,
    *,
    rate: float,
    raw: bool = False,
    axes: int | None = None,
    unbuffered: bool = False,
    not_finite: str = "refuse",
    rest: bool = False,
    progress: Callable[[int], None] | None = None,
) -> PipedStream:
    """Shape samples from `source` into `sink`, one out for each one in.

    The machine is taken to rest at the first sample before the command begins.

    Parameters
    ----------
    shaper : Shaper
        Any shaper.
    source, sink : binary file
        Standard input and output, usually. Text is one sample a line, its numbers separated by commas or blanks; a
        first line of names is copied, empty lines are left out. Raw is little-endian float64.
    rate : float
        Samples per second [Hz].
    raw : bool
        Whether input and output are raw.
    axes : int, optional
        Numbers a sample; by default 1 for raw input, and as many as the first line has for text.
    unbuffered : bool
        Write each sample before the next one is read.
    not_finite : {"refuse", "pass"}
        As for :class:`preshape.stream.Stream`.
    rest : bool
        At the end of the input, write also what is still on its way, the last sample held.
    progress : callable, optional
        Called now and then with the number of samples so far.

    Raises
    ------
    InputError
        At a line or sample that cannot be used, with its number; what came before has been written.
    """
    pipe = _Pipe(shaper, 1.0 / positive("rate", rate, "Hz"), sink, unbuffered, not_finite, progress)
    numbers = None if axes is None else whole_number("axes", axes, 1, 4096)
    try:
        if raw:
            pipe.shape_raw(source, numbers or 1)
        else:
            pipe.shape_lines(source, numbers)
        if rest:
            pipe.finish(raw)
    finally:
        sink.flush()
    return PipedStream(pipe.samples, 0 if pipe.stream is None else pipe.stream.axes)


class _Pipe:
    """A stream between two files; it is made when the first sample shows where the machine rests."""

    def __init__(
        self,
        shaper: Shaper,
        dt: float,
        sink: BinaryIO,
        unbuffered: bool,
        not_finite: str,
        progress: Callable[[int], None] | None,
    ) -> None:
        self._shaper, self._dt, self._sink, self._progress = shaper, dt, sink, progress
        self._unbuffered, self._not_finite = unbuffered, not_finite
        Stream(shaper, dt, not_finite=not_finite)  # what is wrong with them shows before anything is read
        self.stream: Stream | None = None
        self.samples = 0

    def shape_lines(self, source: BinaryIO, axes: int | None) -> None:
        for number, line in _numbered(source):
            fields = line.replace(b",", b" ").split()
            try:
                values = [float(field) for field in fields]
            except ValueError:
                if number == 1 and _are_names(line, fields):
                    self._copy_names(line)
                    continue
                raise InputError(f"line {number} is {_shown(line)}: give numbers, separated by commas.") from None
            axes = axes or len(values)
            if len(values) != axes:
                raise InputError(f"line {number} has {len(values)} numbers: give {axes}, as before.")
            try:
                shaped = self._sample(values)
            except InputError as error:
                raise InputError(f"line {number} is {_shown(line)}: {error}") from None
            self._write(",".join(map(repr, shaped)).encode() + b"\n")
            if self._progress and self.samples % TOLD == 0:
                self._progress(self.samples)

    def shape_raw(self, source: BinaryIO, axes: int) -> None:
        size = 8 * axes
        held = b""
        read = getattr(source, "read1", source.read)
        while data := (source.read(size) if self._unbuffered else read(CHUNK)):
            held += data
            whole = len(held) // size * size
            block = np.frombuffer(held[:whole], dtype="<f8").astype(float).reshape(-1, axes).T
            held = held[whole:]
            if whole:
                first = self.samples
                try:
                    shaped = self._shaped(np.ascontiguousarray(block))
                except InputError as error:
                    raise InputError(f"raw input, from sample {first} on: {error}") from None
                self._write(np.ascontiguousarray(shaped.T).astype("<f8").tobytes())
                if self._progress:
                    self._progress(self.samples)
        if held:
            raise InputError(f"the input ends within sample {self.samples}: {len(held)} bytes of {size} are there.")

    def finish(self, raw: bool) -> None:
        """Write what is on its way."""
        if self.stream is None:
            return
        last = np.repeat(self._last[:, None], self.stream.latency_samples, axis=1)
        rows = self.stream.push_block(last).T
        if raw:
            self._write(np.ascontiguousarray(rows).astype("<f8").tobytes())
        else:
            for row in rows.tolist():
                self._write(b",".join(repr(value).encode() for value in row) + b"\n")

    def _begun(self, first: NDArray[np.float64]) -> Stream:
        """The stream, at rest at the first sample."""
        if self.stream is None:
            stream = Stream(self._shaper, self._dt, first.size, not_finite=self._not_finite)
            stream.reset(np.where(np.isfinite(first), first, 0.0) if self._not_finite == "pass" else first)
            self.stream, self._last = stream, np.zeros(first.size)
        return self.stream

    def _sample(self, values: list[float]) -> list[float]:
        """One sample, shaped; one axis without NumPy, which would take most of the time."""
        stream = self.stream
        if stream is None or stream.axes > 1 or not math.isfinite(values[0]):
            return [float(value) for value in self._shaped(np.array(values)[:, None])[:, 0]]
        shaped = cast("float", stream.push(values[0]))
        self._last[0] = values[0]
        self.samples += 1
        return [shaped]

    def _shaped(self, block: NDArray[np.float64]) -> NDArray[np.float64]:
        """Samples, shape (axes, time), shaped."""
        stream = self._begun(block[:, 0])
        shaped = stream.push_block(block if stream.axes > 1 else block[0])
        self.samples += block.shape[1]
        good = np.isfinite(block)
        for axis in np.flatnonzero(good.any(axis=1)):
            self._last[axis] = block[axis, good[axis]][-1]
        return shaped.reshape(block.shape)

    def _copy_names(self, line: bytes) -> None:
        first = line.replace(b",", b" ").split()[0].strip(b'"').lower()
        if first in (b"t", b"time", b"times"):
            raise InputError(
                "line 1 names a column of times, which a stream would shape like a command: cut it off, or use "
                "preshape shape."
            )
        self._write(line.rstrip(b"\r\n") + b"\n")

    def _write(self, data: bytes) -> None:
        self._sink.write(data)
        if self._unbuffered:
            self._sink.flush()


def _numbered(source: BinaryIO) -> Iterator[tuple[int, bytes]]:
    """Lines that are not empty, with their numbers from 1."""
    number = 0
    while line := source.readline(LONGEST_LINE):
        number += 1
        if len(line) == LONGEST_LINE and not line.endswith(b"\n"):
            raise InputError(f"line {number} is longer than a megabyte: is this raw input? Say --raw.")
        if line.strip():
            yield number, line


def _are_names(line: bytes, fields: list[bytes]) -> bool:
    """Whether this is text, and none of it a number."""
    try:
        line.decode()
    except UnicodeDecodeError:
        return False
    return b"\0" not in line and not any(map(_is_number, fields))


def _is_number(field: bytes) -> bool:
    try:
        float(field)
    except ValueError:
        return False
    return True


def _shown(line: bytes) -> str:
    text = line.decode("utf-8", "replace").strip()
    return repr(text if len(text) <= 60 else f"{text[:57]}...")
