"""Modes from a spectrum: base-driven modes that add coherently, seen through the window, fitted to the logarithm.

An averaged periodogram has noise in proportion to its value, so its logarithm has the same noise everywhere and plain
least squares is the right measure. Modes are added one by one where the fit is worst, as long as the Bayesian
information criterion falls (G. Schwarz, Annals of Statistics 6 (1978) 461-464).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from preshape.identify import uncertainty
from preshape.identify.spectral_model import SpectralModel
from preshape.identify.uncertainty import NORMAL_95

__all__ = ["BACKGROUND_DAMPING", "WIDEST_INTERVAL", "SpectrumFit", "fit_modes"]

DAMPING_BOUNDS = (0.002, 0.5)
"""Damping ratios that a spectrum can show; below, the window hides the width, above there is no peak."""

BACKGROUND_DAMPING = 0.3
"""From this damping ratio on a fitted mode is a slope of the background, no resonance."""

FIRST_DAMPING = 0.05
TRIAL_STEPS = 12
FINAL_STEPS = 60
"""Evaluations of the model in a trial start and in the fit that continues the best of them."""

TRIAL_PLACES = 3
"""Frequencies at which a further mode is tried."""

BINS_PER_FREEDOM = 2.0
"""Neighbouring bins overlap: this many of them count as one independent value."""

LOWEST_FLOOR = 1e-9
"""Lowest floor that is considered, relative to the highest density; it keeps the logarithm finite."""

INSIGNIFICANT = 0.005
"""Density below this part of the highest (after division by the frequency) is blurred: what is there does not
shake the machine, and must not cost the peaks their accuracy."""

MODEL_ERROR = 0.02
"""Relative error that the model is allowed anyway: no mode is added to explain less, no interval is narrower for it."""

WIDEST_INTERVAL = 0.15
"""A fit in which a natural frequency is known worse than by this relative half-width (95 %) has a mode too many."""

_Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class SpectrumFit:
    """A fitted sum of modes.

    Attributes
    ----------
    natural, damping, gains : ndarray, shape (mode,)
        Undamped natural frequencies [Hz], damping ratios, real gains.
    covariance : ndarray, shape (2 * mode, 2 * mode)
        Of the logarithms of natural frequencies, then of damping ratios.
    density : ndarray, shape (frequency,)
        The fitted curve, in the unit of the spectrum.
    misfit : float
        Root mean square of log(measured / fitted).
    criterion : float
        Bayesian information criterion; lower is better.
    """

    natural: _Array
    damping: _Array
    gains: _Array
    covariance: _Array
    density: _Array
    misfit: float
    criterion: float

    @property
    def uncertain(self) -> bool:
        """Whether some peak is not determined by the data (two modes that cancel each other, say)."""
        deviations = np.sqrt(np.diag(self.covariance)[: self.natural.size])
        return bool(np.any((NORMAL_95 * deviations > WIDEST_INTERVAL) & (self.damping < BACKGROUND_DAMPING)))


class _Problem:
    """The least-squares problem for a number of modes: unknowns and their bounds, residuals, Jacobian.

    Unknowns: log natural frequencies, log damping ratios (absent when fixed), gains, direct, log floor.
    """

    def __init__(self, model: SpectralModel, density: _Array, count: int, fixed: float | None) -> None:
        self.model = model
        self.scale = float(density.max())
        relative = model.frequencies / model.frequencies[-1]
        flat = density / self.scale / relative ** min(model.exponent, 1.0)
        self.ignored = INSIGNIFICANT * float(flat.max()) * relative ** min(model.exponent, 1.0)
        self.measured = np.log(density / self.scale + self.ignored)
        self.count = count
        self.fixed = fixed
        self._last: tuple[bytes, _Array, _Array] | None = None
        low, high = model.frequencies[0], model.frequencies[-1]
        free = np.full(count, np.inf)
        damping = [] if fixed is not None else [np.full(count, np.log(bound)) for bound in DAMPING_BOUNDS]
        self.lower = np.concatenate([np.full(count, np.log(low)), *damping[:1], -free, [-np.inf, np.log(LOWEST_FLOOR)]])
        self.upper = np.concatenate([np.full(count, np.log(high)), *damping[1:], free, [np.inf, 0.0]])

    def parts(self, unknowns: _Array) -> tuple[_Array, _Array, _Array, float, float]:
        """Natural frequencies, damping ratios, gains, direct, floor."""
        n = self.count
        natural = np.exp(unknowns[:n])
        damping = np.full(n, self.fixed) if self.fixed is not None else np.exp(unknowns[n : 2 * n])
        return natural, damping, unknowns[-n - 2 : -2], float(unknowns[-2]), float(np.exp(unknowns[-1]))

    def _evaluate(self, unknowns: _Array) -> tuple[_Array, _Array]:
        key = unknowns.tobytes()
        if self._last is None or self._last[0] != key:
            natural, damping, gains, direct, floor = self.parts(unknowns)
            density, slopes = self.model.density(natural, damping, gains, direct, floor)
            n = self.count
            slopes[n : 2 * n] *= damping[:, None]
            slopes[-1] *= floor
            if self.fixed is not None:
                slopes = np.delete(slopes, np.s_[n : 2 * n], axis=0)
            self._last = key, density, slopes
        return self._last[1], self._last[2]

    def residual(self, unknowns: _Array) -> _Array:
        return np.asarray(np.log(self._evaluate(unknowns)[0] + self.ignored) - self.measured)

    def jacobian(self, unknowns: _Array) -> _Array:
        density, slopes = self._evaluate(unknowns)
        return np.asarray((slopes / (density + self.ignored)).T)

    def solve(self, start: _Array, steps: int) -> tuple[_Array, float]:
        """The best unknowns from a start, and half the sum of squared residuals."""
        from scipy.optimize import least_squares

        inside = np.clip(start, self.lower + 1e-9, self.upper - 1e-9)
        result = least_squares(
            self.residual, inside, self.jacobian, bounds=(self.lower, self.upper), x_scale="jac", max_nfev=steps
        )
        return result.x, float(result.cost)


def fit_modes(
    model: SpectralModel, density: _Array, *, maximum: int, damping: float | None = None
) -> list[SpectrumFit]:
    """The best fits with 1, 2, ... up to `maximum` modes, as long as more modes are worth it; the last is the choice.

    Parameters
    ----------
    model : SpectralModel
        Frequencies, window and excitation of the spectrum.
    density : ndarray, shape (frequency,)
        Measured density at the frequencies of the model, above zero somewhere.
    maximum : int
        Largest number of modes.
    damping : float, optional
        Fixes all damping ratios.
    """
    fits: list[SpectrumFit] = []
    best: _Array | None = None
    if damping is not None:
        damping = max(damping, DAMPING_BOUNDS[0])  # a spectrum cannot tell less, and the model has a pole at 0
    for count in range(1, maximum + 1):
        problem = _Problem(model, density, count, damping)
        trials = [problem.solve(start, TRIAL_STEPS) for start in _starts(problem, best)]
        best, _ = problem.solve(min(trials, key=lambda trial: trial[1])[0], FINAL_STEPS)
        fit = _summary(problem, best)
        if fits and fit.criterion >= fits[-1].criterion:
            break
        if not fits or not fit.uncertain:  # an uncertain fit may still lead to a good one with a mode more
            fits.append(fit)
    return fits


def _starts(problem: _Problem, best: _Array | None) -> Iterator[_Array]:
    """Starting values: the best fit with one mode fewer, and a mode more where the measurement stands above it."""
    frequencies, exponent = problem.model.frequencies, problem.model.exponent
    fixed = problem.fixed is not None
    if best is None:
        flat = problem.measured - exponent * np.log(frequencies)
        level = float(np.exp(0.5 * (np.median(flat) + exponent * np.log(frequencies[-1]))))
        for place in _highest(flat):
            damping = [] if fixed else [np.log(FIRST_DAMPING)]
            yield np.array([np.log(frequencies[place]), *damping, level, 0.0, np.log(1e-6)])
        return
    n = problem.count - 1
    blocks = [best[:n], *([] if fixed else [best[n : 2 * n]]), best[-n - 2 : -2]]
    smaller = _Problem(problem.model, np.exp(problem.measured) * problem.scale, n, problem.fixed)
    excess = -smaller.residual(best)
    gain = 0.2 * float(np.max(np.abs(blocks[-1])))
    for place, sign in product(_highest(excess), (1.0, -1.0)):
        added = [np.log(frequencies[place]), *([] if fixed else [np.log(FIRST_DAMPING)]), sign * gain]
        yield np.concatenate([*(np.append(block, new) for block, new in zip(blocks, added, strict=True)), best[-2:]])


def _highest(curve: _Array) -> _Array:
    """Indices of the highest local maxima, the highest first."""
    padded = np.concatenate([[-np.inf], curve, [-np.inf]])
    peaks = np.flatnonzero((curve >= padded[:-2]) & (curve >= padded[2:]))
    return np.asarray(peaks[np.argsort(curve[peaks])[::-1]][:TRIAL_PLACES])


def _summary(problem: _Problem, unknowns: _Array) -> SpectrumFit:
    """Covariance by the Jacobian at the solution, curve and criterion."""
    residual, jacobian = problem.residual(unknowns), problem.jacobian(unknowns)
    natural, damping, gains, direct, floor = problem.parts(unknowns)
    freedoms = residual.size / BINS_PER_FREEDOM
    square = float(residual @ residual) / residual.size
    variance = (square + MODEL_ERROR**2) * freedoms / max(freedoms - unknowns.size, 1.0) * BINS_PER_FREEDOM
    full = uncertainty.covariance(jacobian, variance)
    n = problem.count
    covariance = np.zeros((2 * n, 2 * n))
    known = 2 * n if problem.fixed is None else n
    covariance[:known, :known] = full[:known, :known]
    order = np.argsort(natural)
    both = np.concatenate([order, order + n])
    return SpectrumFit(
        natural[order],
        damping[order],
        gains[order],
        covariance[np.ix_(both, both)],
        problem.scale * problem.model.density(natural, damping, gains, direct, floor)[0],
        float(np.sqrt(square)),
        freedoms * float(np.log(square + MODEL_ERROR**2)) + unknowns.size * float(np.log(freedoms)),
    )
