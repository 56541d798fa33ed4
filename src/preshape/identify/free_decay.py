"""Where in a record the machine rings freely: the part from which on decaying sinusoids explain everything."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.identify import rrf_capture
from preshape.identify.decaying_sinusoids import Subspace, left_over
from preshape.identify.measurement import TimeSeries
from preshape.identify.welch import spectrum

__all__ = ["FreeDecay", "PRINTER_BAND", "find_free_decay", "highest_power"]

PRINTER_BAND = (10.0, 130.0)
"""Structural modes of printers [Hz]. Above, captures are full of motor and belt lines, which no shaper can reach."""

MOST_SAMPLES = 600
"""Samples after which a record is thinned, as far as its frequencies allow."""

SAMPLES_PER_PERIOD = 8.0
"""Samples that thinning leaves in a period of the highest frequency with power."""

POWER_FLOOR = 1e-3
NOISE_MARGIN = 30.0
"""A frequency has power when its density is above this part of the highest and above so many times the median."""

LOW_PASS_SPAN = 0.022
"""Length of the filter that takes motor lines out of printer captures [s]; it blurs the stop by half of that."""

LONGEST_RECORD = 3000
"""Samples after thinning from which on only the end of the vibration is looked at."""

QUIET_BLOCKS = 100
QUIET_RATIO = 3.0
"""A hundredth of a long record is quiet when its variance is below so many times that of the record's end."""

START_TRIALS = 24
COARSE = 5
REFINEMENTS = 3
LATEST_START = 0.85
"""Starts that are tried, the stride at which a few are tried first, halvings of the step before the earliest good
one, and the latest start as a part of the record."""

NOISE_RATIO = 2.0
SURELY_NOISE = 1.2
MODEL_ERROR = 0.02
"""A start is late enough when what is left is below so many times the least, or below this part of the signal."""

FEWEST_PER_FREEDOM = 2.0
"""A part of the record is judged only when it has so many values for each unknown."""

SCAN_PENCIL = 80

_Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FreeDecay:
    """A part of a record, prepared for the fit.

    Attributes
    ----------
    values : ndarray, shape (channel, sample)
        Filtered and thinned, mean removed.
    rate : float
        Samples per second of `values` [Hz].
    start : float
        Time of the first sample in the record [s].
    band : tuple of float
        Where structural modes are looked for [Hz].
    noise_factor : float
        How much denser noise is in the band than over all of `values` (a low-pass filter was applied).
    """

    values: _Array
    rate: float
    start: float
    band: tuple[float, float]
    noise_factor: float


def find_free_decay(series: TimeSeries, maximum: int) -> FreeDecay | None:
    """The longest free decay at the end of a record, or None when no part of it is long enough to tell."""
    values, rate, first, blur, factor = _prepared(series)
    band = PRINTER_BAND if series.format == rrf_capture.FORMAT else (0.0, 0.45 * rate)
    samples = values.shape[-1]
    order = 2 * maximum + 1
    unknowns = 2 * maximum + order * values.shape[0]
    starts = np.unique(np.linspace(0, LATEST_START * samples, START_TRIALS).astype(int))
    starts = starts[(samples - starts) * values.shape[0] >= FEWEST_PER_FREEDOM * unknowns]
    if not starts.size or samples - starts[-1] <= order + 1:
        starts = starts[samples - starts > 2 * (order + 1)]
    if not starts.size:
        return None
    few = [_left(values[:, start:], rate, order) for start in starts[::COARSE]]
    if few[0] <= SURELY_NOISE * min(few):  # free from the first sample on, as in most recorded ring-downs
        return FreeDecay(_centred(values), rate, first, band, factor)
    left = [few[i // COARSE] if i % COARSE == 0 else _left(values[:, s:], rate, order) for i, s in enumerate(starts)]
    limit = NOISE_RATIO * min(left)

    def good(start: int, rest: float) -> bool:
        return rest <= max(limit, MODEL_ERROR * float(np.std(_centred(values[:, start:]))))

    earliest = next(index for index, rest in enumerate(left) if good(int(starts[index]), rest))
    start = int(starts[earliest])
    before = int(starts[earliest - 1]) if earliest else 0
    for _ in range(REFINEMENTS):
        middle = (before + start) // 2
        if before < middle < start:
            if good(middle, _left(values[:, middle:], rate, order)):
                start = middle
            else:
                before = middle
    if start > 0:
        start = min(start + blur, samples - int(FEWEST_PER_FREEDOM * unknowns / values.shape[0]))
    return FreeDecay(_centred(values[:, start:]), rate, first + start / rate, band, factor)


def _left(values: _Array, rate: float, order: int) -> float:
    """Standard deviation of what decaying sinusoids leave of a record."""
    centred = _centred(values)
    natural, damping = Subspace(centred, rate, SCAN_PENCIL).poles(order)
    squares, freedoms = left_over(centred, rate, natural, damping)
    return float(np.sqrt(squares / max(freedoms, 1)))


def _centred(values: _Array) -> _Array:
    return np.asarray(values - values.mean(axis=-1, keepdims=True))


def _prepared(series: TimeSeries) -> tuple[_Array, float, float, int, float]:
    """Values, rate [Hz], time of the first sample [s], samples blurred at an edge, and the noise factor."""
    values, rate = series.values, series.sample_rate
    if series.format == rrf_capture.FORMAT and rate > 2.5 * PRINTER_BAND[1]:
        from scipy.signal import firwin

        taps = 2 * int(0.5 * LOW_PASS_SPAN * rate) + 1
        if values.shape[-1] > 4 * taps:
            step = max(int(rate / (3.5 * PRINTER_BAND[1])), 1)
            weights = firwin(taps, PRINTER_BAND[1], fs=rate)
            smooth = np.array([np.convolve(channel, weights, "valid")[::step] for channel in values])
            first = series.start + 0.5 * (taps - 1) / rate
            return smooth, rate / step, first, -(-taps // (2 * step)), rate / step / (2.0 * PRINTER_BAND[1])
    step = max(min(values.shape[-1] // MOST_SAMPLES, int(rate / (SAMPLES_PER_PERIOD * highest_power(series)))), 1)
    kept = values.shape[-1] // step * step
    # The mean of blocks keeps decaying sinusoids what they are and white noise white.
    thinned = values[:, :kept].reshape(values.shape[0], -1, step).mean(axis=-1)
    begin, end = _loud(thinned)
    start = series.start + (begin * step + 0.5 * (step - 1)) / rate
    return thinned[:, begin:end], rate / step, start, 1, 1.0


def _loud(values: _Array) -> tuple[int, int]:
    """Begin and end of the last samples that are worth looking at: quiet after the vibration has died is not."""
    samples = values.shape[-1]
    if samples <= LONGEST_RECORD:
        return 0, samples
    block = samples // QUIET_BLOCKS
    parts = _centred(values)[:, : block * QUIET_BLOCKS].reshape(values.shape[0], QUIET_BLOCKS, block)
    energy = np.sum(np.var(parts, axis=-1), axis=0)
    quiet = float(np.median(energy[-QUIET_BLOCKS // 10 :]))
    loud = np.flatnonzero(energy > QUIET_RATIO * quiet)
    end = min((int(loud[-1]) + 3) * block, samples) if loud.size else samples
    return max(end - LONGEST_RECORD, 0), end


def highest_power(series: TimeSeries) -> float:
    """The highest frequency with power in the record [Hz]."""
    found = spectrum(series)
    density = found.total[1:]
    powerful = np.flatnonzero(density > max(POWER_FLOOR * density.max(), NOISE_MARGIN * float(np.median(density))))
    return float(found.frequencies[1:][powerful[-1] if powerful.size else -1])
