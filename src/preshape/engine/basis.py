"""The constraint functions of zero vibration, orthonormalised on the interval they are used on.

The engine counts time backwards: the lead u of an impulse is its time before the last one. A shaper's residual is then
sum a_i exp(-s_j u_i) whatever its duration, fast damped modes live near u = 0 where floating-point numbers are finest,
and a longer shaper is one that may use larger leads. The functions are u^k exp(-s_j u).

Scaling the rows is not enough: near-equal modes, and derivatives of one mode, are nearly parallel on a short interval,
and then look satisfied long before they are. Divided differences (kernel) tell near-equal modes apart; after
orthonormalising, a distance of 1e-4 means 1e-4.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from preshape.errors import InputError
from preshape.kernel import (
    DividedExponentials,
    chebyshev_derivative,
    chebyshev_values,
    near_rates,
    orthonormal_series,
)
from preshape.mode import Modes

__all__ = ["Basis", "plain_rows"]

SAMPLES_PER_PERIOD = 16
"""Samples in a period of the fastest mode: for orthonormalising, and for finding the extrema of a combination."""

SPARSER = 3
"""Orthonormalising needs that much fewer samples: more than four a period of the fastest mode span what all span."""

MAXIMUM_REFINEMENTS = 60

EXACT, BRACKET = 1e-15, 1e-6
"""Precisions of times relative to the duration: the last digit, and enough to tell neighbouring extrema apart."""


FEASIBLE = 1e-12
"""Smallest distance (rows orthonormal) that least squares tells from zero."""


IN_SPAN = 1e-10
"""Coefficients that miss the rows' span by no more than this fraction of the largest are in it."""

DENSE = 3e-11
"""Rounding of the rows from which on their span is computed in thirty-two digits instead of sixteen."""


class Basis:
    """Rows g(u) in R^m, orthonormal over even leads in [0, duration], each of mean square one.

    m = 2 sum_j (q_j + 1) unless some are dependent to all digits. Modes far from each other are spanned by divided
    exponentials; where these are dependent to more than five digits (dense modes on a short interval), by series that
    were orthonormalised in thirty-two digits.

    Parameters
    ----------
    modes : Modes
        Modes whose vibration is to vanish.
    orders : tuple of int
        Derivatives of the residual that vanish with it at each mode.
    duration : float
        Length of the interval [s]; leads outside [0, duration] may still be evaluated.
    groups : tuple of tuples of int, optional
        Indices of modes that are treated as near each other, by default found from their distance; () for dense modes.
    """

    def __init__(
        self,
        modes: Modes,
        orders: tuple[int, ...],
        duration: float,
        groups: tuple[tuple[int, ...], ...] | None = None,
    ) -> None:
        self.modes, self.orders, self.duration = modes, orders, duration
        self._fastest = max(mode.frequency for mode in modes)
        self._rates = np.array([-mode.pole.conjugate() for mode in modes])
        leads = np.linspace(0.0, duration, self.samples_needed(duration) // SPARSER + 2 * len(modes))
        self.groups = near_rates(list(self._rates), duration) if groups is None else groups
        self._functions: DividedExponentials | None = None
        if self.groups:
            self._with_exponentials(leads)
        if not self.groups:
            self._with_series(leads)
        elif groups is None and self.rounding > DENSE:
            near, self.groups = self.groups, ()
            self._with_series(leads)
            if self.size < 2 * sum(order + 1 for order in orders):  # they tell less apart than divided differences do
                self.groups = near
                self._with_exponentials(leads)
        self.zero = max(FEASIBLE, 4.0 * math.sqrt(max(self.size, 1)) * self.rounding)
        """A distance below this counts as zero: the constraints can be met."""

    def _with_exponentials(self, leads: NDArray[np.float64]) -> None:
        nodes = [[self._rates[i] for i in group for _ in range(self.orders[i] + 1)] for group in self.groups]
        self._functions = DividedExponentials(nodes, self.duration)
        slope, size = self._functions.derivative, self._functions.size
        self._derivative = np.empty((2 * size, 2 * size))
        self._derivative[:size, :size] = self._derivative[size:, size:] = slope.real
        self._derivative[:size, size:], self._derivative[size:, :size] = -slope.imag, slope.imag
        phase = 1.0 + np.multiply.outer(np.abs(self._functions.rates), leads)
        self._orthonormalise(self.raw(leads), None, np.concatenate([phase, phase]))

    def _with_series(self, leads: NDArray[np.float64]) -> None:
        self._functions = None
        series = orthonormal_series(self._rates, self.orders, self.duration)
        self._count = series.shape[1] if series.size else 0
        if not series.size:  # nothing can be said with these numbers, and whoever asks for the functions is told
            self.size, self.rounding = 0, math.inf
            return
        self._derivative = chebyshev_derivative(self._count, self.duration)
        angles = 2.0 * np.arcsin(np.sqrt(leads / self.duration))
        self._orthonormalise(self.raw(leads), series, 1.0 + np.multiply.outer(np.arange(self._count), angles))

    def _orthonormalise(
        self, raw: NDArray[np.float64], combine: NDArray[np.float64] | None, phase: NDArray[np.float64]
    ) -> None:
        """The transform from raw functions at even leads to orthonormal rows, and what rounding does to these."""
        triangle = np.asarray(np.linalg.qr((raw if combine is None else combine @ raw).T, mode="r"))
        scale = math.sqrt(raw.shape[1])
        self._transform, self._back = _inverse_transposed(triangle) * scale, triangle / scale
        if combine is not None:
            self._transform, self._back = self._transform @ combine, self._back @ combine
        self._slopes = [self._transform]
        self.size = int(self._transform.shape[0])
        spread = np.abs(self._transform) @ (np.abs(raw) * phase)
        self.rounding = float(np.finfo(float).eps * spread.max())
        """Error of g that rounding a lead and the functions makes at most [-]: no equation in g can be met better."""

    def samples_needed(self, duration: float) -> int:
        """How many samples of [0, duration] [s] show the extrema of a combination of the rows."""
        functions = sum(order + 1 for order in self.orders)
        return math.ceil(SAMPLES_PER_PERIOD * self._fastest * duration) + 8 * functions

    def __call__(self, leads: NDArray[np.float64]) -> NDArray[np.float64]:
        """g at `leads` [s], shape (row, lead)."""
        raw = self.raw(leads)
        values: NDArray[np.float64] = self._transform @ raw
        return values

    def raw(self, leads: NDArray[np.float64]) -> NDArray[np.float64]:
        """The functions that g combines, shape (function, lead): exponentials, real parts first, or polynomials."""
        if self._functions is None:
            if not self._count:
                slowest = min(mode.frequency for mode in self.modes)
                raise InputError(
                    f"modes of {slowest:g} to {self._fastest:g} Hz, damped as these are, fall by more within "
                    f"{self.duration:g} s than floating point holds: leave out the fastest, or design them apart and "
                    "convolve."
                )
            return chebyshev_values(leads, self.duration, self._count)
        values = self._functions(leads)
        return np.concatenate([values.real, values.imag])

    def slopes(self, raw: NDArray[np.float64], derivative: int) -> NDArray[np.float64]:
        """d^n g / du^n from what :meth:`raw` gave, shape (row, lead) [1/s^n]."""
        while len(self._slopes) <= derivative:
            self._slopes.append(self._slopes[-1] @ self._derivative)
        values: NDArray[np.float64] = self._slopes[derivative] @ raw
        return values

    def values(self, raw: NDArray[np.float64]) -> NDArray[np.float64]:
        """g from what :meth:`raw` gave, shape (row, lead)."""
        return self.slopes(raw, 0)

    def weights(self, multipliers: NDArray[np.float64], derivatives: int) -> list[NDArray[np.float64]]:
        """Row vectors that give p = multipliers . g and its first `derivatives` derivatives when applied to raw."""
        found = [multipliers @ self._transform]
        for _ in range(derivatives):
            found.append(found[-1] @ self._derivative)
        return found

    def coefficients(self, multipliers: NDArray[np.float64]) -> tuple[complex, ...]:
        """multipliers . g(u) as c_n of Re sum c_n phi_n(u), phi the divided exponentials or Chebyshev polynomials."""
        if self._functions is None:
            return tuple((multipliers @ self._transform).astype(complex).tolist())
        plain, size = multipliers @ self._transform, self._functions.size
        return tuple((plain[:size] - 1j * plain[size:]).tolist())

    def multipliers(self, coefficients: NDArray[np.complex128]) -> NDArray[np.float64]:
        """The inverse of :meth:`coefficients`, scaled to length one; zeros when they are no combination of the rows."""
        if self._functions is None:
            plain = coefficients.real
            if plain.size != self._transform.shape[1] or coefficients.imag.any():
                return np.zeros(self.size)
        else:
            plain = np.concatenate([coefficients.real, -coefficients.imag])
        found: NDArray[np.float64] = self._back @ plain
        miss = float(np.abs(found @ self._transform - plain).max())
        length = float(np.linalg.norm(found))
        if length == 0.0 or miss > IN_SPAN * float(np.abs(plain).max()):
            return np.zeros(self.size)
        return found / length


def plain_rows(
    modes: Modes, orders: tuple[int, ...], leads: NDArray[np.float64], duration: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(u/T)^k exp(-s_j u), what the papers' equations ask, and their slopes [1/s], each of shape (row, lead).

    Real parts come before imaginary parts.
    """
    rates = np.repeat([-mode.pole.conjugate() for mode in modes], [order + 1 for order in orders])
    powers = np.concatenate([np.arange(order + 1) for order in orders])[:, None]
    wave = np.exp(np.multiply.outer(-rates, leads))
    rows = wave * (leads / duration) ** powers
    slopes = -rates[:, None] * rows + wave * (powers / duration) * (leads / duration) ** np.maximum(powers - 1, 0)
    return np.concatenate([rows.real, rows.imag]), np.concatenate([slopes.real, slopes.imag])


def _inverse_transposed(triangle: NDArray[np.float64]) -> NDArray[np.float64]:
    """R^-T of an upper triangular R."""
    from scipy.linalg.lapack import dtrtri

    inverse, trouble = dtrtri(triangle)
    if trouble:
        return np.asarray(np.linalg.pinv(triangle).T, dtype=float)
    result: NDArray[np.float64] = inverse.T
    return result
