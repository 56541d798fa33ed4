"""Decaying sinusoids that several channels share: a start by the matrix pencil, a finish by least squares.

The start: the poles are the eigenvalues of the shift of the signal subspace (Y. Hua & T. Sarkar, IEEE Trans. Acoust.
Speech Signal Process. 38 (1990) 814-824; the same idea as ERA of Juang & Pappa, J. Guidance 8 (1985) 620-627). The
finish: amplitudes are eliminated (variable projection, G. Golub & V. Pereyra, SIAM J. Numer. Anal. 10 (1973) 413-432,
Jacobian as L. Kaufman, BIT 15 (1975) 49-57), so only frequencies and damping ratios are searched.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.identify import uncertainty

__all__ = ["DecayFit", "Subspace", "fit_decay", "left_over"]

LONGEST_PENCIL = 220
"""Rows of the matrix whose subspace is taken; more cost time and gain nothing that the finish would not."""

DAMPING_BOUNDS = (-0.05, 0.7)
"""Damping ratios that the finish may try; growing ones show that something is not a free decay."""

STEPS = 30
"""Evaluations of the finish."""

_Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class DecayFit:
    """Fitted decaying sinusoids.

    Attributes
    ----------
    natural, damping : ndarray, shape (mode,)
        Undamped natural frequencies [Hz] and damping ratios.
    covariance : ndarray, shape (2 * mode, 2 * mode)
        Of natural frequencies [Hz], then damping ratios.
    energy : ndarray, shape (mode,)
        Sum of squares of each component over the record, all channels, in the squared unit.
    curve : ndarray, shape (channel, sample)
        The fitted signal.
    noise : ndarray, shape (channel,)
        Standard deviation of what is left.
    criterion : float
        Bayesian information criterion; lower is better.
    """

    natural: _Array
    damping: _Array
    covariance: _Array
    energy: _Array
    curve: _Array
    noise: _Array
    criterion: float


class Subspace:
    """The signal subspace of a record, from which poles of any order are read off.

    Parameters
    ----------
    values : ndarray, shape (channel, sample)
        A record, scaled so that the channels have the same noise.
    rate : float
        Samples per second [Hz].
    longest : int
        Limit to the rows of the matrix.
    """

    def __init__(self, values: _Array, rate: float, longest: int = LONGEST_PENCIL) -> None:
        rows = min(values.shape[-1] // 2, longest)
        hankel = np.lib.stride_tricks.sliding_window_view(values, rows, axis=-1).reshape(-1, rows)
        _, vectors = np.linalg.eigh(hankel.T @ hankel)
        self._vectors = vectors[:, ::-1]
        self._rate = rate

    def poles(self, order: int) -> tuple[_Array, _Array]:
        """Undamped natural frequencies [Hz] and damping ratios of the oscillating poles among `order`."""
        basis = self._vectors[:, : min(order, self._vectors.shape[0] - 1)]
        shift, *_ = np.linalg.lstsq(basis[:-1], basis[1:], rcond=None)
        discrete = np.linalg.eigvals(shift)
        upper = discrete[(discrete.imag > 1e-9) & (np.abs(discrete) > 1e-6)]
        poles = self._rate * np.log(upper)
        natural = np.abs(poles) / (2.0 * np.pi)
        damping = -poles.real / np.abs(poles)
        keep = (damping > DAMPING_BOUNDS[0]) & (damping < DAMPING_BOUNDS[1])
        order_of = np.argsort(natural[keep])
        return natural[keep][order_of], damping[keep][order_of]


def _basis(natural: _Array, damping: _Array, times: _Array) -> tuple[_Array, _Array]:
    """Columns exp(-z w t) cos/sin(w sqrt(1 - z^2) t), interleaved by mode, then a constant; and complex exponentials.

    The exponentials, shape (mode, sample), serve the derivatives.
    """
    omega = 2.0 * np.pi * natural[:, None]
    complex_pole = omega * (-damping[:, None] + 1j * np.sqrt(1.0 - damping[:, None] ** 2))
    waves = np.exp(complex_pole * times)
    columns = np.stack([waves.real, waves.imag], axis=1).reshape(2 * natural.size, times.size)
    return np.concatenate([columns, np.ones((1, times.size))]).T, waves


def left_over(values: _Array, rate: float, natural: _Array, damping: _Array) -> tuple[float, int]:
    """Sum of squares that decaying sinusoids of given poles leave of a record, and the freedoms that remain."""
    basis, _ = _basis(natural, damping, np.arange(values.shape[-1]) / rate)
    amplitudes = np.linalg.lstsq(basis, values.T, rcond=None)[0]
    return float(np.sum((values.T - basis @ amplitudes) ** 2)), values.size - amplitudes.size - 2 * natural.size


class _Projection:
    """Residual of the best amplitudes for given poles, and its Jacobian, with memory of the last point."""

    def __init__(self, values: _Array, rate: float, fixed: float | None) -> None:
        self.values = values
        self.times = np.arange(values.shape[-1]) / rate
        self.fixed = fixed
        self._last: tuple[bytes, _Array, _Array] | None = None

    def split(self, unknowns: _Array) -> tuple[_Array, _Array]:
        if self.fixed is not None:
            return unknowns, np.full(unknowns.size, self.fixed)
        n = unknowns.size // 2
        return unknowns[:n], unknowns[n:]

    def amplitudes(self, unknowns: _Array) -> tuple[_Array, _Array]:
        """The basis (sample, column) and the amplitudes (column, channel)."""
        basis, _ = _basis(*self.split(unknowns), self.times)
        return basis, np.asarray(np.linalg.lstsq(basis, self.values.T, rcond=None)[0], dtype=np.float64)

    def _evaluate(self, unknowns: _Array) -> tuple[_Array, _Array]:
        key = unknowns.tobytes()
        if self._last is not None and self._last[0] == key:
            return self._last[1], self._last[2]
        natural, damping = self.split(unknowns)
        basis, waves = _basis(natural, damping, self.times)
        q, r = np.linalg.qr(basis)
        projected = q.T @ self.values.T
        amplitudes = np.linalg.lstsq(r, projected, rcond=None)[0]
        residual = q @ projected - self.values.T
        root = np.sqrt(1.0 - damping**2)
        by_frequency = 2.0 * np.pi * (-damping + 1j * root)
        by_damping = 2.0 * np.pi * natural * (-1.0 - 1j * damping / root)
        slopes = []
        for factors in (by_frequency,) if self.fixed is not None else (by_frequency, by_damping):
            moved = factors[:, None] * self.times * waves
            for mode in range(natural.size):
                pair = amplitudes[2 * mode : 2 * mode + 2]
                slope = np.outer(moved[mode].real, pair[0]) + np.outer(moved[mode].imag, pair[1])
                slopes.append((slope - q @ (q.T @ slope)).ravel())
        self._last = key, residual.ravel(), np.array(slopes).T
        return self._last[1], self._last[2]

    def residual(self, unknowns: _Array) -> _Array:
        return self._evaluate(unknowns)[0]

    def jacobian(self, unknowns: _Array) -> _Array:
        return self._evaluate(unknowns)[1]


def fit_decay(values: _Array, rate: float, natural: _Array, damping: _Array, *, fixed: float | None = None) -> DecayFit:
    """Finish a start by least squares, channels weighted by the noise that the start leaves in them.

    Parameters
    ----------
    values : ndarray, shape (channel, sample)
        A free decay.
    rate : float
        Samples per second [Hz].
    natural, damping : ndarray, shape (mode,)
        The start: natural frequencies [Hz], damping ratios.
    fixed : float, optional
        Fixes all damping ratios.
    """
    from scipy.optimize import least_squares

    count = natural.size
    start = natural if fixed is not None else np.concatenate([natural, damping])
    plain = _Projection(values, rate, fixed)
    basis, amplitudes = plain.amplitudes(start)
    noise = _noise(values.T - basis @ amplitudes, values)
    problem = _Projection(values / noise[:, None], rate, fixed)
    low, high = np.full(count, 0.25 * natural.min()), np.full(count, 0.5 * rate)
    if fixed is None:
        low = np.concatenate([low, np.full(count, DAMPING_BOUNDS[0])])
        high = np.concatenate([high, np.full(count, DAMPING_BOUNDS[1])])
    inside = np.clip(start, low + 1e-9, high - 1e-9)
    solution = least_squares(
        problem.residual, inside, problem.jacobian, bounds=(low, high), x_scale="jac", max_nfev=STEPS
    ).x
    basis, amplitudes = plain.amplitudes(solution)
    left = values.T - basis @ amplitudes
    jacobian = problem.jacobian(solution)
    size, linear = left.size, basis.shape[1] * values.shape[0]
    squares = float(np.sum((left / noise) ** 2))
    variance = squares / max(size - linear - solution.size, 1)
    covariance = np.zeros((2 * count, 2 * count))
    known = solution.size
    covariance[:known, :known] = uncertainty.covariance(jacobian, variance)
    final_natural, final_damping = problem.split(solution)
    parts = basis[:, :-1].reshape(-1, count, 2), amplitudes[:-1].reshape(count, 2, -1)
    energy = np.array([np.sum((parts[0][:, j] @ parts[1][j]) ** 2) for j in range(count)])
    order = np.argsort(final_natural)
    both = np.concatenate([order, order + count])
    final_noise = _noise(left, values)
    likelihood = values.shape[-1] * float(np.sum(2.0 * np.log(final_noise)))
    return DecayFit(
        final_natural[order],
        final_damping[order],
        covariance[np.ix_(both, both)],
        energy[order],
        (basis @ amplitudes).T,
        final_noise,
        likelihood + (solution.size + linear) * float(np.log(size)),
    )


def _noise(left: _Array, values: _Array) -> _Array:
    """Standard deviation of what is left in each channel, kept above rounding errors, shape (channel,)."""
    smallest = 1e-9 * float(np.max(np.std(values, axis=-1))) + np.finfo(float).tiny
    return np.asarray(np.maximum(np.sqrt(np.mean(left**2, axis=0)), smallest))
