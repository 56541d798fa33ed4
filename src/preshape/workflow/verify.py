"""Did the shaper do on the machine what was predicted? Recordings of one move, without and with it."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from preshape import identify
from preshape.checks import positive
from preshape.errors import InputError
from preshape.identify import IdentifiedMode, TimeSeries
from preshape.mode import Mode
from preshape.report import Ringing, Verification
from preshape.shaper import Shaper
from preshape.workflow.mode_verdicts import judged, unmatched
from preshape.workflow.move_stops import find_stops
from preshape.workflow.ring_amplitudes import RingFit, Tail, fit_ringing
from preshape.workflow.stop_time import Motion
from preshape.workflow.verification_trouble import comparison_trouble, move_trouble
from preshape.workflow.window_residuals import window_residuals

__all__ = ["verify"]

Recording = TimeSeries | str | os.PathLike[str]

DECAYED = 6.0
"""Time constants of the slowest decay over which amplitudes are fitted."""

EARLIEST = 0.05
"""A recording may begin so long after the stop [s]."""

FEWEST = 48
"""Samples after the stop that are needed."""

HIGHEST = 2.0
"""The root mean square counts what is below so many times the highest mode's frequency."""

SAME_CLOCK = 0.005
"""Relative difference of sample rates within which repeats are searched for modes together."""

_Array = NDArray[np.float64]


def verify(
    before: Recording | Iterable[Recording],
    after: Recording | Iterable[Recording],
    *,
    shaper: Shaper | None = None,
    stop: float | tuple[float, float] | None = None,
    lasting: float | None = None,
    window: float | None = None,
    below: float | None = None,
) -> Verification:
    """Compare recordings of the same move without and with a shaper.

    Parameters
    ----------
    before, after : TimeSeries, path, or several
        Recordings in time without and with the shaper, in any format that :func:`preshape.identify.read` knows.
    shaper : Shaper, optional
        What the machine was told to execute; its residual vibration is set beside the measurement.
    stop : float or pair of float, optional
        When the move stops [s]: one time for all recordings, or one for those before and one for those after. Found
        by itself unless given.
    lasting : float, optional
        How long the unshaped move takes [s], as the recipe says: the stop is then so long after the beginning.
    window : float, optional
        Time over which the root mean square is taken [s]; all that is recorded, up to six time constants of the slowest
        mode, unless given. It begins at the stop, or where that was found, `wait` after it, when it is surely over.
    below : float, optional
        Frequency up to which it is taken [Hz]; twice the highest mode's unless given.

    Returns
    -------
    Verification
        Residuals with intervals, modes with verdicts, new modes, and trouble.

    Raises
    ------
    InputError
        If a recording cannot be read (MeasurementError), is no recording in time, has other axes than the rest, or ends
        too soon after the stop.

    Notes
    -----
    Modes are found in all unshaped recordings together. The amplitude of each is referred to the recording's own stop,
    so that the ratio is residual vibration as :func:`preshape.vibration.residual_vibration` defines it. Intervals
    (95 %): an amplitude's is that of a noncentral chi square, with the spectrum of what the fit leaves as noise; with
    three repeats or more at least Student's of their spread. A ratio's combines both (see
    :func:`preshape.workflow.ratio_interval.ratio_interval`) and adds, in quadrature, what the poles' and the stops'
    uncertainty do to it, and what looking later changes beyond the noise: modes that nobody has fitted. A prediction's
    is the range over the intervals of frequency and damping. The ratio of the root mean squares is open where the stop
    is not known to 3 ms.

    Examples
    --------
    >>> import numpy as np
    >>> times = np.arange(1000) / 1000.0
    >>> ring = np.exp(-8.0 * times) * np.sin(2 * np.pi * 30.0 * times)
    >>> noise = 0.002 * np.random.default_rng(1).normal(size=(2, 1000))
    >>> loud, quiet = (TimeSeries(1000.0, 0.0, (a * ring + n)[None, :], ("x",)) for a, n in zip((1.0, 0.2), noise))
    >>> result = verify(loud, quiet, stop=0.0)
    >>> round(result.modes[0].ratio.value, 2), result.modes[0].verdict
    (0.2, 'reduced')
    """
    sides = [_recordings(before, "before"), _recordings(after, "after")]
    everything = [one for side in sides for one in side]
    _check_alike(everything)
    if lasting is not None:
        lasting = positive("lasting", lasting, "s")
    stops = find_stops(sides[0], sides[1], shaper, _stops(stop), lasting)
    motions = (stops.before, stops.after)
    tails = [_tails(side, moved, stops.guard) for side, moved in zip(sides, motions, strict=True)]
    found = _modes(tails[0], sides[0][0][1])
    trouble = [
        *comparison_trouble([name for name, _ in sides[0]], [name for name, _ in sides[1]], everything),
        *move_trouble(sides, motions),
        *stops.trouble,
    ]
    extra = unmatched(_modes(tails[1], sides[1][0][1]).modes, found.modes)
    if not found.modes:
        trouble.append("no mode was found in the unshaped recordings: they are too noisy, or end too soon to tell.")
    modes = [*found.modes, *extra]
    length = _length(tails, modes)
    tails = [[replace(tail, values=tail.values[:, : int(length * tail.rate)]) for tail in side] for side in tails]
    fits = [[fit_ringing(tail, [one.mode for one in modes]) for tail in side] for side in tails]
    verdicts, more = judged(modes, len(found.modes), tails, fits, stops, shaper)
    trouble += more
    window = length if window is None else min(positive("window", window, "s"), length)
    if below is not None:
        below = positive("below", below, "Hz")
    else:
        below = HIGHEST * max([one.mode.frequency for one in modes], default=everything[0][1].sample_rate)
    residuals = window_residuals(tails, fits, [one.mode for one in modes], window, below, stops.spread)
    floors = [float(np.sum(m.floor**2)) for side in motions for m in side if m.floor is not None]
    return Verification(
        modes=verdicts,
        axes=everything[0][1].channels,
        before=residuals[0],
        after=residuals[1],
        ratio=residuals[2],
        wait=stops.guard,
        window=window,
        below=below,
        floor=float(np.sqrt(np.mean(floors))) if floors else None,
        unit=everything[0][1].unit,
        unshaped=_ringings(sides[0], motions[0], tails[0], fits[0]),
        shaped=_ringings(sides[1], motions[1], tails[1], fits[1]),
        trouble=tuple(dict.fromkeys(trouble)),
    )


def _recordings(given: Recording | Iterable[Recording], side: str) -> list[tuple[str, TimeSeries]]:
    several = [given] if isinstance(given, TimeSeries | str | os.PathLike) else list(given)
    if not several:
        raise InputError(f"no recording was given for {side}: name at least one.")
    found = []
    for number, one in enumerate(several, 1):
        series = one if isinstance(one, TimeSeries) else identify.read(one)
        name = f"{side} {number}" if isinstance(one, TimeSeries) else Path(one).name
        if not isinstance(series, TimeSeries):
            raise InputError(f"{name} is a spectrum: what is left after a stop needs a recording in time.")
        found.append((name, series))
    return found


def _check_alike(recordings: Sequence[tuple[str, TimeSeries]]) -> None:
    first, one = recordings[0]
    for name, other in recordings[1:]:
        if other.channels != one.channels or (one.unit and other.unit and one.unit != other.unit):
            raise InputError(
                f"{name} holds {', '.join(other.channels)} in {other.unit or '?'}, {first} "
                f"{', '.join(one.channels)} in {one.unit or '?'}: record all with the same sensor."
            )


def _stops(stop: float | tuple[float, float] | None) -> tuple[float, float] | None:
    if stop is None:
        return None
    pair = stop if isinstance(stop, tuple) else (stop, stop)
    if len(pair) != 2 or not all(np.isfinite(one) for one in pair):
        raise InputError(f"stop {stop!r} is no time: give seconds, or a pair of them for before and after.")
    return pair


def _tails(side: Sequence[tuple[str, TimeSeries]], motions: Sequence[Motion], guard: float) -> list[Tail]:
    tails = []
    for (name, series), motion in zip(side, motions, strict=True):
        first = max(int(np.ceil((motion.stop + guard - series.start) * series.sample_rate - 1e-9)), 0)
        values = series.values[:, first:]
        if motion.stop < series.start - EARLIEST:
            raise InputError(
                f"{name} begins at {series.start:.4g} s, more than {1e3 * EARLIEST:g} ms after the stop at "
                f"{motion.stop:.4g} s: start recording sooner, or correct the stop."
            )
        if values.shape[-1] < FEWEST:
            raise InputError(
                f"{name}: {values.shape[-1]} samples follow the stop at {motion.stop:.4g} s, and {FEWEST} are needed: "
                "record longer, or correct the stop."
            )
        offset = series.start + first / series.sample_rate - motion.stop
        tails.append(Tail(values, series.sample_rate, float(offset), motion.floor))
    return tails


def _modes(tails: Sequence[Tail], like: TimeSeries) -> identify.Identification:
    """Modes of all repeats together: they share their poles, so each repeat counts as more channels."""
    rates = [tail.rate for tail in tails]
    if max(rates) > (1.0 + SAME_CLOCK) * min(rates):
        tails = tails[:1]
    samples = min(tail.values.shape[-1] for tail in tails)
    values = np.concatenate([tail.values[:, :samples] for tail in tails])
    names = tuple(f"{k}" for k in range(values.shape[0]))
    rate = float(np.mean([tail.rate for tail in tails]))
    return identify.ring_down(replace(like, sample_rate=rate, start=0.0, values=values, channels=names, remarks=()))


def _length(tails: Sequence[Sequence[Tail]], modes: Sequence[IdentifiedMode]) -> float:
    """Time after the stop that is fitted [s], the same for all."""
    recorded = min((tail.values.shape[-1] - 1) / tail.rate for side in tails for tail in side)
    slowest = min([_decay(one.mode) for one in modes], default=0.0)
    least = max((FEWEST + 1) / tail.rate for side in tails for tail in side)
    return float(recorded if slowest <= 0.0 else min(recorded, max(DECAYED / slowest, least)))


def _decay(mode: Mode) -> float:
    return float(mode.damping * mode.omega)


def _ringings(
    side: Sequence[tuple[str, TimeSeries]], motions: Sequence[Motion], tails: Sequence[Tail], fits: Sequence[RingFit]
) -> tuple[Ringing, ...]:
    found = []
    for (name, _), motion, tail, fit in zip(side, motions, tails, fits, strict=True):
        size = 1 << int(np.ceil(np.log2(max(4 * fit.centred.shape[-1], tail.rate))))
        power = np.sum(np.abs(np.fft.rfft(fit.centred, size, axis=-1)) ** 2, axis=0)
        found.append(
            Ringing(name, motion.stop, motion.spread, tail.times, fit.centred, fit.curve,
                    np.arange(size // 2 + 1, dtype=np.float64) * (tail.rate / size), np.sqrt(power) / tail.rate)
        )  # fmt: skip
    return tuple(found)
