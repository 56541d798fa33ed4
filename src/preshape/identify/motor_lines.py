"""Lines of motors in a printer's record: found by their persistence above all structural modes, and taken out.

A motor that turns shakes the machine at a multiple of its step rate for as long as it turns; a resonance is loud where
it was struck and dies away. Above the structural modes, where no shaper reaches, a frequency is therefore a motor's
when it is loud in most of the record and not only in a part. The rule, on short overlapping windows: the *median* over
the windows of its power, summed over the axes, stands out of the median over the frequencies, and is not far below the
*mean* over the windows.

What the rule cannot tell: a resonance up there that is struck again and again through the record, or that rings on for
most of it, is taken for a motor. In a capture of a second, struck at start and stop of the move, that is one of 150 Hz
damped less than about 0.01.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

__all__ = ["LOWEST_LINE", "without_motor_lines"]

STRUCTURAL = 130.0
"""Structural modes of printers end here [Hz]."""

WINDOW = 0.18
"""Length of a window [s]: long enough that 10 Hz above the structural modes nothing of them is touched."""

LOWEST_LINE = STRUCTURAL + 2.0 / WINDOW
"""Lines below this frequency [Hz] are left alone: they cannot be taken out without touching structural modes."""

GATE = 0.02
"""Length of the shorter windows [s] in which it is asked whether taking a line out leaves less power: a line must not
be smeared past the stop, into the ringing that matters.

Chosen on four real captures. On simulated ones (modes of 41, 70, 110 Hz, lines of 149.5, 220, 400 Hz) it does not
matter from 10 to 40 ms: the frequency found is within 0.16 % of the true one, the damping ratio within 2.8 %; at 5 ms
it is up to 4.5 % low, because parts of a period are gated. On the real ones it does: the unshaped runs 29 keep their
modes (X 44.5 to 46.1 Hz and 57 to 61 Hz, damping ratio 0.06 to 0.12; Y 39 and 50 Hz), but of the shaped runs 30, where
little rings, even the number of modes changes. Those are not known better than that."""

FEWEST_WINDOWS = 5
"""A record shorter than so many half windows does not tell persistence."""

LOUD = 5.0
"""A line's median power is at least so many times the median over the frequencies."""

LEAKAGE = 2e-3
"""And at least this part of the loudest frequency's in the record as it came, structural modes included: less leaks
through a Hann window, or is left where a line was taken out."""

PERSISTENT = 0.5
"""A line's median power over the windows is at least this part of its mean."""

MOST_LINES = 8
PADDING = 4
_Array = NDArray[np.float64]


def without_motor_lines(values: _Array, rate: float) -> tuple[_Array, tuple[str, ...]]:
    """The record without its motor lines, and a sentence that names them.

    Parameters
    ----------
    values : ndarray, shape (axis, sample)
        The record.
    rate : float
        Samples per second [Hz].

    Returns
    -------
    values : ndarray, shape (axis, sample)
        In each of the half overlapping Hann windows the sinusoid of the line's frequency that fits best in the least
        squares sense is subtracted, wherever that leaves less power: a notch 1/WINDOW wide to each side which
        follows the amplitude and ends where the motor stops.
    remarks : tuple of str
        Empty when there was no line.
    """
    length = 2 * int(0.5 * WINDOW * rate)
    count = 2 * values.shape[-1] // max(length, 1) - 1
    if LOWEST_LINE >= 0.45 * rate or count < FEWEST_WINDOWS:
        return values, ()
    offset = values.mean(axis=-1, keepdims=True)
    rest: _Array = values - offset
    before = float(np.sum(rest**2))
    found: list[float] = []
    least = LEAKAGE * float(np.median(_power(rest, length), axis=0)[1:].max())
    while len(found) < MOST_LINES and (line := _loudest_line(rest, rate, length, least, found)) is not None:
        part = _sinusoid(rest, line / rate, length)
        rest = rest - _gate(rest, part, 2 * int(0.5 * GATE * rate)) * part
        found.append(line)
    if not found:
        return values, ()
    removed = 1.0 - float(np.sum(rest**2)) / before
    # A line that wanders is taken out in several goes; it is named once.
    apart = [line for k, line in enumerate(found) if all(abs(line - other) > 2.0 / WINDOW for other in found[:k])]
    named = ", ".join(f"{line:.0f}" for line in sorted(apart))
    plural = "s" if len(apart) > 1 else ""
    remark = (
        f"motor line{plural} at {named} Hz taken out, {100.0 * removed:.0f} % of the record's power: loud in most of "
        "the record, as no resonance is that dies away."
    )
    return rest + offset, (remark,)


def _power(rest: _Array, length: int) -> _Array:
    """Power in half overlapping Hann windows, summed over the axes, shape (window, frequency)."""
    windows = np.lib.stride_tricks.sliding_window_view(rest, length, axis=-1)[:, :: length // 2]
    weights = np.hanning(length + 1)[:-1]
    return np.asarray(np.sum(np.abs(np.fft.rfft(windows * weights, PADDING * length, axis=-1)) ** 2, axis=0))


def _loudest_line(rest: _Array, rate: float, length: int, least: float, found: list[float]) -> float | None:
    """Frequency [Hz] of the loudest line that is left; what has less median power than `least` is none."""
    power = _power(rest, length)
    frequencies = np.fft.rfftfreq(PADDING * length, 1.0 / rate)
    median, mean = np.median(power, axis=0), power.mean(axis=0)
    # Where the power falls from the lowest line on, it is the side of what is louder below, and no line.
    first = int(np.searchsorted(frequencies, LOWEST_LINE))
    rises = np.flatnonzero(np.diff(median[first - 1 :]) > 0.0)
    inside = (np.arange(median.size) >= first + (rises[0] if rises.size else median.size)) & (
        frequencies <= 0.45 * rate
    )
    if not inside.any():
        return None
    typical = float(np.median(median[inside]))
    for line in found:  # what is left of one that was taken out is none
        inside &= np.abs(frequencies - line) > 1.0 / WINDOW
    line = inside & (median > max(LOUD * typical, least)) & (median > PERSISTENT * mean)
    if not line.any():
        return None
    return float(frequencies[int(np.argmax(np.where(line, median, 0.0)))])


def _sinusoid(rest: _Array, frequency: float, length: int) -> _Array:
    """The part of the record at a frequency [cycles per sample], its amplitude following from window to window."""
    half = length // 2
    padded = np.pad(rest, ((0, 0), (half, length + half)))
    phase = np.exp(-2j * np.pi * frequency * np.arange(length))
    weights = np.hanning(length + 1)[:-1]
    part = np.zeros_like(padded)
    for begin in range(0, rest.shape[-1] + half, half):
        window = padded[:, begin : begin + length]
        amplitude = 2.0 * (window * weights) @ phase / weights.sum()
        part[:, begin : begin + length] += weights * np.real(amplitude[:, None] * np.conj(phase))
    return part[:, half : half + rest.shape[-1]]


def _gate(rest: _Array, part: _Array, length: int) -> _Array:
    """1 where taking the part out leaves less power, 0 where it would add some, shape (sample,), without steps."""
    half = length // 2
    padded = [np.pad(one, ((0, 0), (half, length + half))) for one in (rest, rest - part)]
    weights = np.hanning(length + 1)[:-1]
    gate = np.zeros(padded[0].shape[-1])
    for begin in range(0, rest.shape[-1] + half, half):
        before, after = (float(np.sum(weights * one[:, begin : begin + length] ** 2)) for one in padded)
        if after < before:
            gate[begin : begin + length] += weights
    return gate[half : half + rest.shape[-1]]
