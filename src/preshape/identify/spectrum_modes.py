"""Modes from a spectrum, and what its shape says about the machine."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.errors import MeasurementError
from preshape.identify import rrf_capture
from preshape.identify.free_decay import PRINTER_BAND
from preshape.identify.identification import SPECTRUM_FIT, Identification, IdentifiedMode, mode_of_logarithms
from preshape.identify.measurement import Spectrum
from preshape.identify.spectral_model import SpectralModel
from preshape.identify.spectrum_fit import BACKGROUND_DAMPING, WIDEST_INTERVAL, SpectrumFit, fit_modes
from preshape.identify.uncertainty import NORMAL_95
from preshape.mode import Mode

__all__ = ["modes_of_spectrum"]

SWEPT_PART = 2.0 / 3.0
"""Klipper writes spectra up to 1.5 times the end of its sweep; above that end nothing was excited."""

EDGE_BINS = 2.5
"""Bins by which the band stays below the end of the sweep: the window smears the edge so far."""

POWER_FLOOR = 1e-3
POWER_MARGIN = 1.5
"""Where the excitation is unknown, the band ends at so many times the highest frequency with so much of the power."""

FEWEST_BINS = 16
MOST_BINS = 400
"""Least number of spectral values for a fit, and the number to which more are thinned."""

SMALLEST_SHARE = 0.05
"""Modes with less of the energy are not reported (Klipper's scoring ignores as much)."""

PEAK_HEIGHT = 0.05
PEAK_PROMINENCE = 1.25
"""A peak counts when it is above this part of the highest and stands out by this factor."""

TOO_MANY_PEAKS = 6
TOO_BROAD = 0.18
"""A mode with a large share and at least this damping ratio is no single resonance."""

LARGE_SHARE = 0.3
POOR_MISFIT = 0.25
"""Root mean square of log(measured / fitted) above which the modes do not describe the spectrum."""

CLEAR_PEAK = 4.0
"""A resonance stands out of the median of the band at least by this factor."""

_Array = NDArray[np.float64]


def modes_of_spectrum(spectrum: Spectrum, damping: float | None, maximum: int) -> Identification:
    """Fit modes to the density summed over the channels, inside the band that can be trusted.

    The sum is used, not the strongest axis: on the real files its fits are steadier, because modes that move between
    axes stay whole, and on simulated machines the bias is below 3 % of the damping ratio.
    """
    name = spectrum.source or "the spectrum"
    summed = spectrum.total
    inside = _band(spectrum)
    if np.count_nonzero(inside) < FEWEST_BINS:
        raise MeasurementError(
            f"{name}: only {np.count_nonzero(inside)} spectral values lie in the band where modes can be found; "
            f"at least {FEWEST_BINS} are needed, so measure longer."
        )
    if not np.any(summed[inside] > 0.0):
        raise MeasurementError(
            f"{name}: the spectrum is zero everywhere; check that the accelerometer works and record again."
        )
    picked = np.flatnonzero(inside)
    picked = picked[:: -(-picked.size // MOST_BINS)]
    model = SpectralModel(spectrum.frequencies[picked], spectrum.window_duration, spectrum.excitation_exponent)
    fits = fit_modes(model, summed[picked], maximum=maximum, damping=damping)
    fit = fits[-1]
    share = _shares(fit, spectrum.excitation_exponent)
    modes = _modes(fit, share, maximum, damping)
    fitted = np.full(summed.shape, np.nan)
    fitted[picked[0] : picked[-1] + 1] = np.interp(
        spectrum.frequencies[picked[0] : picked[-1] + 1], spectrum.frequencies[picked], fit.density
    )
    trouble = _trouble(spectrum, inside, fit, share, modes)
    whole = Spectrum(
        spectrum.frequencies,
        summed[None, :],
        ("sum",),
        spectrum.unit,
        spectrum.normalised,
        spectrum.window_duration,
        spectrum.excitation_exponent,
        spectrum.source,
        spectrum.format,
    )
    return Identification(modes, whole, fitted, SPECTRUM_FIT, (*spectrum.remarks, *trouble), not trouble)


def _band(spectrum: Spectrum) -> NDArray[np.bool_]:
    """Which frequencies were excited and can be trusted."""
    frequencies = spectrum.frequencies
    if spectrum.excitation_exponent > 0.0:
        # Raw data reach half the sample rate, far above any sweep; spectra in files end at 1.5 times the sweep.
        low, high = PRINTER_BAND[0], SWEPT_PART * frequencies[-1] - EDGE_BINS / spectrum.window_duration
        high = min(high, PRINTER_BAND[1]) if frequencies[-1] > 5.0 * PRINTER_BAND[1] else high
    else:
        powerful = np.flatnonzero(spectrum.total > POWER_FLOOR * spectrum.total.max())
        highest = frequencies[powerful[-1]] if powerful.size else frequencies[-1]
        low, high = 3.0 / spectrum.window_duration, min(0.9 * frequencies[-1], POWER_MARGIN * highest)
        if spectrum.format == rrf_capture.FORMAT:
            low, high = max(low, PRINTER_BAND[0]), min(high, PRINTER_BAND[1])
    return np.asarray((frequencies >= low) & (frequencies <= high))


def _shares(fit: SpectrumFit, exponent: float) -> _Array:
    """Energy of each mode's resonance alone, the integral of |g T|^2 f^p, as a part of their sum, shape (mode,).

    Klipper's normalisation (p = 1) is the common measure for its spectra, whichever kind the file holds.
    """
    width = fit.natural * (1.0 + 4.0 * fit.damping**2) / fit.damping
    energy = fit.gains**2 * width * fit.natural ** min(exponent, 1.0)
    return np.asarray(energy / max(float(energy.sum()), np.finfo(float).tiny))


def _modes(fit: SpectrumFit, share: _Array, maximum: int, fixed: float | None) -> tuple[IdentifiedMode, ...]:
    """The resonances among the fitted modes, the strongest first. Intervals are symmetric in the logarithm."""
    deviation = NORMAL_95 * np.sqrt(np.diag(fit.covariance))
    count = fit.natural.size
    found = []
    for j in range(count):
        frequency, ratio = float(fit.natural[j]), float(fit.damping[j]) if fixed is None else fixed
        if share[j] < SMALLEST_SHARE or deviation[j] > WIDEST_INTERVAL:
            continue
        if fixed is None and ratio >= BACKGROUND_DAMPING:
            continue
        found.append(
            mode_of_logarithms(
                Mode(frequency, ratio), float(deviation[j]), float(deviation[count + j]), float(share[j])
            )
        )
    return tuple(sorted(found, key=lambda mode: -mode.share)[:maximum])


def _trouble(
    spectrum: Spectrum, inside: NDArray[np.bool_], fit: SpectrumFit, share: _Array, modes: tuple[IdentifiedMode, ...]
) -> tuple[str, ...]:
    """Sentences on mechanical trouble that the spectrum shows."""
    frequencies = spectrum.frequencies[inside]
    relative = frequencies ** max(spectrum.excitation_exponent - 1.0, 0.0)
    density = spectrum.total[inside] / relative
    peaks = _prominent(np.log(np.maximum(density, 1e-6 * density.max())), float(np.log(PEAK_PROMINENCE)))
    peaks = peaks[density[peaks] >= PEAK_HEIGHT * density.max()]
    sentences = []
    if peaks.size >= TOO_MANY_PEAKS:
        sentences.append(
            f"too many peaks ({peaks.size}): look for binding, a loose belt or screw, "
            "or something else that rattles, and measure again."
        )
    if not modes or density.max() < CLEAR_PEAK * float(np.median(density)):
        ratio = density.max() / max(float(np.median(density)), np.finfo(float).tiny)
        sentences.append(
            f"no clear peak: the highest value, at {frequencies[density.argmax()]:.0f} Hz, is {ratio:.1f} times "
            "the median of the band."
        )
    for j in np.flatnonzero((share >= LARGE_SHARE) & (fit.damping >= TOO_BROAD)):
        sentences.append(
            f"the hump around {fit.natural[j]:.0f} Hz is too broad for a resonance (damping {fit.damping[j]:.2f}): "
            "look for friction, binding or several modes in one."
        )
    if fit.misfit > POOR_MISFIT:
        sentences.append(
            f"the modes describe the spectrum only to {100.0 * np.expm1(fit.misfit):.0f} %: "
            "the machine rattles or the sweep was disturbed."
        )
    return tuple(sentences)


def _prominent(curve: _Array, least: float) -> NDArray[np.intp]:
    """Local maxima that stand out by `least` of the higher of the two lowest points towards anything higher.

    As scipy.signal.find_peaks with a prominence, which would cost half a second at every start of the command line.
    """
    padded = np.concatenate([[-np.inf], curve, [-np.inf]])
    tops = np.flatnonzero((curve > padded[:-2]) & (curve >= padded[2:]))
    found = []
    for top in tops:
        higher = np.flatnonzero(curve > curve[top])
        left, right = higher[higher < top], higher[higher > top]
        before = curve[left[-1] : top].min() if left.size else -np.inf
        after = curve[top : right[0]].min() if right.size else -np.inf
        if curve[top] - max(before, after) >= least:
            found.append(int(top))
    return np.array(found, dtype=np.intp)
