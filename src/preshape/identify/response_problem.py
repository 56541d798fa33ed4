"""The least-squares problem of modes in a frequency response: gains eliminated, poles and phase searched."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from preshape.identify.frequency_response import FrequencyResponse
from preshape.identify.spectral_model import transmissibility

__all__ = ["DAMPING_BOUNDS", "MODEL_ERROR", "PHASES", "ResponseProblem", "poles_among"]

DAMPING_BOUNDS = (3e-4, 0.6)
WEIGHT_ERROR = 0.001
"""Relative error beside the noise that weighs the residuals: little, or what noise leaves of the peaks is lost."""

MODEL_ERROR = 0.005
"""Relative error that the model is allowed: no mode is added to explain less, no interval is narrower for it."""

PHASES = 4
"""Coefficients of the phase: constant, delay, delay that grows with the frequency, and that bends."""

_Array = NDArray[np.float64]
_Complex = NDArray[np.complex128]


def poles_among(unknowns: _Array, count: int, fixed: float | None) -> tuple[_Array, _Array]:
    """Natural frequencies [Hz] and damping ratios among the unknowns."""
    natural = np.exp(unknowns[:count])
    return natural, np.full(count, fixed) if fixed is not None else np.exp(unknowns[count : 2 * count])


class ResponseProblem:
    """Weighted residuals of the best gains for given poles and phase, and their Jacobian, as real numbers.

    Unknowns: log natural frequencies, log damping ratios (absent when fixed), coefficients of the phase.
    """

    def __init__(self, response: FrequencyResponse, count: int, fixed: float | None) -> None:
        self.response = response
        self.count = count
        self.fixed = fixed
        size = np.abs(response.values)
        self.weights = 1.0 / np.hypot(response.deviation, WEIGHT_ERROR * size)
        self.allowed = 1.0 / np.hypot(response.deviation, MODEL_ERROR * size)
        f = response.frequencies
        middle, half = 0.5 * (f[0] + f[-1]), 0.5 * (f[-1] - f[0])
        self.powers = ((f - middle) / half) ** np.arange(PHASES)[:, None]
        self.relative = f / f[-1]
        damping = [] if fixed is not None else [np.full(count, np.log(bound)) for bound in DAMPING_BOUNDS]
        free = np.full(PHASES, np.inf)
        self.lower = np.concatenate([np.full(count, np.log(f[0])), *damping[:1], -free])
        self.upper = np.concatenate([np.full(count, np.log(f[-1])), *damping[1:], free])
        self._last: tuple[bytes, _Array, _Array, _Array] | None = None

    def poles(self, unknowns: _Array) -> tuple[_Array, _Array]:
        """Natural frequencies [Hz] and damping ratios."""
        return poles_among(unknowns, self.count, self.fixed)

    def evaluate(self, unknowns: _Array) -> tuple[_Array, _Array, _Array]:
        """Residuals (channel * 2 * bin,), Jacobian (residual, unknown), gains (channel, mode + 2)."""
        key = unknowns.tobytes()
        if self._last is not None and self._last[0] == key:
            return self._last[1:]
        natural, damping = self.poles(unknowns)
        turn = np.exp(1j * (unknowns[-PHASES:] @ self.powers))
        modal, by_natural, by_damping = transmissibility(self.response.frequencies, natural, damping)
        basis = turn * np.concatenate([modal, np.ones((1, turn.size)), (self.relative**2)[None, :]])
        moves = (
            [turn * by_natural] if self.fixed is not None else [turn * by_natural, turn * damping[:, None] * by_damping]
        )
        residuals, slopes, gains = [], [], []
        for values, weight in zip(self.response.values, self.weights, strict=True):
            columns = _real(basis * weight).T
            q, r = np.linalg.qr(columns)
            wanted = _real(values[None, :] * weight)[0]
            gain = np.linalg.lstsq(r, q.T @ wanted, rcond=None)[0]
            curve = gain @ basis
            moved = [gain[: self.count, None] * each for each in moves]
            moved.append(1j * self.powers * curve)
            slope = _real(np.concatenate(moved) * weight).T
            residuals.append(columns @ gain - wanted)
            slopes.append(slope - q @ (q.T @ slope))
            gains.append(gain)
        self._last = key, np.concatenate(residuals), np.concatenate(slopes), np.array(gains)
        return self._last[1:]

    def curve(self, unknowns: _Array) -> _Complex:
        """The fitted response, shape (channel, bin)."""
        natural, damping = self.poles(unknowns)
        modal, _, _ = transmissibility(self.response.frequencies, natural, damping)
        basis = np.concatenate([modal, np.ones((1, modal.shape[-1])), (self.relative**2)[None, :]])
        turned = self.evaluate(unknowns)[2] @ basis * np.exp(1j * (unknowns[-PHASES:] @ self.powers))
        return np.asarray(turned, dtype=np.complex128)

    def residual(self, unknowns: _Array) -> _Array:
        return self.evaluate(unknowns)[0]

    def jacobian(self, unknowns: _Array) -> _Array:
        return self.evaluate(unknowns)[1]

    def cost(self, unknowns: _Array) -> float:
        """Sum of squared residuals in units of noise and allowed model error: what the number of modes goes by."""
        residual = self.evaluate(unknowns)[0].reshape(len(self.weights), 2, -1)
        return float(np.sum((residual * (self.allowed / self.weights)[:, None, :]) ** 2))

    def solve(self, start: _Array, steps: int) -> _Array:
        """The best unknowns from a start."""
        from scipy.optimize import least_squares

        inside = np.clip(start, self.lower + 1e-9, self.upper - 1e-9)
        result = least_squares(
            self.residual,
            inside,
            self.jacobian,
            bounds=(self.lower, self.upper),
            x_scale="jac",
            max_nfev=steps,
        )
        return np.asarray(result.x, dtype=np.float64)


def _real(rows: _Complex) -> _Array:
    """Real and imaginary parts side by side."""
    return np.concatenate([rows.real, rows.imag], axis=-1)
