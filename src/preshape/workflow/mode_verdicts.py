"""Each mode without and with the shaper: amplitudes, their ratio, the prediction, and what to say of it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from preshape.identify import IdentifiedMode
from preshape.mode import Mode
from preshape.report import AS_PREDICTED, DOUBTFUL, LESS, MORE, NOISE, Estimate, ModeVerdict
from preshape.shaper import Shaper
from preshape.vibration import residual_vibration
from preshape.workflow.move_stops import Stops
from preshape.workflow.ratio_interval import ratio_interval
from preshape.workflow.ring_amplitudes import NORMAL_95, RingFit, Tail, amplitude_interval, fit_ringing

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
    slopes = _pole_spreads(modes, tails)
    verdicts, trouble = [], []
    for index, one in enumerate(modes):
        before, after = (amplitude_interval(side, index) for side in fits)
        ratio, low, high = ratio_interval(after, before)
        decay = one.mode.damping * one.mode.omega
        by_stop = ratio * decay * stops.between
        more = NORMAL_95 * math.hypot(slopes[index], by_stop if math.isfinite(by_stop) else 0.0)
        if math.isfinite(ratio):
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


def _pole_spreads(modes: Sequence[IdentifiedMode], tails: Sequence[Sequence[Tail]]) -> np.ndarray:
    """Standard deviation of each mode's ratio for the uncertainty of all poles, by differences, shape (mode,)."""
    plain = [one.mode for one in modes]
    middle = _ratios(tails, plain)
    total = np.zeros(len(modes))
    for index, one in enumerate(modes):
        for moved in _moved(one):
            shifted = _ratios(tails, [*plain[:index], moved, *plain[index + 1 :]])
            total += (shifted - middle) ** 2
    return np.sqrt(total)


def _moved(one: IdentifiedMode) -> list[Mode]:
    """The mode with its frequency, and with its damping, one standard deviation higher."""
    frequency = 0.5 * (one.frequency_interval[1] - one.frequency_interval[0]) / NORMAL_95
    damping = 0.5 * (one.damping_interval[1] - one.damping_interval[0]) / NORMAL_95
    return [
        Mode(one.mode.frequency + frequency, one.mode.damping),
        Mode(one.mode.frequency, min(one.mode.damping + damping, 0.99)),
    ]


def _ratios(tails: Sequence[Sequence[Tail]], modes: Sequence[Mode]) -> np.ndarray:
    """Ratio of the amplitudes as they come out, with the noise in them."""
    sides = []
    for side in tails:
        fits = [fit_ringing(tail, modes).parts for tail in side]
        sides.append(np.sqrt(np.mean([np.sum(parts**2, axis=(1, 2)) for parts in fits], axis=0)))
    return np.asarray(sides[1] / np.maximum(sides[0], np.finfo(float).tiny))
