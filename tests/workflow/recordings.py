"""Recordings of a move whose residual vibration is known in closed form.

A carriage follows the acceleration command a(t) of a trapezoidal move, in steps; each mode obeys
q'' + 2 z w q' + w^2 q = -g a, so that after a step of size s at time 0 its acceleration is
-g s exp(-z w t) (cos w_d t - z / sqrt(1 - z^2) sin w_d t). The sensor sees the carriage in x, and all modes.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from preshape import Mode, Shaper
from preshape.identify import TimeSeries

MODES = (Mode(42.0, 0.06), Mode(78.0, 0.04))
GAINS = ((0.8, 0.1, 0.0), (0.3, 0.2, 0.05))
"""Of each mode in x, y and z."""

Extra = tuple[Mode, tuple[float, float, float]]


def recording(
    shaper: Shaper | None = None,
    *,
    seed: int = 0,
    noise: float = 0.01,
    rate: float = 1600.0,
    acceleration: float = 1.0,
    extra: Sequence[Extra] = (),
    from_stop: bool = False,
) -> tuple[TimeSeries, float]:
    """A recording, and when the move stops in it; `extra` modes are struck by the stop, with these amplitudes."""
    rng = np.random.default_rng(seed)
    quiet, ramp, last, tail = 0.1 + rng.uniform(0.0, 1.0 / rate), 0.04, 0.3, 0.4
    impulses = [(0.0, 1.0)] if shaper is None else [*zip(shaper.times, shaper.amplitudes, strict=True)]
    stop = quiet + last + impulses[-1][0]
    times = np.arange(int((stop + tail) * rate)) / rate
    values = np.zeros((3, times.size))
    for delay, amplitude in impulses:
        for begin, sign in ((0.0, 1.0), (ramp, -1.0), (last - ramp, -1.0), (last, 1.0)):
            step = sign * acceleration * amplitude
            t = times - quiet - delay - begin
            on, t = t >= 0.0, np.maximum(t, 0.0)
            values[0] += step * on
            for mode, gains in zip(MODES, GAINS, strict=True):
                z = mode.damping
                swing = np.cos(mode.omega_d * t) - z / np.sqrt(1.0 - z**2) * np.sin(mode.omega_d * t)
                values -= np.outer(gains, step * on * np.exp(-z * mode.omega * t) * swing)
    for mode, amplitudes in extra:
        t = np.maximum(times - stop, 0.0)
        values += np.outer(amplitudes, np.exp(-mode.damping * mode.omega * t) * np.sin(mode.omega_d * t))
    values[2] += 9.8
    values += noise * rng.normal(size=values.shape)
    if from_stop:
        kept = times >= stop
        return TimeSeries(rate, float(times[kept][0] - stop), values[:, kept], ("x", "y", "z"), "m/s^2"), 0.0
    return TimeSeries(rate, 0.0, values, ("x", "y", "z"), "m/s^2"), stop


def klipper_text(series: TimeSeries) -> str:
    """As Klipper writes raw data: seconds and mm/s^2."""
    rows = [
        f"{t:.6f},{1e3 * x:.6f},{1e3 * y:.6f},{1e3 * z:.6f}"
        for t, (x, y, z) in zip(series.times, series.values.T, strict=True)
    ]
    return "\n".join(["#time,accel_x,accel_y,accel_z", *rows, ""])
