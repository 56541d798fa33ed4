"""How much a shaper excites above the modes it knows: the largest gain of its impulses there.

The spectrum of a shaped command is that of the command times F(f) = sum_i a_i exp(-2 pi i f t_i). Positive impulses
never amplify, |F| <= 1. Negative ones do: |F| reaches up to sum |a_i|, between and above the modes they were designed
for, and a mode that nobody modelled may ring more with the shaper than without.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.checks import positive
from preshape.errors import InputError
from preshape.shaper import Shaper
from preshape.vibration.transform import transform, transform_uniform

__all__ = ["DECADE", "HighFrequencyGain", "high_frequency_gain"]

DECADE = 10.0
"""The range searched ends at this multiple of its start: modes further up hardly see a command of the lower ones."""

SAMPLES_PER_RIPPLE = 32
"""Samples per 1/duration of frequency; |F| has no faster ripple."""

RISE = (math.pi / (2.0 * SAMPLES_PER_RIPPLE)) ** 2 / 2.0
"""How far a peak can rise above the sample nearest to it, as a fraction of the bound (0.12 %): F, with its mean delay
taken out, is of exponential type pi duration, so Bernstein's inequality bounds its second derivative."""

MOST_SAMPLES = 1 << 20
"""The range is cut to this many samples, 32768 ripples, for shapers that are very long against the highest mode."""

BISECTIONS = 32
"""They place a peak to 1e-11/duration, its height to rounding."""

AS_HIGH = 1e-12
"""Of peaks equally high within this fraction, as impulses on a common grid have them, the lowest frequency counts."""


@dataclass(frozen=True)
class HighFrequencyGain:
    """The largest gain abs(F) of a shaper over a range of frequencies.

    Parameters
    ----------
    value : float
        The largest abs(F) found in the range [-]: 1 leaves what is there, 3 is three times the unshaped excitation.
    frequency : float
        Where it is [Hz].
    low, high : float
        The range that was searched [Hz].
    bound : float
        sum abs(a_i), boxes included [-], which abs(F) exceeds at no frequency, in the range or above it. Impulse times
        without a common measure come as near to it as one likes, if one looks high enough.
    """

    value: float
    frequency: float
    low: float
    high: float
    bound: float


def high_frequency_gain(shaper: Shaper, above: float, up_to: float | None = None) -> HighFrequencyGain:
    """The largest gain abs(sum_i a_i exp(-2 pi i f t_i)) of a shaper over the frequencies above its modes.

    It is located on the continuum: sampled, and every sample that could belong to the largest peak refined by
    bisection of the slope.

    Parameters
    ----------
    shaper : Shaper
        Any shaper; one of positive impulses has a gain of at most 1.
    above : float
        Where the range starts [Hz], above zero: the frequency of the highest mode.
    up_to : float, optional
        Where it ends [Hz]; ten times `above` unless given. Shortened for a shaper of more than about 3000 periods of
        `above`; the result says which range was searched.

    Raises
    ------
    InputError
        If the range is empty or starts at or below zero.

    Examples
    --------
    >>> import preshape
    >>> gain = high_frequency_gain(preshape.design.um_zv((10.0, 0.0)), above=10.0)
    >>> round(gain.value, 6), round(gain.frequency, 6), gain.high, gain.bound
    (3.0, 30.0, 100.0, 3.0)
    """
    low = positive("above", above, "Hz")
    high = DECADE * low if up_to is None else positive("up_to", up_to, "Hz")
    if high <= low:
        raise InputError(f"the range {low:g} ... {high:g} Hz is empty: give an end above its start.")
    bound = shaper.magnitude
    if shaper.duration == 0.0:
        return HighFrequencyGain(bound, low, low, high, bound)
    high = min(high, low + (MOST_SAMPLES - 2) / (SAMPLES_PER_RIPPLE * shaper.duration))
    count = math.ceil((high - low) * shaper.duration * SAMPLES_PER_RIPPLE) + 2
    step = (high - low) / (count - 1)
    gains = np.abs(transform_uniform(shaper, -2j * math.pi * low, -2j * math.pi * step, count))
    padded = np.concatenate([[0.0], gains, [0.0]])
    peak = (gains >= padded[:-2]) & (gains >= padded[2:]) & (gains >= gains.max() - RISE * bound)
    near = np.linspace(low, high, count)[peak]
    found = np.concatenate([[low], _summits(shaper, near, step, low, high), [high]])
    values = np.abs(_transform(shaper, found))
    best = int(np.argmax(values >= (1.0 - AS_HIGH) * values.max()))
    return HighFrequencyGain(min(float(values[best]), bound), float(found[best]), low, high, bound)


def _summits(shaper: Shaper, near: NDArray[np.float64], step: float, low: float, high: float) -> NDArray[np.float64]:
    """Where |F| is largest within one step of each of `near`: by bisection of d|F|^2/df, or an end of the range."""
    left, right = np.maximum(near - step, low), np.minimum(near + step, high)
    for _ in range(BISECTIONS):
        middle = 0.5 * (left + right)
        rising = np.real(np.conj(_transform(shaper, middle)) * _transform(shaper, middle, slope=True)) > 0.0
        left, right = np.where(rising, middle, left), np.where(rising, right, middle)
    inside: NDArray[np.float64] = np.where(left == low, low, 0.5 * (left + right))
    return np.where(right == high, high, inside)


def _transform(shaper: Shaper, frequencies: NDArray[np.float64], slope: bool = False) -> NDArray[np.complex128]:
    """F, or dF/df."""
    values = transform(shaper, np.multiply(-2j * np.pi, frequencies), moment=int(slope))
    return -2j * np.pi * values if slope else values
