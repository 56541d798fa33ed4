"""Filtered commands for a comparison: the base move behind notches or a low-pass filter, in continuous time."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Mode, Modes
from preshape.plant import Output, exact_motion
from preshape.profile import Profile
from preshape.workflow.contenders.limited import Filtered, Limited, Move, stretched
from preshape.workflow.contenders.piecewise import interpolated

__all__ = ["filtered_moves"]

POLE_DAMPING = 0.7
"""Of a notch, as of :func:`preshape.command.notch_filtered`."""

LOW_PASS = 1.0 / 3.0
"""Cutoff of the low-pass filter over the lowest frequency: second order leaves a ninth of it there."""

VANISHED = 1e-12
"""A filter's own motion below this part of what began it is over: the profile ends there, the command long before."""

DYING = (0.0, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32, 0.64, 1.0)
"""Parts of the time in which it vanishes, where pieces of another length begin: no sudden change of length."""


@dataclass(frozen=True)
class _Filter:
    """H(s) = direct + (rate s + level) / (s^2 + 2 z w s + w^2), z and w of the pole."""

    pole: Mode
    direct: float
    rate: float
    level: float

    def transfer(self, s: NDArray[np.complex128]) -> NDArray[np.complex128]:
        """H at complex frequencies [1/s]."""
        if self.rate == self.level == 0.0:
            return np.full(s.shape, complex(self.direct))
        w = self.pole.omega
        return np.asarray(self.direct + (self.rate * s + self.level) / (s**2 + 2.0 * self.pole.damping * w * s + w**2))


def filtered_moves(
    modes: Modes, limited: Limited, base: str, negligible: float
) -> list[tuple[str, Callable[[], Move]]]:
    """Names and makers: one notch for each mode in series, and a second-order Butterworth low-pass filter.

    Parameters
    ----------
    modes : Modes
        What vibrates.
    limited : Limited
        The distance and the limits.
    base : str
        Name of the move that is filtered.
    negligible : float
        The command has ended when less than this is left of the way [unit].
    """
    lowest = min(mode.frequency for mode in modes)
    pole = Mode(LOW_PASS * lowest, math.sqrt(0.5))
    low_pass = _Filter(pole, 0.0, 0.0, pole.omega**2)
    return [
        (f"{base}, notch", lambda: _filtered(limited, [_notch(mode) for mode in modes], negligible)),
        (f"{base}, low-pass", lambda: _filtered(limited, [low_pass], negligible)),
    ]


def _notch(mode: Mode) -> _Filter:
    """(s^2 + 2 z w s + w^2) / (s^2 + 2 z_p w s + w^2) = 1 + 2 (z - z_p) w s / (s^2 + 2 z_p w s + w^2)."""
    pole = Mode(mode.frequency, POLE_DAMPING)
    return _Filter(pole, 1.0, 2.0 * (mode.damping - POLE_DAMPING) * mode.omega, 0.0)


def _filtered(limited: Limited, filters: Sequence[_Filter], negligible: float) -> Move:
    output = _output(filters)
    slowest = min(one.pole.damping * one.pole.omega for one in filters)
    tail = -math.log(VANISHED) / slowest

    def build(slower: float) -> Profile:
        base = limited.base(slower)
        breaks = _breaks(sorted({float(time) for time in base.times}), tail)
        motion = exact_motion([one.pole for one in filters], base)
        return interpolated(partial(motion, output), breaks)

    acceleration, slower = stretched(build, limited)
    base = limited.base(slower)
    return Move(
        acceleration,
        base.end_time - math.log(min(1.0, negligible / abs(limited.distance))) / slowest,
        exact=False,
        note="" if slower == 1.0 else f"base slowed {100.0 * (slower - 1.0):.2g} % to keep the limits",
        filtered=Filtered(base, partial(_transfer, filters)),
    )


def _transfer(filters: Sequence[_Filter], s: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Of the filters in series, at complex frequencies [1/s]."""
    product = np.ones(s.shape, dtype=complex)
    for one in filters:
        product = product * one.transfer(s)
    return product


def _output(filters: Sequence[_Filter]) -> Output:
    """What comes out of the filters in series, as a sum of the motions of their poles: partial fractions.

    R / (s - p) with its conjugate is (2 Re R s - 2 Re(R conj p)) / (s^2 + 2 z w s + w^2).
    """
    levels, rates = [], []
    for number, one in enumerate(filters):
        p = one.pole.pole
        others = [other for k, other in enumerate(filters) if k != number]
        residue = (one.rate * p + one.level) / (2j * p.imag) * complex(_transfer(others, np.array([p]))[0])
        levels.append(-2.0 * (residue * p.conjugate()).real)
        rates.append(2.0 * residue.real)
    return Output(tuple(levels), tuple(rates), command=math.prod(one.direct for one in filters))


def _breaks(steps: Sequence[float], tail: float) -> list[float]:
    """Where the base steps, and how the filter's own motion dies out after each step, so that pieces may grow with it.

    The last of them is where the profile ends.
    """
    found = []
    for step, following in zip(steps, [*steps[1:], math.inf], strict=True):
        found += [time for time in (step + part * tail for part in DYING) if time < following]
    return found
