"""Machines, moves and recordings drawn at random, for a verification that has never seen them.

Closed form: after a step s of the commanded acceleration the acceleration of a mode is
-g s exp(-z w t) (cos w_d t - z / sqrt(1 - z^2) sin w_d t); after a ramp of slope j it is the integral of that,
-g j exp(-z w t) sin(w_d t) / w_d. The sensor sees the carriage in x, gravity in z, and all modes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import preshape
from preshape import Mode, Shaper
from preshape.identify import TimeSeries
from preshape.vibration import residual_vibration

HIGHEST = 250.0
"""No mode is above [Hz]."""

FAMILIES = ("zv", "zvd", "zvdd", "ei", "mzv", "two")


@dataclass(frozen=True, eq=False)
class Pair:
    """The same move without and with a shaper, recorded by the same sensor, and what is true of it.

    Parameters
    ----------
    before, after : TimeSeries
        The recordings; each begins by itself, so long before the move as it happens.
    told, executed : Shaper
        What the machine was told, and what it did.
    modes : tuple of Mode
        Of the machine.
    stops : tuple of float
        When the command stops in each recording [s].
    lasting : float
        How long the unshaped move takes [s].
    """

    before: TimeSeries
    after: TimeSeries
    told: Shaper
    executed: Shaper
    modes: tuple[Mode, ...]
    stops: tuple[float, float]
    lasting: float

    @property
    def stretch(self) -> float:
        """Of the executed shaper's times, against those of the told one."""
        return self.executed.duration / self.told.duration

    def truth(self, mode: Mode) -> float:
        """The residual vibration that the executed shaper leaves of a mode [-]."""
        return float(residual_vibration(self.executed, mode.frequency, mode.damping))

    def nearest(self, frequency: float, within: float = 0.05) -> Mode | None:
        """The machine's mode at a frequency, or None."""
        best = min(self.modes, key=lambda one: abs(one.frequency - frequency))
        return best if abs(best.frequency - frequency) <= within * best.frequency else None


def draw(seed: int, number: int, noise: float, *, obeys: bool = True) -> Pair:
    """Pair `number` of a seed: 1 to 3 modes of 15 to 250 Hz, damping ratios of 0.01 to 0.12.

    Acceleration phases take 20 to 120 ms, one in three with ramps of the acceleration; 800 to 3200 samples a second;
    50 to 500 ms before the move and 0.3 to 1.2 s after it. The noise is white, of this part of the acceleration in each
    sample. The shaper's mode is off by up to 10 %. Unless the machine `obeys`, it executes a shaper for a mode that is
    20 to 40 % higher or lower than it was told.
    """
    rng = np.random.default_rng([seed, number])
    frequencies = [float(np.exp(rng.uniform(np.log(15.0), np.log(90.0))))]
    for _ in range(int(rng.integers(0, 3))):
        frequencies.append(frequencies[-1] * float(rng.uniform(1.3, 2.3)))
    modes = tuple(
        Mode(one, float(np.exp(rng.uniform(np.log(0.01), np.log(0.12))))) for one in frequencies if one < HIGHEST
    )
    gains = np.array(
        [[rng.uniform(0.3, 1.0) * 0.6**k, rng.uniform(0.0, 0.3), rng.uniform(0.0, 0.1)] for k in range(len(modes))]
    )
    ramp = float(rng.uniform(0.02, 0.12))
    lasting = 2.0 * ramp + float(rng.uniform(0.02, 0.4))
    soft = float(rng.uniform(0.1, 0.3)) * ramp if rng.random() < 1.0 / 3.0 else 0.0
    rate = float(np.exp(rng.uniform(np.log(800.0), np.log(3200.0))))
    told = _shaper(rng, modes, 1.0)
    state = rng.bit_generator.state
    scale = float(rng.uniform(1.2, 1.4)) ** float(rng.choice([-1.0, 1.0]))
    rng.bit_generator.state = state
    executed = told if obeys else Shaper(told.times / scale, told.amplitudes)
    recordings, stops = [], []
    for impulses in ([(0.0, 1.0)], [*zip(executed.times.tolist(), executed.amplitudes.tolist(), strict=True)]):
        quiet, tail = float(rng.uniform(0.05, 0.5)), float(rng.uniform(0.3, 1.2))
        stop = quiet + lasting + impulses[-1][0]
        times = np.arange(int((stop + tail) * rate)) / rate
        values = np.zeros((3, times.size))
        values[2] = 9.8
        for delay, amplitude in impulses:
            for begin, sign in ((0.0, 1.0), (ramp, -1.0), (lasting - ramp, -1.0), (lasting, 1.0)):
                if soft > 0.0:  # a change of the acceleration takes this long, and ends when the phase does
                    early = begin - soft * (begin > 0.0)
                    slope = sign * amplitude / soft
                    changes = ((early, slope, True), (early + soft, -slope, True))
                else:
                    changes = ((begin, sign * amplitude, False),)
                for at, size, is_ramp in changes:
                    values += _response(times - quiet - delay - at, size, is_ramp, modes, gains)
        values += noise * rng.normal(size=values.shape)
        recordings.append(TimeSeries(rate, 0.0, values, ("x", "y", "z"), "m/s^2"))
        stops.append(stop)
    return Pair(recordings[0], recordings[1], told, executed, modes, (stops[0], stops[1]), lasting)


def _response(
    t: NDArray[np.float64], size: float, is_ramp: bool, modes: tuple[Mode, ...], gains: NDArray[np.float64]
) -> NDArray[np.float64]:
    on, t = t >= 0.0, np.maximum(t, 0.0)
    values = np.zeros((3, t.size))
    values[0] = size * (t if is_ramp else on)
    for mode, gain in zip(modes, gains, strict=True):
        z, decay = mode.damping, np.exp(-mode.damping * mode.omega * t)
        swing = np.cos(mode.omega_d * t) - z / np.sqrt(1.0 - z**2) * np.sin(mode.omega_d * t)
        wave = decay * (np.sin(mode.omega_d * t) / mode.omega_d if is_ramp else swing)
        values -= np.outer(gain, size * on * wave)
    return values


def _shaper(rng: np.random.Generator, modes: tuple[Mode, ...], factor: float) -> Shaper:
    family = str(rng.choice(FAMILIES))
    first = (modes[0].frequency * float(rng.uniform(0.9, 1.1)) * factor, modes[0].damping)
    if family == "two":
        second = modes[-1] if len(modes) > 1 else Mode(1.7 * modes[0].frequency, modes[0].damping)
        return preshape.design.zv(first) * preshape.design.zv(second)
    return getattr(preshape.design, family)(first)
