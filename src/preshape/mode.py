"""Mode and Modes: what vibrates, as natural frequency and damping ratio.

The undamped natural frequency in hertz is the only frequency that travels through this library. Where a source means
the damped frequency, convert at the border with :meth:`Mode.from_damped_frequency`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from numbers import Real
from typing import TypeAlias, cast, overload

from preshape.errors import InputError

__all__ = ["Mode", "Modes", "ModesLike", "one_mode"]

EQUAL_MODES = 1e-9
"""Two modes whose frequencies and damping ratios agree to this relative tolerance are the same mode given twice."""


@dataclass(frozen=True, slots=True)
class Mode:
    """One vibration mode.

    Parameters
    ----------
    frequency : float
        Undamped natural frequency [Hz], finite and above zero.
    damping : float
        Damping ratio [-], 0 <= damping < 1.

    Raises
    ------
    InputError
        If a value is outside its range or not a number.

    Examples
    --------
    >>> mode = Mode(50.0, 0.1)
    >>> round(mode.damped_period, 7)
    0.0201008
    """

    frequency: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        for name in ("frequency", "damping"):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, Real):
                raise InputError(f"{name} must be a number, not {value!r}.")
            object.__setattr__(self, name, float(value))
        if not (math.isfinite(self.frequency) and self.frequency > 0.0):
            raise InputError(
                f"frequency {self.frequency:g} Hz is not a natural frequency: give a finite value above 0 Hz."
            )
        if not 0.0 <= self.damping < 1.0:
            raise InputError(
                f"damping ratio {self.damping:g} is outside [0, 1): at 1 and above nothing vibrates; give 0.05 for 5 %."
            )

    @classmethod
    def from_damped_frequency(cls, damped_frequency: float, damping: float = 0.0) -> Mode:
        """The mode that rings at `damped_frequency` [Hz] (what a ring-down shows) with ratio `damping` [-]."""
        trial = cls(damped_frequency, damping)
        return cls(trial.frequency / math.sqrt(1.0 - trial.damping**2), trial.damping)

    @property
    def omega(self) -> float:
        """Undamped natural frequency [rad/s]."""
        return 2.0 * math.pi * self.frequency

    @property
    def omega_d(self) -> float:
        """Damped natural frequency [rad/s]."""
        return self.omega * math.sqrt(1.0 - self.damping**2)

    @property
    def damped_period(self) -> float:
        """Period of the damped oscillation [s]."""
        return 2.0 * math.pi / self.omega_d

    @property
    def decay_per_half_period(self) -> float:
        """K, what one half period of free decay leaves of the amplitude [-] (Singer & Seering, figure 6)."""
        return math.exp(-math.pi * self.damping / math.sqrt(1.0 - self.damping**2))

    @property
    def pole(self) -> complex:
        """The upper pole, -z w + i w sqrt(1 - z^2) [rad/s]."""
        return complex(-self.damping * self.omega, self.omega_d)

    def __str__(self) -> str:
        return f"{self.frequency:.4g} Hz, damping {self.damping:.3g}"


ModesLike: TypeAlias = "Mode | Modes | tuple[float, float] | Iterable[Mode | tuple[float, float]]"
"""What every design accepts: a Mode, a (frequency, damping) pair, or several of them."""


class Modes(Sequence[Mode]):
    """An ordered, immutable collection of modes, no two the same.

    Parameters
    ----------
    modes : Mode, (frequency, damping) pair, or iterable of these
        Frequencies [Hz], damping ratios [-]. The order is kept.

    Raises
    ------
    InputError
        If there is none, one is not a mode, or one is given twice.

    Examples
    --------
    >>> Modes([(0.20, 0.0), (0.26, 0.01)])
    Modes([(0.2, 0.0), (0.26, 0.01)])
    """

    __slots__ = ("_modes",)

    def __init__(self, modes: ModesLike) -> None:
        self._modes: tuple[Mode, ...] = tuple(_each_mode(modes))
        if not self._modes:
            raise InputError("no mode was given: a shaper needs at least one (frequency [Hz], damping) pair.")
        ordered = sorted(self._modes, key=lambda mode: mode.frequency)
        for first, second in zip(ordered, ordered[1:], strict=False):
            if (
                second.frequency - first.frequency <= EQUAL_MODES * second.frequency
                and abs(second.damping - first.damping) <= EQUAL_MODES
            ):
                raise InputError(
                    f"the mode {first} is given twice: give it once, or raise the order of robustness at it."
                )

    @overload
    def __getitem__(self, index: int) -> Mode: ...
    @overload
    def __getitem__(self, index: slice) -> Modes: ...
    def __getitem__(self, index: int | slice) -> Mode | Modes:
        return Modes(self._modes[index]) if isinstance(index, slice) else self._modes[index]

    def __len__(self) -> int:
        return len(self._modes)

    def __iter__(self) -> Iterator[Mode]:
        return iter(self._modes)

    def __eq__(self, other: object) -> bool:
        return self._modes == other._modes if isinstance(other, Modes) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._modes)

    def __repr__(self) -> str:
        return f"Modes([{', '.join(f'({mode.frequency!r}, {mode.damping!r})' for mode in self._modes)}])"


def one_mode(mode: ModesLike) -> Mode:
    """The single mode in `mode`; InputError when there are several."""
    modes = Modes(mode)
    if len(modes) != 1:
        raise InputError(f"{len(modes)} modes were given where one is expected: call once for each mode.")
    return modes[0]


def _each_mode(modes: ModesLike) -> Iterator[Mode]:
    """Yield the modes of anything that :data:`ModesLike` allows."""
    if isinstance(modes, Mode):
        yield modes
    elif isinstance(modes, tuple) and len(modes) == 2 and all(isinstance(value, Real) for value in modes):
        yield Mode(*cast("tuple[float, float]", modes))
    elif isinstance(modes, str | bytes) or not isinstance(modes, Iterable):
        raise InputError(
            f"{modes!r} is not a mode: give Mode(frequency, damping) or a pair (frequency [Hz], damping), "
            "or a list of them."
        )
    else:
        for item in modes:
            if isinstance(item, Mode):
                yield item
            elif isinstance(item, Sequence) and not isinstance(item, str) and len(item) == 2:
                yield Mode(*item)
            else:
                raise InputError(
                    f"{item!r} is not a mode: give Mode(frequency, damping) or a pair (frequency [Hz], damping)."
                )
