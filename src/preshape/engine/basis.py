"""The constraint functions of zero vibration: t^k exp(s_j t), orthonormalised on the interval they are used on.

Scaling the rows is not enough: near-equal modes, and derivatives of one mode, are nearly parallel on a short interval,
and then look satisfied long before they are. After orthonormalising, a distance of 1e-4 means 1e-4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.mode import Modes

__all__ = ["Basis"]

SAMPLES_PER_PERIOD = 24
"""Samples in a period of the fastest mode: for orthonormalising, and for finding every extremum of a combination."""


MAXIMUM_REFINEMENTS = 60

EXACT, BRACKET = 1e-15, 1e-6
"""Precisions of times relative to the duration: the last digit, and enough to tell neighbouring extrema apart."""


class Basis:
    """Rows g(t) in R^m, m = 2 sum_j (q_j + 1), orthonormal over even samples of [0, duration], each of mean square one.

    Parameters
    ----------
    modes : Modes
        Modes whose vibration is to vanish.
    orders : tuple of int
        Derivatives of the residual that vanish with it at each mode.
    duration : float
        Length of the interval [s]; times outside [0, duration] may still be evaluated.
    """

    def __init__(self, modes: Modes, orders: tuple[int, ...], duration: float) -> None:
        self.modes, self.orders, self.duration = modes, orders, duration
        self._rates = np.repeat([-mode.pole.conjugate() for mode in modes], [order + 1 for order in orders])
        self._powers = np.concatenate([np.arange(order + 1) for order in orders])
        size = self._powers.size
        derivative = np.diag(self._rates)
        rows = np.flatnonzero(self._powers)
        derivative[rows, rows - 1] = self._powers[rows] / duration
        self._derivative = np.block([[derivative.real, -derivative.imag], [derivative.imag, derivative.real]])
        samples = self.samples_needed(duration)
        raw = self.raw(np.linspace(0.0, duration, samples))
        triangle: NDArray[np.float64] = np.asarray(np.linalg.qr(raw.T, mode="r"))
        self._transform = np.linalg.solve(triangle.T, np.eye(2 * size)) * np.sqrt(samples)
        self.size = 2 * size
        phase = float(np.abs(self._rates).max()) * duration
        self.rounding = float(np.finfo(float).eps * phase * np.linalg.norm(self._transform, 2))
        """Error of g that the rounding of a time alone makes [-]: no equation in g can be met better."""

    def samples_needed(self, duration: float) -> int:
        """How many samples of [0, duration] show every extremum of a combination of the rows."""
        fastest = max(mode.frequency for mode in self.modes)
        return int(np.ceil(SAMPLES_PER_PERIOD * fastest * duration)) + 8 * self._powers.size

    def __call__(self, times: NDArray[np.float64], derivative: int = 0) -> NDArray[np.float64]:
        """g or a derivative of it at `times` [s], shape (row, time)."""
        values: NDArray[np.float64] = self._transform @ self.raw(times, derivative)
        return values

    def raw(self, times: NDArray[np.float64], derivative: int = 0) -> NDArray[np.float64]:
        """(t/T)^k exp(s_j (t - T)) or a derivative of it, real parts before imaginary parts, shape (row, time)."""
        wave = np.exp(np.multiply.outer(self._rates, times - self.duration))
        wave *= (times / self.duration) ** self._powers[:, None]
        rows = np.concatenate([wave.real, wave.imag])
        for _ in range(derivative):
            rows = self._derivative @ rows
        return rows

    def coefficients(self, multipliers: NDArray[np.float64], duration: float) -> tuple[complex, ...]:
        """The combination multipliers . g(t) as c_jk of Re sum c_jk (t/T)^k exp(s_j (t - T)) with T = `duration`."""
        real, imaginary = np.split(self._transform.T @ multipliers, 2)
        stretch = duration / self.duration
        scale = stretch**self._powers * np.exp(self._rates * (duration - self.duration))
        return tuple(complex(value) for value in (real - 1j * imaginary) * scale)

    def multipliers(self, coefficients: NDArray[np.complex128]) -> NDArray[np.float64]:
        """The inverse of :meth:`coefficients` for T = this basis' duration, scaled to length one; zeros stay zeros."""
        plain = np.concatenate([coefficients.real, -coefficients.imag])
        found = np.linalg.solve(self._transform.T, plain)
        length = float(np.linalg.norm(found))
        return found / length if length > 0.0 else found

    def minima(self, multipliers: NDArray[np.float64], stop: float, precision: float = EXACT) -> NDArray[np.float64]:
        """Times of all local minima of p = multipliers . g on [0, stop], both ends included [s].

        Between neighbouring roots of p'' the slope is monotone, so none of its roots is missed there; samples alone
        would miss a minimum beside a maximum, which is what flat certificates have. `precision` is that of the times,
        relative to the duration.
        """
        weights = [multipliers @ self._transform]
        for _ in range(3):
            weights.append(weights[-1] @ self._derivative)
        samples = np.linspace(0.0, stop, self.samples_needed(stop))
        rows = self.raw(samples)
        bends = weights[2] @ rows >= 0.0
        change = np.flatnonzero(bends[:-1] != bends[1:])
        turning = self._refined(weights[2:], samples[change], samples[change + 1], BRACKET)
        nodes = np.concatenate([samples, turning])
        rising = np.concatenate([weights[1] @ rows, weights[1] @ self.raw(turning)]) >= 0.0
        order = np.argsort(nodes, kind="stable")
        nodes, rising = nodes[order], rising[order]
        turns = np.flatnonzero(~rising[:-1] & rising[1:])
        inner = self._refined(weights[1:], nodes[turns], nodes[turns + 1], precision)
        return np.unique(np.concatenate([[0.0], inner, [stop]]))

    def _refined(
        self,
        weights: list[NDArray[np.float64]],
        low: NDArray[np.float64],
        high: NDArray[np.float64],
        precision: float,
    ) -> NDArray[np.float64]:
        """The root of weights[0] . raw in each bracket: Newton steps (slope weights[1]) that bisection keeps inside."""
        if low.size == 0:
            return low
        sign = np.where(weights[0] @ self.raw(high) >= 0.0, 1.0, -1.0)
        guess = 0.5 * (low + high)
        for _ in range(MAXIMUM_REFINEMENTS):
            rows = self.raw(guess)
            value, slope = sign * (weights[0] @ rows), sign * (weights[1] @ rows)
            low, high = np.where(value < 0.0, guess, low), np.where(value < 0.0, high, guess)
            step = guess - value / np.where(slope > 0.0, slope, np.inf)
            inside = (step >= low) & (step <= high) & (slope > 0.0)
            following = np.where(inside, step, 0.5 * (low + high))
            moved = float(np.abs(following - guess).max())
            guess = following
            if moved <= precision * self.duration:
                break
        return guess
