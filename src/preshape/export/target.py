"""What a target of an export is: what it accepts, how it is written, and how it is read back."""

from __future__ import annotations

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
    taps : int
        Most taps on the grid, or impulses of a target without a grid.
    samples : int
        Longest delay [samples].
    precisions : tuple of str
        "double", "single" or both, the default first.
    negative : bool
        Whether weights may be negative.
    """

    taps: int
    samples: int
    precisions: tuple[str, ...] = ("double",)
    negative: bool = True


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
