"""Modes from a sweep whose command is known: the frequency response, and the spectrum where that fails."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from preshape.identify import klipper_raw
from preshape.identify.frequency_response import noise_of
from preshape.identify.identification import FREQUENCY_RESPONSE, Identification, IdentifiedMode, mode_of_logarithms
from preshape.identify.klipper_sweep import Sweep
from preshape.identify.measurement import Spectrum, TimeSeries
from preshape.identify.response_fit import WIDEST_INTERVAL, ResponseFit, fit_response
from preshape.identify.spectral_model import transmissibility
from preshape.identify.spectrum_modes import SMALLEST_SHARE, modes_of_spectrum
from preshape.identify.sweep_alignment import Alignment, align
from preshape.identify.uncertainty import NORMAL_95
from preshape.identify.welch import spectrum
from preshape.mode import Mode

__all__ = ["modes_of_sweep"]

LEAST_SHARP = 0.15
"""Part of the impulse response's energy at its peak below which command and record do not belong together."""

LARGEST_MISFIT = 0.35
"""Part of the response (root of power) that modes may leave before their spectrum is the better witness."""

NOTED_MISFIT = 0.12
"""Part of the response (root of power) left by the modes from which on it is said."""

LARGEST_DAMPING = 0.35
"""Above, a fitted mode is a slope of the background, no resonance."""

_Array = NDArray[np.float64]


def modes_of_sweep(series: TimeSeries, sweep: Sweep | None, damping: float | None, maximum: int) -> Identification:
    """Fit modes to the response to a sweep.

    Parameters
    ----------
    series : TimeSeries
        The record of a sweep.
    sweep : Sweep, optional
        What was commanded; found in the record unless given.
    damping : float, optional
        Fixes all damping ratios.
    maximum : int
        Largest number of modes.
    """
    seen = modes_of_spectrum(spectrum(series), damping, maximum)
    if not seen.modes:
        return seen
    if any(remark.startswith(klipper_raw.LOST) for remark in series.remarks):
        return _by_spectrum(seen, "with samples missing, command and response drift apart")
    laid = align(series, sweep)
    if laid is None or laid.sharpness < LEAST_SHARP:
        return _by_spectrum(seen, "no evenly rising sweep was found in the record")
    natural = np.array([mode.mode.frequency for mode in seen.modes])
    within = (natural > laid.frequencies[0]) & (natural < laid.frequencies[-1])
    if not within.any():
        end = laid.sweep.highest
        return replace(
            _by_spectrum(seen, f"the sweep in the record ends at {end:.0f} Hz, below all modes"), clear=False
        )
    ratio = np.array([mode.mode.damping for mode in seen.modes])
    fit = fit_response(laid, natural[within], ratio[within], maximum=maximum, damping=damping)
    modes = _modes(fit, maximum, damping)
    if not modes:
        return _by_spectrum(seen, "the response to the sweep shows no mode well enough")
    if fit.misfit > LARGEST_MISFIT:
        return _by_spectrum(seen, f"the modes explain the response to the sweep only to {_explained(fit)}")
    trouble = seen.trouble
    if fit.misfit > NOTED_MISFIT:
        trouble = (
            *trouble,
            f"the modes explain the response to the sweep only to {_explained(fit)}: the machine rattles or is not "
            "linear, and the intervals are wider for it.",
        )
    return Identification(
        modes, seen.spectrum, _density(laid, fit, seen.spectrum), FREQUENCY_RESPONSE, trouble, seen.clear
    )


def _explained(fit: ResponseFit) -> str:
    return f"{100.0 * (1.0 - min(fit.misfit, 1.0)):.0f} %"


def _by_spectrum(seen: Identification, reason: str) -> Identification:
    """The spectrum's modes, and why not the response's."""
    note = f"{reason}: the modes come from the spectrum alone, which does not tell close modes apart."
    return replace(seen, trouble=(*seen.trouble, note))


def _modes(fit: ResponseFit, maximum: int, fixed: float | None) -> tuple[IdentifiedMode, ...]:
    """The resonances among the fitted modes, the strongest first. Intervals are symmetric in the logarithm."""
    width = fit.natural**2 * (1.0 + 4.0 * fit.damping**2) / fit.damping
    energy = np.sum(fit.gains**2, axis=0) * width  # of |g T|^2 f, Klipper's normalisation
    count = fit.natural.size
    half = NORMAL_95 * np.sqrt(np.diag(fit.covariance))
    good = (half[:count] < WIDEST_INTERVAL) & (fit.damping < LARGEST_DAMPING)
    share = np.where(good, energy, 0.0) / max(float(energy[good].sum()), np.finfo(float).tiny)
    found = []
    for j in np.flatnonzero(good & (share >= SMALLEST_SHARE)):
        frequency, ratio = float(fit.natural[j]), float(fit.damping[j]) if fixed is None else fixed
        found.append(
            mode_of_logarithms(Mode(frequency, ratio), float(half[j]), float(half[count + j]), float(share[j]))
        )
    return tuple(sorted(found, key=lambda mode: -mode.share)[:maximum])


def _density(laid: Alignment, fit: ResponseFit, measured: Spectrum) -> _Array:
    """What the fit makes of the measured spectrum, seen through the same window; NaN outside the sweep."""
    from scipy.signal import welch

    modal, _, _ = transmissibility(laid.frequencies, fit.natural, fit.damping)
    relative = laid.frequencies / fit.response.frequencies[-1]  # the model of response_fit, line by line
    basis = np.concatenate([modal, np.ones((1, modal.shape[-1])), (relative**2)[None, :]])
    step = float(laid.frequencies[1] - laid.frequencies[0])
    first = round(laid.frequencies[0] / step)
    # Transforms up to the end of the sweep alone are those of a record with fewer samples a second.
    lines = np.zeros((len(fit.gains), first + laid.frequencies.size + 1), dtype=np.complex128)
    lines[:, first:-1] = np.concatenate([fit.gains, fit.background], axis=-1) @ basis * laid.command
    samples = 2 * (lines.shape[-1] - 1)
    motion = np.fft.irfft(lines, samples, axis=-1)
    rate = samples * step
    length = max(round(measured.window_duration * rate), 16)
    # The transforms are sums over the samples of the record, so the values are too large by the ratio of the rates.
    scale = samples / laid.samples
    frequencies, density = welch(
        motion * scale, rate, ("kaiser", 6.0), length, length // 2, detrend="constant", axis=-1
    )
    noise = 2.0 * noise_of(laid).sum(axis=0) * step / (laid.samples * step) ** 2
    total = np.interp(measured.frequencies, frequencies, density.sum(axis=0))
    total += np.interp(measured.frequencies, laid.frequencies, noise)
    inside = (measured.frequencies >= laid.frequencies[0]) & (measured.frequencies <= laid.frequencies[-1])
    return np.where(inside, total, np.nan)
