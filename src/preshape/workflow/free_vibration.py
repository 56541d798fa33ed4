"""The modes in what a plant does after a command: amplitudes by least squares, and when it has settled."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Modes
from preshape.report import OutputMotion

__all__ = ["final_value", "output_motion"]

FASTEST = 0.45
"""Modes above this part of the sample rate cannot be told from slower ones."""

SAMPLES_PER_PERIOD = 16.0
"""Of the fastest mode, that are fitted; more add nothing but work."""

FITTED_PERIODS = 20.0
"""Of the slowest mode."""

Real = NDArray[np.float64]


def output_motion(times: Real, values: Real, end: int, pushed: bool, modes: Modes, within: float) -> OutputMotion:
    """What an output does under a command that changes last at sample `end`.

    Parameters
    ----------
    times, values : ndarray, shape (sample,)
        [s], [unit of the output].
    end : int
        Sample.
    pushed : bool
        Whether the command stays at another value than 0: a free body is then accelerated for ever.
    modes : Modes
        What rings.
    within : float
        Window of settling [unit of the output].
    """
    amplitudes, unexplained, trend = _fitted(times[end:] - times[end], values[end:], 2 if pushed else 1, modes)
    outside = np.flatnonzero(np.abs(values - final_value(times, values, modes)) > within)
    settled = float(times[min(int(outside[-1]) + 1, times.size - 1)]) if outside.size else 0.0
    # A vibration leaves a window twice in each period: what has been inside for less than that may leave it again.
    slowest = 1.0 / min(mode.frequency for mode in modes)
    return OutputMotion(
        amplitudes=amplitudes,
        unexplained=unexplained,
        residual=float(np.nansum(amplitudes)),
        peak=float(np.abs(values).max()),
        settling_time=math.inf if times[-1] - settled < slowest else settled,
        within=within,
        trend=trend,
    )


def final_value(times: Real, values: Real, modes: Modes) -> float:
    """Where an output ends: its mean over the last period of the slowest mode [unit of the output]."""
    period = 1.0 / (min(mode.frequency for mode in modes) * float(times[1] - times[0]))
    return float(values[-max(round(period), 1) :].mean())


def _fitted(t: Real, y: Real, degree: int, modes: Modes) -> tuple[Real, float, Real]:
    """Amplitudes at t = 0, the root mean square of what is left, and factors of the powers of t."""
    amplitudes = np.full(len(modes), math.nan)
    dt = float(t[1] - t[0]) if t.size > 1 else math.inf
    seen = [k for k, mode in enumerate(modes) if mode.frequency * dt < FASTEST]
    if not seen:
        return amplitudes, float(np.std(y)), np.array([float(np.mean(y))])
    frequencies = [modes[k].frequency for k in seen]
    stride = max(int(1.0 / (SAMPLES_PER_PERIOD * max(frequencies) * dt)), 1)
    kept = slice(0, int(np.ceil(FITTED_PERIODS / (min(frequencies) * dt))) + 1, stride)
    t, y = t[kept], y[kept]
    ringing = np.exp(np.multiply.outer(t, np.array([modes[k].pole for k in seen])))
    powers, span = np.arange(degree + 1), max(float(t[-1]), dt)
    smooth = (t[:, np.newaxis] / span) ** powers
    columns = np.concatenate([ringing.real, ringing.imag, smooth], axis=1)
    found, *_ = np.linalg.lstsq(columns, y, rcond=None)
    amplitudes[seen] = np.hypot(found[: len(seen)], found[len(seen) : 2 * len(seen)])
    left = float(np.sqrt(np.mean((y - columns @ found) ** 2)))
    return amplitudes, left, found[2 * len(seen) :] / span**powers
