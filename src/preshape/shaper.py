"""Shaper: impulses, and boxes between them; what every design returns and everything else takes."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from preshape.errors import InputError
from preshape.files import write_atomically
from preshape.provenance import Design
from preshape.shaper_command import Exact, Function, Labelled, command_shaped, function_shaped, taps_of
from preshape.shaper_file import SCHEMA, boxes_from_plain, from_plain, read_json, to_json, to_plain
from preshape.shaper_parts import (
    Box,
    GivenBoxes,
    boxes_shifted,
    check_impulses,
    check_one_each,
    check_sum,
    checked_boxes,
    counted,
    frozen_vector,
    merged_impulses,
    part_lines,
    sum_of,
)

__all__ = ["Shaper"]

Samples = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Shaper:
    """A sequence of impulses and boxes; convolved with any command it removes the vibration it was designed for.

    Parameters
    ----------
    times : array_like, shape (impulse,)
        Impulse times [s], increasing from 0.
    amplitudes : array_like, shape (impulse,)
        Amplitudes [-]; they and the boxes' shares sum to 1, so that a shaped command ends where the command ends.
    design : Design, optional
        Where it comes from.
    boxes : iterable of (float, float, float), optional
        Parts of constant density: start [s], end [s] and density [1/s] of each, one after the other. Most shapers have
        none.

    Raises
    ------
    InputError
        If the impulses or boxes do not obey these rules.

    Examples
    --------
    >>> shaper = Shaper([0.0, 0.5], [0.5, 0.5])
    >>> shaper.duration, shaper.centroid
    (0.5, 0.25)
    >>> Shaper([0.0, 0.5], [0.25, 0.25], boxes=[(0.0, 0.5, 1.0)]).boxes[0].mass
    0.5
    """

    times: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    design: Design = field(default_factory=Design)
    boxes: tuple[Box, ...] = ()

    def __init__(
        self, times: ArrayLike, amplitudes: ArrayLike, design: Design | None = None, boxes: GivenBoxes = ()
    ) -> None:
        object.__setattr__(self, "times", frozen_vector("times", times))
        object.__setattr__(self, "amplitudes", frozen_vector("amplitudes", amplitudes))
        object.__setattr__(self, "design", design or Design())
        object.__setattr__(self, "boxes", checked_boxes(boxes))
        check_impulses(self.times, self.amplitudes)
        check_sum(self.amplitudes, self.boxes)

    @classmethod
    def normalised(
        cls, times: ArrayLike, amplitudes: ArrayLike, design: Design | None = None, boxes: GivenBoxes = ()
    ) -> Shaper:
        """The shaper with weights of any positive sum, divided by it; equal times are merged.

        Parameters
        ----------
        times : array_like, shape (impulse,)
            Impulse times [s], in any order; the earliest becomes 0.
        amplitudes : array_like, shape (impulse,)
            Weights of any unit.
        design : Design, optional
            Where it comes from.
        boxes : iterable of (float, float, float), optional
            Start [s], end [s] and density [unit of the weights / s] of parts of constant density.

        Raises
        ------
        InputError
            If the sum is not above zero, or as for Shaper.
        """
        t, a = frozen_vector("times", times), frozen_vector("amplitudes", amplitudes)
        check_one_each(t, a)
        parts = checked_boxes(boxes, float(t.min()))
        total = sum_of(a, parts)
        if total <= 0.0:
            raise InputError(f"the amplitudes sum to {total:g}: a shaper's sum must be above zero, or nothing moves.")
        scaled = [box._replace(density=box.density / total) for box in parts]
        return cls(*merged_impulses(t - t.min(), a / total, bool(parts)), design, scaled)

    def with_design(self, design: Design) -> Shaper:
        """The same impulses and boxes, with another record of where they come from."""
        return Shaper(self.times, self.amplitudes, design, self.boxes)

    @property
    def duration(self) -> float:
        """Time from the first impulse to the end of the last part [s]: what shaping adds to a move."""
        return max(float(self.times[-1]), *(box.end for box in self.boxes[-1:]), 0.0)

    @property
    def centroid(self) -> float:
        """Weighted mean of the times [s]: the delay at constant speed."""
        return float(self.times @ self.amplitudes) + sum(0.5 * (b.start + b.end) * b.mass for b in self.boxes)

    @property
    def magnitude(self) -> float:
        """Sum of the sizes of all parts [-]: 1 for a positive shaper; it amplifies no frequency by more."""
        return sum_of(np.abs(self.amplitudes), [box._replace(density=abs(box.density)) for box in self.boxes])

    def __len__(self) -> int:
        return self.times.size

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Shaper):
            return NotImplemented
        mine, others = (self.times, self.amplitudes), (other.times, other.amplitudes)
        return all(map(np.array_equal, mine, others)) and self.boxes == other.boxes

    def __hash__(self) -> int:
        return hash((self.times.tobytes(), self.amplitudes.tobytes(), self.boxes))

    def convolve(self, other: Shaper, design: Design | None = None) -> Shaper:
        """Both shapers in a row, as one (also written ``a * b``): zero wherever either is zero.

        Raises
        ------
        InputError
            If both have boxes: two averages in a row are no average.

        Examples
        --------
        >>> half = Shaper([0.0, 0.5], [0.5, 0.5])
        >>> (half * half).amplitudes.tolist()
        [0.25, 0.5, 0.25]
        """
        times = np.add.outer(self.times, other.times).ravel()
        amplitudes = np.multiply.outer(self.amplitudes, other.amplitudes).ravel()
        waits = 0.0 in (self.amplitudes[0], other.amplitudes[0])  # a leading impulse of 0 is a delay, and stays one
        times, amplitudes = merged_impulses(times, amplitudes, waits or bool(self.boxes or other.boxes))
        if not (self.boxes or other.boxes):
            return Shaper(times, amplitudes / amplitudes.sum(), design)
        if self.boxes and other.boxes:
            raise InputError("both shapers have boxes, whose convolution is none: put one on a grid (design.on_grid).")
        impulses, boxed = (other, self) if self.boxes else (self, other)
        boxes = boxes_shifted(boxed.boxes, impulses.times, impulses.amplitudes)
        return Shaper.normalised(times, amplitudes, design, boxes)

    def __mul__(self, other: Shaper) -> Shaper:
        return self.convolve(other) if isinstance(other, Shaper) else NotImplemented

    def taps(self, dt: float) -> tuple[NDArray[np.intp], NDArray[np.float64]]:
        """Delays [samples] and weights [-], both shape (tap,), on a grid of `dt` [s].

        An impulse between two samples is split linearly between them: the mean delay stays exact, and the residual
        at a mode of frequency f rises only by about (pi f dt)^2 / 2. A box counts as impulses at all its instants.
        """
        return taps_of(self.times, self.amplitudes, self.boxes, dt)

    @overload
    def shape(self, command: Exact) -> Exact: ...

    @overload
    def shape(
        self, command: Labelled, dt: float | None = ..., *, axis: int = ..., initial: ArrayLike = ...
    ) -> Labelled: ...

    @overload
    def shape(self, command: ArrayLike, dt: float, *, axis: int = ..., initial: ArrayLike = ...) -> Samples: ...

    def shape(self, command: Any, dt: float | None = None, *, axis: int = -1, initial: ArrayLike = 0.0) -> Any:
        """Convolve a command with the shaper: a sampled one, or exactly a Profile.

        Parameters
        ----------
        command : array_like, shape (..., time), or Profile, or of pandas or xarray
            Samples of the command, any unit, evenly spaced; the last one is held afterwards. Or a Profile: then the
            rest is left out. Of a Series or DataFrame the rows are times, of a DataArray its "time"; their index goes
            on in the answer. A function of time is shaped by :meth:`shape_function`.
        dt : float
            Sample time [s]; left out where a time index says it.
        axis : int
            The time axis; by default the last.
        initial : array_like
            What was commanded before the first sample, in the command's unit: zero, so that a step shows; give the
            start position of a machine that does not start at zero. Must broadcast against ``command[..., :1]``.

        Returns
        -------
        ndarray, shape (..., time + ceil(duration / dt)), or what the command is
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
        return command_shaped(self, command, dt, axis, initial)

    def shape_function(
        self, command: Function, antiderivative: Function | None = None
    ) -> Callable[[ArrayLike], NDArray[np.float64]]:
        """The shaped command as a function of time, from the command as a function of time: exact, by evaluation.

        Parameters
        ----------
        command : callable
            Takes times [s] of any shape, also those before its start, and gives values of that shape.
        antiderivative : callable, optional
            Its integral from any fixed time on [unit s]; for a shaper with boxes, which average.

        Raises
        ------
        InputError
            If the shaper has boxes and no antiderivative is given.

        Examples
        --------
        >>> ramp = Shaper([0.0, 0.5], [0.5, 0.5]).shape_function(lambda t: np.maximum(t, 0.0))
        >>> ramp([0.25, 0.5, 1.0]).tolist()
        [0.125, 0.25, 0.75]
        """
        return function_shaped(self.times, self.amplitudes, self.boxes, command, antiderivative)

    def to_dict(self) -> dict[str, Any]:
        """The shaper as plain data, schema ``preshape/shaper/1`` (docs/reference/shaper-file.md)."""
        boxes = [box._asdict() for box in self.boxes]
        return {
            "schema": SCHEMA,
            "times": self.times.tolist(),
            "amplitudes": self.amplitudes.tolist(),
            **({"boxes": boxes} if boxes else {}),
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
        boxes = boxes_from_plain(data.get("boxes", []))
        return cls(data.get("times", []), data.get("amplitudes", []), design, boxes)

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

    @property
    def parts(self) -> str:
        """How many impulses and boxes there are, in words."""
        return counted(self.times, self.boxes)

    def __repr__(self) -> str:
        return f"<Shaper {self.design.family}: {self.parts} in {self.duration:.6g} s, {self.design.status}>"

    def __str__(self) -> str:
        lines = [repr(self)[1:-1], "", *part_lines(self.times, self.amplitudes, self.boxes)]
        if self.design.modes is not None:
            lines += ["", "  designed for " + "; ".join(str(mode) for mode in self.design.modes)]
        return "\n".join(lines)
