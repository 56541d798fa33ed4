"""Phasors driven by a piecewise polynomial: q' = s q + f(t), solved segment by segment without a time step.

Within a segment f is its Taylor polynomial sum_k f_k t^k / k!, so
  q(t) = exp(s t) q(0) + sum_k f_k t^(k+1) phi_{k+1}(s t)
exactly. Between segments the phasor may be kicked, which is what impulses in the input do.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from preshape.kernel.phi_functions import phi_functions

__all__ = ["DrivenPhasors", "driven_phasors", "taylor_shifted", "taylor_sizes"]


@dataclass(frozen=True, eq=False, slots=True)
class DrivenPhasors:
    """Phasors at rest at 0 before the first segment, under one and the same input.

    Parameters
    ----------
    poles : ndarray of complex, shape (pole,)
        s [1/s], real part at most 0.
    starts : ndarray, shape (segment,)
        Where the segments of the input begin [s], not decreasing; the last one goes on for ever.
    taylor : ndarray, shape (segment, order + 1)
        The input's derivatives of order 0, 1, ... at the start of each segment, right after its step.
    at_start : ndarray of complex, shape (pole, segment)
        The phasors at the start of each segment, right after its kick.
    """

    poles: NDArray[np.complex128]
    starts: NDArray[np.float64]
    taylor: NDArray[np.float64]
    at_start: NDArray[np.complex128]

    def segment(self, times: NDArray[np.float64]) -> NDArray[np.intp]:
        """Index of the segment that each time is in; -1 before the first."""
        return np.searchsorted(self.starts, times, side="right") - 1

    def look(
        self, segment: NDArray[np.intp], since: NDArray[np.float64], derivatives: int
    ) -> tuple[list[NDArray[np.complex128]], NDArray[np.float64]]:
        """The phasors' derivatives of order 0 to `derivatives`, and the input's, `since` [s] after a segment's start.

        Returns
        -------
        list of ndarray, each of shape (pole, time)
        ndarray, shape (order, time)
        """
        forces = taylor_shifted(self.taylor[segment], since)
        values = [_advanced(self.poles, self.at_start[:, segment], self.taylor[segment].T, since)]
        for order in range(derivatives):
            nxt = self.poles[:, np.newaxis] * values[order]
            values.append(nxt + forces[order] if order < len(forces) else nxt)
        return values, forces


def driven_phasors(
    poles: NDArray[np.complex128],
    starts: NDArray[np.float64],
    taylor: NDArray[np.float64],
    kicks: NDArray[np.complex128] | None = None,
) -> DrivenPhasors:
    """Carry the phasors from segment to segment.

    Parameters
    ----------
    poles, starts, taylor : ndarray
        As of :class:`DrivenPhasors`.
    kicks : ndarray of complex, shape (pole, segment), optional
        What is added to the phasors where each segment begins.

    Examples
    --------
    An input that steps to 1, and a pole that is fast against what follows, settle at -1/s:

    >>> run = driven_phasors(np.array([-50.0 + 0j]), np.array([0.0, 1.0]), np.array([[1.0], [1.0]]))
    >>> run.at_start.real.round(12).tolist()
    [[0.0, 0.02]]
    """
    count = starts.size
    state = np.zeros((poles.size, count), dtype=complex)
    if count:
        gaps = np.diff(starts)
        decays = np.exp(np.multiply.outer(poles, gaps))
        forced = _advanced(poles, state[:, 1:], taylor[:-1].T, gaps)
        now = np.zeros(poles.size, dtype=complex) if kicks is None else kicks[:, 0]
        state[:, 0] = now
        for k in range(count - 1):
            now = decays[:, k] * now + forced[:, k]
            if kicks is not None:
                now = now + kicks[:, k + 1]
            state[:, k + 1] = now
    return DrivenPhasors(poles, starts, taylor, state)


def taylor_shifted(taylor: NDArray[np.float64], since: NDArray[np.float64]) -> NDArray[np.float64]:
    """Derivatives of polynomials `since` after the points where `taylor`, shape (time, order), holds them.

    Returns
    -------
    ndarray, shape (order, time)
    """
    result = np.empty((taylor.shape[1], since.size))
    for order in range(taylor.shape[1]):
        result[order] = _polynomial(taylor.T[order:], since)
    return result


def taylor_sizes(derivatives: NDArray[np.float64], width: NDArray[np.float64]) -> NDArray[np.float64]:
    """What polynomials with these derivatives at 0, shape (order, time), cannot exceed on [0, width], shape (time,)."""
    return _polynomial(np.abs(derivatives), width)


def _polynomial(taylor: NDArray[np.float64], since: NDArray[np.float64]) -> NDArray[np.float64]:
    """sum_k taylor[k] since^k / k!, by Horner; `taylor` of shape (order, time)."""
    if len(taylor) == 0:
        return np.zeros_like(since)
    value: NDArray[np.float64] = taylor[-1]
    for order in range(len(taylor) - 1, 0, -1):
        value = taylor[order - 1] + value * since / order
    return value


def _advanced(
    poles: NDArray[np.complex128],
    phasors: NDArray[np.complex128],
    taylor: NDArray[np.float64],
    since: NDArray[np.float64],
) -> NDArray[np.complex128]:
    """The phasors, shape (pole, time), `since` later, under an input with derivatives `taylor`, shape (order, time)."""
    used = len(taylor)
    while used and not taylor[used - 1].any():
        used -= 1
    phi = phi_functions(np.multiply.outer(poles, since), used)
    value: NDArray[np.complex128] = phi[0] * phasors
    power = np.ones_like(since)
    for order in range(used):
        power = power * since
        value += (taylor[order] * power) * phi[order + 1]
    return value
