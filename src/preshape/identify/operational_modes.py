"""Modes of a machine at work: shaken all the time by what nobody measured, several outputs together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.identify.covariance_subspace import Covariances, Poles, Realisation
from preshape.identify.free_decay import highest_power
from preshape.identify.identification import OPERATIONAL, Identification, IdentifiedMode
from preshape.identify.measurement import Spectrum, TimeSeries
from preshape.identify.stabilisation import SMALLEST_SHARE, stabilised
from preshape.identify.welch import spectrum
from preshape.mode import Mode

__all__ = ["is_stationary", "operational_modes"]

RATE = 4.0
"""Samples a period of the highest frequency with power, after thinning."""

SPAN, ROWS = 60, (16, 40)
"""Rows of the Hankel matrix, and the limits to its block rows: longer lags hold more noise, not more of the modes."""

HIGHEST_ORDER = 36
BLOCKS = 20
"""Parts of the record of which each is left out once: the scatter is the uncertainty (jackknife)."""

STUDENT_95 = 2.09
"""Quantile of Student's distribution for so many blocks."""

MOST_MISSING = 0.2
"""Part of the blocks without which a mode may be lost; one that is lost oftener is none."""

SAME_FREQUENCY, SAME_SHAPE = 0.05, 0.8
"""A pole without a block is the one of the whole record when it is so near, and the shapes so much alike."""

WIDEST_INTERVAL = 0.1
"""Modes whose natural frequency is known worse than by this relative half-width (95 %) are left out."""

DEEPEST = 1.1
"""Modes whose damping ratio is known worse than by this half-width of its logarithm (a factor of 3) are left out."""

LONG_ENOUGH = 0.5
"""Relative half-width of a damping ratio's interval above which it is said that the record is short."""

WISHED = 0.2
"""The half-width that a longer record would give, in that sentence."""

PARTS, EVEN = 6, 10.0
"""A record is stationary when no part of so many has more than so many times the energy of another, and they do not
fall one after the other, as they do where something rings down."""

LINE_DAMPING = 5e-4
"""Steel alone damps as little; below, it is a steady line."""

DEAD = 1e-9
"""A channel with less of the largest deviation is constant."""

FEWEST_SAMPLES = 2000
"""After thinning."""

_Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class _Spread:
    """How far the modes move when blocks are left out: standard deviations of log frequency, log damping; losses."""

    frequency: _Array
    damping: _Array
    missing: _Array


def is_stationary(series: TimeSeries) -> bool:
    """Whether a record vibrates about as much from its beginning to its end, and does not just die away."""
    values = series.values - series.values.mean(axis=-1, keepdims=True)
    size = values.shape[-1] // PARTS
    if size < 2:
        return False
    scale = np.maximum(values.std(axis=-1), np.finfo(float).tiny)
    parts = (values[:, : size * PARTS] / scale[:, None]).reshape(values.shape[0], PARTS, size)
    energy = np.sum(np.var(parts, axis=-1), axis=0)
    return bool(energy.max() < EVEN * energy.min() and np.any(np.diff(energy) >= 0.0))


def operational_modes(series: TimeSeries, *, damping: float | None = None, maximum: int = 4) -> Identification:
    """Find the modes in a stationary record of one or several outputs, the excitation being unknown and broad.

    Covariance-driven stochastic subspace identification with all outputs as references. The order is the lowest at
    which the stabilisation diagram has most columns. Intervals come from leaving out each twentieth of the record.

    Parameters
    ----------
    series : TimeSeries
        A thousand periods of the slowest mode, better more; channels are scaled to the same size.
    damping : float, optional
        Replaces all damping ratios.
    maximum : int
        Largest number of modes to report.

    Returns
    -------
    Identification
        With the `stabilisation` diagram; without modes, and with the reason in `trouble`, when nothing is stable.

    Notes
    -----
    What nobody measured must shake all modes alike: a motor's steady line looks like a mode without damping, and is
    told apart by just that; a peak in the excitation looks like a mode, and cannot be told apart.

    References
    ----------
    P. Van Overschee & B. De Moor, Subspace Identification for Linear Systems (1996), chapter 3; B. Peeters & G. De
    Roeck, Mech. Syst. Signal Process. 13 (1999) 855-878; the uncertainty by leaving out blocks: M. Quenouille,
    Biometrika 43 (1956) 353-360.

    Examples
    --------
    >>> import numpy as np
    >>> from scipy.signal import lfilter
    >>> pole = np.exp(2 * np.pi * 4.0 * (-0.02 + 1j * np.sqrt(1 - 0.02**2)) / 50.0)
    >>> noise = np.random.default_rng(1).normal(size=30_000)
    >>> record = lfilter([1.0], np.poly([pole, pole.conjugate()]).real, noise)
    >>> found = operational_modes(TimeSeries(50.0, 0.0, record[None, :], ("x",)))
    >>> round(float(found.modes[0].mode.frequency), 1), found.modes[0].damping_interval[0] < 0.02
    (4.0, True)
    """
    measured = spectrum(series, window_duration=min(0.1 * series.duration, 200.0 / highest_power(series)))
    summed = Spectrum(
        measured.frequencies, measured.total[None, :], ("sum",), measured.unit, source=series.source,
        window_duration=measured.window_duration, format=series.format,
    )  # fmt: skip
    nothing = np.full(summed.frequencies.shape, np.nan)
    values, rate, scale = _thinned(series)
    if values.shape[-1] < FEWEST_SAMPLES:
        reason = (
            f"the record holds {values.shape[-1]} samples at {rate:.3g} Hz where its vibration lies: for modes at work "
            f"record at least {FEWEST_SAMPLES / rate:.3g} s."
        )
        return Identification((), summed, nothing, OPERATIONAL, (*series.remarks, reason), False)
    rows = int(np.clip(SPAN // values.shape[0], *ROWS))
    highest = min(HIGHEST_ORDER, (rows - 1) * values.shape[0])
    covariances = Covariances(values, rows, BLOCKS)
    realisation = Realisation(covariances.mean(), rows, rate, highest)
    diagram = stabilised(realisation, highest)
    if not diagram.order:
        reason = "no pole comes back from order to order: nothing resonates, or the record is too short."
        return Identification((), summed, nothing, OPERATIONAL, (*series.remarks, reason), False, diagram)
    poles = realisation.poles(diagram.order)
    chosen = np.flatnonzero(diagram.chosen[diagram.orders == diagram.order])
    spread = _left_out(covariances, rate, diagram.order, poles, chosen)
    modes, lines = _modes(poles, chosen, spread, damping, maximum)
    trouble = [*series.remarks]
    trouble += [f"the line at {line:.4g} Hz does not decay: a motor, a fan or the mains, not a mode." for line in lines]
    if not modes:
        trouble.append("no resonance is known well enough: record longer, or shake more.")
    elif (worst := _widest(modes)) > LONG_ENOUGH and damping is None:
        longer = series.duration * (worst / WISHED) ** 2
        trouble.append(
            f"damping ratios are known to {100.0 * worst:.0f} % only: about {longer:.2g} s of record would give "
            f"{100.0 * WISHED:.0f} %."
        )
    inside = summed.frequencies < 0.5 * rate
    fitted = nothing.copy()
    fitted[inside] = realisation.density(diagram.order, covariances.mean()[0], scale**2, summed.frequencies[inside])
    return Identification(modes, summed, fitted, OPERATIONAL, tuple(trouble), bool(modes), diagram)


def _thinned(series: TimeSeries) -> tuple[_Array, float, _Array]:
    """Values at a rate that suits their frequencies, of deviation 1; the rate [Hz]; the scale of each channel."""
    values = series.values - series.values.mean(axis=-1, keepdims=True)
    samples = values.shape[-1]
    rate = min(RATE * highest_power(series), series.sample_rate)
    kept = int(samples * rate / series.sample_rate)
    if kept < samples:
        # Cut off above half the new rate, by the transform of the whole: nothing folds back.
        values = np.fft.irfft(np.fft.rfft(values, axis=-1)[:, : kept // 2 + 1], kept, axis=-1) * (kept / samples)
        rate = series.sample_rate * kept / samples
    scale = values.std(axis=-1)
    alive = scale > DEAD * scale.max()
    return values[alive] / scale[alive, None], rate, np.asarray(scale[alive], dtype=np.float64)


def _left_out(covariances: Covariances, rate: float, order: int, whole: Poles, chosen: NDArray[np.intp]) -> _Spread:
    """Deviations of the chosen poles by the jackknife."""
    found = np.full((2, BLOCKS, chosen.size), np.nan)
    for block in range(BLOCKS):
        poles = Realisation(covariances.mean(block), covariances.rows, rate, order).poles(order)
        for column, pole in enumerate(chosen):
            distance = np.hypot(np.log(poles.natural / whole.natural[pole]), poles.damping - whole.damping[pole])
            alike = np.abs(poles.shapes.conj() @ whole.shapes[pole]) ** 2 > SAME_SHAPE
            fits = np.flatnonzero((distance < SAME_FREQUENCY) & alike & (poles.damping > 0.0))
            if fits.size:
                near = fits[int(np.argmin(distance[fits]))]
                found[:, block, column] = np.log(poles.natural[near]), np.log(poles.damping[near])
    there = np.sum(np.isfinite(found[0]), axis=0)
    centre = np.nansum(found, axis=1) / np.maximum(there, 1)
    squares = np.nansum((found - centre[:, None, :]) ** 2, axis=1)
    deviation = np.sqrt((BLOCKS - 1) * squares / np.maximum(there, 1))
    return _Spread(deviation[0], deviation[1], 1.0 - there / BLOCKS)


def _modes(
    poles: Poles, chosen: NDArray[np.intp], spread: _Spread, fixed: float | None, maximum: int
) -> tuple[tuple[IdentifiedMode, ...], tuple[float, ...]]:
    """The resonances, the strongest first, and the frequencies [Hz] of lines that do not decay."""
    power = np.maximum(poles.power[chosen], 0.0)
    share = power / max(float(np.maximum(poles.power, 0.0).sum()), np.finfo(float).tiny)
    found: list[tuple[int, IdentifiedMode]] = []
    lines = []
    for column in np.argsort(share)[::-1]:
        pole = chosen[column]
        frequency, ratio = float(poles.natural[pole]), float(poles.damping[pole])
        wide, deep = STUDENT_95 * float(spread.frequency[column]), STUDENT_95 * float(spread.damping[column])
        if share[column] < SMALLEST_SHARE or wide > WIDEST_INTERVAL or spread.missing[column] > MOST_MISSING:
            continue
        if ratio < LINE_DAMPING:
            lines.append(frequency)
            continue
        if deep > DEEPEST:
            continue
        grown, deeper = float(np.exp(wide)), float(np.exp(min(deep, 20.0)))
        if any(_one(poles, pole, other, grown * float(np.exp(0.5 * np.diff(np.log(mode.frequency_interval))[0])))
               for other, mode in found):  # fmt: skip
            continue
        ratios = (ratio / deeper, min(ratio * deeper, 1.0)) if fixed is None else (fixed, fixed)
        found.append(
            (
                int(pole),
                IdentifiedMode(
                    Mode(frequency, ratio if fixed is None else fixed),
                    (frequency / grown, frequency * grown),
                    ratios,
                    float(share[column]),
                ),
            )
        )
    return tuple(mode for _, mode in found[:maximum]), tuple(lines)


def _one(poles: Poles, first: int, second: int, apart: float) -> bool:
    """Whether two poles are one mode that the model has split: nearer than their intervals, shapes alike."""
    near = abs(np.log(poles.natural[first] / poles.natural[second])) < np.log(apart)
    return bool(near and np.abs(poles.shapes[first].conj() @ poles.shapes[second]) ** 2 > SAME_SHAPE)


def _widest(modes: tuple[IdentifiedMode, ...]) -> float:
    """The widest relative half-width of the damping ratios' intervals."""
    return max(0.5 * (mode.damping_interval[1] - mode.damping_interval[0]) / mode.mode.damping for mode in modes)
