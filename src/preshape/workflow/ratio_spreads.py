"""What the ratio of a mode's amplitudes depends on beside noise: the poles, and what nobody has fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from preshape.identify import IdentifiedMode
from preshape.mode import Mode
from preshape.workflow.ratio_interval import Estimate, ratio_interval
from preshape.workflow.ring_amplitudes import NORMAL_95, Tail, amplitude_interval, fit_ringing

__all__ = ["pole_spreads", "start_spread"]

LATER = 0.5
"""Time constants of a mode after which its ratio is looked at once more."""

FEWEST = 48
"""Samples that are left then."""

Tails = Sequence[Sequence[Tail]]


def start_spread(modes: Sequence[Mode], index: int, tails: Tails, whole: Estimate) -> float:
    """Standard deviation of a mode's ratio for what rings beside the modes that were found.

    A mode that was missed is there at first and dies away, and what remains of the command's end does so even sooner.
    Both move the ratio that is read from the later part. What it moves by more than the noise does is counted.

    Parameters
    ----------
    modes : sequence of Mode
        All that were fitted; `index` is the one.
    tails : sequence of two sequences of Tail
        Of the recordings before and after.
    whole : Estimate
        The ratio from the whole tails, and the ends of its 95 % interval for their noise.
    """
    mode = modes[index]
    decay = mode.damping * mode.omega
    sides = []
    for side in tails:
        fits = []
        for tail in side:
            samples = tail.values.shape[-1]
            cut = max(min(round(LATER * tail.rate / decay) if decay > 0.0 else samples, samples - FEWEST), 0)
            later = replace(tail, values=tail.values[:, cut:], offset=tail.offset + cut / tail.rate)
            fits.append(fit_ringing(later, modes))
        sides.append(amplitude_interval(fits, index))
    late = ratio_interval(sides[1], sides[0])
    widths = [(one[2] - one[1]) / (2.0 * NORMAL_95) for one in (late, whole)]
    if not np.isfinite(late).all() or not np.isfinite(widths).all():
        return 0.0
    by_noise = max(widths[0] ** 2 - widths[1] ** 2, 0.0)
    return float(np.sqrt(max((late[0] - whole[0]) ** 2 - by_noise, 0.0)))


def pole_spreads(modes: Sequence[IdentifiedMode], tails: Tails) -> np.ndarray:
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


def _ratios(tails: Tails, modes: Sequence[Mode]) -> np.ndarray:
    """Ratio of the amplitudes as they come out, with the noise in them."""
    sides = []
    for side in tails:
        fits = [fit_ringing(tail, modes).parts for tail in side]
        sides.append(np.sqrt(np.mean([np.sum(parts**2, axis=(1, 2)) for parts in fits], axis=0)))
    return np.asarray(sides[1] / np.maximum(sides[0], np.finfo(float).tiny))
