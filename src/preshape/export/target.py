"""What a target of an export is: what it accepts, how it is written, how it is read back, and what it does.

There are two kinds. A :class:`Target` works on samples: the shaper is put on its grid, and what is written is read back
bit for bit. A :class:`preshape.export.SettingsTarget` takes settings in its own words. Both know

``parse(files)``
    what the text says: :class:`Taps`, or settings and their version.
``execute(files, version, axis)``
    what the controller does with it: the impulses that it convolves a command with. That is the shaper in an export's
    ``placed``, whatever was asked for.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.shaper import Shaper

__all__ = ["EPSILON", "PRECISIONS", "AnyTarget", "Exported", "Files", "Limits", "Placed", "Taps", "Target"]

Files = Mapping[str, str | bytes]
"""Name of each file, which may name a folder with a slash, and its content; text is UTF-8 with line feeds."""

PRECISIONS = {"double": np.float64, "single": np.float32}
"""Numbers of a controller."""

EPSILON = {"double": 2.0**-53, "single": 2.0**-24}
"""How far rounding to them moves a number, relative."""

LARGEST_SUM = 1e6
"""Most that the sizes of the weights may sum to: what the kernel takes."""


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
    seconds : float
        The same of a target that takes impulses: how far one may be executed from where it was asked for [s].
    amplitude : float
        How far each amplitude that is written may be off [-]; 0: by no more than the numbers' precision.
    """

    taps: int | None
    samples: int | None = None
    precisions: tuple[str, ...] = ("double",)
    negative: bool = True
    shortest: float = 0.0
    longest: float = math.inf
    smallest: float = 0.0
    resolution: str = "every bit"
    seconds: float = 0.0
    amplitude: float = 0.0

    def __str__(self) -> str:
        """What fits, in a line."""
        parts = []
        if self.samples is not None:
            parts += [f"up to {self.taps} taps" if self.taps else "any taps", f"delays up to {self.samples} samples"]
            parts.append(" or ".join(self.precisions))
        elif self.taps is not None:
            parts.append(f"up to {self.taps} impulses")
        if self.shortest > 0.0 or self.longest < math.inf:
            parts.append(f"{self.shortest:g} to {self.longest:g} s")
        if self.smallest > 0.0:
            parts.append(f"none below {self.smallest:g}")
        if not self.negative:
            parts.append("positive ones only")
        return ", ".join([*parts, self.resolution])


@dataclass(frozen=True, eq=False)
class Taps:
    """What stands in the files of a target on samples.

    Parameters
    ----------
    dt : float
        Sample time of the controller [s].
    delays : ndarray of uint32, shape (tap,)
        Delays [samples], increasing from 0.
    weights : ndarray, shape (tap,)
        Weights [-], already rounded to the precision, so that they sum to 1 to its rounding.
    precision : str
        "double" or "single".
    """

    dt: float
    delays: NDArray[np.uint32]
    weights: NDArray[np.float64]
    precision: str

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


@dataclass(frozen=True, eq=False)
class Placed(Taps):
    """A shaper on the controller's grid, as a target writes it.

    Parameters
    ----------
    dt, delays, weights, precision
        As of :class:`Taps`.
    shaper : Shaper
        What the target does with them, as ``execute`` says; with ``design.settings`` of
        :func:`preshape.design.on_grid`, and what is left at the modes.
    name : str
        An identifier in lower case that every target's language allows.
    version : str
        One of the target's versions.
    """

    shaper: Shaper
    name: str
    version: str


def _nothing(files: Files) -> tuple[str, ...]:
    return ()


@dataclass(frozen=True)
class AnyTarget(ABC):
    """One way out, of either kind.

    Parameters
    ----------
    name : str
        What the command line calls it.
    summary : str
        One line on what comes out, and where it goes.
    versions : tuple of str
        Versions of the target's language, host or firmware that are told apart, the default first.
    limits : Limits
        What it can hold.
    """

    name: str
    summary: str
    versions: tuple[str, ...]
    limits: Limits

    @abstractmethod
    def execute(self, files: Files, version: str | None = None, axis: str | None = None) -> Shaper:
        """The impulses that the controller convolves a command with when it has these files.

        Parameters
        ----------
        files : mapping of str to str or bytes
            Of one export. A target that takes settings also takes one file of any name, or its text.
        version : str, optional
            One of ``versions``; by default what an export says of itself, otherwise the first.
        axis : str, optional
            Which one of a target with settings for each; by default the only one that is set, or all where they are set
            alike.

        Raises
        ------
        InputError
            If the files hold no such thing, or the controller would refuse it.
        """

    def limits_of(self, version: str) -> Limits:
        """What a version can hold."""
        return self.limits

    def version_of(self, given: str | None) -> str:
        """The version that is meant: the first unless one is given; InputError when there is no such version."""
        if given is None:
            return self.versions[0]
        if given not in self.versions:
            raise InputError(
                f"version {given!r} is not known for target {self.name}: it is {' or '.join(self.versions)}."
            )
        return given


@dataclass(frozen=True)
class Target(AnyTarget):
    """One way out, on samples.

    Parameters
    ----------
    name, summary, versions, limits
        As of :class:`AnyTarget`.
    render : callable
        The files for a :class:`Placed` shaper.
    parse : callable
        The :class:`Taps` in such files, bit for bit. InputError when they are not there.
    run : callable
        What the controller convolves with when it has these taps: one of :mod:`preshape.export.arithmetic`.
    next_step : callable
        What the user does with the files, as lines of text; the command line shows them.
    notes : callable, optional
        Sentences for the user on what came out in these files, beside what they hold for everybody.
    """

    render: Callable[[Placed], Files]
    parse: Callable[[Files], Taps]
    run: Callable[[Taps], Shaper]
    next_step: Callable[[Placed], tuple[str, ...]] = field(default=lambda placed: ())
    notes: Callable[[Files], tuple[str, ...]] = _nothing

    def execute(self, files: Files, version: str | None = None, axis: str | None = None) -> Shaper:
        """As :class:`AnyTarget` says; the versions of such a target all do the same."""
        self.version_of(version)
        if axis is not None:
            raise InputError(f"target {self.name} shapes one axis: leave the axis out.")
        taps = self.parse(files)
        self.check(taps)
        return self.run(taps)

    def check(self, taps: Taps) -> None:
        """InputError when the target cannot hold them."""
        limits, count = self.limits, taps.delays.size
        at = f"at dt = {taps.dt:g} s and target {self.name} holds"
        if limits.taps is not None and count > limits.taps:
            raise InputError(
                f"the shaper has {count} taps {at} {limits.taps}: design one with fewer impulses, or sample less often."
            )
        if limits.samples is not None and taps.latency_samples > limits.samples:
            raise InputError(
                f"the shaper is {taps.latency_samples} samples long {at} {limits.samples}: sample less often."
            )
        if not limits.negative and float(taps.weights.min()) < 0.0:
            raise InputError(
                f"the shaper has negative taps, which target {self.name} cannot hold: design a positive one."
            )
        if not (size := float(np.abs(taps.weights).sum())) <= LARGEST_SUM:
            raise InputError(
                f"the sizes of the shaper's weights sum to {size:g}, and {LARGEST_SUM:g} is the most: design a shaper "
                "with smaller negative impulses."
            )


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
