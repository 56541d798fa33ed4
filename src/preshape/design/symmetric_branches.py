"""Symmetric shapers for three undamped modes, followed from closed forms along straight lines in the frequencies.

Unknown are the half times tau_k, impulses at the middle +- tau_k, and the weights a_k of the pairs; the equations are
sum a_k cos(w tau_k) = 0 at each mode, sum a_k tau_k sin(w tau_k) = 0 as well for order 1, and sum a_k = 1: as many as
unknowns for 4 impulses (two pairs) and for 7 (three pairs and the middle one). In p = tau^2 all of this is analytic
also at tau = 0, where two impulses meet in the middle. Closed forms, h the distance of impulses, u = f h:

    evenly spaced   (1 - 2 c q + q^2)(1 + q), for order 1 convolved with itself, vanishes at u = s, 1 - s, 1 + s ...
                    (c = cos 2 pi s) and at u = 1/2, 3/2 ...: so f2 = (f1 + f3) / 2 with h = 1 / (f1 + f3), "mean",
                    and f3 = f1 + 2 f2 with h = 1 / (2 f2), "sum"
    meeting         1 - 2 c q + q^2 with h = 1 / (f1 + f2) vanishes at u = 2 - s too: f3 = f1 + 2 f2 again, order 0;
                    its middle impulse is two that have met

Newton's method follows the solution from one of these to the modes wanted, the step halved where it does not converge.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

__all__ = ["SymmetricShaper", "shortest_branch"]

SMALLEST_STEP = 1e-3
"""Fraction of the way at which a branch that Newton cannot follow is given up: it turns back there."""

LARGEST_CHANGE = 0.2
"""A Newton step that changes a weight, or a p in units of the distance of impulses, by more has left the branch."""

NEWTON_STEPS = 12

ON_THE_BRANCH = 1e-9
"""Equation error on the way."""

SOLVED = 1e-12
"""Equation error that a solution may have; rounding leaves about 1e-15."""


MET = 1e-15
"""A tau^2 in units of h^2 below which two impulses are one in the middle: it changes the residual by its size."""

SAME_LENGTH = 1e-9
"""Two branches whose lengths differ by less [relative] have led to the same solution: the first one names it."""


@dataclass(frozen=True)
class SymmetricShaper:
    """Impulses of a symmetric solution.

    Parameters
    ----------
    times, amplitudes : ndarray, shape (impulse,)
        From 0 [s]; all positive, sum 1 [-].
    start : str
        The closed form it was followed from: "mean", "sum" or "meeting".
    """

    times: NDArray[np.float64]
    amplitudes: NDArray[np.float64]
    start: str


@dataclass(frozen=True)
class _Pairs:
    """Squared half times in units of h^2, weights; `fixed` is 1 when the first is a single impulse in the middle."""

    squares: NDArray[np.float64]
    weights: NDArray[np.float64]
    fixed: int


@dataclass(frozen=True)
class _Start:
    name: str
    frequencies: tuple[float, float, float]
    distance: float
    pairs: _Pairs


def shortest_branch(frequencies: tuple[float, ...], order: int) -> SymmetricShaper | None:
    """The shortest positive solution found for three `frequencies` [Hz] in rising order, or None."""
    best: SymmetricShaper | None = None
    for start in _starts(frequencies, order):
        pairs = _followed(start, frequencies, order)
        if pairs is not None and (pairs.weights > 0.0).all():
            found = _impulses(pairs, start)
            if best is None or found.times[-1] < best.times[-1] * (1.0 - SAME_LENGTH):
                best = found
    return best


def _starts(frequencies: tuple[float, ...], order: int) -> Iterator[_Start]:
    f1, f2, f3 = frequencies
    mean, total = (f1, 0.5 * (f1 + f3), f3), (f1, f2, f1 + 2.0 * f2)
    yield _Start("mean", mean, 1.0 / (f1 + f3), _evenly_spaced(f1 / (f1 + f3), order))
    if f1 < f2:
        yield _Start("sum", total, 0.5 / f2, _evenly_spaced(0.5 * f1 / f2, order))
        if order == 0:
            c = np.cos(2.0 * np.pi * f1 / (f1 + f2))
            meeting = _Pairs(np.array([0.0, 1.0]), np.array([-c, 1.0]) / (1.0 - c), 0)
            yield _Start("meeting", total, 1.0 / (f1 + f2), meeting)


def _evenly_spaced(s: float, order: int) -> _Pairs:
    c = np.cos(2.0 * np.pi * s)
    impulses = np.array([1.0, 1.0 - 2.0 * c, 1.0 - 2.0 * c, 1.0])
    if order == 1:
        impulses = np.convolve(impulses, impulses)
    middle, single = impulses.size // 2, impulses.size % 2
    weights = 2.0 * impulses[middle:] / impulses.sum()
    weights[0] /= 1.0 + single
    return _Pairs((np.arange(weights.size) + (0.0 if single else 0.5)) ** 2, weights, single)


def _followed(start: _Start, frequencies: tuple[float, ...], order: int) -> _Pairs | None:
    """The solution at `frequencies`, or None when the branch from `start` does not reach them."""
    first = 2.0 * np.pi * start.distance * np.array(start.frequencies)
    last = 2.0 * np.pi * start.distance * np.array(frequencies)
    pairs, way, step = start.pairs, 0.0, 1.0
    while way < 1.0:
        target = min(1.0, way + step)
        found = _newton(first + target * (last - first), pairs, order, SOLVED if target == 1.0 else ON_THE_BRANCH)
        if found is not None and (np.diff(found.squares) > 0.0).all():
            pairs, way, step = found, target, 2.0 * step
        elif step < SMALLEST_STEP:
            return None
        else:
            step *= 0.5
    return pairs


def _newton(phases: NDArray[np.float64], start: _Pairs, order: int, accepted: float) -> _Pairs | None:
    """Solve the equations at w h = `phases`, or None when Newton's method leaves the neighbourhood of `start`."""
    squares, weights, fixed, count = start.squares, start.weights, start.fixed, start.weights.size
    best, error = start, np.inf
    for _ in range(NEWTON_STEPS):
        rows, slopes = _rows(phases, squares, order)
        equations = np.append(rows @ weights, weights.sum() - 1.0)
        before, error = error, float(np.abs(equations).max())
        if error < accepted:
            best = _Pairs(squares, weights, fixed)
            if error >= 0.5 * before or accepted > SOLVED:  # at the end, until rounding stops it
                return best
        jacobian = np.zeros((equations.size, 2 * count - fixed))
        jacobian[:-1, :count] = rows
        jacobian[-1, :count] = 1.0
        jacobian[:-1, count:] = (slopes * weights)[:, fixed:]
        try:
            change = np.linalg.solve(jacobian, -equations)
        except np.linalg.LinAlgError:
            return None
        if not np.abs(change).max() < LARGEST_CHANGE:
            return None
        weights = weights + change[:count]
        squares = squares + np.concatenate([np.zeros(fixed), change[count:]])
        squares = np.where(np.abs(squares) < MET, 0.0, squares)
        if squares.min() < 0.0:
            return None
    return best if error < accepted else None


def _rows(
    phases: NDArray[np.float64], squares: NDArray[np.float64], order: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """cos(w tau) and, for order 1, tau sin(w tau), shape (row, pair), with their derivatives by p = tau^2."""
    angle = np.multiply.outer(phases, np.sqrt(squares))
    cosine, sinc = np.cos(angle), np.sinc(angle / np.pi)
    column = phases[:, np.newaxis]
    if order == 0:
        return cosine, -0.5 * column**2 * sinc
    rows = np.vstack([cosine, column * squares * sinc])
    return rows, np.vstack([-0.5 * column**2 * sinc, 0.5 * column * (sinc + cosine)])


def _impulses(pairs: _Pairs, start: _Start) -> SymmetricShaper:
    half, weights = np.sqrt(pairs.squares) * start.distance, 0.5 * pairs.weights
    if half[0] == 0.0:  # a single impulse in the middle
        times = np.concatenate([-half[:0:-1], half])
        amplitudes = np.concatenate([weights[:0:-1], [2.0 * weights[0]], weights[1:]])
    else:
        times = np.concatenate([-half[::-1], half])
        amplitudes = np.concatenate([weights[::-1], weights])
    return SymmetricShaper(times + half[-1], amplitudes, start.name)
