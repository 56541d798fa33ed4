"""Two rings in Python: of past commands, for a fixed shaper, and of what is to arrive, for one that changes."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.kernel.sparse_convolution import convolve_padded

__all__ = ["LONGEST_DELAY", "STATE", "Gather", "Scatter", "Taps"]

Taps = tuple[NDArray[np.uint32], NDArray[np.float64]]
"""Delays [samples], increasing, and weights [-], of sum 1."""

LONGEST_DELAY = 2**26
"""A shaper of more samples than this is refused: its ring would take a gigabyte."""

STATE = "the state does not fit this stream: give bytes that Stream.state returned."

Pair = tuple[float, float]
"""An unevaluated sum of twice the precision."""


class Gather:
    """A fixed shaper: the past commands in a ring."""

    def __init__(self, taps: Taps, value: float = 0.0) -> None:
        self.original, self._taps = taps, _plain(taps)
        self._longest = self._taps[-1][0]
        self._ring, self._at = [value] * (self._longest + 1), 0

    def step(self, u: float) -> float:
        """The next sample, shaped."""
        ring, at = self._ring, self._at
        ring[at] = u
        reference, total = ring[at - self._longest], 0.0
        for delay, weight in self._taps[:-1]:
            total += weight * (ring[at - delay] - reference)
        self._at = (at + 1) % len(ring)
        return reference + total

    def block(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """The next samples, at least one, shaped."""
        padded = np.concatenate([self.save()[1:], u])
        self.load(padded[-len(self._ring) :].tolist())
        return convolve_padded(padded, *self.original)

    def save(self) -> list[float]:
        """What it remembers."""
        return self._ring[self._at :] + self._ring[: self._at]

    def load(self, numbers: list[float]) -> None:
        """Put back what save gave."""
        if len(numbers) != len(self._ring):
            raise InputError(STATE)
        self._ring, self._at = numbers, 0


class Scatter:
    """A changing shaper: what is to arrive, sample by sample from the next one on."""

    def __init__(self, taps: Taps, command: float) -> None:
        self._taps, self._command = _plain(taps), command
        self._pending, self._remaining = (0.0, 0.0), 0
        self._ahead: list[Pair] = []

    @classmethod
    def taking_over(cls, gather: Gather) -> Scatter:
        """Where a gather stands: its past is scattered again."""
        oldest, *others = gather.save()
        scatter = cls(gather.original, oldest)
        for u in others:
            scatter.step(u)
        return scatter

    def retune(self, taps: Taps) -> None:
        """Scatter what is commanded from now on with these taps."""
        self._taps = _plain(taps)

    def step(self, u: float) -> float:
        """The next sample, shaped."""
        increment = _two_sum(u, -self._command)
        self._command = u
        longest = self._taps[-1][0]
        if increment[0] != 0.0:
            self._ahead += [(0.0, 0.0)] * (longest + 1 - len(self._ahead))
            rest = increment
            for delay, weight in self._taps[:-1]:
                piece = weight * increment[0]
                self._ahead[delay] = _pair_sum(self._ahead[delay], (piece, 0.0))
                rest = _pair_sum(rest, (-piece, -0.0))
            self._ahead[longest] = _pair_sum(self._ahead[longest], rest)
            self._pending = _pair_sum(self._pending, increment)
            self._remaining = max(self._remaining, longest)
        high, low = self._ahead.pop(0) if self._ahead else (0.0, 0.0)
        self._pending = _pair_sum(self._pending, (-high, -low))
        if self._remaining == 0:
            self._pending = (0.0, 0.0)  # everything has arrived: the rounding of the way ends here
        else:
            self._remaining -= 1
        high, low = _two_sum(u, -self._pending[0])
        return high + (low - self._pending[1])

    def block(self, u: NDArray[np.float64]) -> NDArray[np.float64]:
        """The next samples, at least one, shaped."""
        return np.array([self.step(value) for value in u.tolist()])

    def save(self) -> list[float]:
        """What it remembers."""
        ahead = self._ahead + [(0.0, 0.0)] * (self._remaining + 1 - len(self._ahead))
        arriving = [part for pair in ahead[: self._remaining + 1] for part in pair]
        return [self._command, *self._pending, float(self._remaining), *arriving]

    def load(self, numbers: list[float]) -> None:
        """Put back what save gave."""
        if len(numbers) < 6 or not 0.0 <= numbers[3] < LONGEST_DELAY or len(numbers) != 6 + 2 * int(numbers[3]):
            raise InputError(STATE)
        self._command, self._pending, self._remaining = numbers[0], (numbers[1], numbers[2]), int(numbers[3])
        self._ahead = list(zip(numbers[4::2], numbers[5::2], strict=True))


def _plain(taps: Taps) -> Sequence[tuple[int, float]]:
    return list(zip(taps[0].tolist(), taps[1].tolist(), strict=True))


def _two_sum(a: float, b: float) -> Pair:
    """a + b exactly, as a pair (Knuth)."""
    high = a + b
    shadow = high - a
    return high, (a - (high - shadow)) + (b - shadow)


def _pair_sum(a: Pair, b: Pair) -> Pair:
    """a + b to twice the precision of the larger."""
    high, low = _two_sum(a[0], b[0])
    low = low + (a[1] + b[1])
    total = high + low
    return total, low - (total - high)
