"""Each mode without and with the shaper: amplitudes, their ratio, the prediction, and what to say of it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from preshape.identify import IdentifiedMode
from preshape.report import AS_PREDICTED, DOUBTFUL, LESS, MORE, NOISE, Estimate, ModeVerdict
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration
from preshape.workflow.move_stops import Stops
from preshape.workflow.ratio_interval import ratio_interval
from preshape.workflow.ratio_spreads import pole_spreads, start_spread
from preshape.workflow.ring_amplitudes import NORMAL_95, RingFit, Tail, amplitude_interval

__all__ = ["judged", "unmatched"]

SAME_MODE = 0.05
"""Relative difference of frequencies within which two modes are one."""

POINTS = 9
"""Of frequency and of damping, within their intervals, at which a prediction is made."""

Sides = Sequence[Sequence[RingFit]]


def unmatched(found: Sequence[IdentifiedMode], known: Sequence[IdentifiedMode]) -> list[IdentifiedMode]:
    """Modes of the shaped recordings that are none of the unshaped ones."""

    def matches(one: IdentifiedMode, other: IdentifiedMode) -> bool:
        near = abs(one.mode.frequency - other.mode.frequency) <= SAME_MODE * other.mode.frequency
        low, high = one.frequency_interval
        return near or (low <= other.frequency_interval[1] and high >= other.frequency_interval[0])

    return [one for one in found if not any(matches(one, other) for other in known)]


def judged(
    modes: Sequence[IdentifiedMode],
    known: int,
    tails: Sequence[Sequence[Tail]],
    fits: Sides,
    stops: Stops,
    shaper: Shaper | None,
) -> tuple[tuple[ModeVerdict, ...], list[str]]:
    """Verdicts, and sentences on what cannot be told.

    Parameters
    ----------
    modes : sequence of IdentifiedMode
        The `known` first ones of the unshaped recordings, then candidates for new ones, which are left out when the
        shaped recordings do not hold more of them than the unshaped ones.
    known : int
        How many are not new.
    tails, fits : sequence of two sequences
        Of the recordings before and after.
    stops : Stops
        How surely they are known.
    shaper : Shaper or None
        For the prediction.
    """
    poles = pole_spreads(modes, tails)
    verdicts, trouble = [], []
    for index, one in enumerate(modes):
        before, after = (amplitude_interval(side, index) for side in fits)
        ratio, low, high = ratio_interval(after, before)
        decay = one.mode.damping * one.mode.omega
        if stops.doubtful:
            low, high = 0.0, math.inf
        elif math.isfinite(ratio):
            start = start_spread([mode.mode for mode in modes], index, tails, (ratio, low, high))
            more = NORMAL_95 * math.hypot(poles[index], start, ratio * decay * stops.between)
            low = max(ratio - math.hypot(ratio - low, more), 0.0)
            high = ratio + math.hypot(high - ratio, more)
        measured = Estimate(ratio, low, high)
        predicted = None if shaper is None else _predicted(shaper, one)
        new = index >= known
        if new and not (low > 1.0 or (before[1] <= 0.0 < after[1] and after[1] > before[2])):
            continue
        verdict = DOUBTFUL if stops.doubtful else _verdict(measured, predicted, before[1] <= 0.0, after[1] <= 0.0)
        if before[1] <= 0.0 and not new:
            trouble.append(
                f"the noise is too high to tell what became of the mode at {one.mode.frequency:.3g} Hz: "
                "record louder moves, or several repeats."
            )
        shown = [
            _widened(amplitude, decay * max(motion.spread for motion in side))
            for amplitude, side in ((before, stops.before), (after, stops.after))
        ]
        verdicts.append(ModeVerdict(one, shown[0], shown[1], measured, predicted, verdict, new))
    return tuple(verdicts), trouble


def _widened(amplitude: tuple[float, float, float], relative: float) -> Estimate:
    """An amplitude at the stop, whose interval counts that the stop is not known; `relative` is that deviation."""
    value, low, high = amplitude
    more = NORMAL_95 * relative * value
    return Estimate(value, max(value - math.hypot(value - low, more), 0.0), value + math.hypot(high - value, more))


def _verdict(
    ratio: Estimate, predicted: tuple[float, float, float] | None, silent_before: bool, silent_after: bool
) -> str:
    if silent_before and not ratio.low > 1.0:
        return NOISE
    low, _, high = predicted if predicted is not None else (1.0, 1.0, 1.0)
    if ratio.low > high:
        return LESS if predicted is not None else "increased"
    if ratio.high < low:
        return MORE if predicted is not None else "reduced"
    if silent_after:
        return NOISE
    return AS_PREDICTED if predicted is not None else "no sure change"


def _predicted(shaper: Shaper, one: IdentifiedMode) -> tuple[float, float, float]:
    """Least, middle and greatest residual vibration within the intervals of frequency and damping."""
    low, high = one.frequency_interval
    frequencies = np.linspace(max(low, 0.0), high, POINTS)
    low, high = one.damping_interval
    dampings = np.linspace(max(low, 0.0), min(high, 0.99), POINTS)
    around = residual_vibration(shaper, frequencies[:, None], dampings[None, :])
    middle = float(residual_vibration(shaper, one.mode.frequency, one.mode.damping))
    return min(float(around.min()), middle), middle, max(float(around.max()), middle)
