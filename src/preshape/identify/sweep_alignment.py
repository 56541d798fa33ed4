"""Which sweep a record holds, and when it starts: from the frequency that rises through it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.identify.klipper_sweep import Sweep
from preshape.identify.measurement import TimeSeries

__all__ = ["Alignment", "align"]

WINDOW = 1.0
"""Of the short spectra whose highest frequencies are followed [s]; half of it is the step."""

FOLLOWED = (4.0, 320.0)
"""Frequencies in which a sweep is looked for [Hz]; Klipper's end at 300 Hz at most."""

RATES = np.arange(0.1, 2.1001, 0.01)
"""Of sweeps that are looked for [Hz/s]; Klipper's slowest and fastest are the ends."""

NEAR = 2.0
"""A window's loudest frequency is on the line when it is so near [Hz]."""

QUIET = 1e-3
"""What has less of a window's highest power is not its sweep."""

REFITS = 3
FEWEST_WINDOWS = 8
"""Windows on the line without which there is none."""

FEWEST_LINES = 200
"""Lines of the transform in the sweep, and samples per second, without which nothing can be laid over a record."""

SLOWEST = 50.0
FLOOR = 0.01
"""Lines where the command has less than this part of its median power say nothing about the impulse response."""

LEAST_FOLLOWED = 0.3
"""Part of the windows under the line that must be near it."""

USUAL_START = 5.0
"""Klipper's min_freq [Hz]: windows below some 15 Hz are too quiet to show it."""

USUAL_BELOW = 15.0
ROUND = 0.01
"""Rates that people ask for are multiples of this [Hz/s]; one so found is taken to be meant when this near [-]."""

CLOCKS = 1e-3
"""How far the rate may be from the one assumed [-]: clocks differ, and a rate need not be round."""

DISPERSION_STEP = 0.3
MOST_STRETCHES = 60
"""Step of the delays that are tried, over the resolution of the sweep, 1 / (highest - lowest), and most steps."""

PEAK = (0.05, 1.0)
"""Before and after its maximum, what counts as the peak of the impulse response [s]."""

SLOW_WAVES = (0.0, 1.2)
"""Periods of the slow wave that are tried [s], the acceleration being Klipper's."""

BAND_MARGIN = 3.0
"""Frequencies left out at both ends of a sweep [Hz]."""

_Array = NDArray[np.float64]
_Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class Alignment:
    """A sweep, laid over a record.

    Attributes
    ----------
    sweep : Sweep
        Its acceleration is in scale with Klipper's usual one only.
    frequencies : ndarray, shape (line,)
        Of the transforms over the whole record [Hz], those inside the sweep.
    command : ndarray, shape (line,)
        Transform of the commanded acceleration.
    response : ndarray, shape (channel, line)
        Transforms of the measured ones.
    samples : int
        Samples of the record, with the zeros that make its length a good one for transforms.
    stretch : float
        Delay that grows with the frequency [s/Hz], clocks being different, already taken out of `response`.
    sharpness : float
        Part of the energy of the impulse response near its peak, 0 to 1.
    """

    sweep: Sweep
    frequencies: _Array
    command: _Complex
    response: _Complex
    samples: int
    stretch: float
    sharpness: float


def align(series: TimeSeries, sweep: Sweep | None) -> Alignment | None:
    """Find the sweep in a record, or where in it a known one starts; None when nothing rises through it.

    Parameters
    ----------
    series : TimeSeries
        The record, at most some minutes.
    sweep : Sweep, optional
        What was commanded, if known.
    """
    from scipy.fft import next_fast_len, rfft

    line = _line(series)
    if line is None:
        return None
    rate, at_zero, first, last = line
    if sweep is None:
        usual = first < USUAL_BELOW and at_zero < USUAL_START
        lowest = USUAL_START if usual else first
        candidates = [Sweep(lowest, last, rate, slow_period=period) for period in SLOW_WAVES]
    else:
        candidates = [sweep]
    sweep = candidates[0]
    start = (sweep.lowest - at_zero) / rate
    values = series.values - series.values.mean(axis=-1, keepdims=True)
    samples = values.shape[-1]
    length = next_fast_len(samples, real=True)
    frequencies = np.arange(length // 2 + 1, dtype=np.float64) * (series.sample_rate / length)
    inside = (frequencies > sweep.lowest + BAND_MARGIN) & (frequencies < sweep.highest - BAND_MARGIN)
    frequencies = frequencies[inside]
    if frequencies.size < FEWEST_LINES:
        return None
    response = rfft(values, length, axis=-1)[:, inside]
    best: Alignment | None = None
    for candidate in candidates:
        command = rfft(candidate.sampled(series.sample_rate, start, samples), length)[inside]
        if not command.any():  # it would start after the end of the record
            return None
        found = _laid(candidate, frequencies, command, response, length, best)
        if best is None or found.sharpness > best.sharpness:
            best = found
    return best


def _line(series: TimeSeries) -> tuple[float, float, float, float] | None:
    """The frequency that rises evenly: its rate [Hz/s], value at the first sample, lowest and highest seen [Hz]."""
    window = round(WINDOW * series.sample_rate)
    values = series.values - series.values.mean(axis=-1, keepdims=True)
    if values.shape[-1] < FEWEST_WINDOWS * window or series.sample_rate < SLOWEST:
        return None
    parts = np.lib.stride_tricks.sliding_window_view(values, window, axis=-1)[:, :: window // 2] * np.hanning(window)
    power = np.sum(np.abs(np.fft.rfft(parts, axis=-1)) ** 2, axis=0)
    frequencies = np.fft.rfftfreq(window, 1.0 / series.sample_rate)
    followed = (frequencies >= FOLLOWED[0]) & (frequencies <= min(FOLLOWED[1], 0.45 * series.sample_rate))
    power, frequencies = power[:, followed], frequencies[followed]
    # Over its median in time, a resonance or a fan's line is no louder than the rest, and what passes by once is.
    score = power / np.maximum(np.median(power, axis=0), np.finfo(float).tiny)
    score[power < QUIET * power.max(axis=1, keepdims=True)] = 0.0
    loudest = frequencies[score.argmax(axis=1)]
    times = (np.arange(loudest.size) * (window // 2) + 0.5 * window) / series.sample_rate
    offsets = np.round((loudest - RATES[:, None] * times) / NEAR).astype(int)
    counts = [np.unique(row, return_counts=True) for row in offsets]
    pick = int(np.argmax([count.max() for _, count in counts]))
    rate, at_zero = float(RATES[pick]), NEAR * float(counts[pick][0][counts[pick][1].argmax()])
    near = np.zeros(loudest.size, dtype=bool)
    for _ in range(REFITS):
        near = np.abs(loudest - rate * times - at_zero) < NEAR
        if np.count_nonzero(near) < FEWEST_WINDOWS:
            return None
        rate, at_zero = (float(each) for each in np.polyfit(times[near], loudest[near], 1))
    under = (times >= times[near][0]) & (times <= times[near][-1])
    if np.count_nonzero(near) < LEAST_FOLLOWED * np.count_nonzero(under) or rate <= 0.0:
        return None
    whole = ROUND * round(rate / ROUND)
    if whole > 0.0 and abs(whole / rate - 1.0) < 3.0 * CLOCKS:
        rate, at_zero = whole, at_zero + (rate - whole) * float(times[near].mean())
    return rate, at_zero, float(loudest[near][0]), float(loudest[near][-1])


def _laid(
    sweep: Sweep,
    frequencies: _Array,
    command: _Complex,
    response: _Complex,
    samples: int,
    known: Alignment | None,
) -> Alignment:
    """The response moved to where, and stretched to what, makes the impulse response of its loudest channel sharp."""
    loudest = response[np.argmax(np.sum(np.abs(response) ** 2, axis=-1))]
    raw = loudest * np.conj(command) / np.maximum(np.abs(command) ** 2, FLOOR * np.median(np.abs(command) ** 2))
    step = float(frequencies[1] - frequencies[0])
    span = float(frequencies[-1] - frequencies[0])
    if known is None:
        # Delay t(f) = s (f - middle), from clocks that differ: phase pi s (f - middle)^2.
        middle = 0.5 * (frequencies[0] + frequencies[-1])
        widest = CLOCKS / sweep.rate
        steps = min(int(np.ceil(widest * span**2 / DISPERSION_STEP)), MOST_STRETCHES)
        stretches = DISPERSION_STEP / span**2 * np.arange(-steps, steps + 1)
        square = 1j * np.pi * (frequencies - middle) ** 2
        fourth = [float(np.sum(np.abs(np.fft.ifft(raw * np.exp(each * square))) ** 4)) for each in stretches]
        stretch = float(stretches[int(np.argmax(fourth))])
    else:
        stretch, middle = known.stretch, 0.5 * (frequencies[0] + frequencies[-1])
    bend = np.exp(1j * np.pi * stretch * (frequencies - middle) ** 2)
    impulse = np.abs(np.fft.ifft(raw * bend)) ** 2
    peak, per_second = int(impulse.argmax()), step * impulse.size
    around = (np.arange(-round(PEAK[0] * per_second), round(PEAK[1] * per_second) + 1) + peak) % impulse.size
    delay = peak / per_second
    turned = response * bend * np.exp(2j * np.pi * delay * frequencies)
    sharpness = float(impulse[around].sum()) / max(float(impulse.sum()), float(np.finfo(float).tiny))
    return Alignment(
        sweep,
        frequencies,
        command,
        turned,
        samples,
        stretch,
        sharpness,
    )
