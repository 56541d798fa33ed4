"""The ratio of two quantities that are each known within an interval."""

from __future__ import annotations

import math

__all__ = ["ratio_interval"]

Estimate = tuple[float, float, float]
"""A value and the ends of its 95 % interval."""


def ratio_interval(upper: Estimate, lower: Estimate) -> Estimate:
    """The ratio of two independent quantities, none negative, and the ends of its 95 % interval.

    By the method of variance estimates recovery for ratios, which needs no symmetry of the intervals. Where the divisor
    may be 0, the upper end is infinite.

    References
    ----------
    A. Donner & G. Y. Zou, Stat. Methods Med. Res. 21 (2012) 347-359; R. G. Newcombe, Stat. Methods Med. Res. 25 (2016)
    1774-1778.

    Examples
    --------
    >>> [round(value, 3) for value in ratio_interval((1.0, 0.9, 1.1), (2.0, 2.0, 2.0))]
    [0.5, 0.45, 0.55]
    """
    a, a_low, a_high = upper
    b, b_low, b_high = lower
    if b <= 0.0:
        return math.nan, 0.0, math.inf
    ratio, product = a / b, a * b
    # Either end solves a quadratic: (a - r b)^2 is the squared half-width of a - r b at the interval's ends.
    high = math.inf
    width = b_low * (2.0 * b - b_low)
    if width > 0.0:
        high = (product + math.sqrt(max(product**2 - a_high * (2.0 * a - a_high) * width, 0.0))) / width
    spread = b_high - b
    quadratic = b**2 - spread**2
    constant = a_low * (2.0 * a - a_low)
    root = math.sqrt(max(product**2 - constant * quadratic, 0.0))
    # The smaller root, written so that nothing cancels; with a wide divisor the quadratic term may be negative.
    low = constant / (product + root) if product + root > 0.0 else 0.0
    return ratio, min(max(low, 0.0), ratio), max(high, ratio)
