"""Shaper: impulse times and amplitudes; what every design returns and everything else takes."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError
from preshape.files import write_atomically
from preshape.kernel import sparse_convolve
from preshape.provenance import Design
from preshape.shaper_file import SCHEMA, from_plain, read_json, to_json, to_plain

__all__ = ["Shaper"]

SUM_TOLERANCE = 1e-9
"""How far the amplitudes' sum may be from 1 [-]."""

COINCIDENT = 1e-9
"""Impulses closer than this fraction of the shaper's duration are one: set at their centroid, where moving them
changes the residual only in second order (below 1e-15). For opposite signs it would be first order: they must coincide
to rounding."""


@dataclass(frozen=True, eq=False)
class Shaper:
    """A sequence of impulses; convolved with any command it removes the vibration it was designed for.

    Parameters
    ----------
    times : array_like, shape (impulse,)
        Impulse times [s], increasing from 0.
    amplitudes : array_like, shape (impulse,)
        Amplitudes [-], summing to 1 so that a shaped command ends where the command ends.
    design : Design, optional
        Where it comes from.

    Raises
    ------
    InputError
        If the impulses do not obey these rules.

    Examples
    --------
    >>> shaper = Shaper([0.0, 0.5], [0.5, 0.5])
    >>> shaper.duration, shaper.centroid
    (0.5, 0.25)
    """

    times: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    design: Design = field(default_factory=Design)

    def __init__(self, times: ArrayLike, amplitudes: ArrayLike, design: Design | None = None) -> None:
        object.__setattr__(self, "times", _frozen_vector("times", times))
        object.__setattr__(self, "amplitudes", _frozen_vector("amplitudes", amplitudes))
        object.__setattr__(self, "design", design or Design())
        if self.times.size != self.amplitudes.size:
            raise InputError(
                f"{self.times.size} times and {self.amplitudes.size} amplitudes: a shaper needs one of each an impulse."
            )
        if self.times[0] != 0.0:
            raise InputError(f"the first impulse is at {self.times[0]:g} s: shift the times so that it is at 0.")
        steps = np.diff(self.times)
        if (steps <= 0.0).any():
            late = int(np.argmax(steps <= 0.0)) + 1
            raise InputError(
                f"times must increase, but impulse {late + 1} at {self.times[late]:g} s does not come after "
                f"{self.times[late - 1]:g} s: sort them, and add up the amplitudes of equal times."
            )
        total = float(self.amplitudes.sum())
        if abs(total - 1.0) > SUM_TOLERANCE:
            raise InputError(
                f"the amplitudes sum to {total:.9g}, not 1: the command would not end where it should; "
                "Shaper.normalised(times, amplitudes) divides them by their sum."
            )

    @classmethod
    def normalised(cls, times: ArrayLike, amplitudes: ArrayLike, design: Design | None = None) -> Shaper:
        """The shaper with `amplitudes` of any positive sum, divided by it; equal times are merged.

        Parameters
        ----------
        times : array_like, shape (impulse,)
            Impulse times [s], in any order; the earliest becomes 0.
        amplitudes : array_like, shape (impulse,)
            Weights of any unit.

        Raises
        ------
        InputError
            If the sum is not above zero, or as for Shaper.
        """
        t, a = _frozen_vector("times", times), _frozen_vector("amplitudes", amplitudes)
        if t.size != a.size:
            raise InputError(f"{t.size} times and {a.size} amplitudes: a shaper needs one of each an impulse.")
        total = float(a.sum())
        if total <= 0.0:
            raise InputError(f"the amplitudes sum to {total:g}: a shaper's sum must be above zero, or nothing moves.")
        return cls(*_merged(t - t.min(), a / total), design)

    @property
    def duration(self) -> float:
        """Time from the first to the last impulse [s]: what shaping adds to a move."""
        return float(self.times[-1])

    @property
    def centroid(self) -> float:
        """Amplitude-weighted mean of the impulse times [s]: the delay at constant speed."""
        return float(self.times @ self.amplitudes)

    def __len__(self) -> int:
        return self.times.size

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Shaper):
            return NotImplemented
        return np.array_equal(self.times, other.times) and np.array_equal(self.amplitudes, other.amplitudes)

    def __hash__(self) -> int:
        return hash((self.times.tobytes(), self.amplitudes.tobytes()))

    def convolve(self, other: Shaper, design: Design | None = None) -> Shaper:
        """Both shapers in a row, as one (also written ``a * b``): zero wherever either is zero.

        Examples
        --------
        >>> half = Shaper([0.0, 0.5], [0.5, 0.5])
        >>> (half * half).amplitudes.tolist()
        [0.25, 0.5, 0.25]
        """
        times = np.add.outer(self.times, other.times).ravel()
        amplitudes = np.multiply.outer(self.amplitudes, other.amplitudes).ravel()
        times, amplitudes = _merged(times, amplitudes)
        return Shaper(times, amplitudes / amplitudes.sum(), design)

    def __mul__(self, other: Shaper) -> Shaper:
        return self.convolve(other) if isinstance(other, Shaper) else NotImplemented

    def taps(self, dt: float) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
        """Delays [samples] and weights [-], both shape (tap,), on a grid of `dt` [s].

        An impulse between two samples is split linearly between them: the mean delay stays exact, and the residual
        at a mode of frequency f rises only by about (pi f dt)^2 / 2.
        """
        if not (math.isfinite(dt) and dt > 0.0):
            raise InputError(f"dt is {dt!r}: give the sample time in seconds, above zero.")
        position = self.times / dt
        whole = np.rint(position)
        on_grid = np.abs(position - whole) <= COINCIDENT * np.maximum(1.0, whole)
        lower = np.where(on_grid, whole, np.floor(position))
        fraction = np.where(on_grid, 0.0, position - lower)
        delays = np.concatenate([lower, lower + 1.0]).astype(np.intp)
        weights = np.concatenate([self.amplitudes * (1.0 - fraction), self.amplitudes * fraction])
        unique, where = np.unique(delays, return_inverse=True)
        summed = np.bincount(where, weights)
        keep = summed != 0.0
        return unique[keep].astype(np.intp), summed[keep]

    def shape(self, command: ArrayLike, dt: float, *, axis: int = -1, initial: ArrayLike = 0.0) -> NDArray[np.float64]:
        """Convolve a sampled command with the impulses.

        Parameters
        ----------
        command : array_like, shape (..., time)
            Samples of the command, any unit, evenly spaced; the last one is held afterwards.
        dt : float
            Sample time [s].
        axis : int
            The time axis; by default the last.
        initial : array_like
            What was commanded before the first sample, in the command's unit: zero, so that a step shows; give the
            start position of a machine that does not start at zero. Must broadcast against ``command[..., :1]``.

        Returns
        -------
        ndarray, shape (..., time + ceil(duration / dt))
            Long enough to reach the command's end value.

        Raises
        ------
        InputError
            If the command is empty or not finite, or dt is not a positive number.

        Examples
        --------
        >>> Shaper([0.0, 0.5], [0.5, 0.5]).shape([1.0, 1.0, 1.0], dt=0.25).tolist()
        [0.5, 0.5, 1.0, 1.0, 1.0]
        """
        u = np.asarray(command, dtype=float)
        if u.ndim == 0 or u.size == 0:
            raise InputError("the command has no samples: give an array with the time along `axis`.")
        if not np.isfinite(u).all():
            raise InputError("the command holds NaN or infinity: replace or cut those samples before shaping.")
        u = np.moveaxis(u, axis, -1)
        before = np.broadcast_to(np.asarray(initial, dtype=float), (*u.shape[:-1], 1))
        delays, weights = self.taps(dt)
        return np.moveaxis(sparse_convolve(u, delays, weights, before), -1, axis)

    def to_dict(self) -> dict[str, Any]:
        """The shaper as plain data, schema ``preshape/shaper/1`` (docs/reference/shaper-file.md)."""
        return {
            "schema": SCHEMA,
            "times": self.times.tolist(),
            "amplitudes": self.amplitudes.tolist(),
            "duration": self.duration,
            "design": to_plain(self.design),
        }

    @classmethod
    def from_dict(cls, data: Mapping[str, Any]) -> Shaper:
        """The shaper that :meth:`to_dict` wrote; InputError when the data are not of that schema."""
        schema = data.get("schema") if isinstance(data, Mapping) else None
        if schema != SCHEMA:
            raise InputError(f'the data say schema {schema!r}: a shaper has "schema": "{SCHEMA}".')
        design = from_plain(data.get("design", {}), Design)
        return cls(data.get("times", []), data.get("amplitudes", []), design)

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the shaper to a JSON file; InputError when the place cannot be written."""
        return write_atomically(path, to_json(self.to_dict()))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Shaper:
        """Read a shaper from a JSON file; InputError naming what is wrong with it."""
        data = read_json(path)
        try:
            return cls.from_dict(data)
        except InputError as error:
            raise InputError(f"{path}: {error}") from None

    def __repr__(self) -> str:
        return f"<Shaper {self.design.family}: {len(self)} impulses in {self.duration:.6g} s, {self.design.status}>"

    def __str__(self) -> str:
        lines = [repr(self)[1:-1], "", "  time [s]      amplitude [-]"]
        lines += [f"  {t:<12.9f}  {a:+.9f}" for t, a in zip(self.times, self.amplitudes, strict=True)]
        if self.design.modes is not None:
            lines += ["", "  designed for " + "; ".join(str(mode) for mode in self.design.modes)]
        return "\n".join(lines)


def _frozen_vector(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """A read-only copy of `values` as a vector, or a clear refusal."""
    try:
        vector = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise InputError(f"{name} must be numbers, one an impulse, not {values!r}.") from None
    if vector.ndim != 1 or vector.size == 0:
        raise InputError(f"{name} has shape {vector.shape}: give a flat list with at least one impulse.")
    if not np.isfinite(vector).all():
        raise InputError(f"{name} holds NaN or infinity at impulse {int(np.argmin(np.isfinite(vector))) + 1}.")
    vector.flags.writeable = False
    return vector


def _merged(
    times: NDArray[np.float64], amplitudes: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Sorted impulses, coincident ones added up at their centroid."""
    order = np.argsort(times, kind="stable")
    t, a = times[order], amplitudes[order]
    nearness = np.where(a[1:] * a[:-1] > 0.0, COINCIDENT, np.finfo(float).eps) * max(float(t[-1]), np.finfo(float).tiny)
    group = np.concatenate([[0], np.cumsum(np.diff(t) > nearness)])
    total = np.bincount(group, a)
    size = np.bincount(group, np.abs(a))
    first = t[np.flatnonzero(np.diff(group, prepend=-1.0))]
    offset = np.bincount(group, np.abs(a) * (t - first[group]))
    centre = first + offset / np.where(size > 0.0, size, 1.0)
    keep = total != 0.0
    return centre[keep] - centre[keep][0], total[keep]
