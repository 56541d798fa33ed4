"""What a target of an export is: what it accepts, how it is written, and how it is read back.

There are two kinds. A :class:`Target` works on samples: the shaper is put on its grid, and what is written is read back
bit for bit. A :class:`preshape.export.SettingsTarget` takes settings in its own words: there the shaper that counts is
what the controller makes of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from preshape.shaper import Shaper

__all__ = ["Exported", "Files", "Limits", "Placed", "Target"]

Files = Mapping[str, str | bytes]
"""Name of each file, which may name a folder with a slash, and its content; text is UTF-8 with line feeds."""


@dataclass(frozen=True)
class Limits:
    """What a target can hold.

    Parameters
    ----------
    taps : int or None
        Most taps on the grid, or impulses of a target without a grid; None: any number.
    samples : int or None
        Longest delay [samples]; None for a target without a grid.
    precisions : tuple of str
        "double", "single" or both, the default first.
    negative : bool
        Whether weights may be negative.
    shortest, longest : float
        Durations [s] that a target without a grid takes.
    smallest : float
        Least size of an impulse [-].
    resolution : str
        How finely what fits is held, in words.
    """

    taps: int | None
    samples: int | None = None
    precisions: tuple[str, ...] = ("double",)
    negative: bool = True
    shortest: float = 0.0
    longest: float = math.inf
    smallest: float = 0.0
    resolution: str = "every bit"

    def __str__(self) -> str:
        """What fits, in a line."""
        parts = []
        if self.samples is not None:
            parts += [f"{self.taps} taps" if self.taps else "any taps", f"delays up to {self.samples} samples"]
            parts.append(" or ".join(self.precisions))
        elif self.taps is not None:
            parts.append(f"{self.taps} impulses")
        if self.shortest > 0.0 or self.longest < math.inf:
            parts.append(f"{self.shortest:g} to {self.longest:g} s")
        if self.smallest > 0.0:
            parts.append(f"none below {self.smallest:g}")
        if not self.negative:
            parts.append("positive ones")
        return ", ".join([*parts, self.resolution])


@dataclass(frozen=True)
class Placed:
    """A shaper on the controller's grid, as a target writes it.

    Parameters
    ----------
    shaper : Shaper
        As the target will run it: on the grid, in single precision with rounded amplitudes, the last one what the
        others leave of 1; with ``design.settings`` of :func:`preshape.design.on_grid`, and what is left at the modes.
    dt : float
        Sample time of the controller [s].
    delays : ndarray of uint32, shape (tap,)
        Delays [samples], increasing from 0.
    weights : ndarray, shape (tap,)
        Weights [-], already rounded to the precision, so that they sum to 1 to its rounding.
    name : str
        An identifier in lower case that every target's language allows.
    precision : str
        "double" or "single".
    version : str
        One of the target's versions.
    """

    shaper: Shaper
    dt: float
    delays: NDArray[np.uint32]
    weights: NDArray[np.float64]
    name: str
    precision: str
    version: str

    @property
    def latency_samples(self) -> int:
        """Samples until a step has arrived altogether."""
        return int(self.delays[-1])

    @property
    def latency(self) -> float:
        """The same as a time [s]."""
        return self.latency_samples * self.dt

    @property
    def ring(self) -> int:
        """Entries of the ring: the next power of two above the latency."""
        return 1 << self.latency_samples.bit_length()

    @property
    def ring_bytes(self) -> int:
        """Memory of the ring."""
        return self.ring * (4 if self.precision == "single" else 8)


def _nothing(files: Files) -> tuple[str, ...]:
    return ()


@dataclass(frozen=True)
class Target:
    """One way out.

    Parameters
    ----------
    name : str
        What the command line calls it.
    summary : str
        One line on what comes out, and where it goes.
    versions : tuple of str
        Versions of the target's language or host that are told apart, the default first.
    limits : Limits
        What it can hold.
    render : callable
        The files for a :class:`Placed` shaper.
    parse : callable
        The shaper in such files, with the times [s] and the weights that the target will use: that of
        :class:`Placed`, bit for bit. InputError when it is not there.
    next_step : callable
        What the user does with the files, as lines of text; the command line shows them.
    notes : callable, optional
        Sentences for the user on what came out in these files, beside what they hold for everybody.
    """

    name: str
    summary: str
    versions: tuple[str, ...]
    limits: Limits
    render: Callable[[Placed], Files]
    parse: Callable[[Files], Shaper]
    next_step: Callable[[Placed], tuple[str, ...]] = field(default=lambda placed: ())
    notes: Callable[[Files], tuple[str, ...]] = _nothing


@dataclass(frozen=True)
class Exported:
    """What came out.

    Parameters
    ----------
    target : Target
        For whom.
    placed : Placed
        What is in it.
    files : mapping of str to str or bytes
        Names and contents.
    notes : tuple of str
        Sentences on what came out, for the user; mostly none.
    """

    target: Target
    placed: Placed
    files: Files = field(repr=False)
    notes: tuple[str, ...] = ()
