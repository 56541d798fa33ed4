"""Modes from a free decay."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError, MeasurementError
from preshape.identify.decaying_sinusoids import DecayFit, Subspace, fit_decay
from preshape.identify.free_decay import FreeDecay, find_free_decay
from preshape.identify.identification import RING_DOWN, Identification, IdentifiedMode
from preshape.identify.measurement import Spectrum, TimeSeries
from preshape.identify.uncertainty import NORMAL_95
from preshape.mode import Mode

__all__ = ["check_wishes", "ring_down"]

FEWEST_SAMPLES = 32
EXTRA_COMPONENTS = 3
"""Components beyond the modes that are asked for: lines of motors and fans, slow drifts."""

PATIENCE = 3
"""So many fits in a row that are not better end the search for more components."""

LARGEST_DAMPING = 0.4
"""Above, a component is a drift or the end of the move, not a resonance."""

SMALLEST_SHARE = 0.02
"""Components with less of the energy are not reported: they do not matter, and noise makes some."""

WIDEST_INTERVAL = 0.05
"""Components whose natural frequency is known worse than by this relative half-width (95 %) are not reported."""

LEAST_EXPLAINED = 0.5
"""Part of the energy that decaying sinusoids must explain for the record to count as a ring-down."""

LEAST_HELD = 0.5
"""Part of the energy that the reported modes must hold for the result to be clear."""

FEWEST_PERIODS = 1.5
SPACING = 1.0
"""Spacing of the frequencies at which the spectrum of a ring-down is given [Hz], at most."""

_Array = NDArray[np.float64]


def check_wishes(damping: float | None, maximum: int) -> None:
    """Raise InputError unless the damping ratio and the number of modes make sense."""
    if damping is not None and not 0.0 <= damping < 1.0:
        raise InputError(
            f"damping {damping!r} is outside [0, 1): give a damping ratio such as 0.05, or None to fit it."
        )
    if isinstance(maximum, bool) or not isinstance(maximum, int) or maximum < 1:
        raise InputError(f"maximum {maximum!r} is not a number of modes: give an integer of at least 1.")


def ring_down(time_series: TimeSeries, *, damping: float | None = None, maximum: int = 4) -> Identification:
    """Find the modes in a record that ends with a free decay.

    The free part is found by itself: the earliest start from which decaying sinusoids, common to all channels,
    explain the record to its end. Their number is chosen by the Bayesian information criterion. What does not decay
    (the interval of its damping ratio holds 0) is a line of a motor or fan, and not a mode.

    Parameters
    ----------
    time_series : TimeSeries
        At least 32 samples. Gravity and other offsets may stay in.
    damping : float, optional
        Fixes all damping ratios instead of fitting them.
    maximum : int
        Largest number of modes to report.

    Returns
    -------
    Identification
        Without modes, and with the reason in `trouble`, when there is no free decay.

    Raises
    ------
    MeasurementError
        If the record is too short or constant.
    InputError
        If `damping` or `maximum` make no sense.

    Notes
    -----
    On decaying cosines 40 dB above white noise, frequencies are right within 0.2 % and damping ratios within 3 % for
    damping ratios of 0.005 to 0.1, one mode or two that are 25 % apart; errors are within 25 % of the Cramer-Rao bound,
    which no unbiased estimate beats. At a damping ratio of 0.15 that bound lets frequency errors reach 0.5 % for two
    modes, or one sampled below 1 kHz. It fails on records shorter than about two periods; modes closer than z f / 2
    merge; a mode with less than 2 % of the energy is left out; at 10 dB most modes with a damping ratio of 0.05 or more
    are lost.

    References
    ----------
    Y. Hua & T. Sarkar, IEEE Trans. Acoust. Speech Signal Process. 38 (1990) 814-824 (matrix pencil);
    G. Golub & V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413-432 (variable projection).

    Examples
    --------
    >>> import numpy as np
    >>> times = np.arange(1000) / 1000.0
    >>> decay = np.exp(-0.05 * 2 * np.pi * 40.0 * times) * np.cos(2 * np.pi * 40.0 * np.sqrt(1 - 0.05**2) * times)
    >>> noise = 0.01 * np.random.default_rng(1).normal(size=1000)
    >>> found = ring_down(TimeSeries(1000.0, 0.0, (decay + noise)[None, :], ("x",)))
    >>> [round(float(found.modes[0].mode.frequency), 1), round(float(found.modes[0].mode.damping), 3)]
    [40.0, 0.05]
    """
    check_wishes(damping, maximum)
    samples = time_series.values.shape[-1]
    name = time_series.source or "the time series"
    if samples < FEWEST_SAMPLES:
        raise MeasurementError(
            f"{name}: {samples} samples are too few to find modes; record at least {FEWEST_SAMPLES}."
        )
    if not np.any(np.ptp(time_series.values, axis=-1) > 0.0):
        raise MeasurementError(
            f"{name}: all samples are the same; check that the accelerometer works and record again."
        )
    decay = find_free_decay(time_series, maximum)
    fit = None if decay is None else _best_fit(decay, maximum, damping)
    trouble: tuple[str, ...] = ()
    if decay is None or fit is None:
        trouble = ("no free decay was found in the record: it is too short, or nothing rings at its end.",)
        spectrum = Spectrum(np.array([0.0, 1.0]), np.zeros((1, 2)), ("sum",), source=time_series.source)
        return Identification((), spectrum, np.full(2, np.nan), RING_DOWN, (*time_series.remarks, *trouble), False)
    modes = _modes(decay, fit, maximum, damping)
    explained = 1.0 - float(np.sum((decay.values - fit.curve) ** 2) / np.sum(decay.values**2))
    if explained < LEAST_EXPLAINED:
        trouble = (
            f"no free decay was found in the record: decaying sinusoids explain only {100.0 * explained:.0f} % of it.",
        )
    elif not modes:
        trouble = ("no free decay was found in the record: nothing in it decays as a structure does.",)
    elif (held := sum(mode.share for mode in modes)) < LEAST_HELD:
        trouble = (
            f"the modes hold only {100.0 * held:.0f} % of the vibration after the stop: the rest is drift or "
            "lines of motors, so measure with a sharper stop.",
        )
    return Identification(
        modes if explained >= LEAST_EXPLAINED else (),
        _energy_spectrum(decay, decay.values, time_series),
        _energy_spectrum(decay, fit.curve, time_series).total,
        RING_DOWN,
        (*time_series.remarks, *trouble),
        not trouble,
    )


def _best_fit(decay: FreeDecay, maximum: int, damping: float | None) -> DecayFit | None:
    """The fit whose number of components the information criterion prefers."""
    subspace = Subspace(decay.values, decay.rate)
    best: DecayFit | None = None
    tried: set[int] = set()
    worse = 0
    for count in range(1, maximum + EXTRA_COMPONENTS + 1):
        natural, ratio = subspace.poles(2 * count + 1)
        if not natural.size or natural.size in tried or 2 * natural.size + 1 >= decay.values.shape[-1] // 2:
            continue
        tried.add(natural.size)
        fit = fit_decay(decay.values, decay.rate, natural, ratio, fixed=damping)
        if best is None or (fit.criterion < best.criterion and not _crowded(fit)):
            best, worse = fit, 0
        else:
            worse += 1
        if worse == PATIENCE:
            break
    return best


def _crowded(fit: DecayFit) -> bool:
    """Whether two components are not told apart by the data."""
    half = NORMAL_95 * np.sqrt(np.diag(fit.covariance)[: fit.natural.size])
    return bool(np.any(np.diff(fit.natural) < half[:-1] + half[1:]))


def _modes(decay: FreeDecay, fit: DecayFit, maximum: int, fixed: float | None) -> tuple[IdentifiedMode, ...]:
    """The components that are structural, the strongest first."""
    count = fit.natural.size
    half = NORMAL_95 * np.sqrt(decay.noise_factor * np.diag(fit.covariance))
    duration = decay.values.shape[-1] / decay.rate
    share = fit.energy / max(float(fit.energy.sum()), np.finfo(float).tiny)
    found = []
    for j in range(count):
        frequency, ratio = float(fit.natural[j]), float(fit.damping[j])
        spread, ratio_spread = float(half[j]), float(half[count + j])
        decays = fixed is not None or 0.0 < ratio - ratio_spread
        within = decay.band[0] <= frequency <= decay.band[1] and frequency * duration >= FEWEST_PERIODS
        known = spread < WIDEST_INTERVAL * frequency and share[j] >= SMALLEST_SHARE
        if decays and within and known and ratio < LARGEST_DAMPING:
            found.append(
                IdentifiedMode(
                    Mode(frequency, max(ratio, 0.0)),
                    (frequency - spread, frequency + spread),
                    (max(ratio - ratio_spread, 0.0), min(ratio + ratio_spread, 1.0)),
                    float(share[j]),
                )
            )
    return tuple(sorted(found, key=lambda mode: -mode.share)[:maximum])


def _energy_spectrum(decay: FreeDecay, values: _Array, series: TimeSeries) -> Spectrum:
    """One-sided density of a decay, padded with zeros to a smooth curve, summed over the channels."""
    samples = values.shape[-1]
    length = 1 << int(np.ceil(np.log2(max(samples, decay.rate / SPACING))))
    power: _Array = np.abs(np.fft.rfft(values, length, axis=-1)) ** 2 / (decay.rate * samples)
    power[:, 1:-1] *= 2.0
    return Spectrum(
        np.arange(length // 2 + 1, dtype=np.float64) * (decay.rate / length),
        np.asarray(power.sum(axis=0)[None, :], dtype=np.float64),
        ("sum",),
        unit=f"({series.unit})^2/Hz" if series.unit else "",
        window_duration=samples / decay.rate,
        source=series.source,
        format=series.format,
    )
