"""Stream: a shaper in a loop. What it gives sample by sample is what :meth:`Shaper.shape` gives, bit for bit."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.checks import positive, whole_number
from preshape.errors import InputError
from preshape.kernel import Taps
from preshape.mode import ModesLike
from preshape.shaper import Shaper
from preshape.stream.parts import engine_of, numbers, row_of, taps_of
from preshape.stream.state import StreamState, read_state, write_state
from preshape.stream.tracking import Tracked, remembered, restored, tracked

__all__ = ["Stream"]

MOST_AXES = 4096


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
        self._shapers: tuple[Shaper, ...] | None = row_of(shaper)
        self._build(taps_of(self._shapers, self._dt))

    def _build(self, stages: tuple[Taps, ...]) -> None:
        self._stages = stages
        self._engine = engine_of(self._axes, stages, self._not_finite == "pass")
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
        u = numbers(sample)
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
        u = np.ascontiguousarray(numbers(samples))
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
        values = numbers(value)
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
        shapers = row_of(shaper)
        stages = taps_of(shapers, self._dt)
        if len(stages) != len(self._stages):
            raise InputError(
                f"{len(stages)} shapers were given and the stream has {len(self._stages)} in a row: give as many."
            )
        for index, (fresh, old) in enumerate(zip(stages, self._stages, strict=True)):
            if len(stages) == 1 or not (np.array_equal(fresh[0], old[0]) and np.array_equal(fresh[1], old[1])):
                self._engine.retune(index, *fresh)
        self._stages, self._shapers = stages, shapers

    def track(self, modes: ModesLike, *, tolerance: float = 0.0, search: bool = True) -> Tracked:
        """Follow modes that move: design the shaper for them from the one in force, and retune.

        Call it whenever the modes are known anew, as often as every sample; what that gives and what it does not is in
        docs/how-to/adaptive.md. When nothing has to change it does nothing, and the stream stays bit for bit what it
        was. Whatever happens, a shaper is in force: a redesign that is not found, or modes that are refused, leave the
        one before.

        Parameters
        ----------
        modes : Mode, (frequency, damping) or several
            The modes now, as many as the shaper was designed for and in the same order.
        tolerance : float
            Mismatch [-] up to which the shaper stays: what an estimator's noise does. See :class:`Tracked`.
        search : bool
            What happens where Newton's method does not lead to the new shaper, as where impulses appear or vanish:
            search for it, which takes milliseconds to a tenth of a second, or keep the one in force and say so.

        Returns
        -------
        Tracked
            The shaper now in force, and how it was found.

        Raises
        ------
        InputError
            If the stream has several shapers in a row, or one that is not from :func:`preshape.design.direct`; if the
            modes are not as many as its, or not modes, such as NaN. Then nothing has changed.

        Examples
        --------
        >>> from preshape import design
        >>> stream = Stream(design.direct([(1.0, 0.0), (2.7, 0.01)]), dt=0.01)
        >>> stream.track([(1.001, 0.0), (2.703, 0.01)]).start
        'near'
        """
        found = tracked(self._shapers, modes, tolerance, search)
        if found.changed:
            self.retune(found.shaper)
        return found

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
        shaper = remembered(self._shapers)
        return write_state(StreamState(self._dt, self._axes, self._not_finite, self._stages, rings, shaper))

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
        stream._shapers = restored(saved.shaper, saved.stages, saved.dt)
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
