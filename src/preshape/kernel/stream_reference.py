"""The stream kernel in Python and NumPy: what c/extension.c does, bit for bit, and what runs where that is missing.

A fixed shaper gathers: y[n] = r + sum of w (u[n - d] - r), r the sample of the last tap. A shaper that has been changed
scatters: every increment of the command is spread over the future by the shaper in force, the last tap getting exactly
what is left of it, and y[n] = u[n] - (what has not arrived yet). These sums are pairs of twice the precision, and zero
again as soon as everything has arrived, so that nothing drifts and a command at rest is reached to the last bit.
"""

from __future__ import annotations

import threading
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.kernel.stream_rings import LONGEST_DELAY, STATE, Gather, Scatter, Taps

__all__ = ["LIMIT", "EngineLike", "ReferenceEngine"]

LIMIT = 1e250
"""Larger samples are refused like infinity: nothing below it overflows on the way."""

LARGEST_SUM = 1e6
"""Most that the sizes of the weights may sum to; with LIMIT it keeps sums finite."""

SUM_TOLERANCE = 1e-3
"""How far the weights' sum may be from 1; the last weight is taken as what the others leave of it."""

BUSY = (
    "this stream is shaping a block in another thread: samples of one stream have an order; use a lock, or a stream "
    "for each thread."
)
ALLOWED = 'give finite commands within +-1e250, or let such samples through with not_finite="pass".'


class EngineLike(Protocol):
    """What both kernels do."""

    def push(self, sample: float, /) -> float:
        """Shape one sample of the only axis."""

    def block(self, command: NDArray[np.float64], shaped: NDArray[np.float64], /) -> None:
        """Shape samples (axes, time) into an array of that shape; all or none are taken."""

    def reset(self, values: NDArray[np.float64], /) -> None:
        """As if these values, one an axis, had been commanded for ever."""

    def retune(self, stage: int, delays: NDArray[np.uint32], weights: NDArray[np.float64], /) -> None:
        """Change the taps of a stage for what is commanded from now on."""

    def scattering(self, stage: int, /) -> bool:
        """Whether a stage scatters increments."""

    def save(self, axis: int, stage: int, /) -> bytes:
        """What a ring remembers, as float64.

        The past commands from the oldest on, or the last command, the pending pair, the number of samples until all
        has arrived, and the pairs that arrive until then.
        """

    def load(self, axis: int, stage: int, scattering: bool, values: bytes, /) -> None:
        """Put back what save gave."""


class ReferenceEngine:
    """Axes times stages of shapers.

    Parameters
    ----------
    axes : int
        Signals that are shaped alike.
    stages : tuple of Taps
        Shapers in a row.
    pass_bad : bool
        Let samples that are not finite through, the last finite one held meanwhile; otherwise they are refused.

    Raises
    ------
    InputError
        If taps are no shaper.
    """

    def __init__(self, axes: int, stages: tuple[Taps, ...], pass_bad: bool = False) -> None:
        self._stages = [_checked(*taps) for taps in stages]
        self._pass_bad, self._free = pass_bad, threading.Lock()
        self._units: list[list[Gather | Scatter]] = [[Gather(taps) for taps in self._stages] for _ in range(axes)]
        self._held = [0.0] * axes

    def push(self, sample: float, /) -> float:
        if len(self._units) != 1:
            raise ValueError("push is for one axis")
        u = float(sample)
        with _Alone(self._free):
            if abs(u) <= LIMIT:
                self._held[0] = u
                return self._step(0, u)
            if not self._pass_bad:
                raise InputError(f"the sample is {u!r}: {ALLOWED}")
            self._step(0, self._held[0])
            return u

    def block(self, command: NDArray[np.float64], shaped: NDArray[np.float64], /) -> None:
        axes = len(self._units)
        u = np.asarray(command).reshape(axes, -1)
        y = np.asarray(shaped).reshape(axes, -1)
        good = np.abs(u) <= LIMIT
        with _Alone(self._free):
            if not (self._pass_bad or good.all()):
                axis, sample = np.argwhere(~good)[0].tolist()
                raise InputError(
                    f"sample {sample} of axis {axis} is {float(u[axis, sample])!r}, and nothing of this block was "
                    f"taken: {ALLOWED}"
                )
            for axis in range(axes if u.size else 0):
                if good[axis].all():
                    values = u[axis]
                    for unit in self._units[axis]:
                        values = unit.block(values)
                    self._held[axis] = float(u[axis, -1])
                    y[axis] = values
                else:
                    y[axis] = [self._passed(axis, value) for value in u[axis].tolist()]

    def reset(self, values: NDArray[np.float64], /) -> None:
        if np.size(values) != len(self._units):
            raise ValueError("one value for each axis is needed")
        for value in np.ravel(values).tolist():
            if not abs(value) <= LIMIT:
                raise InputError(f"the sample is {value!r}: {ALLOWED}")
        with _Alone(self._free):
            self._held = np.ravel(values).tolist()
            self._units = [[Gather(taps, value) for taps in self._stages] for value in self._held]

    def retune(self, stage: int, delays: NDArray[np.uint32], weights: NDArray[np.float64], /) -> None:
        taps = _checked(delays, weights)
        with _Alone(self._free):
            self._stages[stage] = taps
            for units in self._units:
                unit = units[stage]
                if isinstance(unit, Gather):
                    unit = units[stage] = Scatter.taking_over(unit)
                unit.retune(taps)

    def scattering(self, stage: int, /) -> bool:
        return isinstance(self._units[0][stage], Scatter)

    def save(self, axis: int, stage: int, /) -> bytes:
        with _Alone(self._free):
            return np.array(self._units[axis][stage].save()).tobytes()

    def load(self, axis: int, stage: int, scattering: bool, values: bytes, /) -> None:
        numbers = np.frombuffer(values).tolist()
        if not all(abs(number) <= LIMIT for number in numbers):
            raise InputError(STATE)
        with _Alone(self._free):
            taps = self._stages[stage]
            unit = Scatter(taps, 0.0) if scattering else Gather(taps)
            unit.load(numbers)
            self._units[axis][stage] = unit
            if stage == 0:
                self._held[axis] = numbers[0] if scattering else numbers[-1]

    def _step(self, axis: int, u: float) -> float:
        for unit in self._units[axis]:
            u = unit.step(u)
        return u

    def _passed(self, axis: int, u: float) -> float:
        if abs(u) <= LIMIT:
            self._held[axis] = u
            return self._step(axis, u)
        self._step(axis, self._held[axis])
        return u


class _Alone:
    """Holds a lock, which nobody else may hold."""

    def __init__(self, lock: threading.Lock) -> None:
        self._lock = lock

    def __enter__(self) -> None:
        if not self._lock.acquire(blocking=False):
            raise RuntimeError(BUSY)

    def __exit__(self, *_: object) -> None:
        self._lock.release()


def _checked(delays: Any, weights: Any) -> Taps:
    """The taps, if they are a shaper on the grid."""
    d, w = np.array(delays, dtype=np.uint32), np.array(weights, dtype=float)
    if d.shape != w.shape:
        raise InputError("a shaper on the grid needs one weight for each delay.")
    right = d.size and (np.diff(d.astype(np.int64)) > 0).all() and np.abs(w).sum() <= LARGEST_SUM
    if not (right and abs(sum(w.tolist()) - 1.0) <= SUM_TOLERANCE):
        raise InputError(
            "the taps are no shaper on the grid: delays must increase from 0, weights must be finite and sum to 1."
        )
    if int(d[-1]) >= LONGEST_DELAY:
        raise InputError("the shaper is longer than 2**26 samples: sample less often.")
    return d, w
