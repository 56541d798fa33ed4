"""An output of driven phasors, y(t) = Re sum_j w_j q_j(t) + a piecewise polynomial, and what bounds its derivatives.

Under a staircase, the commonest input by far, q'' = s q' within a segment, so q = q_0 + q'_0 (exp(s t) - 1) / s: one
exponential gives the value and all derivatives.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.kernel.driven_phasors import DrivenPhasors, taylor_shifted, taylor_sizes
from preshape.kernel.driven_tail import free_phasors, trend

__all__ = ["DrivenOutput", "Looked"]

SLOW = 0.5
"""A pole that turns less than this [rad] in the longest segment needs exp(s t) - 1 without cancellation."""


@dataclass(frozen=True, eq=False, slots=True)
class Looked:
    """An output and its derivatives at the starts of intervals, and the most that they can be within them.

    Parameters
    ----------
    value, slope, curvature : ndarray, shape (interval,)
        The output and its first two derivatives at the start.
    size : ndarray, shape (interval,)
        Of what is added up there, for rounding.
    most_curvature, most_third : ndarray, shape (interval,)
        What the second and third derivative cannot exceed in the interval.
    """

    value: NDArray[np.float64]
    slope: NDArray[np.float64]
    curvature: NDArray[np.float64]
    size: NDArray[np.float64]
    most_curvature: NDArray[np.float64]
    most_third: NDArray[np.float64]


class DrivenOutput:
    """An output of driven phasors.

    Parameters
    ----------
    phasors : DrivenPhasors
        What moves.
    weights : ndarray of complex, shape (pole,)
        w_j.
    polynomial : ndarray, shape (segment, degree + 1)
        Derivatives of the polynomial part at the start of each segment.
    """

    __slots__ = (
        "_bounds",
        "_level",
        "_powers",
        "_sizes",
        "_slow",
        "_staircase",
        "_swing",
        "phasors",
        "polynomial",
        "weights",
    )

    def __init__(
        self, phasors: DrivenPhasors, weights: NDArray[np.complex128], polynomial: NDArray[np.float64]
    ) -> None:
        used = np.flatnonzero(polynomial.any(axis=0))
        self.phasors, self.weights = phasors, weights
        self.polynomial = polynomial[:, : used[-1] + 1] if used.size else polynomial[:, :0]
        self._staircase = not phasors.taylor[:, 1:].any()
        if self._staircase:
            poles = phasors.poles[:, np.newaxis]
            self._swing = weights[:, np.newaxis] * (phasors.at_start + phasors.taylor[:, 0] / poles)
            self._level = (weights @ phasors.at_start).real
            self._sizes = np.abs(self._level) + 2.0 * np.abs(self._swing).sum(axis=0)
            self._powers = (phasors.poles ** np.arange(1, 4)[:, np.newaxis]).astype(np.complex128)
            self._bounds = np.abs(self._powers[1:])
            longest = float((phasors.starts[1:] - phasors.starts[:-1]).max(initial=0.0))
            self._slow = np.flatnonzero(np.abs(phasors.poles) * longest < SLOW)

    def values(
        self, segment: NDArray[np.intp], since: NDArray[np.float64], derivatives: int = 0
    ) -> NDArray[np.float64]:
        """The derivatives of order 0 to `derivatives` (at most 3), shape (order, time)."""
        result = np.empty((derivatives + 1, since.size))
        if self._staircase:
            risen, swing = self._risen(segment, since)
            result[0] = self._level[segment] + risen.sum(axis=0).real
            if derivatives:
                result[1:] = (self._powers[:derivatives] @ (risen + swing)).real
        else:
            phasors, _ = self.phasors.look(segment, since, derivatives)
            for order, q in enumerate(phasors):
                result[order] = (self.weights @ q).real
        if self.polynomial.shape[1]:
            smooth = taylor_shifted(self.polynomial[segment], since)[: derivatives + 1]
            result[: len(smooth)] += smooth
        return result

    def looked(self, segment: NDArray[np.intp], since: NDArray[np.float64], width: NDArray[np.float64]) -> Looked:
        """The output at the starts of intervals, and what bounds it within them."""
        values = np.empty((3, since.size))
        if self._staircase:
            risen, swing = self._risen(segment, since)
            moving = risen + swing
            values[0] = self._level[segment] + risen.sum(axis=0).real
            values[1:] = (self._powers[:2] @ moving).real
            size, bounds = self._sizes[segment], list(self._bounds @ np.abs(moving))
        else:
            phasors, forces = self.phasors.look(segment, since, 3)
            sizes = np.abs(self.weights)
            for order, q in enumerate(phasors[:3]):
                values[order] = (self.weights @ q).real
            size = sizes @ np.abs(phasors[0])
            # |q^(n)| grows no faster than the n-th derivative of the input feeds it.
            bounds = [
                sizes @ np.abs(phasors[n]) + sizes.sum() * width * taylor_sizes(forces[n:], width) for n in (2, 3)
            ]
        if self.polynomial.shape[1]:
            smooth = taylor_shifted(self.polynomial[segment], since)
            values[: len(smooth)] += smooth[:3]
            size = size + np.abs(smooth[0])
            bounds = [bound + taylor_sizes(smooth[n:], width) for n, bound in zip((2, 3), bounds, strict=True)]
        return Looked(values[0], values[1], values[2], size, bounds[0], bounds[1])

    def ending(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """What comes after the last step.

        Returns
        -------
        trend : ndarray, shape (order,)
            Derivatives, right after the last step, of what remains when the free vibration has died out.
        amplitudes : ndarray, shape (pole,)
            Of each pole's free vibration in the output then.
        """
        if not self._staircase:
            level = trend(self.phasors, self.weights, self.polynomial, 0.0)
            return level, np.abs(self.weights) * np.abs(free_phasors(self.phasors))
        swing = self._swing[:, -1]
        level = np.zeros(max(1, self.polynomial.shape[1]))
        level[: self.polynomial.shape[1]] = self.polynomial[-1]
        level[0] += self._level[-1] - swing.sum().real
        return level, np.abs(swing)

    def _risen(
        self, segment: NDArray[np.intp], since: NDArray[np.float64]
    ) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """w_j q'_0 / s (exp(s t) - 1), and w_j q'_0 / s, each of shape (pole, time)."""
        swing = np.take(self._swing, segment, axis=1)
        turned = np.multiply.outer(self.phasors.poles, since)
        risen = np.exp(turned)
        risen -= 1.0
        if self._slow.size:
            risen[self._slow] = np.expm1(turned[self._slow])
        risen *= swing
        return risen, swing
