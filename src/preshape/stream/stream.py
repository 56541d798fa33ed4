"""Stream: a shaper in a loop. What it gives sample by sample is what :meth:`Shaper.shape` gives, bit for bit."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive, whole_number
from preshape.errors import InputError
from preshape.kernel import EngineLike, ReferenceEngine, Taps, compiled
from preshape.shaper import Shaper
from preshape.stream.state import StreamState, read_state, write_state

__all__ = ["Stream"]

MOST_AXES, MOST_STAGES = 4096, 64
LARGEST_GAIN = 1e18
"""The stages' magnitudes multiplied may not exceed this: with the kernel's limit of a sample, nothing overflows."""


class Stream:
    """A shaper that takes a command as it comes, one sample or one block at a time.

    As long as the shaper stays, the output is bit for bit that of :meth:`Shaper.shape`, however the samples are cut
    into blocks, and a constant command comes out unchanged. After :meth:`retune`, every *increment* of the command goes
    through the shaper that was in force when it was commanded: the change itself moves nothing, whatever was commanded
    before arrives as it would have, and the output ends where the command ends, to the last bit.

    Parameters
    ----------
    shaper : Shaper or sequence of Shaper
        What shapes. Several are applied in a row, each with its own memory: what their convolution does with the sum of
        their impulses instead of the product. Impulses between samples are split linearly; put the shaper on the grid
        with :func:`preshape.design.on_grid` to choose another way. Boxes become impulses at all their instants.
    dt : float
        Sample time [s]. For another sample time make another stream.
    axes : int
        Signals that are shaped alike, at the same time.
    not_finite : {"refuse", "pass"}
        What happens to a sample that is NaN, infinite or beyond 1e250: it is refused and changes nothing, or it comes
        out as it is while the last finite sample is held inside, so that later samples are not spoilt.

    Raises
    ------
    InputError
        If an argument is not of these, or the shaper is longer than 2**26 samples.

    Notes
    -----
    At rest at 0 in the beginning: say :meth:`reset` with the machine's position if it is another. One stream is for one
    thread at a time; a block is shaped without Python's lock, and a call from another thread meanwhile is refused with
    RuntimeError. Streams do not share anything. With several axes a sample takes microseconds: prefer blocks.

    References
    ----------
    Hyde, 3.2.2 (rings in a row).

    Examples
    --------
    >>> stream = Stream(Shaper([0.0, 0.5], [0.5, 0.5]), dt=0.25)
    >>> [stream.push(u) for u in (1.0, 1.0, 1.0)]
    [0.5, 0.5, 1.0]
    >>> stream.push_block([1.0, 2.0, 2.0, 2.0]).tolist()
    [1.0, 1.5, 1.5, 2.0]
    """

    def __init__(
        self, shaper: Shaper | Sequence[Shaper], dt: float, axes: int = 1, *, not_finite: str = "refuse"
    ) -> None:
        if not_finite not in ("refuse", "pass"):
            raise InputError(f'not_finite is {not_finite!r}: it is "refuse" or "pass".')
        self._dt = positive("dt", dt, "s")
        self._axes = whole_number("axes", axes, 1, MOST_AXES)
        self._not_finite = not_finite
        self._build(_taps_of(shaper, self._dt))

    def _build(self, stages: tuple[Taps, ...]) -> None:
        self._stages = stages
        self._engine = _engine(self._axes, stages, self._not_finite == "pass")
        if self._axes == 1:
            self.push = self._engine.push  # type: ignore[method-assign, assignment]  # no detour through Python

    def push(self, sample: ArrayLike) -> float | NDArray[np.float64]:
        """Shape one sample.

        Parameters
        ----------
        sample : float, or array_like of shape (axes,)
            The command, any unit.

        Returns
        -------
        float, or ndarray of shape (axes,)
            The shaped command, its unit.

        Raises
        ------
        InputError
            If it is not finite (unless these are passed), or not one number an axis.
        """
        u = _numbers(sample)
        if u.shape != (self._axes,):
            raise InputError(f"the sample has shape {u.shape}: give {self._axes} numbers, one an axis.")
        return self.push_block(u[:, None])[:, 0]

    def push_block(self, samples: ArrayLike, out: NDArray[np.float64] | None = None) -> NDArray[np.float64]:
        """Shape many samples; all of them are taken, or none.

        Parameters
        ----------
        samples : array_like, shape (time,), or (axes, time) if there are several
            The command, any unit.
        out : ndarray of float64, optional
            Where the result goes: contiguous, of the samples' shape; it may be the samples themselves.

        Returns
        -------
        ndarray
            The shaped command, of the same shape and unit: as many samples as came in, the rest comes later.

        Raises
        ------
        InputError
            If a sample is not finite (unless these are passed), or a shape does not fit.
        """
        u = np.ascontiguousarray(_numbers(samples))
        several = u.ndim == 2 and u.shape[0] == self._axes
        if not (several or (u.ndim == 1 and self._axes == 1)):
            wanted = "(time,)" if self._axes == 1 else f"({self._axes}, time)"
            raise InputError(f"the samples have shape {u.shape}: give {wanted}, the time along the last axis.")
        y = np.empty_like(u) if out is None else out
        if y.shape != u.shape or y.dtype != np.float64 or not y.flags.c_contiguous or not y.flags.writeable:
            raise InputError(f"out must be a contiguous writable float64 array of shape {u.shape}.")
        if y is not u and np.shares_memory(y, u):
            if y.ctypes.data != u.ctypes.data:
                raise InputError("out overlaps the samples without being them: give the samples themselves, or others.")
            u = y
        if u.size:
            self._engine.block(u, y)
        return y

    def reset(self, value: ArrayLike = 0.0) -> None:
        """Forget the past: as if `value` (one, or one an axis; the command's unit) had been commanded for ever."""
        values = _numbers(value)
        if values.shape not in ((), (self._axes,)):
            raise InputError(
                f"the value has shape {values.shape}: give one number, or one for each of {self._axes} axes."
            )
        self._engine.reset(np.ascontiguousarray(np.broadcast_to(values, (self._axes,))))

    def retune(self, shaper: Shaper | Sequence[Shaper]) -> None:
        """Shape what is commanded from now on with another shaper; what was commanded before arrives as it would have.

        The first change costs as much as one sample for each sample of the shaper's duration, the later ones a
        microsecond or so. A sample then costs about seven times as much as with a fixed shaper, however often it
        changes, until :meth:`reset`.

        Parameters
        ----------
        shaper : Shaper or sequence of Shaper
            As many as the stream was made with.

        Raises
        ------
        InputError
            If it is another number of shapers, or one cannot be used; then nothing has changed.
        """
        stages = _taps_of(shaper, self._dt)
        if len(stages) != len(self._stages):
            raise InputError(
                f"{len(stages)} shapers were given and the stream has {len(self._stages)} in a row: give as many."
            )
        for index, (fresh, old) in enumerate(zip(stages, self._stages, strict=True)):
            if len(stages) == 1 or not (np.array_equal(fresh[0], old[0]) and np.array_equal(fresh[1], old[1])):
                self._engine.retune(index, *fresh)
        self._stages = stages

    @property
    def dt(self) -> float:
        """Sample time [s]."""
        return self._dt

    @property
    def axes(self) -> int:
        """How many signals are shaped alike."""
        return self._axes

    @property
    def latency(self) -> float:
        """Time until a step has arrived altogether [s]: the duration of the shaper on the grid."""
        return self.latency_samples * self._dt

    @property
    def latency_samples(self) -> int:
        """The same in samples."""
        return sum(int(delays[-1]) for delays, _ in self._stages)

    @property
    def state(self) -> bytes:
        """Everything that :meth:`from_state` needs to go on, in another process or with the other kernel too."""
        rings = [
            [(self._engine.scattering(j), self._engine.save(axis, j)) for j in range(len(self._stages))]
            for axis in range(self._axes)
        ]
        return write_state(StreamState(self._dt, self._axes, self._not_finite, self._stages, rings))

    @classmethod
    def from_state(cls, state: bytes) -> Stream:
        """The stream whose :attr:`state` this was, about to give the same samples.

        Raises
        ------
        InputError
            If the bytes are damaged, cut, or of another version.

        Examples
        --------
        >>> stream = Stream(Shaper([0.0, 0.5], [0.5, 0.5]), dt=0.25)
        >>> stream.push(4.0), Stream.from_state(stream.state).push(4.0)
        (2.0, 2.0)
        """
        saved = read_state(state)
        stream = cls.__new__(cls)
        stream._dt, stream._axes, stream._not_finite = saved.dt, saved.axes, saved.not_finite
        stream._build(saved.stages)
        for axis, rings in enumerate(saved.rings):
            for stage, (scattering, values) in enumerate(rings):
                stream._engine.load(axis, stage, scattering, values)
        return stream

    def __reduce__(self) -> tuple[object, ...]:
        return Stream.from_state, (self.state,)

    def __repr__(self) -> str:
        taps = " then ".join(str(delays.size) for delays, _ in self._stages)
        return f"<Stream: {taps} taps, {self._axes} axis(es), dt {self._dt:g} s, latency {self.latency:g} s>"


def _engine(axes: int, stages: tuple[Taps, ...], pass_bad: bool) -> EngineLike:
    if compiled is not None:
        engine: EngineLike = compiled.Engine(axes, stages, pass_bad)
        return engine
    warnings.warn(
        "preshape was installed without a C compiler: streams run on NumPy, to the same bits but slower",
        RuntimeWarning,
        stacklevel=1,
    )
    return ReferenceEngine(axes, stages, pass_bad)


def _taps_of(shaper: Shaper | Sequence[Shaper], dt: float) -> tuple[Taps, ...]:
    """The stages on the grid."""
    shapers = [shaper] if isinstance(shaper, Shaper) else shaper
    if not isinstance(shapers, Sequence) or not all(isinstance(one, Shaper) for one in shapers):
        raise InputError(f"{shaper!r} is no shaper: give a Shaper, or a list of them.")
    if not 1 <= len(shapers) <= MOST_STAGES:
        raise InputError(f"{len(shapers)} shapers were given: give 1 to {MOST_STAGES} in a row.")
    gain = float(np.prod([one.magnitude for one in shapers]))
    if not gain <= LARGEST_GAIN:
        raise InputError(f"these shapers in a row may amplify by {gain:g}: up to {LARGEST_GAIN:g} is allowed.")
    taps = [one.taps(dt) for one in shapers]
    return tuple((delays.astype(np.uint32), np.ascontiguousarray(weights)) for delays, weights in taps)


def _numbers(values: ArrayLike) -> NDArray[np.float64]:
    try:
        return np.asarray(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{values!r} is not made of numbers.") from None
