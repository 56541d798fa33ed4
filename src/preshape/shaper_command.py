"""Commands through a shaper's parts: on a sample grid, or as functions of time."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError
from preshape.kernel import sparse_convolve
from preshape.shaper_labelled import Labelled, is_labelled, labelled_shaped
from preshape.shaper_parts import COINCIDENT, Box

__all__ = [
    "Exact",
    "Function",
    "Labelled",
    "Shapeable",
    "command_shaped",
    "function_shaped",
    "samples_shaped",
    "taps_of",
]

Exact = TypeVar("Exact", bound="Shapeable")

Function = Callable[[NDArray[np.float64]], ArrayLike]
"""A command: values at times [s] of any shape."""


class Shapeable(Protocol):
    """A command that knows how to be shaped exactly, as a :class:`preshape.profile.Profile` does."""

    def shaped(self: Exact, shaper: Any, /) -> Exact:
        """The command convolved with a Shaper."""


def taps_of(
    times: NDArray[np.float64], amplitudes: NDArray[np.float64], boxes: Sequence[Box], dt: float
) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
    """Delays [samples] and weights [-], both shape (tap,), each delay once: what :meth:`Shaper.taps` returns."""
    if not (math.isfinite(dt) and dt > 0.0):
        raise InputError(f"dt is {dt!r}: give the sample time in seconds, above zero.")
    parts = [_impulse_taps(times / dt, amplitudes), *(_box_taps(box, dt) for box in boxes)]
    delays = np.concatenate([part[0] for part in parts]).astype(np.intp)
    weights = np.concatenate([part[1] for part in parts])
    unique, where = np.unique(delays, return_inverse=True)
    summed = np.bincount(where, weights)
    keep = (summed != 0.0) | (unique == 0)  # a first tap of weight 0 says that the shaper begins with a delay
    return unique[keep].astype(np.intp), summed[keep]


def command_shaped(shaper: Any, command: Any, dt: float | None, axis: int, initial: ArrayLike) -> Any:
    """A command of any kind through a Shaper: what :meth:`Shaper.shape` returns."""
    if is_labelled(command):

        def shape(values: Any, step: float, along: int) -> NDArray[np.float64]:
            return samples_shaped(values, shaper.taps(step), along, initial)

        return labelled_shaped(command, shape, dt, axis)
    if hasattr(command, "shaped"):
        if dt is not None:
            raise InputError("this command is shaped exactly and has no samples: leave dt out.")
        return command.shaped(shaper)
    if dt is None or callable(command):
        raise InputError("samples need their dt, a function shape_function: shape(samples, dt=...).")
    return samples_shaped(command, shaper.taps(dt), axis, initial)


def samples_shaped(
    command: ArrayLike, taps: tuple[NDArray[np.intp], NDArray[np.float64]], axis: int, initial: ArrayLike
) -> NDArray[np.float64]:
    """A sampled command, shape (..., time), convolved with taps along `axis`; `initial` was commanded before it."""
    u = np.asarray(command, dtype=float)
    if u.ndim == 0 or u.size == 0:
        raise InputError("the command has no samples: give an array with the time along `axis`.")
    if not np.isfinite(u).all():
        raise InputError("the command holds NaN or infinity: replace or cut those samples before shaping.")
    u = np.moveaxis(u, axis, -1)
    before = np.broadcast_to(np.asarray(initial, dtype=float), (*u.shape[:-1], 1))
    return np.moveaxis(sparse_convolve(u, *taps, before), -1, axis)


def function_shaped(
    times: NDArray[np.float64],
    amplitudes: NDArray[np.float64],
    boxes: Sequence[Box],
    command: Function,
    antiderivative: Function | None,
) -> Callable[[ArrayLike], NDArray[np.float64]]:
    """What :meth:`Shaper.shape_function` returns."""
    if boxes and antiderivative is None:
        raise InputError("this shaper averages over boxes: give the command's antiderivative too.")
    integral = antiderivative or command

    def shaped(t: ArrayLike) -> NDArray[np.float64]:
        when = np.asarray(t, dtype=float)
        value = np.zeros(when.shape)
        for time, amplitude in zip(times, amplitudes, strict=True):
            value = value + amplitude * np.asarray(command(when - time))
        for start, end, density in boxes:
            value = value + density * (np.asarray(integral(when - start)) - np.asarray(integral(when - end)))
        return value

    return shaped


def _impulse_taps(
    positions: NDArray[np.float64], amplitudes: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Impulses at `positions` [samples], each split linearly between its two neighbours."""
    position = _on_samples(positions)
    lower = np.floor(position)
    fraction = position - lower
    delays = np.concatenate([lower, lower + 1.0])
    return delays, np.concatenate([amplitudes * (1.0 - fraction), amplitudes * fraction])


def _box_taps(box: Box, dt: float) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """A box, every instant of which is split linearly between its two neighbours."""
    start, end = _on_samples(np.array([box.start, box.end]) / dt)
    if start == end:  # shorter than the rounding of its times
        return _impulse_taps(np.array([start]), np.array([box.mass]))
    delays = np.arange(np.floor(start), np.ceil(end) + 1.0)
    return delays, box.mass / (end - start) * (_share(end - delays) - _share(start - delays))


def _share(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """The integral up to x of max(0, 1 - |x|), what a sample takes of an impulse at distance x."""
    near = np.clip(x, -1.0, 1.0)
    return np.where(near < 0.0, 0.5 * (near + 1.0) ** 2, 1.0 - 0.5 * (1.0 - near) ** 2)


def _on_samples(positions: NDArray[np.float64]) -> NDArray[np.float64]:
    """`positions` [samples], rounding of whole ones removed."""
    whole = np.rint(positions)
    near = np.abs(positions - whole) <= COINCIDENT * np.maximum(1.0, whole)
    return np.asarray(np.where(near, whole, positions))
