"""Modes from a frequency response: base-driven modes with real gains in every channel, behind a smooth delay.

Gains are eliminated (variable projection, G. Golub & V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413-432; Jacobian as
L. Kaufman, BIT 15 (1975) 49-57), so natural frequencies, damping ratios and the delay are searched. Modes are added one
by one where the fit is worst, as long as the Bayesian information criterion falls.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.identify.frequency_response import FrequencyResponse, binned, noise_of
from preshape.identify.response_problem import DAMPING_BOUNDS, MODEL_ERROR, PHASES, ResponseProblem, poles_among
from preshape.identify.sweep_alignment import Alignment
from preshape.identify.uncertainty import NORMAL_95

__all__ = ["WIDEST_INTERVAL", "ResponseFit", "fit_response"]

FIRST_DAMPING = 0.03
TRIAL_PLACES = 3
"""Frequencies at which a further mode is tried."""

TRIAL_STEPS = 8
FINAL_STEPS = 40
"""Evaluations of the model in a trial and in the fit that continues the best of them."""

WIDEST_INTERVAL = 0.1
"""A fit in which a natural frequency is known worse than by this relative half-width (95 %) has a mode too many."""

CLUSTER = 2.0
"""Width [Hz] over which what the model does not explain is taken to hang together."""

SMOOTHED = 5
"""Bins over which the misfit is averaged before its highest places are looked for."""

CONSTANT_PHASES = 4
PHASE_STEP, PHASE_STEPS = 0.4, 20
"""Constant phases that are tried in half a turn; step of the delays as the phase at the end of
the band [rad], and number of steps on either side."""

_Array = NDArray[np.float64]
_Complex = NDArray[np.complex128]


@dataclass(frozen=True, eq=False)
class ResponseFit:
    """A fitted sum of modes.

    Attributes
    ----------
    natural, damping : ndarray, shape (mode,)
        Undamped natural frequencies [Hz], damping ratios.
    gains : ndarray, shape (channel, mode)
        Acceleration of the channel for one of the base, as far as it is this mode's.
    background : ndarray, shape (channel, 2)
        The same of modes above the band: its constant, and what grows with the square of f / (end of the band).
    covariance : ndarray, shape (2 * mode, 2 * mode)
        Of the logarithms of natural frequencies, then of damping ratios.
    response : FrequencyResponse
        What was fitted.
    values : ndarray, shape (channel, bin)
        The fitted curve.
    misfit : float
        What the model leaves of the response, root of the part of its power, noise taken off.
    """

    natural: _Array
    damping: _Array
    gains: _Array
    background: _Array
    covariance: _Array
    response: FrequencyResponse
    values: _Complex
    misfit: float


def fit_response(
    laid: Alignment, natural: _Array, ratio: _Array, *, maximum: int, damping: float | None = None
) -> ResponseFit:
    """Fit the modes that a spectrum shows, and those besides that the Bayesian information criterion asks for.

    Parameters
    ----------
    laid : Alignment
        A sweep over a record.
    natural, ratio : ndarray, shape (mode,)
        Where to begin: natural frequencies [Hz] and damping ratios, at least one.
    maximum : int
        Largest number of modes.
    damping : float, optional
        Fixes all damping ratios.
    """
    if damping is not None:
        damping = max(damping, DAMPING_BOUNDS[0])
    noise = noise_of(laid)
    problem = ResponseProblem(binned(laid, noise, natural, ratio), natural.size, damping)
    ends = [_finished(laid, noise, start, natural.size, damping) for start in _delayed(problem, natural, ratio)]
    best, problem = min(ends, key=lambda end: end[1].cost(end[0]))
    while problem.count > 1:  # what the spectrum had one too many of
        smaller = ResponseProblem(problem.response, problem.count - 1, damping)
        fewer = [smaller.solve(_without(best, problem.count, j), FINAL_STEPS) for j in range(problem.count)]
        found = min(fewer, key=smaller.cost)
        needed = smaller.cost(found) - problem.cost(best) >= _price(problem)
        if needed and not _uncertain(_summary(best, problem)):
            break
        problem, best = smaller, found
    while problem.count < maximum:
        count = problem.count + 1
        trial = ResponseProblem(problem.response, count, damping)
        places = problem.response.frequencies[_worst(problem, best)]
        trials = [trial.solve(_with_mode(best, count - 1, float(place), damping), TRIAL_STEPS) for place in places]
        found, larger = _finished(laid, noise, min(trials, key=trial.cost), count, damping)
        before = ResponseProblem(larger.response, count - 1, damping)
        gained = before.cost(before.solve(best, FINAL_STEPS)) - larger.cost(found)
        if gained < _price(larger) or _uncertain(_summary(found, larger)):
            break
        problem, best = larger, found
    return _summary(*_finished(laid, noise, best, problem.count, damping))


def _finished(
    laid: Alignment, noise: _Array, start: _Array, count: int, fixed: float | None
) -> tuple[_Array, ResponseProblem]:
    """The best unknowns from a start, and their problem: bins follow the modes once."""
    for _ in range(2):
        problem = ResponseProblem(binned(laid, noise, *poles_among(start, count, fixed)), count, fixed)
        start = problem.solve(start, FINAL_STEPS)
    return start, problem


def _price(problem: ResponseProblem) -> float:
    """What a mode must gain to be worth its unknowns."""
    channels, bins = problem.weights.shape
    return float(((2 if problem.fixed is None else 1) + channels) * np.log(2.0 * channels * bins))


def _delayed(problem: ResponseProblem, natural: _Array, ratio: _Array) -> list[_Array]:
    """Unknowns for given modes, with the best of many delays, one for each constant phase; gains have either sign."""
    poles = [np.log(natural)] if problem.fixed is not None else [np.log(natural), np.log(ratio)]
    slopes = PHASE_STEP * np.arange(-PHASE_STEPS, PHASE_STEPS + 1)
    return [
        min(
            (np.concatenate([*poles, [constant, slope], np.zeros(PHASES - 2)]) for slope in slopes),
            key=problem.cost,
        )
        for constant in np.pi / CONSTANT_PHASES * np.arange(CONSTANT_PHASES)
    ]


def _without(unknowns: _Array, count: int, mode: int) -> _Array:
    """Unknowns with a mode fewer."""
    taken = [mode] if unknowns.size == count + PHASES else [mode, count + mode]
    return np.delete(unknowns, taken)


def _worst(problem: ResponseProblem, unknowns: _Array) -> NDArray[np.intp]:
    """Bins in which the misfit is highest, far from each other, the worst first."""
    residual = problem.evaluate(unknowns)[0].reshape(len(problem.weights), 2, -1)
    squares = np.sum((residual * (problem.allowed / problem.weights)[:, None, :]) ** 2, axis=(0, 1))
    power = np.convolve(squares, np.ones(SMOOTHED), "same")
    padded = np.concatenate([[-np.inf], power, [-np.inf]])
    tops = np.flatnonzero((power >= padded[:-2]) & (power >= padded[2:]))
    return np.asarray(tops[np.argsort(power[tops])[::-1]][:TRIAL_PLACES], dtype=np.intp)


def _with_mode(unknowns: _Array, count: int, frequency: float, fixed: float | None) -> _Array:
    """Unknowns with a mode more."""
    parts = [np.append(unknowns[:count], np.log(frequency))]
    if fixed is None:
        parts.append(np.append(unknowns[count : 2 * count], np.log(FIRST_DAMPING)))
    return np.concatenate([*parts, unknowns[-PHASES:]])


def _uncertain(fit: ResponseFit) -> bool:
    """Whether a mode is not determined, or two are not told apart: they cancel each other, or are a slope together."""
    n = fit.natural.size
    half = NORMAL_95 * np.sqrt(np.diag(fit.covariance))
    logs, ratios = np.log(fit.natural), np.log(fit.damping)
    frequencies, dampings = half[:n], half[n:]
    near = np.diff(logs) < frequencies[1:] + frequencies[:-1]
    alike = np.abs(np.diff(ratios)) < dampings[1:] + dampings[:-1]
    return bool(np.any(frequencies > WIDEST_INTERVAL) or np.any(near & alike))


def _summary(unknowns: _Array, problem: ResponseProblem) -> ResponseFit:
    """Covariance: from the noise, or from the misfit where that asks for more."""
    residual, jacobian, gains = problem.evaluate(unknowns)
    response, channels = problem.response, len(problem.weights)
    ratio = np.tile((response.deviation * problem.weights)[:, None, :], (1, 2, 1)).ravel()
    normal = np.linalg.pinv(jacobian.T @ jacobian, rcond=1e-13, hermitian=True)
    by_noise = normal @ (jacobian.T * ratio**2) @ jacobian @ normal
    cluster = (response.frequencies / CLUSTER).astype(int)
    scores = (jacobian * residual[:, None]).reshape(channels * 2, -1, jacobian.shape[1]).sum(axis=0)
    sums = np.array([scores[cluster == each].sum(axis=0) for each in np.unique(cluster)])
    factor = len(sums) / max(len(sums) - jacobian.shape[1], 1)
    by_misfit = normal @ (factor * sums.T @ sums) @ normal
    n = problem.count
    known = 2 * n if problem.fixed is None else n
    covariance = np.zeros((2 * n, 2 * n))
    larger = np.sqrt(np.maximum(np.diag(by_misfit) / np.maximum(np.diag(by_noise), 1e-300), 1.0))[:known]
    covariance[:known, :known] = by_noise[:known, :known] * np.outer(larger, larger)
    natural, damping = problem.poles(unknowns)
    curve = problem.curve(unknowns)
    left = np.abs(response.values - curve) ** 2 - 2.0 * response.deviation**2
    whole = float(np.sum(np.abs(response.values) ** 2))
    misfit = float(np.sqrt(max(float(left.sum()), 0.0) / whole))
    # What is left, and what any model is wrong by, may hide an error of that part of a peak's width, and may hang
    # together over the whole band.
    wrong = float(np.hypot(misfit, MODEL_ERROR))
    hidden = np.concatenate([wrong * damping, np.full(n, wrong)])
    covariance[:known, :known] += np.diag((hidden[:known] / NORMAL_95) ** 2)
    order = np.argsort(natural)
    both = np.concatenate([order, order + n])
    return ResponseFit(
        natural[order],
        damping[order],
        gains[:, order],
        gains[:, n:],
        covariance[np.ix_(both, both)],
        response,
        curve,
        misfit,
    )
