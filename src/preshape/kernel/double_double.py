"""Numbers of twice the precision of a double, as unevaluated sums of two doubles, for arrays.

Thirty-two digits by a few dozen double operations each (Dekker 1971; Knuth, TAOCP 4.2.2): for the rare step that loses
sixteen of them, not for inner loops.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

__all__ = ["DoubleDouble"]

SPLITTER = 134217729.0
"""2^27 + 1: splits a double into halves whose products are exact."""


@dataclass(frozen=True)
class DoubleDouble:
    """An array of high + low, |low| at most half a unit in the last place of high."""

    high: NDArray[np.float64]
    low: NDArray[np.float64]

    @classmethod
    def of(cls, values: NDArray[np.float64] | float) -> DoubleDouble:
        """Doubles, exactly."""
        array = np.asarray(values, dtype=float)
        return cls(array, np.zeros_like(array))

    def __getitem__(self, index: Any) -> DoubleDouble:
        return DoubleDouble(self.high[index], self.low[index])

    def __neg__(self) -> DoubleDouble:
        return DoubleDouble(-self.high, -self.low)

    def __add__(self, other: DoubleDouble) -> DoubleDouble:
        total, error = _sum(self.high, other.high)
        small, lost = _sum(self.low, other.low)
        total, error = _quick_sum(total, error + small)
        return DoubleDouble(*_quick_sum(total, error + lost))

    def __sub__(self, other: DoubleDouble) -> DoubleDouble:
        return self + (-other)

    def __mul__(self, other: DoubleDouble) -> DoubleDouble:
        product, error = _product(self.high, other.high)
        return DoubleDouble(*_quick_sum(product, error + (self.high * other.low + self.low * other.high)))

    def __truediv__(self, other: DoubleDouble) -> DoubleDouble:
        quotient = DoubleDouble.of(self.high / other.high)
        for _ in range(2):
            rest = self - quotient * other
            quotient = quotient + DoubleDouble.of(rest.high / other.high)
        return quotient

    def sqrt(self) -> DoubleDouble:
        """The square root, by two Newton steps from that of the high part."""
        root = DoubleDouble.of(np.sqrt(self.high))
        for _ in range(2):
            rest = self - root * root
            root = root + DoubleDouble.of(rest.high / (2.0 * root.high))
        return root

    def sum(self) -> DoubleDouble:
        """The sum over the last axis, by halves."""
        whole = self
        while whole.high.shape[-1] > 1:
            size = whole.high.shape[-1]
            half = size // 2
            folded = whole[..., :half] + whole[..., half : 2 * half]
            if size % 2:
                folded = DoubleDouble(
                    np.concatenate([folded.high, whole.high[..., -1:]], axis=-1),
                    np.concatenate([folded.low, whole.low[..., -1:]], axis=-1),
                )
            whole = folded
        return whole[..., 0]


def _sum(a: NDArray[np.float64], b: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """a + b and what rounding took from it."""
    total = a + b
    part = total - a
    return total, (a - (total - part)) + (b - part)


def _quick_sum(a: NDArray[np.float64], b: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The same for |a| >= |b|."""
    total = a + b
    return total, b - (total - a)


def _product(a: NDArray[np.float64], b: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """a b and what rounding took from it."""
    product = a * b
    a_high, a_low = _split(a)
    b_high, b_low = _split(b)
    return product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low


def _split(a: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    scaled = SPLITTER * a
    high = scaled - (scaled - a)
    return high, a - high
