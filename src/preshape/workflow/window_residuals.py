"""Root mean squares in a window after the stop, and how surely they are known, the stop's uncertainty included."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Mode
from preshape.report import Estimate
from preshape.workflow.ratio_interval import ratio_interval
from preshape.workflow.ring_amplitudes import NORMAL_95, RingFit, Tail, band_power, fit_ringing

__all__ = ["Residuals", "window_residuals"]

FEWEST = 48
"""Samples in which the vibration is looked at."""

Residuals = tuple[tuple[Estimate, ...], tuple[Estimate, ...], tuple[Estimate, ...]]
"""Before, after, and after over before: for each axis, then in total."""

Tails = Sequence[Sequence[Tail]]


def window_residuals(
    tails: Tails, fits: Sequence[Sequence[RingFit]], modes: Sequence[Mode], window: float, below: float, spread: float
) -> Residuals:
    """Root mean square of each axis and in total, over the repeats.

    Vibration dies away, and fast modes sooner than slow ones: a window that begins later holds less, and another ratio.
    What beginning later by a standard deviation of the stop changes is added to the intervals. A ratio is open where
    the stops are not known, or that leaves too little of the recording.

    Parameters
    ----------
    tails, fits : sequence of two sequences
        Of the recordings before and after.
    modes : sequence of Mode
        That were fitted.
    window, below : float
        Its length [s], and the frequency up to which the vibration counts [Hz].
    spread : float
        Standard deviation of the stops [s]; 0 when they were given, infinite where they are not known.
    """
    before, after, ratio = _both(tails, fits, window, below)
    if spread == 0.0:
        return before, after, ratio
    later = _later(tails, spread)
    if later is None:
        return before, after, tuple(Estimate(one.value, 0.0, math.inf) for one in ratio)
    moved = _both(later, [[fit_ringing(tail, modes) for tail in side] for side in later], window, below)
    before, after, ratio = (
        tuple(_widened(one, other) for one, other in zip(found, shifted, strict=True))
        for found, shifted in zip((before, after, ratio), moved, strict=True)
    )
    return before, after, ratio


def _both(tails: Tails, fits: Sequence[Sequence[RingFit]], window: float, below: float) -> Residuals:
    before, after = (_side(side, fit, window, below) for side, fit in zip(tails, fits, strict=True))
    ratio = (
        ratio_interval((a.value, a.low, a.high), (b.value, b.low, b.high)) for b, a in zip(before, after, strict=True)
    )
    return before, after, tuple(Estimate(*one) for one in ratio)


def _later(tails: Tails, seconds: float) -> list[list[Tail]] | None:
    """The tails without their first part; None where too few samples are left."""
    if not all(tail.values.shape[-1] - seconds * tail.rate > FEWEST for side in tails for tail in side):
        return None
    cuts = [[max(math.ceil(seconds * tail.rate), 1) for tail in side] for side in tails]
    return [
        [
            replace(tail, values=tail.values[:, cut:], offset=tail.offset + cut / tail.rate)
            for tail, cut in zip(side, cut_side, strict=True)
        ]
        for side, cut_side in zip(tails, cuts, strict=True)
    ]


def _widened(one: Estimate, shifted: Estimate) -> Estimate:
    more = NORMAL_95 * abs(shifted.value - one.value)
    if not math.isfinite(more):
        return one
    return Estimate(
        one.value,
        max(one.value - math.hypot(one.value - one.low, more), 0.0),
        one.value + math.hypot(one.high - one.value, more),
    )


def _side(tails: Sequence[Tail], fits: Sequence[RingFit], window: float, below: float) -> tuple[Estimate, ...]:
    found = [
        band_power(fit, tail, max(round(window * tail.rate), 2), below) for tail, fit in zip(tails, fits, strict=True)
    ]
    power = np.mean([one for one, _ in found], axis=0)
    variance = np.mean([one for _, one in found], axis=0) / len(found)
    rows = [*zip(power, variance, strict=True), (float(power.sum()), float(variance.sum()))]
    spread = np.array([[*one, one.sum()] for one, _ in found])
    return tuple(_root(p, v, spread[:, k]) for k, (p, v) in enumerate(rows))


def _root(power: float, variance: float, each: NDArray[np.float64]) -> Estimate:
    half = NORMAL_95 * float(np.sqrt(variance))
    if each.size > 2:
        from scipy.stats import t as student

        deviation = float(np.std(each, ddof=1)) / np.sqrt(each.size)
        half = max(half, float(student.ppf(0.975, each.size - 1)) * deviation)
    low, high = np.sqrt(max(power - half, 0.0)), np.sqrt(power + half)
    return Estimate(float(np.sqrt(power)), float(low), float(high))
